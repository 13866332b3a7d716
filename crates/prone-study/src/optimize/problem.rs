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
        // Without a torque part only the violation counts.
        let torque = if price.torque.is_nan() {
            0.0
        } else {
            price.torque
        };
        Score::new(price.violations.total(), torque)
    }
}
