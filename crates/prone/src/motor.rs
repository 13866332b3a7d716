//! Direct-current motors behind gears, under a position controller.
//!
//! At the joint, with gear efficiency η, stall torque τₛ and no-load speed ω₀ (both at the joint),
//! stiffness K of the position controller, effort limit τₘ, and ω the joint's speed:
//!
//! ```text
//! b  = η τₛ / ω₀                        back-EMF, N·m·s/rad                                (1)
//! uᵥ = clip(K · error, ±η τₛ)           torque that the supply's voltage gives at rest     (2)
//! u  = clip(uᵥ, −τₘ + b ω, τₘ + b ω)   current limit                                     (3)
//! τ  = u − b ω                          torque applied                                     (4)
//! ```
//!
//! (2) is the voltage: a controller that asks for more than the supply has is clipped. (4) is the
//! line from stall torque to no-load speed. (3) keeps the current, and with it |τ|, below the
//! published effort limit. In simulation u acts as it is over a step and −b ω as damping, whose ω is
//! that after the step: so it stays stable, and |τ| passes the limit by no more than b times the
//! change of ω in a step.
//!
//! **Play.** A gear may have some backlash β. Then the error that (2) goes by is
//!
//! ```text
//! error = e − clip(e, ±β/2),   e = command − angle of the joint                          (5)
//! ```
//!
//! Within ± half the play the teeth of the gear are apart, and the controller passes no torque on;
//! outside, the error counts from the edge of the play. The play is no joint of its own. So rotor
//! inertia and back-EMF stay at the joint, also where the teeth are apart, and teeth meet without an
//! impact. Where one motor turns two joints there is one gear, and one play of the mean of their errors.
//!
//! η is an estimate ([`crate::robot::Control::gear_efficiency`]). Of a joint whose motor is not
//! known, η τₛ is taken for its effort limit and ω₀ for its speed limit; [`DcServo::assumed`] says
//! so, and nothing is said about its heat.
//!
//! What the motors of a run did is an [`Effort`]; whether a robot's could do it is a [`Verdict`].

mod effort;
mod verdict;

pub use effort::{Commands, Effort, MotorEffort, MotorStep, MotorUse, UnknownMotor};
pub use verdict::{Duty, HEAD_CARRIES, Load, Measure, Reason, Verdict};

use crate::robot::Joint;

/// A speed limit above the no-load speed of the joint's motor.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "speed limit {limit} rad/s of {joint} is above the no-load speed of its motor, {no_load:.3} rad/s"
)]
pub struct TooFast {
    /// Name of the joint.
    pub joint: String,
    /// Its speed limit, rad/s.
    pub limit: f64,
    /// What its motor reaches without any load, rad/s.
    pub no_load: f64,
}

/// Checks that a joint's speed limit is one that its motor reaches.
///
/// # Errors
/// [`TooFast`]. Of a motor whose no-load speed is not known nothing is said.
pub fn check_speed(joint: &Joint) -> Result<(), TooFast> {
    match joint.motor.and_then(|motor| motor.no_load_speed) {
        Some(no_load) if joint.speed_limit > no_load => Err(TooFast {
            joint: joint.name.clone(),
            limit: joint.speed_limit,
            no_load,
        }),
        _ => Ok(()),
    }
}

/// A motor with its gear and controller, at the joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DcServo {
    /// Torque that the controller asks for per position error, K, N·m/rad.
    pub stiffness: f64,
    /// Torque that the supply gives at rest, behind the gear, η τₛ, N·m.
    pub supply_torque: f64,
    /// Torque at the current limit, τₘ, N·m.
    pub current_torque: f64,
    /// What torque loses per speed, b, N·m·s/rad.
    pub back_emf: f64,
    /// Whether stall torque or no-load speed are not the manufacturer's but assumed from the
    /// limits.
    pub assumed: bool,
    /// Play of the gear from one edge to the other, β, rad.
    pub backlash: f64,
}

/// What a motor is made to do at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Driven {
    /// u of equation (3), N·m: torque before the back-EMF is taken off.
    pub torque: f64,
    /// Whether equation (2) cut what the controller asked for.
    pub supply_clipped: bool,
    /// Whether equation (3) cut what the supply would have given.
    pub current_limited: bool,
}

impl DcServo {
    /// The motor of a joint with a gear of some efficiency, under a controller that is `stiffer`
    /// times as stiff as the robot's own, with a current limit, N·m at the joint.
    pub fn new(joint: &Joint, gear_efficiency: f64, stiffer: f64, current_torque: f64) -> Self {
        let known = joint
            .motor
            .and_then(|motor| Some((gear_efficiency * motor.stall, motor.no_load_speed?)));
        let (supply_torque, no_load) = known.unwrap_or((joint.effort_limit, joint.speed_limit));
        Self {
            stiffness: stiffer * joint.servo_stiffness,
            supply_torque,
            current_torque,
            back_emf: supply_torque / no_load,
            assumed: known.is_none(),
            backlash: 0.0,
        }
    }

    /// The same motor behind a gear with some play from one edge to the other, rad.
    #[must_use]
    pub const fn with_backlash(self, backlash: f64) -> Self {
        Self { backlash, ..self }
    }

    /// Equation (5): what the play leaves of a position error, rad.
    pub fn beyond_play(&self, error: f64) -> f64 {
        let half = self.backlash / 2.0;
        error - error.clamp(-half, half)
    }

