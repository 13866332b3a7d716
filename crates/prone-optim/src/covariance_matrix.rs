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
//! A point that is known to be good ([`Scorer::known`](crate::Scorer::known)) is scored first, alone, so that
//! nothing worse is ever found.
//!
//! A search of the crate begins at a random mean and ends by its own criteria; then another begins,
//! with the population doubled from search to search up to `2^doublings`, then small again.
//!
//! The crate asks for scores one by one, through a closure, and its state cannot be written. But the
//! state follows from the seed and the scores: so those are kept, and each generation the search is
//! made anew, told all its scores, and asked for its next points, which are then scored together
//! like any solver's. That costs microseconds per earlier generation, and makes a checkpoint exact
//! after every generation.

use std::cell::RefCell;

use cmaes::{CMAESOptions, DVector};
use serde::{Deserialize, Serialize};

use crate::{Candidate, Evaluator, Interval, NoScores, Random, Solver};

/// Parameters of the searches.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct CovarianceMatrixOptions {
    /// Points per generation of the first search; at least 4.
    pub population: usize,
    /// How often the population is doubled before it is small again.
    pub doublings: u32,
    /// First standard deviation, widths of the bounds.
    pub step: f64,
    /// Share of the bounds, about their middle, in which the first means lie; 1 is all of them.
    pub middle: f64,
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
            middle: 1.0,
            evaluations_per_search: 10_000,
            violation_weight: 1000.0,
        }
    }
}

/// The solver and its state between generations.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CovarianceMatrix {
    options: CovarianceMatrixOptions,
    random: Random,
    searches: u64,
    search: Option<Search>,
    /// Whether a point that is known to be good is still to be scored.
    known_first: bool,
}

/// A search of the crate: how it began, and what it was told.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Search {
    mean: Vec<f64>,
    step: f64,
    population: usize,
    seed: u64,
    /// (1) of every point it asked for, in order; whole generations.
    told: Vec<f64>,
}

impl CovarianceMatrix {
    /// A search that has not begun.
    pub fn new(options: CovarianceMatrixOptions, seed: u64) -> Self {
        Self {
            options,
            random: Random::new(seed),
            searches: 0,
            search: None,
            known_first: true,
        }
    }

    fn begin(&mut self, variables: usize) -> Search {
        let doublings = self.searches % (u64::from(self.options.doublings) + 1);
        self.searches += 1;
        Search {
            mean: (0..variables)
                .map(|_| 0.5 + self.options.middle * (self.random.uniform() - 0.5))
                .collect(),
            step: self.options.step,
            population: self.options.population.max(4) << doublings,
            seed: self.random.seed(),
            told: Vec::new(),
        }
    }
}

impl Solver for CovarianceMatrix {
    fn advance(&mut self, evaluator: &mut Evaluator<'_>) -> Result<(), NoScores> {
        let bounds = evaluator.bounds();
        if let (true, Some(known)) = (self.known_first, evaluator.known()) {
            let known = known.to_vec();
            evaluator.evaluate(vec![known])?;
            self.known_first = false;
            return Ok(());
        }
        let most = self.options.evaluations_per_search;
        let going_on = self.search.take();
        let going_on = going_on.filter(|search| search.told.len() + search.population <= most);
        let asked = match &going_on {
            Some(search) => search.ask()?,
            None => None,
        };
        let (mut search, shares) = if let (Some(search), Some(shares)) = (going_on, asked) {
            (search, shares)
        } else {
            let search = self.begin(bounds.len());
            let shares = search.ask()?.ok_or(NoScores::BudgetSpent)?;
            (search, shares)
        };
        let place = |(interval, &share): (&Interval, &f64)| interval.at(fold(share));
        let points = shares
            .iter()
            .map(|shares| bounds.iter().zip(shares).map(place).collect());
        let scored = evaluator.evaluate(points.collect())?;
        let weight = self.options.violation_weight;
        let penalised = |Candidate { score, .. }: &Candidate| {
            (weight * score.violation() + score.value()).min(f64::MAX)
        };
        search.told.extend(scored.iter().map(penalised));
        self.search = Some(search);
        Ok(())
    }

    fn restarts(&self) -> u64 {
        self.searches.saturating_sub(1)
    }
}

impl Search {
    /// The next generation's points, in the crate's coordinates; `None` where it has ended. Options
    /// that the crate refuses (no variables, a step of zero) leave nothing to search.
    fn ask(&self) -> Result<Option<Vec<Vec<f64>>>, NoScores> {
        let tape = RefCell::new((self.told.iter(), Vec::with_capacity(self.population)));
        let play = |shares: &DVector<f64>| {
            let (told, asked) = &mut *tape.borrow_mut();
            if let Some(&known) = told.next() {
                return known;
            }
            asked.push(shares.iter().copied().collect::<Vec<f64>>());
            // No number ends the crate's generation; all its points are known by then.
            if asked.len() < self.population {
                0.0
            } else {
                f64::NAN
            }
        };
        let mut search = CMAESOptions::new(self.mean.clone(), self.step)
            .population_size(self.population)
            .seed(self.seed)
            .build(play)
            .map_err(|_| NoScores::BudgetSpent)?;
        for _ in 0..self.told.len() / self.population {
            if search.next().is_some() {
                return Ok(None);
            }
        }
        let _ = search.next();
        drop(search);
        Ok(Some(tape.into_inner().1))
    }
}

/// A real number folded into [0, 1]: the identity there, mirrored at both ends.
fn fold(share: f64) -> f64 {
    let turn = share.rem_euclid(2.0);
    if turn > 1.0 { 2.0 - turn } else { turn }
}

#[cfg(test)]
mod tests;
