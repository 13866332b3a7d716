//! The settings in which cycles are searched and confirmed.
//!
//! All are the locomotion regime, with the manufacturer's effort and joint limits on. Searches look at
//! the first of the [`corners`], confirmations at all of them; what else a setting changes, engine step,
//! time scale, servo, turn command, is what its name says.

use prone::gait::cycle::{TimeScale, TimeScaleError};
use prone::gait::{PhaseDuration, PhaseDurationError};
use prone::regime::{MotorServo, Regime};
use prone::scene::{Scene, SideFriction};
use prone_sim::{LoadedRobot, WorldError};

use super::corners::{self, Asked, Corner, OFFSET_DEG, UNEVEN, offsets};
use super::setting::{HOLDS, Role, Setting, SettingSpec};
use prone_record::frontier::{CycleObjective, SettingKind};

/// Time scales over which a cycle has to hold: played slowly, an arm shows how high it is lifted;
/// played fast, servos lag.
const FAST: f64 = 0.8;
const SLOW: f64 = 1.7;
/// Seeds of calibration errors that show how far a cycle is thrown off without being steered: some
/// that neither the corners nor any test uses.
const OFF_SEED: u64 = 101;
/// Least turn a cycle at the largest command, rad: 10°.
const TURN: f64 = 0.1745;
/// Least turn a cycle at half the largest command, rad: 2°.
const HALF_TURN: f64 = 0.035;
/// Cycles in which a held heading shows how far the robot comes off its line: a metre or two.
const HELD_CYCLES: usize = 6;
/// Share of the advance that a search keeps where it has to hold: a confirmation asks for less.
const KEEP: f64 = 0.78;

/// The corners of a search, those first in which candidates fail most often: sticky ground, uneven
/// ground with joints that are off, servos that give way, play, late commands. What fails in one is not
/// tried in those after it. Of the sixteen of uneven ground these three throw the NAO's crawls off most.
const SEARCHED: [Corner; 9] = [
    Corner::Friction(1.0),
    Corner::Uneven {
        friction: UNEVEN[1],
        seed: 8,
    },
    Corner::Uneven {
        friction: UNEVEN[0],
        seed: 8,
    },
    Corner::Uneven {
        friction: UNEVEN[1],
        seed: 1,
    },
    Corner::Stiffness(0.5),
    Corner::Backlash { degrees: 1.0 },
    Corner::Friction(0.4),
    Corner::LATE,
    Corner::Masses(1.1),
];

