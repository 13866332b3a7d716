//! Keeping a crawl on its line: a command to turn, and one to move aside, once a cycle.
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
//!
//! A cycle that can be shifted aside without being turned is held by two commands, each for its own
//! error, with the sum of ψ and its gain c. Where a shift is not enough, the robot heads towards the line
//! (e), less steeply than without a shift:
//!
//! ```text
//! y' = y + L ψ
//! u = clip(−k (ψ + e y' + c Σ ψ), ±limit)                             (2)
//! v = clip(−(a y' + b Σ y'), ±shift limit)                            (3)
//! ```
//!
//! y' is the offset of a point at L ahead of the root, about which a turn turns the robot: its own offset a
//! turn changes, and a shift that answered it would turn the robot back.

use std::f64::consts::TAU;

use glam::DVec3;

use crate::frames::{Ground, Root, Transform};
use crate::gait::cycle::{Steer, Steering};
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

/// The commands of equation (1), or (2) and (3), cycle after cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeadingHold {
    /// k, a, b, c, e and L.
    pub gains: SteeringGains,
    /// The largest |u|, rad.
    pub limit: f64,
    /// The largest |v|, rad; 0 of a cycle that cannot be shifted.
    pub shift_limit: f64,
    sum: f64,
    yaw_sum: f64,
}

impl HeadingHold {
    /// With a robot's gains, turning by at most `limit`, rad.
    pub const fn new(gains: SteeringGains, limit: f64) -> Self {
        Self {
            gains,
            limit,
            shift_limit: 0.0,
            sum: 0.0,
            yaw_sum: 0.0,
        }
    }

    /// With a robot's gains and as far as a cycle can be steered.
    pub const fn of(gains: SteeringGains, steering: &Steering) -> Self {
        Self::new(gains, steering.limit).shifting(steering.shift_limit)
    }

    /// The same, shifting by at most `limit`, rad.
    #[must_use]
    pub const fn shifting(self, limit: f64) -> Self {
        Self {
            shift_limit: limit,
            ..self
        }
    }

    /// What the next cycle is steered by, rad: by equation (1), or (2) and (3) where it can be shifted.
    pub fn steer(&mut self, bearing: Bearing) -> Steer {
        if self.shift_limit == 0.0 {
            return Steer {
                turn: self.turn(bearing),
                shift: 0.0,
            };
        }
        let gains = self.gains;
        let heading = shorter(bearing.yaw);
        let aside = bearing.y + gains.ahead * heading;
        let turn = Held {
            wanted: |sum: f64| -gains.yaw * (heading + gains.aside * aside + gains.yaw_sum * sum),
            limit: self.limit,
        };
        let shift = Held {
            wanted: |sum: f64| -(gains.lateral * aside + gains.lateral_sum * sum),
            limit: self.shift_limit,
        };
        Steer {
            turn: turn.command(&mut self.yaw_sum, heading),
            shift: shift.command(&mut self.sum, aside),
        }
    }

    /// The turn command for the next cycle, rad, with the target heading subtracted from the
    /// bearing by the caller. A heading and the same heading a whole turn on are one.
    pub fn turn(&mut self, bearing: Bearing) -> f64 {
        let SteeringGains {
            yaw,
            lateral,
            lateral_sum,
            aside: _,
            yaw_sum: _,
            ahead: _,
        } = self.gains;
        let heading = shorter(bearing.yaw);
        let held = Held {
            wanted: |sum: f64| -yaw * (heading + lateral * bearing.y + lateral_sum * sum),
            limit: self.limit,
        };
        held.command(&mut self.sum, bearing.y)
    }
}

/// A command of an error and of its sum, which stops growing while the command is at its limit.
struct Held<W> {
    /// The command by the sum.
    wanted: W,
    /// Its largest amount.
    limit: f64,
}

impl<W: Fn(f64) -> f64> Held<W> {
    fn command(&self, sum: &mut f64, error: f64) -> f64 {
        let next = *sum + error;
        let wanted = (self.wanted)(next);
        if wanted.abs() < self.limit {
            *sum = next;
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
        aside: 0.5,
        yaw_sum: 0.2,
        ahead: 0.3,
    };

    #[test]
    fn a_cycle_that_can_be_shifted_is_held_by_a_command_for_each_error() {
        let steering = Steering {
            limit: 0.2,
            shift_limit: 0.1,
            dead_band: 0.0,
            spread: 0.0,
            joints: std::collections::BTreeMap::new(),
        };
        let steer = |y, yaw| HeadingHold::of(GAINS, &steering).steer(Bearing { x: 0.0, y, yaw });
        // Left of the line it moves to the right and turns little; turned, it turns back.
        let (with, without) = (
            steer(0.01, 0.0),
            HeadingHold::new(GAINS, 0.2).steer(Bearing {
                x: 0.0,
                y: 0.01,
                yaw: 0.0,
            }),
        );
        assert!(with.shift < 0.0 && with.turn < 0.0 && with.turn > without.turn);
        assert!(steer(0.0, 0.05).turn < 0.0);
        // Turned about a point ahead that is on the line, it is turned back and not moved.
        let about = steer(-0.3 * 0.05, 0.05);
        assert!(about.turn < 0.0 && about.shift.abs() < 1e-15);
        assert!(
            (steer(1.0, 0.0).shift + 0.1).abs() < f64::EPSILON,
            "clipped"
        );
        let mut hold = HeadingHold::of(GAINS, &steering);
        let aside = Bearing {
            x: 0.0,
            y: 0.005,
            yaw: 0.01,
        };
        let first = hold.steer(aside);
        let second = hold.steer(aside);
        assert!(
            second.turn < first.turn && second.shift < first.shift,
            "learnt"
        );
    }

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
