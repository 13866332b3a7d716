//! The settings in which cycles are priced and checked.
//!
//! All are the locomotion regime, with the maker's effort and joint limits on; friction, servo
//! gains, time scale and the engine's step are what its name says.

use prone::gait::cycle::{Cycle, TimeScale, TimeScaleError};
use prone::gait::{PhaseDuration, PhaseDurationError};
use prone::robot::{JointAngles, Robot};
use prone::scene::{Scene, SideFriction};
use prone_optim::Random;
use prone_sim::regime::Servo;
use prone_sim::{LoadedRobot, Regime, World, WorldError};

use super::price::CycleRules;
use super::trial::{Role, Setting};

/// Friction of the locomotion regime and the span over which a cycle has to hold.
const SLIPPERY: f64 = 0.4;
const STICKY: f64 = 1.0;
/// Time scales over which a cycle has to hold: played slowly, an arm shows how high it is lifted;
/// played fast, servos lag.
const FAST: f64 = 0.8;
const SLOW: f64 = 1.7;
/// Velocity gain of stiff servos, N·m·s/rad: with the servo law's 20/s, 400 N·m/rad.
const STIFF: f64 = 20.0;
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
/// Share that a confirmation asks for.
pub const HOLDS: f64 = 0.8;

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

/// Makes settings of one robot.
struct Maker<'a> {
    robot: &'a LoadedRobot,
    regime: Regime,
}

impl Maker<'_> {
    fn make(
        &self,
        name: &str,
        regime: Regime,
        scale: f64,
        cycles: usize,
        role: Role,
    ) -> Result<Setting, SettingError> {
        Ok(Setting {
            name: name.to_owned(),
            world: World::new(self.robot, regime)?,
            scale: TimeScale::new(scale)?,
            pull: None,
            turn: 0.0,
            offsets: None,
            cycles,
            role,
        })
    }

    fn friction(&self, friction: f64) -> Regime {
        self.regime.with_friction(friction)
    }
}

fn maker(robot: &LoadedRobot) -> Maker<'_> {
    Maker {
        robot,
        regime: Regime::LOCOMOTION,
    }
}

/// For a search of the advance: as it is, and the two corners in which it is hardest to hold.
///
/// # Errors
/// [`SettingError`].
pub fn for_advance(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    let maker = maker(robot);
    Ok(vec![
        maker.make("as it is", maker.regime, 1.0, 2, Role::Value)?,
        maker.make(
            "slow, slippery",
            maker.friction(SLIPPERY),
            SLOW,
            1,
            Role::Keep(KEEP),
        )?,
        maker.make(
            "fast, sticky",
            maker.friction(STICKY),
            FAST,
            1,
            Role::Keep(KEEP),
        )?,
    ])
}

/// What a search adds where its cycle has to be steered: at the largest command it turns, and joints
/// that are off on ground that is more slippery on one side turn it by less than that.
///
/// # Errors
/// [`SettingError`].
pub fn for_steering(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    steering(robot, KEEP, OFF_SEED)
}

/// The same for a confirmation, with joints off by other angles.
///
/// # Errors
/// [`SettingError`].
pub fn for_steering_confirmation(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    steering(robot, HOLDS, OFF_SEED + UNEVEN.len() as u64)
}

fn steering(robot: &LoadedRobot, keep: f64, seed: u64) -> Result<Vec<Setting>, SettingError> {
    let maker = maker(robot);
    let turning = maker.make("turning", maker.regime, 1.0, 3, Role::Turn(TURN))?;
    let mut settings = vec![Setting {
        turn: 1.0,
        ..turning
    }];
    for (index, (left, right)) in UNEVEN.into_iter().enumerate() {
        let mut uneven = Scene::level();
        uneven.floor.friction = Some(SideFriction { left, right });
        let name = format!("friction {left} and {right}, joints off");
        let role = Role::Straight { yaw: DRIFT, keep };
        let straight = maker.make(&name, maker.regime, 1.0, 3, role)?;
        settings.push(Setting {
            world: World::in_scene(robot, maker.regime, &uneven)?,
            offsets: Some(offsets(robot.robot(), OFF, seed + index as u64)),
            ..straight
        });
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

/// For a search of the heat: the mean over soft and stiff servos, as nobody knows a robot's.
///
/// # Errors
/// [`SettingError`].
pub fn for_heat(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    let maker = maker(robot);
    let stiff = maker.regime.with_servo(Servo::Uniform(STIFF));
    Ok(vec![
        maker.make("as it is", maker.regime, 1.0, 2, Role::Value)?,
        maker.make("stiff servos", stiff, 1.0, 2, Role::Value)?,
    ])
}

/// For a confirmation: one thing changed at a time, three cycles each. Stiff servos stand beside it,
/// and servos that command as much speed as the fastest joint of the robot has, where the
/// recordings' law cuts at 3 rad/s and limbs lag behind the plan: no search of the advance looks at
/// them.
///
/// # Errors
/// [`SettingError`].
pub fn for_confirmation(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    let maker = maker(robot);
    let keep = Role::Keep(HOLDS);
    let stiff = maker.regime.with_servo(Servo::Uniform(STIFF));
    let fine = maker.regime.with_time_step(0.001);
    let speeds = robot.robot().joints.iter().map(|joint| joint.speed_limit);
    let brisk = maker
        .regime
        .with_servo_speed(speeds.fold(maker.regime.servo_speed, f64::max));
    Ok(vec![
        maker.make("as it is", maker.regime, 1.0, 3, Role::Value)?,
        maker.make("friction 0.4", maker.friction(SLIPPERY), 1.0, 3, keep)?,
        maker.make("friction 1", maker.friction(STICKY), 1.0, 3, keep)?,
        maker.make("time scale 0.8", maker.regime, FAST, 3, keep)?,
        maker.make("time scale 1.7", maker.regime, SLOW, 3, keep)?,
        maker.make("1 ms steps", fine, 1.0, 3, keep)?,
        maker.make("stiff servos", stiff, 1.0, 3, Role::Beside)?,
        maker.make("brisk servos", brisk, 1.0, 3, Role::Beside)?,
    ])
}

/// For a confirmation of the heat: servos, frictions and the duration of the pull.
///
/// # Errors
/// [`SettingError`].
pub fn for_heat_confirmation(robot: &LoadedRobot) -> Result<Vec<Setting>, SettingError> {
    let mut settings = for_confirmation(robot)?;
    let maker = maker(robot);
    for seconds in [1.0, 2.0, 3.0] {
        let name = format!("pull of {seconds} s");
        settings.push(Setting {
            pull: Some(PhaseDuration::new(seconds)?),
            ..maker.make(&name, maker.regime, 1.0, 3, Role::Beside)?
        });
    }
    Ok(settings)
}

/// Rules of a search of advance or speed below a height, m: no slower than the cycle that it is
/// searched about.
pub fn advance_rules(height: f64, base: &Cycle) -> CycleRules {
    CycleRules {
        ceiling: height,
        seconds: base.duration(TimeScale::ONE),
        ..CycleRules::FREE
    }
}

/// Rules of a search of the heat per metre below a height, m.
pub fn heat_rules(height: f64) -> CycleRules {
    CycleRules {
        ceiling: height,
        advance: LEAST_ADVANCE,
        ..CycleRules::FREE
    }
}

/// Least advance of a cycle that is searched for its heat, m: slower ones stand still.
pub const LEAST_ADVANCE: f64 = 0.12;
