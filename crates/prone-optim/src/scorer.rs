//! Who scores points: the seam between a solver and whatever does the work, threads of this process
//! today, other machines tomorrow.
//!
//! A solver hands over a batch of points, each with an id, and gets results by id, in whatever order
//! they are done. Nothing that a solver computes depends on that order: the [`Evaluator`] puts
//! results back into the order of the points before it adds anything up.
//!
//! [`Evaluator`]: crate::Evaluator

use std::collections::BTreeMap;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::{Failure, Interval, Problem, Score};

/// Which point of a batch a result belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct QueryId(pub u64);

/// A point whose score is asked for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Query {
    /// Unique within its batch.
    pub id: QueryId,
    /// The point.
    pub point: Vec<f64>,
}

/// A result and the point that it belongs to.
pub type Answer = (QueryId, Result<Score, Failure>);

/// Scores points, a batch at a time.
pub trait Scorer {
    /// Limits of each variable; points outside are never asked for.
    fn bounds(&self) -> &[Interval];

    /// A point that is known to be good, where there is one: a search about it scores it first.
    fn known(&self) -> Option<&[f64]> {
        None
    }

    /// A result for each point, in any order. A result that is missing means that the work was cut
    /// short: the generation is given up, and the run can go on from the one before.
    fn score(&self, batch: &[Query]) -> Vec<Answer>;
}

/// Scores the points of a problem on the current rayon pool.
#[derive(Debug, Clone, Copy)]
pub struct Threads<P>(pub P);

impl<P: Problem> Scorer for Threads<P> {
    fn bounds(&self) -> &[Interval] {
        self.0.bounds()
    }

    fn score(&self, batch: &[Query]) -> Vec<Answer> {
        let answer = |query: &Query| (query.id, self.0.evaluate(&query.point));
        match batch {
            // Not worth another thread's attention.
            [query] => vec![answer(query)],
            _ => batch.par_iter().map(answer).collect(),
        }
    }
}

/// Scores in the order of the batch; `None` where one is missing. What nobody asked for is ignored,
/// and of two results for one point the first counts.
pub(crate) fn in_order(batch: &[Query], answers: Vec<Answer>) -> Option<Vec<Score>> {
    let mut by_id = BTreeMap::new();
    for (id, result) in answers {
        by_id.entry(id).or_insert(result);
    }
    let scores = batch.iter().map(|query| {
        let result = by_id.remove(&query.id)?;
        Some(result.unwrap_or(Score::WORST))
    });
    scores.collect()
}
