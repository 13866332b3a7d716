//! One solver on one problem, generation by generation.

use serde::{Deserialize, Serialize};

use crate::evaluator::Tally;
use crate::{Candidate, Evaluator, Generation, NoScores, Observer, Score, Scorer, Solver};

/// When to stop.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Termination {
    /// Most evaluations of the whole run, before and after any interruption. A generation that
    /// would pass it is not begun.
    pub evaluations: u64,
    /// Most generations of the whole run.
    pub generations: Option<u64>,
    /// A score that is good enough.
    pub target: Option<Score>,
}

impl Termination {
    /// After a number of evaluations.
    pub const fn after(evaluations: u64) -> Self {
        Self {
            evaluations,
            generations: None,
            target: None,
        }
    }
}

/// Why a run stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum StopReason {
    /// The next generation would pass the evaluation budget.
    Evaluations,
    /// The number of generations is reached.
    Generations,
    /// The target is reached.
    Target,
    /// The observer said so.
    Observer,
    /// The scorer was stopped within a generation, which is given up; the run can go on.
    Scorer,
}

/// A run and its own checkpoint: serialise it, read it back, go on.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Run<S> {
    solver: S,
    generation: u64,
    evaluations: u64,
    best: Option<Candidate>,
}

impl<S: Solver> Run<S> {
    /// A run that has not begun.
    pub const fn new(solver: S) -> Self {
        Self {
            solver,
            generation: 0,
            evaluations: 0,
            best: None,
        }
    }

    /// Goes on until the termination or the observer ends it.
    pub fn proceed(
        &mut self,
        scorer: &dyn Scorer,
        termination: &Termination,
        observer: &mut impl Observer,
    ) -> StopReason {
        loop {
            if let Some(reason) = self.finished(termination) {
                return reason;
            }
            let allowance = termination.evaluations.saturating_sub(self.evaluations);
            let mut evaluator = Evaluator::new(scorer, allowance);
            let mut solver = self.solver.clone();
            match solver.advance(&mut evaluator) {
                Ok(()) => {}
                Err(NoScores::BudgetSpent) => return StopReason::Evaluations,
                Err(NoScores::CutShort) => return StopReason::Scorer,
            }
            self.solver = solver;
            let Some(record) = self.record(evaluator.tally) else {
                // A solver that asks for nothing will never end by itself.
                return StopReason::Evaluations;
            };
            if observer.observe(&record).is_break() {
                return StopReason::Observer;
            }
        }
    }

    /// The solver, as the last generation left it.
    pub const fn solver(&self) -> &S {
        &self.solver
    }

    /// The best point so far.
    pub const fn best(&self) -> Option<&Candidate> {
        self.best.as_ref()
    }

    /// Evaluations so far.
    pub const fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Generations so far.
    pub const fn generation(&self) -> u64 {
        self.generation
    }

    fn finished(&self, termination: &Termination) -> Option<StopReason> {
        let reached = |target: Score| {
            let best = self.best.as_ref();
            best.is_some_and(|best| !target.beats(&best.score))
        };
        if termination.target.is_some_and(reached) {
            Some(StopReason::Target)
        } else if termination
            .generations
            .is_some_and(|most| self.generation >= most)
        {
            Some(StopReason::Generations)
        } else {
            None
        }
    }

    fn record(&mut self, tally: Tally) -> Option<Generation> {
        let candidate = tally.best?;
        let generation_best = candidate.score;
        self.generation += 1;
        self.evaluations += tally.evaluations;
        let best = match self.best.take() {
            Some(best) if !generation_best.beats(&best.score) => best,
            _ => candidate,
        };
        let record = Generation {
            generation: self.generation,
            evaluations: self.evaluations,
            best: best.score,
            generation_best,
            mean_violation: tally.violation / tally.evaluations as f64,
            mean_value: tally.value / tally.evaluations as f64,
            feasible: tally.feasible,
            mean_feasible_value: tally.feasible_value / tally.feasible.max(1) as f64,
            restarts: self.solver.restarts(),
        };
        self.best = Some(best);
        Some(record)
    }
}

#[cfg(test)]
mod tests;
