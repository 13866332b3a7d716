//! The one door through which a solver asks for scores: counts, remembers the best, spreads the
//! work over threads.

use rayon::prelude::*;

use crate::{Candidate, Interval, Problem, Score};

/// More evaluations were asked for than the budget has left; none was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the evaluation budget is spent")]
pub struct BudgetSpent;

/// Scores points of one generation.
pub struct Evaluator<'p, P: Problem> {
    problem: &'p P,
    allowance: u64,
    tally: Tally,
}

/// What a generation's evaluations came to.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tally {
    pub(crate) evaluations: u64,
    pub(crate) violation: f64,
    pub(crate) value: f64,
    pub(crate) feasible: u64,
    pub(crate) feasible_value: f64,
    pub(crate) best: Option<Candidate>,
}

impl<'p, P: Problem> Evaluator<'p, P> {
    pub(crate) fn new(problem: &'p P, allowance: u64) -> Self {
        Self {
            problem,
            allowance,
            tally: Tally::default(),
        }
    }

    /// Limits of each variable.
    pub fn bounds(&self) -> &'p [Interval] {
        self.problem.bounds()
    }

    /// Evaluations left.
    pub const fn remaining(&self) -> u64 {
        self.allowance - self.tally.evaluations
    }

    /// Scores points, in order.
    ///
    /// # Errors
    /// [`BudgetSpent`] where fewer evaluations are left than points; none is scored then.
    pub fn evaluate(&mut self, points: &[Vec<f64>]) -> Result<Vec<Score>, BudgetSpent> {
        if points.len() as u64 > self.remaining() {
            return Err(BudgetSpent);
        }
        let score = |point: &Vec<f64>| self.problem.evaluate(point);
        let scores: Vec<Score> = match points {
            // Not worth another thread's attention.
            [point] => vec![score(point)],
            _ => points.par_iter().map(score).collect(),
        };
        for (point, &score) in points.iter().zip(&scores) {
            self.tally.count(point, score);
        }
        Ok(scores)
    }

    pub(crate) fn into_tally(self) -> Tally {
        self.tally
    }
}

impl Tally {
    fn count(&mut self, point: &[f64], score: Score) {
        self.evaluations += 1;
        self.violation += score.violation();
        self.value += score.value();
        if score.violation() == 0.0 {
            self.feasible += 1;
            self.feasible_value += score.value();
        }
        if self
            .best
            .as_ref()
            .is_none_or(|best| score.beats(&best.score))
        {
            self.best = Some(Candidate {
                point: point.to_vec(),
                score,
            });
        }
    }
}