    /// Equations (2) and (3) at a position error that is left beyond the play, rad, and a speed, rad/s.
    pub fn drive(&self, error: f64, speed: f64) -> Driven {
        let wanted = self.stiffness * error;
        let by_supply = wanted.clamp(-self.supply_torque, self.supply_torque);
        let back = self.back_emf * speed;
        let (least, most) = (back - self.current_torque, back + self.current_torque);
        // Not `clamp`, which panics where the speed is no number, nor `min` and `max`, which give a
        // number where the error is none.
        let torque = if by_supply < least {
            least
        } else if by_supply > most {
            most
        } else {
            by_supply
        };
        Driven {
            torque,
            supply_clipped: wanted.abs() > self.supply_torque,
            current_limited: (torque - by_supply).abs() > 0.0,
        }
    }

    /// Equation (4): the torque applied, N·m, where the joint has a speed, rad/s, after the step.
    pub fn applied(&self, driven: &Driven, speed: f64) -> f64 {
        driven.torque - self.back_emf * speed
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use crate::robot::testing::two_armed;
    use crate::robot::{Joint, Motor};

    use super::*;

    fn joint() -> Joint {
        Joint {
            effort_limit: 1.5,
            speed_limit: 4.0,
            servo_stiffness: 80.0,
            motor: Some(Motor {
                ratio: 100.0,
                nominal: 1.0,
                stall: 5.0,
                no_load_speed: Some(6.0),
            }),
            ..two_armed().joints.swap_remove(0)
        }
    }

    #[track_caller]
    fn near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
    }

    #[test]
    fn limit_stall_no_load_and_current() {
        let servo = DcServo::new(&joint(), 0.6, 1.0, 1.5);
        near(servo.supply_torque, 3.0);
        near(servo.back_emf, 0.5);
        // At rest and far off: the current limit, of a supply that could give twice as much.
        let stalled = servo.drive(1.0, 0.0);
        near(servo.applied(&stalled, 0.0), 1.5);
        assert!(stalled.supply_clipped && stalled.current_limited);
        // At no-load speed nothing is left.
        let running = servo.drive(1.0, 6.0);
        near(servo.applied(&running, 6.0), 0.0);
        assert!(running.supply_clipped && !running.current_limited);
        // A small error is neither clipped nor limited.
        let holding = servo.drive(0.01, 0.0);
        near(servo.applied(&holding, 0.0), 0.8);
        assert!(!holding.supply_clipped && !holding.current_limited);
        // Driven backwards fast, it brakes with no more than its limit.
        let braking = servo.drive(0.0, -20.0);
        near(servo.applied(&braking, -20.0), 1.5);
    }

    /// Between the edges of the play nothing is left of an error; outside, half the play is taken off.
    /// Without play an error keeps every bit.
    #[test]
    fn limit_play_takes_half_of_it_off_an_error() {
        let tight = DcServo::new(&joint(), 0.6, 1.0, 1.5);
        let loose = tight.with_backlash(0.02);
        for error in [0.0, 0.005, -0.01, 0.01] {
            near(loose.beyond_play(error), 0.0);
        }
        near(loose.beyond_play(0.013), 0.003);
        near(loose.beyond_play(-0.013), -0.003);
        assert!(loose.beyond_play(f64::NAN).is_nan());
        for error in [0.1_f64, -0.013, 1e-300] {
            assert_eq!(tight.beyond_play(error).to_bits(), error.to_bits());
        }
    }

    #[test]
    fn limit_what_is_no_number_gives_no_torque_that_is_one() {
        let servo = DcServo::new(&joint(), 0.6, 1.0, 1.5);
        for (error, speed) in [(0.1, f64::NAN), (f64::NAN, 0.0), (f64::NAN, f64::NAN)] {
            let driven = servo.drive(error, speed);
            assert!(servo.applied(&driven, speed).is_nan(), "{error} {speed}");
        }
    }

    #[test]
    fn a_motor_that_is_not_known_is_assumed_from_the_limits() {
        let unknown = Joint {
            motor: None,
            ..joint()
        };
        let servo = DcServo::new(&unknown, 0.6, 4.0, unknown.effort_limit);
        assert!(servo.assumed && !DcServo::new(&joint(), 0.6, 1.0, 1.5).assumed);
        near(servo.supply_torque, 1.5);
        near(servo.back_emf, 1.5 / 4.0);
        near(servo.stiffness, 320.0);
    }

    proptest! {
        /// Whatever is asked, the torque applied at the speed that was read is within the current
        /// limit, and on the side of the line from stall torque to no-load speed that a supply
        /// allows, or brakes.
        #[test]
        fn identity_applied_torque_keeps_both_limits(error in -2.0..2.0, speed in -12.0..12.0) {
            let servo = DcServo::new(&joint(), 0.6, 1.0, 1.5);
            let applied = servo.applied(&servo.drive(error, speed), speed);
            prop_assert!(applied.abs() <= 1.5 + 1e-12);
            let most = (3.0 - 0.5 * speed).max(-1.5);
            prop_assert!(applied <= most.max(0.0) + 1e-12 || speed < 0.0);
        }

        /// The law has no preferred direction.
        #[test]
        fn identity_the_law_is_odd(error in -2.0..2.0, speed in -12.0..12.0) {
            let servo = DcServo::new(&joint(), 0.6, 1.0, 1.5);
            let (one, other) = (servo.drive(error, speed), servo.drive(-error, -speed));
            prop_assert!((one.torque + other.torque).abs() < 1e-12);
            prop_assert_eq!(one.supply_clipped, other.supply_clipped);
            prop_assert_eq!(one.current_limited, other.current_limited);
        }
    }
}
