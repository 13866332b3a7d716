//! Named contact regimes and the numbers of the simulation, each with its source.
//!
//! The planted chain is statically indeterminate: how much toes and elbows squeeze it between
//! them, and with it every torque, depends on how friction is modelled. So friction is never a
//! free number here but a property of a named regime, and every record says which one it used.

use crate::robot::{Control, Joint, ServoLaw};

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
    pub effort: Effort,
    /// Which servo gains hold.
    pub servo: Servo,
    /// Law of the servos in place of the robot's own ([`Control::servo`]).
    pub servo_law: Option<ServoLaw>,
    /// Largest speed that a servo commands in place of the law's, rad/s.
    pub servo_speed: Option<f64>,
    /// Length of one engine step, s; a whole number of them makes a [`CONTROL_STEP`].
    pub time_step: f64,
}

/// Which joint stops a regime uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stops {
    /// The manufacturer's.
    Maker,
    /// The robot's study stops: a sagging joint must not lean on its stop, which would take the
    /// torque away from the motor that is measured.
    Study,
}

/// Which torque limit a regime uses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effort {
    /// The manufacturer's effort limit of each joint.
    Published,
    /// The same limit for all joints, N·m.
    Uniform(f64),
}

/// Which servo gains a regime uses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Servo {
    /// The robot's own ([`crate::robot::Joint::servo_gain`]).
    Robot,
    /// The same velocity gain for all joints, N·m·s/rad.
    Uniform(f64),
}

impl Servo {
    /// Velocity gain of a joint's servo, N·m·s/rad.
    pub const fn gain(self, joint: &Joint) -> f64 {
        match self {
            Self::Robot => joint.servo_gain,
            Self::Uniform(gain) => gain,
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
        effort: Effort::Uniform(30.0),
        servo: Servo::Robot,
        servo_law: Some(RECORDINGS),
        servo_speed: None,
        time_step: TIME_STEP,
    };

    /// Contacts that stick, with the manufacturer's limits on and the robot's own servos: for moving
    /// forward.
    pub const LOCOMOTION: Self = Self {
        name: "locomotion",
        friction: 0.7,
        impratio: 10.0,
        stops: Stops::Maker,
        effort: Effort::Published,
        servo: Servo::Robot,
        servo_law: None,
        servo_speed: None,
        time_step: TIME_STEP,
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
    /// The law that a robot's servos follow.
    pub fn servo_law(&self, control: &Control) -> ServoLaw {
        let law = self.servo_law.unwrap_or(control.servo);
        ServoLaw {
            speed: self.servo_speed.unwrap_or(law.speed),
            ..law
        }
    }

    /// Engine steps in a time, s, at least one.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a time of milliseconds to minutes over a step of a millisecond or more"
    )]
    pub fn steps_in(&self, seconds: f64) -> usize {
        ((seconds / self.time_step).round() as usize).max(1)
    }
}

/// Servo law of the recordings.
pub const RECORDINGS: ServoLaw = ServoLaw {
    rate: 20.0,
    speed: 3.0,
};

/// Soft-contact time constant, s, and damping ratio (the engine's default).
pub const SOLREF: [f64; 2] = [0.02, 1.0];

/// Soft-contact impedance: from .9 to .99 over 1 mm of penetration, the engine's default curve.
pub const SOLIMP: [f64; 5] = [0.9, 0.99, 0.001, 0.5, 2.0];

#[cfg(test)]
mod tests {
    use crate::robot::SteeringGains;

    use super::*;

    #[test]
    fn a_control_step_is_a_whole_number_of_engine_steps() {
        let fine = Regime {
            time_step: 0.001,
            ..Regime::LOCOMOTION
        };
        for regime in [Regime::TORQUE_STUDY, fine] {
            let steps = regime.steps_in(CONTROL_STEP) as f64;
            assert!((steps * regime.time_step - CONTROL_STEP).abs() < 1e-15);
        }
    }

    /// Of a robot with other servos than the recordings' one.
    #[test]
    fn locomotion_has_the_robots_servo_law_and_the_study_its_own() {
        let own = ServoLaw {
            rate: 12.0,
            speed: 5.0,
        };
        let control = Control {
            command_step: 0.01,
            servo: own,
            stiff_servo_gain: 20.0,
            steering: SteeringGains {
                yaw: 0.9,
                lateral: 3.5,
                lateral_sum: 0.35,
            },
            uphill: 0.03,
        };
        assert_eq!(Regime::LOCOMOTION.servo_law(&control), own);
        for study in [Regime::TORQUE_STUDY, Regime::TABLE] {
            assert_eq!(study.servo_law(&control), RECORDINGS, "{}", study.name);
        }
        let brisk = Regime {
            servo_speed: Some(8.0),
            ..Regime::LOCOMOTION
        };
        let faster = ServoLaw { speed: 8.0, ..own };
        assert_eq!(brisk.servo_law(&control), faster);
    }
}
