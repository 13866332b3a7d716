//! The settings in which cycles are searched and confirmed.
//!
//! All are the locomotion regime, with the manufacturer's effort and joint limits on; friction,
//! servo gains, time scale and the engine's step are what its name says.

use prone::gait::cycle::{TimeScale, TimeScaleError};
use prone::gait::{PhaseDuration, PhaseDurationError};
use prone::regime::{MotorServo, Regime};
use prone::robot::{JointAngles, Robot};
use prone::scene::SideFriction;
use prone_optim::Random;
use prone_sim::{LoadedRobot, WorldError};

use super::setting::{HOLDS, Role, Setting, SettingSpec};
use prone_record::frontier::{CycleObjective, SettingKind};

/// Friction of the locomotion regime and the span over which a cycle has to hold.
const SLIPPERY: f64 = 0.4;
const STICKY: f64 = 1.0;
/// Time scales over which a cycle has to hold: played slowly, an arm shows how high it is lifted;
/// played fast, servos lag.
const FAST: f64 = 0.8;
const SLOW: f64 = 1.7;
/// Friction on the left and on the right of uneven grounds.
const UNEVEN: [(f64, f64); 2] = [(0.5, 0.9), (0.9, 0.5)];
/// How far joints are off there, rad: 1°.
const OFF: f64 = 0.0175;
/// Seeds of these angles: some that no test uses.
const OFF_SEED: u64 = 101;
/// Turn a cycle at the largest command, rad: 6°.
const TURN: f64 = 0.105;
/// Turn a cycle there without any command, rad: 3°, so that half of the command at most is spent on
/// keeping straight.
const DRIFT: f64 = 0.0524;
/// Share of the advance that a search keeps where it has to hold: a confirmation asks for less.
const KEEP: f64 = 0.85;

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
        cycles,
        turn: 0.0,
        role,
    }
}

/// A corner of a search of the advance: another friction, at another speed.
fn corner(kind: SettingKind, friction: f64, scale: f64) -> Result<SettingSpec, SettingError> {
    Ok(SettingSpec {
        regime: Regime {
            friction,
            ..Regime::LOCOMOTION
        },
        scale: TimeScale::new(scale)?,
        ..plain(kind, 1, Role::Keep(KEEP))
    })
}

fn with_friction(friction: f64) -> SettingSpec {
    SettingSpec {
        regime: Regime {
            friction,
            ..Regime::LOCOMOTION
        },
        ..plain(SettingKind::Friction(friction), 3, Role::Keep(HOLDS))
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

fn compiled<const N: usize>(
    robot: &LoadedRobot,
    specs: [SettingSpec; N],
) -> Result<Vec<Setting>, SettingError> {
    let settings = specs.into_iter().map(|spec| Ok(spec.compile(robot)?));
    settings.collect()
}

/// For a search by an objective.
pub fn for_search(
    objective: CycleObjective,
    robot: &LoadedRobot,
) -> Result<Vec<Setting>, SettingError> {
    match objective {
        CycleObjective::Heat | CycleObjective::Peak => for_heat(robot),
        CycleObjective::Advance
        | CycleObjective::Speed
        | CycleObjective::Duty
        | CycleObjective::Height => for_advance(robot),
    }
}

/// For a search of the advance: as it is, and the two corners in which it is hardest to hold.
pub fn for_advance(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    compiled(
        robot,
        [
            plain(SettingKind::AsItIs, 2, Role::Value),
            corner(SettingKind::SlowSlippery, SLIPPERY, SLOW)?,
            corner(SettingKind::FastSticky, STICKY, FAST)?,
        ],
    )
}

/// What a search adds where its cycle has to be steered: at the largest command it turns, and joints
/// that are off on ground that is more slippery on one side turn it by less than that.
pub fn for_steering(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    steering(robot, KEEP, OFF_SEED)
}

/// The same for a confirmation, with joints off by other angles.
pub fn for_steering_confirmation(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    steering(robot, HOLDS, OFF_SEED + UNEVEN.len() as u64)
}

fn steering(robot: &LoadedRobot, keep: f64, seed: u64) -> Result<Vec<Setting>, SettingError> {
    let turning = SettingSpec {
        turn: 1.0,
        ..plain(SettingKind::Turning, 3, Role::Turn(TURN))
    };
    let mut settings = vec![turning.compile(robot)?];
    for (index, (left, right)) in UNEVEN.into_iter().enumerate() {
        let role = Role::Straight { yaw: DRIFT, keep };
        let uneven = SettingSpec {
            friction: Some(SideFriction { left, right }),
            offsets: Some(offsets(robot.robot(), OFF, seed + index as u64)),
            ..plain(SettingKind::Uneven { left, right }, 3, role)
        };
        settings.push(uneven.compile(robot)?);
    }
    Ok(settings)
}

/// Of every joint of arms and legs that a pull moves, left then right, an angle drawn evenly from
/// ±`largest`, rad.
pub fn offsets(robot: &Robot, largest: f64, seed: u64) -> JointAngles {
    let mut random = Random::new(seed);
    let mut offsets = JointAngles::zero(robot);
    for side in robot.chain.sides() {
        for joint in side.commanded_joints() {
            offsets[joint] = largest * (2.0 * random.uniform() - 1.0);
        }
    }
    offsets
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
            with_friction(SLIPPERY),
            with_friction(STICKY),
            with_scale(FAST)?,
            with_scale(SLOW)?,
            fine,
            stiff(3, Role::Beside),
            soft,
        ],
    )?;
    let pulls: &[f64] = match objective {
        CycleObjective::Heat | CycleObjective::Peak => &[1.0, 2.0, 3.0],
        CycleObjective::Advance
        | CycleObjective::Speed
        | CycleObjective::Duty
        | CycleObjective::Height => &[],
    };
    for &seconds in pulls {
        let other_pull = SettingSpec {
            pull: Some(PhaseDuration::new(seconds)?),
            ..plain(SettingKind::PullOf(seconds), 3, Role::Beside)
        };
        settings.push(other_pull.compile(robot)?);
    }
    Ok(settings)
}
