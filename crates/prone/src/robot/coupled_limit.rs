//! Limits of a joint that depend on the angle of another one.
//!
//! Shells of neighbouring links meet in some postures before either joint is at its own stop, so that
//! a manufacturer gives the range of one joint as a table over another. Between two lines of the
//! table the range is linear; beyond its ends it is that of the end.

use super::{JointAngles, JointId, Range, Robot};

/// Range of a joint over the angle of another.
#[derive(Debug, Clone, PartialEq)]
pub struct CoupledLimit {
    /// The joint that is limited.
    pub joint: JointId,
    /// The joint by whose angle.
    pub by: JointId,
    /// The table: angle of `by`, rad, rising, and the range of `joint` there. Never empty.
    pub table: Vec<(f64, Range)>,
}

/// A table that is none.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum CoupledLimitError {
    /// It has no line.
    #[error("a table of limits needs at least one line")]
    Empty,
    /// Its angles do not rise.
    #[error("the angle of line {line} is not above that of the line before")]
    NotRising {
        /// The line, from 1.
        line: usize,
    },
    /// A range whose lower end is not below its upper one, or that is no number.
    #[error("the range of line {line} is empty")]
    Range {
        /// The line, from 1.
        line: usize,
    },
    /// A joint cannot limit itself.
    #[error("a joint cannot limit itself")]
    ByItself,
}

/// A joint that is beyond the limits which another joint's angle sets it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{joint} {angle:.4} rad is outside {lower:.4}..{upper:.4}, its limits while {by} is at {at:.4} rad"
)]
pub struct BeyondCoupled {
    /// The joint's name.
    pub joint: String,
    /// The joint that sets the limits.
    pub by: String,
    /// Where that one is, rad.
    pub at: f64,
    /// What is asked for, rad.
    pub angle: f64,
    /// The lower limit, rad.
    pub lower: f64,
    /// The upper limit, rad.
    pub upper: f64,
}

impl CoupledLimit {
    /// A table of limits.
    ///
    /// # Errors
    /// [`CoupledLimitError`], with the line.
    pub fn new(
        joint: JointId,
        by: JointId,
        table: Vec<(f64, Range)>,
    ) -> Result<Self, CoupledLimitError> {
        if joint == by {
            return Err(CoupledLimitError::ByItself);
        }
        if table.is_empty() {
            return Err(CoupledLimitError::Empty);
        }
        for (index, (angle, range)) in table.iter().enumerate() {
            let line = index + 1;
            let rises = match index.checked_sub(1) {
                None => angle.is_finite(),
                Some(before) => *angle > table[before].0 && angle.is_finite(),
            };
            if !rises {
                return Err(CoupledLimitError::NotRising { line });
            }
            let spans = range.lower < range.upper;
            if !(spans && range.lower.is_finite() && range.upper.is_finite()) {
                return Err(CoupledLimitError::Range { line });
            }
        }
        Ok(Self { joint, by, table })
    }

    /// The range of the joint where the other one is at an angle, rad.
    pub fn range(&self, angle: f64) -> Range {
        let after = self.table.partition_point(|(at, _)| *at <= angle);
        let line = |index: usize| self.table[index.min(self.table.len() - 1)];
        let (from, below) = line(after.saturating_sub(1));
        let (to, above) = line(after);
        let share = if to > from {
            ((angle - from) / (to - from)).clamp(0.0, 1.0)
        } else {
            0.0
        };
        let between = |low: f64, high: f64| low + share * (high - low);
        Range {
            lower: between(below.lower, above.lower),
            upper: between(below.upper, above.upper),
        }
    }

    /// How far its joint is outside in a posture, rad, negative below; NaN where it is no number.
    pub fn excess(&self, posture: &JointAngles) -> f64 {
        self.range(posture[self.by]).excess(posture[self.joint])
    }

    /// Brings its joint within.
    pub fn clamp(&self, posture: &mut JointAngles) {
        posture[self.joint] = self.range(posture[self.by]).clamp(posture[self.joint]);
    }

    /// What is beyond in a posture of a robot, in words.
    pub fn beyond(&self, robot: &Robot, posture: &JointAngles) -> BeyondCoupled {
        let name = |joint: JointId| robot.joints[joint.0].name.clone();
        let Range { lower, upper } = self.range(posture[self.by]);
        BeyondCoupled {
            joint: name(self.joint),
            by: name(self.by),
            at: posture[self.by],
            angle: posture[self.joint],
            lower,
            upper,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(lower: f64, upper: f64) -> Range {
        Range { lower, upper }
    }

    fn table() -> Vec<(f64, Range)> {
        vec![
            (-1.0, range(-0.1, 0.1)),
            (0.0, range(-0.5, 0.9)),
            (0.5, range(-0.5, 0.0)),
        ]
    }

    #[test]
    fn ranges_are_linear_between_lines_and_constant_beyond() {
        let limit = CoupledLimit::new(JointId(1), JointId(0), table()).unwrap();
        for (angle, lower, upper) in [
            (-2.0, -0.1, 0.1),
            (-1.0, -0.1, 0.1),
            (-0.5, -0.3, 0.5),
            (0.0, -0.5, 0.9),
            (0.25, -0.5, 0.45),
            (0.5, -0.5, 0.0),
            (3.0, -0.5, 0.0),
        ] {
            let found = limit.range(angle);
            assert!((found.lower - lower).abs() < 1e-12, "{angle}: {found:?}");
            assert!((found.upper - upper).abs() < 1e-12, "{angle}: {found:?}");
        }
    }

    #[test]
    fn limit_tables_that_are_none() {
        let new = |table| CoupledLimit::new(JointId(1), JointId(0), table);
        assert_eq!(new(Vec::new()), Err(CoupledLimitError::Empty));
        let mut falling = table();
        falling[1].0 = -1.0;
        assert_eq!(new(falling), Err(CoupledLimitError::NotRising { line: 2 }));
        let mut empty = table();
        empty[2].1.upper = f64::NAN;
        assert_eq!(new(empty), Err(CoupledLimitError::Range { line: 3 }));
        let own = CoupledLimit::new(JointId(1), JointId(1), table());
        assert_eq!(own, Err(CoupledLimitError::ByItself));
    }
}
