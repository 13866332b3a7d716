//! The one door through which a solver asks for scores: counts, remembers the best, and puts the
//! results of a [`Scorer`] into the order of the points.

use crate::scorer::in_order;
use crate::{Candidate, Interval, Query, QueryId, Scorer};

/// Why a generation has no scores; the solver's state is then discarded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum NoScores {
    /// More evaluations were asked for than the budget has left; none was done.
    #[error("the evaluation budget is spent")]
    BudgetSpent,
    /// The scorer did not answer for every point.
    #[error("the scorer was stopped before every point had a result")]
    CutShort,
}

/// Scores points of one generation.
pub struct Evaluator<'p> {
    scorer: &'p dyn Scorer,
    allowance: u64,
    pub(crate) tally: Tally,
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

impl<'p> Evaluator<'p> {
    pub(crate) fn new(scorer: &'p dyn Scorer, allowance: u64) -> Self {
        Self {
            scorer,
            allowance,
            tally: Tally::default(),
        }
    }

    /// Limits of each variable.
    pub fn bounds(&self) -> &'p [Interval] {
        self.scorer.bounds()
    }

    /// A point that is known to be good, where there is one.
    pub fn known(&self) -> Option<&[f64]> {
        self.scorer.known()
    }

    /// Scores points, in order.
    ///
    /// # Errors
    /// [`NoScores`] where fewer evaluations are left than points, and none is scored then, or where
    /// the scorer was stopped.
    pub fn evaluate(&mut self, points: Vec<Vec<f64>>) -> Result<Vec<Candidate>, NoScores> {
        if points.len() as u64 > self.allowance - self.tally.evaluations {
            return Err(NoScores::BudgetSpent);
        }
        let query = |(id, point)| Query {
            id: QueryId(id),
            point,
        };
        let batch: Vec<Query> = (0..).zip(points).map(query).collect();
        let scores = in_order(&batch, self.scorer.score(&batch)).ok_or(NoScores::CutShort)?;
        let points = batch.into_iter().map(|query| query.point);
        let scored = points.zip(scores);
        let candidates = scored.map(|(point, score)| Candidate { point, score });
        Ok(candidates
            .inspect(|candidate| self.tally.count(candidate))
            .collect())
    }
}

impl Tally {
    fn count(&mut self, candidate: &Candidate) {
        let score = candidate.score;
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
            self.best = Some(candidate.clone());
        }
    }
}
