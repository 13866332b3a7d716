//! Searching whole cycles in the locomotion regime.
//!
//! [`form`] makes cycles of numbers, [`price`] prices them by what [`trial`]s of them come to and which
//! [`rules`] these break, an optimiser of `prone-optim` searches over both.

pub mod form;
pub mod frontier;
pub mod passage;
pub mod price;
pub mod rules;
pub mod setting;
pub mod settings;
pub mod trial;

use prone_optim::{Interval, Problem, Score};

use form::CycleForm;
use price::CyclePricer;

use crate::optimize::problem::counted;

/// What an optimiser sees of a cycle.
pub struct CycleProblem<'a> {
    /// Points to cycles.
    pub form: &'a CycleForm,
    /// Cycles to prices.
    pub pricer: &'a CyclePricer<'a>,
}

impl Problem for CycleProblem<'_> {
    fn bounds(&self) -> &[Interval] {
        self.form.bounds()
    }

    fn evaluate(&self, point: &[f64]) -> Score {
        let Ok(cycle) = self.form.cycle(point) else {
            return Score::new(f64::MAX, 0.0);
        };
        let price = self.pricer.price(&cycle);
        Score::new(price.violation, counted(price.value, price.violation))
    }
}
