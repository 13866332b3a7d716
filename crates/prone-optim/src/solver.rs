//! How points are proposed.

use crate::{BudgetSpent, Evaluator, Problem};

/// A method of search, with all of its state: population, memories and random numbers.
///
/// The state is cloned before each generation and serialised with a checkpoint; what follows
/// depends on nothing else, so that a resumed run repeats an uninterrupted one.
pub trait Solver: Clone {
    /// Does one generation: proposes points, has them scored, learns from the scores.
    ///
    /// # Errors
    /// [`BudgetSpent`], passed on from [`Evaluator::evaluate`]; the state is then discarded.
    fn advance<P: Problem>(&mut self, evaluator: &mut Evaluator<'_, P>) -> Result<(), BudgetSpent>;

    /// How often the search has begun anew.
    fn restarts(&self) -> u64 {
        0
    }
}
