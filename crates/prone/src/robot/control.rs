//! How a robot is driven and steered, and what searches and pictures have to know of its size.
//!
//! These numbers belong to a robot as its joint limits do: a command step is the cycle of its motor
//! boards, a servo's law is that of its firmware, and an advance of 120 mm is a stride of one robot
//! and a shuffle of another.

use super::Range;

/// How a robot is driven and steered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Control {
    /// Time between two commands, s: the cycle of its motor boards.
    pub command_step: f64,
    /// The law of its joints' servos; their gains are [`super::Joint::servo_gain`].
    pub servo: ServoLaw,
    /// Velocity gain of every joint's servo where its servos are taken to be stiff, N·m·s/rad: the
    /// other end of what is not known about them.
    pub stiff_servo_gain: f64,
    /// How it is kept on its line.
    pub steering: SteeringGains,
    /// Slope above which a cycle for going uphill is taken, rad.
    pub uphill: f64,
}

/// How a servo makes a speed of a position error: `speed = clip(rate · error, ±speed)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ServoLaw {
    /// Commanded speed per position error, 1/s.
    pub rate: f64,
    /// Largest commanded speed, rad/s.
    pub speed: f64,
}

impl ServoLaw {
    /// The speed commanded at a position error, rad, in rad/s.
    pub const fn command(&self, error: f64) -> f64 {
        (self.rate * error).clamp(-self.speed, self.speed)
    }
}

/// Gains of equation (1) of [`crate::steering`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteeringGains {
    /// k, turn commanded per heading error, without unit.
    pub yaw: f64,
    /// a, heading error per lateral offset, rad/m.
    pub lateral: f64,
    /// b, heading error per sum of the lateral offsets over the cycles, rad/m.
    pub lateral_sum: f64,
}

/// Within what searches look for cycles of a robot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSetup {
    /// Least advance of a cycle that is searched for anything but its advance, m: one that gets on
    /// by less stands still.
    pub least_advance: f64,
    /// The upper arm's absolute angle α in a pull, rad: it points down, and not backwards.
    pub upper_arm: Range,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_servo_commands_in_proportion_up_to_its_speed_on_both_sides() {
        let law = ServoLaw {
            rate: 20.0,
            speed: 3.0,
        };
        assert!((law.command(0.1) - 2.0).abs() < f64::EPSILON);
        assert!((law.command(-0.1) + 2.0).abs() < f64::EPSILON);
        assert!((law.command(1.0) - 3.0).abs() < f64::EPSILON);
        assert!((law.command(-1.0) + 3.0).abs() < f64::EPSILON);
        assert!(law.command(f64::NAN).is_nan());
    }
}
