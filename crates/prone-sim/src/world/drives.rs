//! What drives the joints of a world: motors or velocity servos, as actuators of the engine.
//!
//! A motor ([`DcServo`]) is an actuator that gives the torque it is told, without a limit of its own,
//! and its back-EMF as damping of the joint: damping is implicit whatever the torque, so that a motor
//! at its limit stays stable. A velocity servo is the engine's own, with a limit on its force; at that
//! limit it loses its damping, and bangs to and fro where the step is long for it. What would do so
//! is refused ([`check`]).

use mujoco_rs::mujoco_c::mjNGAIN;
use mujoco_rs::prelude::*;
use mujoco_rs::wrappers::mj_editing::MjtLimited;

use prone::motor::{DcServo, Effort, MotorEffort};
use prone::regime::{Regime, Servo, VelocityServo};
use prone::robot::{Drive, JointId, Robot};

use super::World;
use crate::engine_numbers::FREE_JOINT_SPEEDS;

/// What drives one or more joints.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldDrive {
    /// The joints and their one motor.
    pub drive: Drive,
    /// How it is driven.
    pub servo: WorldServo,
}

/// A motor, or a servo of each joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum WorldServo {
    /// One motor, whose torque its joints share evenly.
    Motor(DcServo),
    /// A velocity servo on each joint.
    Velocity {
        /// Its law.
        law: VelocityServo,
        /// Velocity gain, N·m·s/rad.
        gain: f64,
        /// Torque limit, N·m.
        limit: f64,
    },
}

impl WorldServo {
    /// Torque that it asks for per small position error, N·m/rad.
    pub const fn stiffness(&self) -> f64 {
        match self {
            Self::Motor(motor) => motor.stiffness,
            Self::Velocity { law, gain, .. } => *gain * law.rate,
        }
    }
}

impl WorldDrive {
    /// Largest torque that its position error asked for before any limit, N·m.
    pub fn demanded(&self, did: &MotorEffort) -> f64 {
        self.servo.stiffness() * did.largest_lag
    }
}

impl World {
    /// Largest torque that position errors of the shoulders' pitch asked for before any limit, N·m.
    pub fn demanded_of_shoulders(&self, effort: &Effort) -> f64 {
        let shoulders = self.robot().chain.sides().map(|side| side.shoulder);
        let pairs = self.drives().iter().zip(&effort.motors);
        let theirs =
            pairs.filter(|(it, _)| it.drive.joints.iter().any(|id| shoulders.contains(id)));
        let demanded = theirs.map(|(it, did)| it.demanded(did));
        demanded.fold(0.0, f64::max)
    }
}

/// A servo that the engine's step is too long for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TooStiff {
    /// A position controller whose joint would overshoot within a step.
    #[error(
        "joint {joint}: a servo stiffness of {stiffness} N·m/rad times the square of the engine step of {step_ms} ms, over the inertia that its motor moves, is {value:.2}; it must be at most 1: servo_stiffness_nm_rad is {of_robot}, and may be up to {largest:.1}"
    )]
    Motor {
        /// Name of the joint.
        joint: String,
        /// What the joint has of K, N·m/rad.
        stiffness: f64,
        /// The robot's, N·m/rad.
        of_robot: f64,
        /// The largest that it could have, N·m/rad.
        largest: f64,
        /// Engine step, ms.
        step_ms: f64,
        /// K h² / I.
        value: f64,
    },
    /// A velocity servo that can reach its torque limit, where it has no damping.
    #[error(
        "joint {joint}: a velocity gain of {gain} N·m·s/rad times the engine step of {step_ms} ms, over the inertia that its motor moves, is {value:.2}; it must be at most 1, as the servo can reach its torque limit of {limit} N·m: servo_stiffness_nm_rad is {of_robot}, and may be up to {largest:.1}"
    )]
    Velocity {
        /// Name of the joint.
        joint: String,
        /// kᵥ, N·m·s/rad.
        gain: f64,
        /// Engine step, ms.
        step_ms: f64,
        /// kᵥ h / I.
        value: f64,
        /// Torque limit, N·m.
        limit: f64,
        /// The robot's stiffness, N·m/rad.
        of_robot: f64,
        /// The largest that it could have, N·m/rad.
        largest: f64,
    },
}

