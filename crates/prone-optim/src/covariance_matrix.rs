//! CMA-ES from the crate `cmaes`, as a check that shares no code with the default solver.
//!
//! The crate minimises one number over all of ℝⁿ. So each variable is folded into its bounds (a
//! triangle wave: continuous, and the identity inside), in units of its width; and a score
//! becomes
//!
//! ```text
//! f = violation_weight · violation + value                                       (1)
//! ```
//!
//! which is Deb's order only while values differ by less than the weight times the steps of the
//! violation; the run's best is still chosen by [`Score`](crate::Score).
//!
//! One generation of a [`Run`](crate::Run) is one whole search of the crate, from a random mean
//! to its own termination, with its population doubled from search to search up to
//! `2^doublings`, then small again. Its inner state cannot be serialised; between searches there
//! is none but the random numbers, so that a checkpoint stays exact. Points are scored one by one.

use cmaes::{CMAESOptions, DVector};
use serde::{Deserialize, Serialize};

use crate::{BudgetSpent, Evaluator, Interval, Problem, Random, Solver};

/// Parameters of the searches.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CovarianceMatrixOptions {
    /// Points per generation of the first search; at least 4.
    pub population: usize,
    /// How often the population is doubled before it is small again.
    pub doublings: u32,
    /// First standard deviation, widths of the bounds.
    pub step: f64,
    /// Most evaluations of one search.
    pub evaluations_per_search: usize,
    /// What a unit of violation weighs against the value in (1).
    pub violation_weight: f64,
}

impl Default for CovarianceMatrixOptions {
    fn default() -> Self {
        Self {
            population: 12,
            doublings: 3,
            step: 0.2,
            evaluations_per_search: 10_000,
            violation_weight: 1000.0,
        }
    }
}

/// The solver and its state between searches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CovarianceMatrix {
    options: CovarianceMatrixOptions,
    random: Random,
    searches: u64,
}

impl CovarianceMatrix {
    /// A search that has not begun.
    pub fn new(options: CovarianceMatrixOptions, seed: u64) -> Self {
        Self {
            options,
            random: Random::new(seed),
            searches: 0,
        }
    }
}

impl Solver for CovarianceMatrix {
    fn advance<P: Problem>(&mut self, evaluator: &mut Evaluator<'_, P>) -> Result<(), BudgetSpent> {
        let options = self.options;
        let doublings = self.searches % (u64::from(options.doublings) + 1);
        let population = options.population.max(4) << doublings;
        // The crate counts between generations and so passes its limit by less than one.
        let remaining = usize::try_from(evaluator.remaining()).unwrap_or(usize::MAX);
        let most = remaining
            .saturating_sub(population)
            .min(options.evaluations_per_search);
        if most < population {
            return Err(BudgetSpent);
        }
        self.searches += 1;

        let bounds = evaluator.bounds();
        let mean: Vec<f64> = bounds.iter().map(|_| self.random.uniform()).collect();
        let mut spent = Ok(());
        let objective = |shares: &DVector<f64>| {
            let place = |(interval, &share): (&Interval, &f64)| interval.at(fold(share));
            let point = bounds.iter().zip(shares.iter()).map(place).collect();
            match evaluator.evaluate(&[point]).as_deref() {
                Ok([score]) => options.violation_weight * score.violation() + score.value(),
                Ok(_) => f64::MAX,
                Err(error) => {
                    spent = Err(*error);
                    f64::MAX
                }
            }
        };
        let search = CMAESOptions::new(mean, options.step)
            .population_size(population)
            .max_function_evals(most)
            .seed(self.random.seed())
            .build(objective);
        // Options that the crate refuses (no variables, a step of zero) leave nothing to search.
        search.map_err(|_| BudgetSpent)?.run();
        spent
    }

    fn restarts(&self) -> u64 {
        self.searches.saturating_sub(1)
    }
}

/// A real number folded into [0, 1]: the identity there, mirrored at both ends.
fn fold(share: f64) -> f64 {
    let turn = share.rem_euclid(2.0);
    if turn > 1.0 { 2.0 - turn } else { turn }
}

#[cfg(test)]
mod tests;
