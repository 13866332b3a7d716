//! Keeping a crawl on its line: one turn command a cycle.
//!
//! With yaw ψ (rad, positive to the left), lateral offset y (m, positive to the left) and the sum
//! of y over the cycles so far, the command is
//!
//! ```text
//! u = clip(−k (ψ + a y + b Σ y), ±limit)                              (1)
//! ```
//!
//! The offset is turned back into a heading towards the line (a), and what pushes the robot aside
//! all the time, unequal friction or a joint that is off, is learnt by the sum (b), which stops
//! growing while the command is at its limit.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::frames::{Ground, Root, Transform};
use crate::robot::SteeringGains;

/// Where a robot is and where it heads, in the frame of the line that it is to follow.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Bearing {
    /// Along the line, m.
    pub x: f64,
    /// Beside it, m, positive to the left.
    pub y: f64,
    /// Heading, rad, positive to the left.
    pub yaw: f64,
}

impl Bearing {
    /// Bearing of a prone robot whose root has that pose, along the x axis of the ground.
    ///
    /// It lies on its belly, so that forward is where the top of its trunk points: the root's z axis.
    pub fn of_prone(ground_from_root: &Transform<Ground, Root>) -> Self {
        let ahead = ground_from_root.rotate(DVec3::Z);
        let origin = ground_from_root.origin().metres();
        Self {
            x: origin.x,
            y: origin.y,
            yaw: ahead.y.atan2(ahead.x),
        }
    }
}

/// The command of equation (1), cycle after cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadingHold {
    /// k, a and b.
    pub gains: SteeringGains,
    /// The largest |u|, rad.
    pub limit: f64,
    sum: f64,
}

impl HeadingHold {
    /// With a robot's gains, turning by at most `limit`, rad.
    pub const fn new(gains: SteeringGains, limit: f64) -> Self {
        Self {
            gains,
            limit,
            sum: 0.0,
        }
    }

    /// The turn command for the next cycle, rad, with the target heading subtracted from the
    /// bearing by the caller. A heading and the same heading a whole turn on are one.
    pub fn turn(&mut self, bearing: Bearing) -> f64 {
        let SteeringGains {
            yaw,
            lateral,
            lateral_sum,
        } = self.gains;
        let heading = shorter(bearing.yaw);
        let error = |sum: f64| heading + lateral * bearing.y + lateral_sum * sum;
        let sum = self.sum + bearing.y;
        let wanted = -yaw * error(sum);
        if wanted.abs() < self.limit {
            self.sum = sum;
        }
        wanted.clamp(-self.limit, self.limit)
    }
}

/// Turning to a heading and keeping it, wherever that leads: u = clip(k (ψ* − ψ), ±limit).
///
/// Of a command the robot turns a half to nine tenths (by its gait and the ground), so that with
/// k = 1 the error shrinks from cycle to cycle and never changes its sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TurnTo {
    /// ψ*, rad, positive to the left.
    pub heading: f64,
    /// The largest |u|, rad.
    pub limit: f64,
}

impl TurnTo {
    /// The turn command for the next cycle, rad: the shorter way round.
    pub fn turn(&self, bearing: Bearing) -> f64 {
        shorter(self.heading - bearing.yaw).clamp(-self.limit, self.limit)
    }
}

/// An angle the shorter way round, rad.
fn shorter(angle: f64) -> f64 {
    angle - (angle / TAU).round() * TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAINS: SteeringGains = SteeringGains {
        yaw: 0.9,
        lateral: 3.5,
        lateral_sum: 0.35,
    };

    #[test]
    fn a_heading_is_turned_to_the_shorter_way_and_no_faster_than_the_limit() {
        let turn = |heading: f64, yaw: f64| {
            let bearing = Bearing {
                yaw,
                ..Bearing::default()
            };
            TurnTo {
                heading,
                limit: 0.2,
            }
            .turn(bearing)
        };
        assert!((turn(1.0, 0.0) - 0.2).abs() < f64::EPSILON);
        assert!((turn(1.0, 0.9) - 0.1).abs() < 1e-12);
        assert!(turn(3.0, -3.0) < 0.0, "to the right across 180°");
    }

    #[test]
    fn a_robot_that_heads_left_or_is_left_of_the_line_turns_right() {
        let left = |x, y, yaw| HeadingHold::new(GAINS, 0.2).turn(Bearing { x, y, yaw });
        assert!(left(0.0, 0.0, 0.1) < 0.0);
        assert!(left(0.0, 0.01, 0.0) < 0.0);
        assert!(left(0.0, -0.01, 0.0) > 0.0);
        assert!((left(0.0, 0.0, 3.0) + 0.2).abs() < f64::EPSILON, "clipped");
        let whole_turn = left(0.0, 0.0, 0.1 + TAU) - left(0.0, 0.0, 0.1);
        assert!(whole_turn.abs() < 1e-12, "{whole_turn}");
    }

    #[test]
    fn a_steady_push_is_learnt_but_not_while_the_command_is_clipped() {
        let mut hold = HeadingHold::new(GAINS, 0.2);
        let aside = Bearing {
            x: 0.0,
            y: 0.005,
            yaw: 0.0,
        };
        let first = hold.turn(aside);
        assert!(hold.turn(aside) < first);
        let far = Bearing {
            x: 0.0,
            y: 1.0,
            yaw: 0.0,
        };
        let before = hold;
        hold.turn(far);
        assert_eq!(hold, before);
    }
}