/// The drives of a robot in a regime, in the order of [`Robot::drives`].
pub(super) fn in_regime(robot: &Robot, regime: &Regime) -> Vec<WorldDrive> {
    let drives = robot.drives().into_iter().map(|drive| {
        let joint = drive.named_after(robot);
        let limit = regime.torque_limit.limit(joint);
        let servo = match regime.servo {
            Servo::DcMotor(motors) => {
                let efficiency = motors.gear_efficiency(&robot.control);
                let motor = DcServo::new(joint, efficiency, motors.stiffness_factor, limit);
                WorldServo::Motor(motor.with_backlash(motors.backlash))
            }
            Servo::Velocity(law) => WorldServo::Velocity {
                law,
                gain: law.gain(joint),
                limit,
            },
        };
        WorldDrive { drive, servo }
    });
    drives.collect()
}

/// Adds an actuator for each joint, in the order of the joints, named like it.
pub(super) fn add_actuators(spec: &mut MjSpec, robot: &Robot, drives: &[WorldDrive]) {
    for (index, joint) in robot.joints.iter().enumerate() {
        let has = |it: &&WorldDrive| it.drive.joints.contains(&JointId(index));
        let drive = drives.iter().find(has);
        let WorldDrive { servo, .. } = drive.expect("every joint is one of a drive's");
        let actuator = spec.add_actuator();
        // Every property is stated: a new actuator starts from the model's `<default>`.
        actuator
            .with_name(&joint.name)
            .with_target(&joint.name)
            .with_trntype(MjtTrn::mjTRN_JOINT)
            .with_gear([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
            .with_gainprm([0.0; mjNGAIN as usize])
            .with_ctrllimited(MjtLimited::mjLIMITED_FALSE)
            .with_ctrlrange([0.0; 2])
            .with_actlimited(MjtLimited::mjLIMITED_FALSE)
            .with_actrange([0.0; 2])
            .with_inheritrange(0.0)
            .with_damping([0.0; 3])
            .with_armature(0.0)
            .with_delay(0.0)
            .with_nsample(0)
            .with_actdim(-1) // follows from the kind of dynamics, which is none
            .with_group(0);
        match servo {
            WorldServo::Motor(_) => {
                actuator
                    .with_forcelimited(MjtLimited::mjLIMITED_FALSE)
                    .with_forcerange([0.0; 2])
                    .set_to_motor();
            }
            WorldServo::Velocity { gain, limit, .. } => {
                actuator
                    .with_forcelimited(MjtLimited::mjLIMITED_TRUE)
                    .with_forcerange([-limit, *limit])
                    .set_to_velocity(*gain);
            }
        }
    }
}

/// Adds the back-EMF of the motors to the damping that the joints have by themselves.
pub(super) fn add_back_emf(model: &mut MjModel, drives: &[WorldDrive]) {
    for WorldDrive { drive, servo } in drives {
        let WorldServo::Motor(motor) = servo else {
            continue;
        };
        for joint in &drive.joints {
            let dof = FREE_JOINT_SPEEDS + joint.0;
            model.dof_damping_mut()[dof] += motor.back_emf / drive.sharers();
        }
    }
}

/// Refuses servos that the engine's step is too long for, by what their joints alone can be moved by
/// in the zero pose: 1/I is on the diagonal of the inverse mass matrix, armature included.
pub(super) fn check(
    model: &MjModel,
    robot: &Robot,
    regime: &Regime,
    drives: &[WorldDrive],
) -> Result<(), TooStiff> {
    let step = regime.time_step;
    let step_ms = step * 1e3;
    for WorldDrive { drive, servo } in drives {
        let of_robot = drive.named_after(robot).servo_stiffness;
        for joint in &drive.joints {
            let per_inertia = model.dof_invweight0()[FREE_JOINT_SPEEDS + joint.0];
            let name = || robot.joints[joint.0].name.clone();
            match servo {
                WorldServo::Motor(motor) => {
                    let stiffness = motor.stiffness / drive.sharers();
                    let value = stiffness * step * step * per_inertia;
                    if value.is_nan() || value > 1.0 {
                        return Err(TooStiff::Motor {
                            joint: name(),
                            stiffness,
                            of_robot,
                            largest: of_robot / value,
                            step_ms,
                            value,
                        });
                    }
                }
                WorldServo::Velocity { law, gain, limit } => {
                    let value = gain * step * per_inertia;
                    // Sent one way at full speed while it still moves the other way at that speed.
                    let reaches_limit = gain * 2.0 * law.speed >= *limit;
                    if reaches_limit && (value.is_nan() || value > 1.0) {
                        return Err(TooStiff::Velocity {
                            joint: name(),
                            gain: *gain,
                            step_ms,
                            value,
                            limit: *limit,
                            of_robot,
                            largest: of_robot / value,
                        });
                    }
                }
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use prone::regime::{MotorServo, TorqueLimit};
    use prone::robot::{Joint, Motor};
    use prone_files::shipped;

    use super::*;
    use crate::world::{World, WorldError};
    use crate::{LoadedRobot, RobotFiles};

    /// One hinge that nothing touches and nothing loads, with an inertia, kg·m².
    fn hinge(step: f64, inertia: f64, damping: f64, actuator: &str) -> MjData<Arc<MjModel>> {
        let text = format!(
            "<mujoco><option timestep='{step}' integrator='implicitfast' gravity='0 0 0'/>\
             <worldbody><body><joint name='j' axis='0 1 0' damping='{damping}'/>\
             <inertial pos='0 0 0' mass='.1' diaginertia='{inertia} {inertia} {inertia}'/></body>\
             </worldbody><actuator>{actuator}</actuator></mujoco>"
        );
        let spec = MjSpec::from_xml_string(&text);
        let model = spec.and_then(|mut spec| spec.compile()).unwrap();
        MjData::new(Arc::new(model))
    }

    /// Root mean square of the torque over the last half-second of five seconds, in which the hinge
    /// was knocked once; `torque` makes one step and returns what was applied.
    fn after_a_knock(
        data: &mut MjData<Arc<MjModel>>,
        knock: f64,
        mut torque: impl FnMut(&mut MjData<Arc<MjModel>>) -> f64,
    ) -> f64 {
        const STEPS: usize = 2000;
        let last = STEPS / 10;
        let mut square = 0.0;
        for index in 0..STEPS {
            if index == STEPS / 5 {
                data.qvel_mut()[0] += knock;
            }
            let applied = torque(data);
            if index >= STEPS - last {
                square += applied * applied;
            }
        }
        (square / last as f64).sqrt()
    }

    /// A shoulder of the NAO, as stiff as the review's servos.
    fn shoulder() -> Joint {
        let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let id = robot.robot().chain.left.shoulder;
        robot.robot().joints[id.0].clone()
    }

    /// Once knocked, a velocity servo that can reach its limit bangs for ever where kᵥ h / I is
    /// above 2. A motor comes to rest, up to 400 N·m/rad at 2.5 ms.
    #[test]
    fn limit_a_knock_dies_out() {
        const INERTIA: f64 = 0.0055;
        const STEP: f64 = 0.0025;
        let joint = shoulder();
        let limit = joint.effort_limit;
        // The first leads into a lasting orbit: half of what the limit changes the speed by in a step.
        let knocks = [0.5, 5.0, 15.0].map(|share| share * limit * STEP / INERTIA);
        let law = VelocityServo::RECORDINGS;
        let gain = 20.0;
        let servo = format!("<velocity joint='j' kv='{gain}' forcerange='-{limit} {limit}'/>");
        let mut data = hinge(STEP, INERTIA, 0.0, &servo);
        let left = after_a_knock(&mut data, knocks[0], |data| {
            data.ctrl_mut()[0] = law.command(-data.qpos()[0]);
            data.step();
            data.actuator_force()[0]
        });
        assert!(left > 0.9 * limit, "a velocity servo that is quiet: {left}");
        for stiffer in [1.0, 4.0, 10.0] {
            for knock in knocks {
                let motor = DcServo::new(&joint, 0.6, stiffer, limit);
                let mut data = hinge(STEP, INERTIA, motor.back_emf, "<motor joint='j'/>");
                let left = after_a_knock(&mut data, knock, |data| {
                    let told = motor.drive(-data.qpos()[0], data.qvel()[0]);
                    data.ctrl_mut()[0] = told.torque;
                    data.step();
                    motor.applied(&told, data.qvel()[0])
                });
                assert!(left < 1e-3 * limit, "{stiffer} × K, {knock} rad/s: {left}");
            }
        }
    }

    fn refused(robot: &Robot, regime: Regime) -> Option<String> {
        let shipped = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let world = World::new(&shipped, regime).unwrap();
        let drives = in_regime(robot, &regime);
        let refused = check(&world.model, robot, &regime, &drives);
        refused.err().map(|error| error.to_string())
    }

    #[test]
    fn limit_servos_that_a_step_is_too_long_for_are_refused_with_joint_and_value() {
        let shipped = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let mut robot = Robot::clone(shipped.robot());
        let stiff = Regime::LOCOMOTION.with_motors(MotorServo::STIFF);
        for regime in [
            Regime::LOCOMOTION,
            stiff,
            Regime::TORQUE_STUDY,
            Regime::TABLE,
        ] {
            assert_eq!(refused(&robot, regime), None, "{}", regime.name);
        }
        let neck = robot.joint("HeadPitch").unwrap();
        robot.joints[neck.0].servo_stiffness = 4000.0;
        let expected = "joint HeadPitch: a servo stiffness of 4000 N·m/rad times the square of the \
                        engine step of 2.5 ms, over the inertia that its motor moves, is";
        let said = refused(&robot, Regime::LOCOMOTION).unwrap();
        assert!(said.starts_with(expected), "{said}");
        // The same with a finer step: its square is what counts.
        let fine = Regime {
            time_step: 0.001,
            ..Regime::LOCOMOTION
        };
        assert_eq!(refused(&robot, fine), None);
        // The head's gain of 20 N·m·s/rad that it once had in the study: within reach of 30 N·m.
        robot.joints[neck.0].servo_stiffness = 400.0;
        let said = refused(&robot, Regime::TORQUE_STUDY).unwrap();
        assert!(
            said.starts_with("joint HeadPitch: a velocity gain of 20 N·m·s/rad"),
            "{said}"
        );
        let out_of_reach = Regime {
            torque_limit: TorqueLimit::Uniform(1000.0),
            ..Regime::TORQUE_STUDY
        };
        assert_eq!(refused(&robot, out_of_reach), None);
        // Of one motor behind two joints each has half, and half is what is said.
        robot.joints[neck.0].servo_stiffness = 80.0;
        let [left, right] = ["LHipPitch", "RHipPitch"].map(|name| robot.joint(name).unwrap());
        robot.joints[left.0].servo_stiffness = 20_000.0;
        robot.shared_motors = vec![vec![left, right]];
        let said = refused(&robot, Regime::LOCOMOTION).unwrap();
        assert!(
            said.starts_with("joint LHipPitch: a servo stiffness of 10000 N·m/rad"),
            "{said}"
        );
    }

    /// A robot with such a servo makes no world, and the error names it.
    #[test]
    fn a_world_of_a_servo_that_is_too_stiff_is_an_error() {
        let mut files = RobotFiles::shipped(&shipped::NAO);
        let joint = "speed_rad_s = 6.46          # published 7.19\nservo_stiffness_nm_rad = 80.0";
        assert!(files.toml.contains(joint));
        files.toml = files.toml.replacen(joint, &joint.replace("80.0", "9e4"), 1);
        let loaded = LoadedRobot::load(files).unwrap();
        let error = World::new(&loaded, Regime::LOCOMOTION).unwrap_err();
        assert!(matches!(error, WorldError::Servo { .. }), "{error}");
        let message = error.to_string();
        assert!(
            message.starts_with(
                "NAO H25 V4 in regime locomotion: joint HeadPitch: a servo stiffness of 90000"
            ),
            "{message}"
        );
    }

    /// Of a robot without motors the limits are taken, and it is said.
    #[test]
    fn motors_that_are_not_known_are_assumed() {
        let shipped = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let mut robot = Robot::clone(shipped.robot());
        for joint in &mut robot.joints {
            joint.motor = joint.motor.map(|motor| Motor {
                no_load_speed: None,
                ..motor
            });
        }
        for WorldDrive { drive, servo } in in_regime(&robot, &Regime::LOCOMOTION) {
            let joint = drive.named_after(&robot);
            let WorldServo::Motor(motor) = servo else {
                panic!("{servo:?}");
            };
            assert!(motor.assumed, "{}", joint.name);
            assert!((motor.back_emf - joint.effort_limit / joint.speed_limit).abs() < 1e-12);
        }
    }
}
