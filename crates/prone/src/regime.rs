//! Named contact regimes and the numbers of the simulation, each with its source.
//!
//! The planted chain is statically indeterminate: how much toes and elbows squeeze it between
//! them, and with it every torque, depends on how friction is modelled. So friction is never a
//! free number here but a property of a named regime, and every record says which one it used.
//!
//! A regime also says how a simulated robot differs from its model: by its masses, by the stiffness of
//! its servos, by the play of its gears. Commands that arrive late are no matter of a regime.

use crate::robot::{Control, Joint};

/// How contacts, stops and motors are modelled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Regime {
    /// Name in records.
    pub name: &'static str,
    /// Sliding friction of floor and robot (the engine takes the larger of two geoms).
    pub friction: f64,
    /// Ratio of frictional to normal constraint impedance.
    pub impratio: f64,
    /// Which joint stops hold.
    pub stops: Stops,
    /// Which torque limit holds.
    pub torque_limit: TorqueLimit,
    /// How the joints are driven.
    pub servo: Servo,
    /// Length of one engine step, s; a whole number of them makes a [`CONTROL_STEP`].
    pub time_step: f64,
    /// What all masses and moments of inertia of the robot's bodies are multiplied by: 1 where it
    /// weighs what its model says. The armature of its joints stays.
    pub mass_factor: f64,
}

/// Which joint stops a regime uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stops {
    /// The manufacturer's.
    Manufacturer,
    /// The robot's study stops: a sagging joint must not lean on its stop, which would take the
    /// torque away from the motor that is measured.
    Study,
}

/// Which torque limit a regime uses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TorqueLimit {
    /// The manufacturer's effort limit of each joint.
    Published,
    /// The same limit for all joints, N·m.
    Uniform(f64),
}

/// How a regime drives the joints.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Servo {
    /// Direct-current motors under a position controller ([`crate::motor`]).
    DcMotor(MotorServo),
    /// The servo of the published recordings, which no robot has: one without limits of speed or
    /// supply, for their replication only.
    Velocity(VelocityServo),
}

/// What a regime says about motors that is not the robot's own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorServo {
    /// What the stiffness of every servo ([`Joint::servo_stiffness`]) is multiplied by.
    pub stiffness_factor: f64,
    /// Efficiency of the gears in place of the robot's ([`Control::gear_efficiency`]).
    pub gear_efficiency: Option<f64>,
    /// Play of every gear ([`crate::motor`]), from one edge to the other, rad.
    pub backlash: f64,
}

/// A servo that follows a speed: torque = gain · (v − ω) with v = clip(rate · error, ±speed).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityServo {
    /// Commanded speed per position error, 1/s.
    pub rate: f64,
    /// Largest commanded speed, rad/s.
    pub speed: f64,
    /// The same velocity gain for all joints, N·m·s/rad, in place of the one that makes their
    /// stiffness.
    pub gain: Option<f64>,
}

impl MotorServo {
    /// The robot's own.
    pub const ROBOT: Self = Self {
        stiffness_factor: 1.0,
        gear_efficiency: None,
        backlash: 0.0,
    };

    /// Half as stiff: one end of what is taken to be possible, as nobody has measured a robot's.
    pub const SOFT: Self = Self {
        stiffness_factor: 0.5,
        ..Self::ROBOT
    };

    /// Four times as stiff: the other end.
    pub const STIFF: Self = Self {
        stiffness_factor: 4.0,
        ..Self::ROBOT
    };

    /// Efficiency of a robot's gears.
    pub fn gear_efficiency(&self, control: &Control) -> f64 {
        self.gear_efficiency.unwrap_or(control.gear_efficiency)
    }
}

impl VelocityServo {
    /// That of the recordings: the script of their scene commands 20 /s of the error, at most 3 rad/s.
    pub const RECORDINGS: Self = Self {
        rate: 20.0,
        speed: 3.0,
        gain: None,
    };

    /// The speed commanded at a position error, rad, in rad/s.
    pub const fn command(&self, error: f64) -> f64 {
        (self.rate * error).clamp(-self.speed, self.speed)
    }

    /// Velocity gain of a joint's servo, N·m·s/rad.
    pub fn gain(&self, joint: &Joint) -> f64 {
        self.gain.unwrap_or(joint.servo_stiffness / self.rate)
    }
}