/// Why there are no settings.
#[derive(Debug, thiserror::Error)]
pub enum SettingError {
    /// The engine refuses the model.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A time scale that no crawl can have.
    #[error(transparent)]
    Scale(#[from] TimeScaleError),
    /// A duration that no pull can have.
    #[error(transparent)]
    Duration(#[from] PhaseDurationError),
}

/// A setting of the locomotion regime at its own friction, over so many cycles.
fn plain(kind: SettingKind, cycles: usize, role: Role) -> SettingSpec {
    SettingSpec {
        kind,
        regime: Regime::LOCOMOTION,
        friction: None,
        scale: TimeScale::ONE,
        pull: None,
        offsets: None,
        late: None,
        cycles,
        turn: 0.0,
        held: false,
        role,
    }
}

fn with_scale(scale: f64) -> Result<SettingSpec, SettingError> {
    Ok(SettingSpec {
        scale: TimeScale::new(scale)?,
        ..plain(SettingKind::TimeScale(scale), 3, Role::Keep(HOLDS))
    })
}

fn stiff(cycles: usize, role: Role) -> SettingSpec {
    SettingSpec {
        regime: Regime::LOCOMOTION.with_motors(MotorServo::STIFF),
        ..plain(SettingKind::StiffServos, cycles, role)
    }
}

/// As everything is in the model, in a scene; two cycles, whose value counts.
///
/// # Errors
/// [`SettingError`] where the engine refuses it.
pub fn as_it_is(robot: &LoadedRobot, scene: Scene) -> Result<Setting, SettingError> {
    let spec = plain(SettingKind::AsItIs, 2, Role::Value);
    Ok(spec.compile_in(robot, scene)?)
}

/// The same with the heading held where the cycle can be steered.
///
/// # Errors
/// [`SettingError`] where the engine refuses it.
pub fn held(robot: &LoadedRobot, scene: Scene) -> Result<Setting, SettingError> {
    let spec = SettingSpec {
        held: true,
        ..plain(SettingKind::AsItIs, 2, Role::Value)
    };
    Ok(spec.compile_in(robot, scene)?)
}

fn compiled<const N: usize>(
    robot: &LoadedRobot,
    specs: [SettingSpec; N],
) -> Result<Vec<Setting>, SettingError> {
    let settings = specs.into_iter().map(|spec| Ok(spec.compile(robot)?));
    settings.collect()
}

/// For a search by an objective, before any corner.
///
/// # Errors
/// [`SettingError`] where the engine refuses a setting.
pub fn for_search(
    objective: CycleObjective,
    robot: &LoadedRobot,
) -> Result<Vec<Setting>, SettingError> {
    match objective {
        CycleObjective::Heat | CycleObjective::Peak => for_heat(robot),
        CycleObjective::HeatRate
        | CycleObjective::Advance
        | CycleObjective::Speed
        | CycleObjective::Duty
        | CycleObjective::Height => Ok(vec![as_it_is(robot, Scene::level())?]),
    }
}

/// The corners of a search, which come last: most candidates fail before.
///
/// # Errors
/// [`SettingError`] where the engine refuses a setting.
pub fn searched_corners(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    let asked = Asked {
        cycles: 2,
        role: Role::Keep(KEEP),
    };
    on_level_ground(robot, SEARCHED, asked)
}

/// Corners on a level floor; on uneven ground for as long as it takes a drift to show.
fn on_level_ground(
    robot: &LoadedRobot,
    corners: impl IntoIterator<Item = Corner>,
    asked: Asked,
) -> Result<Vec<Setting>, SettingError> {
    let mut settings = corners::settings(robot, &Scene::level(), corners, asked)?;
    for setting in &mut settings {
        if setting.spec.offsets.is_some() {
            setting.spec.cycles = HELD_CYCLES;
        }
    }
    Ok(settings)
}

/// What a search adds where its cycle has to be steered: it turns by 10° a cycle at the largest command, and
/// by 2° at half of it. That it turns further at the largest is asked of what was found
/// ([`super::steering::check_steering`]).
///
/// # Errors
/// [`SettingError`] where the engine refuses a setting.
pub fn for_steering(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    compiled(robot, turning())
}

fn turning() -> [SettingSpec; 2] {
    let turning = |kind, turn, least| SettingSpec {
        turn,
        ..plain(kind, 3, Role::Turn(least))
    };
    [
        turning(SettingKind::HalfTurning, 0.5, HALF_TURN),
        turning(SettingKind::Turning, 1.0, TURN),
    ]
}

/// The same for a confirmation, and how far uneven ground and joints that are off throw it off where
/// it is not steered.
///
/// # Errors
/// [`SettingError`] where the engine refuses a setting.
pub fn for_steering_confirmation(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    let mut settings = for_steering(robot)?;
    for (index, friction) in UNEVEN.into_iter().enumerate() {
        let SideFriction { left, right } = friction;
        let largest = OFFSET_DEG.to_radians();
        let uneven = SettingSpec {
            friction: Some(friction),
            offsets: Some(offsets(robot.robot(), largest, OFF_SEED + index as u64)),
            ..plain(SettingKind::Uneven { left, right }, 3, Role::Beside)
        };
        settings.push(uneven.compile(robot)?);
    }
    Ok(settings)
}

/// For a search of the heat: the robot's own servos and stiff ones, as nobody knows a robot's.
pub fn for_heat(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    compiled(
        robot,
        [
            plain(SettingKind::AsItIs, 2, Role::Value),
            stiff(2, Role::Value),
        ],
    )
}

/// What a search of something else adds where heat is held: stiff servos, so that heat is the same as
/// where it is searched.
pub fn for_held_heat(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    compiled(robot, [stiff(2, Role::Value)])
}

/// For the confirmation of what such a search found: one thing changed at a time, three cycles each.
/// Stiff and soft servos stand beside it: no search of the advance looks at them. Heat and peak are
/// confirmed at other durations of the pull too.
pub fn for_confirmation(
    objective: CycleObjective,
    robot: &LoadedRobot,
) -> Result<Vec<Setting>, SettingError> {
    let asked = Asked {
        cycles: 3,
        role: Role::Keep(HOLDS),
    };
    let corners = on_level_ground(robot, corners::all(), asked)?;
    let fine = SettingSpec {
        regime: Regime {
            time_step: 0.001,
            ..Regime::LOCOMOTION
        },
        ..plain(SettingKind::FineSteps, 3, Role::Keep(HOLDS))
    };
    let soft = SettingSpec {
        regime: Regime::LOCOMOTION.with_motors(MotorServo::SOFT),
        ..plain(SettingKind::SoftServos, 3, Role::Beside)
    };
    let mut settings = compiled(
        robot,
        [
            plain(SettingKind::AsItIs, 3, Role::Value),
            with_scale(FAST)?,
            with_scale(SLOW)?,
            fine,
            stiff(3, Role::Beside),
            soft,
        ],
    )?;
    let pulls: &[f64] = match objective {
        CycleObjective::Heat | CycleObjective::Peak => &[1.0, 2.0, 3.0],
        CycleObjective::HeatRate
        | CycleObjective::Advance
        | CycleObjective::Speed
        | CycleObjective::Duty
        | CycleObjective::Height => &[],
    };
    settings.extend(corners);
    for &seconds in pulls {
        let other_pull = SettingSpec {
            pull: Some(PhaseDuration::new(seconds)?),
            ..plain(SettingKind::PullOf(seconds), 3, Role::Beside)
        };
        settings.push(other_pull.compile(robot)?);
    }
    Ok(settings)
}
