//! What an optimiser sees of a crawl: a box of numbers and a score for each point.

use prone_optim::{Interval, Problem, Score};

use super::form::Parametrisation;
use super::pricing::Pricing;

/// Gaits of one form under one pricing.
pub struct GaitProblem<'a> {
    /// Points to gaits.
    pub forms: &'a Parametrisation,
    /// Gaits to prices.
    pub pricing: &'a dyn Pricing,
}

impl Problem for GaitProblem<'_> {
    fn bounds(&self) -> &[Interval] {
        self.forms.bounds()
    }

    fn evaluate(&self, point: &[f64]) -> Score {
        let Ok(gait) = self.forms.gait(point) else {
            return Score::new(f64::MAX, 0.0);
        };
        let price = self.pricing.price(&gait);
        let violation = price.violations.total();
        Score::new(violation, counted(price.torque, violation))
    }
}

/// The value of a score: where a rule is broken, what is not known does not count. Where none is, it
/// stays not a number, which never wins.
pub(crate) fn counted(value: f64, violation: f64) -> f64 {
    if value.is_nan() && violation > 0.0 {
        0.0
    } else {
        value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limit_an_unknown_value_never_wins() {
        let score = |violation, value| Score::new(violation, counted(value, violation));
        assert!(score(0.0, 1e300).beats(&score(0.0, f64::NAN)));
        assert_eq!(score(0.5, f64::NAN), Score::new(0.5, 0.0));
        assert_eq!(score(0.5, 3.0), Score::new(0.5, 3.0));
    }
}
