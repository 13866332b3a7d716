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

use prone::motor::DcServo;
use prone::regime::{Regime, Servo, VelocityServo};
use prone::robot::{Drive, JointId, Robot};

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

/// A servo that the engine's step is too long for.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TooStiff {
    /// A position controller whose joint would overshoot within a step.
    #[error(
        "joint {joint}: a servo stiffness of {stiffness} N·m/rad times the square of the engine step of {step_ms} ms, over the inertia that its motor moves, is {value:.2}; it must be at most 1"
    )]
    Motor {
        /// Name of the joint.
        joint: String,
        /// K, N·m/rad.
        stiffness: f64,
        /// Engine step, ms.
        step_ms: f64,
        /// K h² / I.
        value: f64,
    },
    /// A velocity servo that can reach its torque limit, where it has no damping.
    #[error(
        "joint {joint}: a velocity gain of {gain} N·m·s/rad times the engine step of {step_ms} ms, over the inertia that its motor moves, is {value:.2}; it must be at most 1, as the servo can reach its torque limit of {limit} N·m"
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
    },
}

/// The drives of a robot in a regime, in the order of [`Robot::drives`].
pub(super) fn of(robot: &Robot, regime: &Regime) -> Vec<WorldDrive> {
    let drives = robot.drives().into_iter().map(|drive| {
        let joint = drive.named_after(robot);
        let limit = regime.effort.limit(joint);
        let servo = match regime.servo {
            Servo::DcMotor(motors) => {
                let efficiency = motors.gear_efficiency(&robot.control);
                WorldServo::Motor(DcServo::new(joint, efficiency, motors.stiffness, limit))
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
        let Some(WorldDrive { servo, .. }) = drives.iter().find(has) else {
            continue;
        };
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
        for joint in &drive.joints {
            let per_inertia = model.dof_invweight0()[FREE_JOINT_SPEEDS + joint.0];
            let name = || robot.joints[joint.0].name.clone();
            match servo {
                WorldServo::Motor(motor) => {
                    let value = motor.stiffness / drive.sharers() * step * step * per_inertia;
                    if value.is_nan() || value > 1.0 {
                        return Err(TooStiff::Motor {
                            joint: name(),
                            stiffness: motor.stiffness,
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
                        });
                    }
                }
            }
        }
    }
    Ok(())
}
