//! How points are proposed.

use crate::{Evaluator, NoScores};

/// A method of search, with all of its state: population, memories and random numbers.
///
/// The state is cloned before each generation and serialised with a checkpoint; what follows
/// depends on nothing else, so that a resumed run repeats an uninterrupted one.
pub trait Solver: Clone {
    /// Does one generation: proposes points, has them scored, learns from the scores.
    ///
    /// # Errors
    /// [`NoScores`], passed on from [`Evaluator::evaluate`]; the state is then discarded.
    fn advance(&mut self, evaluator: &mut Evaluator<'_>) -> Result<(), NoScores>;

    /// How often the search has begun anew.
    fn restarts(&self) -> u64 {
        0
    }
}
