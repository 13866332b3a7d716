//! What is optimised: a box of numbers, and a score for each point in it.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

/// A problem: lower scores are better.
pub trait Problem: Sync {
    /// Limits of each variable; points outside are never asked for.
    fn bounds(&self) -> &[Interval];

    /// The score of a point, or why it has none. Depends on nothing but the point.
    fn evaluate(&self, point: &[f64]) -> Result<Score, Failure>;
}

impl<P: Problem> Problem for &P {
    fn bounds(&self) -> &[Interval] {
        (**self).bounds()
    }

    fn evaluate(&self, point: &[f64]) -> Result<Score, Failure> {
        (**self).evaluate(point)
    }
}

/// Why a point has no score. It depends on nothing but the point, as a score does: the solver sees
/// the worst score of all, [`Score::WORST`], and goes on.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error, Serialize, Deserialize)]
#[error("{reason}")]
pub struct Failure {
    /// In words.
    pub reason: String,
}

impl Failure {
    /// A failure for the reason that an error states.
    pub fn from_error(error: &impl std::fmt::Display) -> Self {
        Self {
            reason: error.to_string(),
        }
    }
}

/// Limits of a variable.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    low: f64,
    high: f64,
}

/// Two numbers that are no limits.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{low} to {high} is no interval: it takes two finite numbers, ascending")]
pub struct IntervalError {
    /// Lower limit.
    pub low: f64,
    /// Upper limit.
    pub high: f64,
}

impl Interval {
    /// From `low` to `high`.
    ///
    /// # Errors
    /// [`IntervalError`] unless both are finite and `low` < `high`.
    pub fn new(low: f64, high: f64) -> Result<Self, IntervalError> {
        if low < high && (high - low).is_finite() {
            Ok(Self { low, high })
        } else {
            Err(IntervalError { low, high })
        }
    }

    /// Lower limit.
    pub const fn low(&self) -> f64 {
        self.low
    }

    /// Upper limit.
    pub const fn high(&self) -> f64 {
        self.high
    }

    /// Upper less lower limit.
    pub fn width(&self) -> f64 {
        self.high - self.low
    }

    /// The nearest point inside.
    pub fn clamp(&self, value: f64) -> f64 {
        value.clamp(self.low, self.high)
    }

    /// The point at a share of the way from `low` to `high`.
    pub fn at(&self, share: f64) -> f64 {
        self.clamp(self.low + share * self.width())
    }
}

/// How good a point is: violation first, value between equals.
///
/// The violation is zero for a feasible point and grows with its distance from feasibility. Not
/// a number counts as the largest number, so that it never wins.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Score {
    violation: f64,
    value: f64,
}

impl Score {
    /// That of a point that has none: further from feasibility than any other.
    pub const WORST: Self = Self {
        violation: f64::MAX,
        value: 0.0,
    };

    /// A violation (not negative) and a value.
    pub fn new(violation: f64, value: f64) -> Self {
        Self {
            violation: finite(violation).max(0.0) + 0.0,
            value: finite(value),
        }
    }

    /// A feasible point.
    pub fn feasible(value: f64) -> Self {
        Self::new(0.0, value)
    }

    /// Distance from feasibility.
    pub const fn violation(&self) -> f64 {
        self.violation
    }

    /// What is minimised among equals.
    pub const fn value(&self) -> f64 {
        self.value
    }

    /// Deb's rules, as one order: less violation wins, then less value.
    pub fn order(&self, other: &Self) -> Ordering {
        let violation = self.violation.total_cmp(&other.violation);
        violation.then(self.value.total_cmp(&other.value))
    }

    /// Whether this is strictly better.
    pub fn beats(&self, other: &Self) -> bool {
        self.order(other).is_lt()
    }
}

/// Within what any format can write and arithmetic on it survives; one zero, not two, as the
/// order of scores tells them apart.
fn finite(number: f64) -> f64 {
    if number.is_nan() {
        f64::MAX
    } else {
        number.clamp(f64::MIN, f64::MAX) + 0.0
    }
}

/// A scored point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Candidate {
    /// The point.
    pub point: Vec<f64>,
    /// Its score.
    pub score: Score,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn violation_comes_before_value() {
        let feasible = Score::feasible(1e9);
        assert!(feasible.beats(&Score::new(1e-12, -1e9)));
        assert!(Score::new(1.0, 5.0).beats(&Score::new(1.0, 6.0)));
        assert!(!feasible.beats(&feasible));
    }

    #[test]
    fn limit_nan_never_wins() {
        assert!(Score::new(5.0, 0.0).beats(&Score::new(f64::NAN, 0.0)));
        assert!(Score::feasible(1e300).beats(&Score::feasible(f64::NAN)));
        assert_eq!(
            Score::new(-0.0, 0.0).order(&Score::feasible(0.0)),
            Ordering::Equal
        );
    }

    #[test]
    fn limit_no_interval() {
        assert!(Interval::new(1.0, 1.0).is_err());
        assert!(Interval::new(f64::NAN, 1.0).is_err());
        assert!(Interval::new(0.0, f64::INFINITY).is_err());
    }
}
