//! Who hears of each generation, and may end the run.

use std::ops::ControlFlow;

use serde::{Deserialize, Serialize};

use crate::Score;

/// What one generation came to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Generation {
    /// Its number, from 1.
    pub generation: u64,
    /// Evaluations of the run so far.
    pub evaluations: u64,
    /// Best score of the run so far.
    pub best: Score,
    /// Best score among this generation's points.
    pub generation_best: Score,
    /// Mean violation of this generation's points.
    pub mean_violation: f64,
    /// Mean value of this generation's points.
    pub mean_value: f64,
    /// How many of this generation's points are feasible.
    pub feasible: u64,
    /// Mean value of those, 0 without any.
    pub mean_feasible_value: f64,
    /// How often the search has begun anew.
    pub restarts: u64,
}

/// Hears of each generation.
pub trait Observer {
    /// Called after each generation; `Break` ends the run.
    fn observe(&mut self, generation: &Generation) -> ControlFlow<()>;
}

/// Hears nothing.
impl Observer for () {
    fn observe(&mut self, _: &Generation) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// Keeps every generation: the data of a convergence figure.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct History(pub Vec<Generation>);

impl Observer for History {
    fn observe(&mut self, generation: &Generation) -> ControlFlow<()> {
        self.0.push(*generation);
        ControlFlow::Continue(())
    }
}
