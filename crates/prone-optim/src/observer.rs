//! Who hears of each generation, and may end the run.

use std::ops::ControlFlow;
use std::time::Duration;

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

/// Both hear; either may end the run.
impl<A: Observer, B: Observer> Observer for (A, B) {
    fn observe(&mut self, generation: &Generation) -> ControlFlow<()> {
        let (first, second) = (self.0.observe(generation), self.1.observe(generation));
        if first.is_break() { first } else { second }
    }
}

impl<O: Observer> Observer for &mut O {
    fn observe(&mut self, generation: &Generation) -> ControlFlow<()> {
        (**self).observe(generation)
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

/// Ends the run when the caller's clock has passed a limit.
#[derive(Debug, Clone)]
pub struct TimeBudget<C> {
    limit: Duration,
    elapsed: C,
}

impl<C: Fn() -> Duration> TimeBudget<C> {
    /// `elapsed` tells the time since the run began; this crate reads no clock itself.
    pub const fn new(limit: Duration, elapsed: C) -> Self {
        Self { limit, elapsed }
    }
}

impl<C: Fn() -> Duration> Observer for TimeBudget<C> {
    fn observe(&mut self, _: &Generation) -> ControlFlow<()> {
        if (self.elapsed)() >= self.limit {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}
