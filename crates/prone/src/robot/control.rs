//! How a robot is driven and steered, and what searches and pictures have to know of its size.
//!
//! These numbers belong to a robot as its joint limits do: a command step is the cycle of its motor
//! boards, the efficiency that of its gears, and an advance of 120 mm is a stride of one robot
//! and a shuffle of another.

use super::Range;

/// How a robot is driven and steered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Control {
    /// Time between two commands, s: the cycle of its motor boards.
    pub command_step: f64,
    /// Share of a motor's torque that its gear passes on, an estimate where the manufacturer says
    /// nothing ([`crate::motor`]).
    pub gear_efficiency: f64,
    /// How it is kept on its line.
    pub steering: SteeringGains,
    /// Slope above which a cycle for going uphill is taken, rad.
    pub uphill: f64,
}

/// Gains of equations (1) to (3) of [`crate::steering`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteeringGains {
    /// k, turn commanded per heading error, without unit.
    pub yaw: f64,
    /// a, heading error per lateral offset, rad/m.
    pub lateral: f64,
    /// b, heading error per sum of the lateral offsets over the cycles, rad/m.
    pub lateral_sum: f64,
    /// e, heading error per lateral offset of cycles that can be shifted, rad/m.
    pub aside: f64,
    /// c, heading error per sum of the heading errors over the cycles, of cycles that can be shifted.
    pub yaw_sum: f64,
    /// L, how far ahead of the root the point lies about which a turn turns cycles that can be shifted, m.
    pub ahead: f64,
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