impl TorqueLimit {
    /// Torque limit of a joint, N·m.
    pub const fn limit(self, joint: &Joint) -> f64 {
        match self {
            Self::Published => joint.effort_limit,
            Self::Uniform(limit) => limit,
        }
    }
}

impl Regime {
    /// Slippery contacts, so that the chain squeezes nothing: the recordings had practically no
    /// internal squeeze (−0.3 ± 2.3 N), and their servos a limit of 30 N·m.
    pub const TORQUE_STUDY: Self = Self {
        name: "torque-study",
        friction: 0.05,
        impratio: 1.0,
        stops: Stops::Study,
        torque_limit: TorqueLimit::Uniform(30.0),
        servo: Servo::Velocity(VelocityServo::RECORDINGS),
        time_step: TIME_STEP,
        mass_factor: 1.0,
    };

    /// Contacts that stick, with the robot's own motors and the manufacturer's limits: for moving
    /// forward.
    pub const LOCOMOTION: Self = Self {
        name: "locomotion",
        friction: 0.7,
        impratio: 10.0,
        stops: Stops::Manufacturer,
        torque_limit: TorqueLimit::Published,
        servo: Servo::DcMotor(MotorServo::ROBOT),
        time_step: TIME_STEP,
        mass_factor: 1.0,
    };

    /// For settled torques, which match the recorded static table: full friction, but so soft
    /// sideways that the squeeze of setting the robot down creeps away within half a second.
    pub const TABLE: Self = Self {
        name: "table",
        friction: 1.0,
        impratio: 0.1,
        ..Self::TORQUE_STUDY
    };
}

/// Usual length of one engine step, s. 5 ms settles the same but is wrong in motion; 1 ms changes the
/// study's costs by about one percent.
pub const TIME_STEP: f64 = 0.0025;

/// Length of one control step, s: the recordings' commands and torques change every 50 ms.
pub const CONTROL_STEP: f64 = 0.05;

impl Regime {
    /// The same regime with other motors.
    #[must_use]
    pub const fn with_motors(self, motors: MotorServo) -> Self {
        Self {
            servo: Servo::DcMotor(motors),
            ..self
        }
    }

    /// Engine steps in a time, s, at least one.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a time of milliseconds to minutes over a step of a tenth of a millisecond or more"
    )]
    pub fn steps_in(&self, seconds: f64) -> usize {
        ((seconds / self.time_step).round() as usize).max(1)
    }
}

/// Soft-contact time constant, s, and damping ratio (the engine's default).
pub const SOLREF: [f64; 2] = [0.02, 1.0];

/// Soft-contact impedance: from .9 to .99 over 1 mm of penetration, the engine's default curve.
pub const SOLIMP: [f64; 5] = [0.9, 0.99, 0.001, 0.5, 2.0];

#[cfg(test)]
mod tests {
    use crate::robot::testing::two_armed;

    use super::*;

    #[test]
    fn a_control_step_is_a_whole_number_of_engine_steps() {
        for time_step in [0.000_25, 0.0005, 0.001, 0.001_25, 0.0025] {
            let regime = Regime {
                time_step,
                ..Regime::LOCOMOTION
            };
            let steps = regime.steps_in(CONTROL_STEP) as f64;
            assert!((steps * regime.time_step - CONTROL_STEP).abs() < 1e-15);
        }
    }

    #[test]
    fn a_velocity_servo_commands_in_proportion_up_to_its_speed_on_both_sides() {
        let servo = VelocityServo::RECORDINGS;
        assert!((servo.command(0.1) - 2.0).abs() < f64::EPSILON);
        assert!((servo.command(-0.1) + 2.0).abs() < f64::EPSILON);
        assert!((servo.command(1.0) - 3.0).abs() < f64::EPSILON);
        assert!((servo.command(-1.0) + 3.0).abs() < f64::EPSILON);
        assert!(servo.command(f64::NAN).is_nan());
    }

    /// A small error moves a velocity servo's joint with the torque that its stiffness asks for.
    #[test]
    fn identity_a_velocity_servo_has_the_joints_stiffness() {
        let servo = VelocityServo::RECORDINGS;
        for joint in &two_armed().joints {
            let torque = servo.gain(joint) * servo.command(0.01);
            assert!((torque - joint.servo_stiffness * 0.01).abs() < 1e-12);
        }
    }
}
