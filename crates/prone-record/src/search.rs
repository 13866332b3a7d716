//! Runs of one solver on one problem, seed by seed, with a checkpoint that goes on as if nothing
//! had happened.
//!
//! Runs take turns, a generation each, so that one which is stopped early has all of them about as far
//! as each other; a generation is spread over the current rayon pool. A [`Search`] is its own
//! checkpoint: serialised between generations and read back, it ends in the same bytes as one that was
//! never interrupted, and one whose budget is raised in those of one that had it from the start.

use std::ops::ControlFlow;

use prone_optim::{
    Candidate, CovarianceMatrix, CovarianceMatrixOptions, DifferentialEvolution,
    DifferentialEvolutionOptions, Generation, Genetic, GeneticOptions, History, Run, Scorer,
    StopReason, Termination,
};
use serde::{Deserialize, Serialize};

/// Which solver searches, and from where.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Solver {
    /// The default.
    #[serde(rename = "differential-evolution")]
    DifferentialEvolution,
    /// CMA-ES: the independent check.
    #[serde(rename = "cma-es")]
    CovarianceMatrix,
    /// The published search, with MATLAB's defaults.
    #[serde(rename = "genetic")]
    Genetic,
    /// CMA-ES from about the middle of the bounds, where a good point is known: narrow first steps,
    /// and no larger populations, which would look far away.
    #[serde(rename = "cma-es, about the middle")]
    AboutTheMiddle,
}

impl Solver {
    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::DifferentialEvolution => "differential-evolution",
            Self::CovarianceMatrix => "cma-es",
            Self::Genetic => "genetic",
            Self::AboutTheMiddle => "cma-es, about the middle",
        }
    }
}

/// Runs with seeds that follow one another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Search {
    budget: u64,
    runs: Vec<SeededRun>,
}

/// One run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeededRun {
    /// Its seed.
    pub seed: u64,
    /// Every generation so far.
    pub history: History,
    state: State,
    stopped: Option<StopReason>,
}

/// A solver's run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum State {
    DifferentialEvolution(Run<DifferentialEvolution>),
    CovarianceMatrix(Run<CovarianceMatrix>),
    Genetic(Run<Genetic>),
}

/// Whether all runs came to their own end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SearchEnd {
    /// They did.
    Finished,
    /// The caller stopped it; it can go on.
    Interrupted,
}

/// A search cannot take evaluations back.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the earlier search has a budget of {earlier} evaluations a run; {budget} are fewer")]
pub struct SmallerBudget {
    /// What was asked for.
    pub budget: u64,
    /// What the search has.
    pub earlier: u64,
}

impl Search {
    /// `runs` runs of a solver with the seeds `seed`, `seed` + 1, …, of at most `budget`
    /// evaluations each. The genetic algorithm ends after its own number of generations as well.
    pub fn new(solver: Solver, seed: u64, runs: u64, budget: u64) -> Self {
        let begin = |seed| SeededRun {
            seed,
            history: History::default(),
            state: State::new(solver, seed),
            stopped: None,
        };
        Self {
            budget,
            runs: (0..runs).map(|k| begin(seed.wrapping_add(k))).collect(),
        }
    }

    /// Allows each run more evaluations: those that ended for want of them go on, to what a search
    /// with that budget from the start would have found.
    ///
    /// # Errors
    /// [`SmallerBudget`] where some have been done that would not be allowed.
    pub fn allow(&mut self, budget: u64) -> Result<(), SmallerBudget> {
        if budget < self.budget {
            return Err(SmallerBudget {
                budget,
                earlier: self.budget,
            });
        }
        if budget > self.budget {
            self.budget = budget;
            for run in &mut self.runs {
                run.stopped = run.stopped.filter(|why| *why != StopReason::Evaluations);
            }
        }
        Ok(())
    }

    /// Goes on until every run is at its end. `between` sees the search after each generation and
    /// may stop it; so does a scorer that leaves points without a result, and the generation is then
    /// done again later.
    pub fn proceed(
        &mut self,
        scorer: &dyn Scorer,
        mut between: impl FnMut(&Self) -> ControlFlow<()>,
    ) -> SearchEnd {
        let budget = self.budget;
        while let Some(run) = self.next_run() {
            let reason = run.advance(scorer, budget);
            let ended = self.runs.iter().all(|run| run.stopped.is_some());
            if reason == StopReason::Scorer || (between(self).is_break() && !ended) {
                return SearchEnd::Interrupted;
            }
        }
        SearchEnd::Finished
    }

    /// Of the runs that are not at their end, the one that has evaluated least; the first of equals.
    fn next_run(&mut self) -> Option<&mut SeededRun> {
        let open = self.runs.iter_mut().filter(|run| run.stopped.is_none());
        open.min_by_key(|run| run.evaluations())
    }

    /// The runs, in the order of their seeds.
    pub fn runs(&self) -> &[SeededRun] {
        &self.runs
    }

    /// Evaluations of all runs so far.
    pub fn evaluations(&self) -> u64 {
        self.runs.iter().map(SeededRun::evaluations).sum()
    }

    /// Evaluations that all runs may do.
    pub fn allowance(&self) -> u64 {
        self.budget.saturating_mul(self.runs.len() as u64)
    }

    /// The best point of all runs and the run that found it, the first of equals.
    pub fn best(&self) -> Option<(&SeededRun, &Candidate)> {
        let found = self
            .runs
            .iter()
            .filter_map(|run| run.best().map(|best| (run, best)));
        found.reduce(|best, next| {
            if next.1.score.beats(&best.1.score) {
                next
            } else {
                best
            }
        })
    }
}

impl SeededRun {
    /// One generation, and why the run paused after it or ended.
    fn advance(&mut self, scorer: &dyn Scorer, budget: u64) -> StopReason {
        let next = self.state.generation() + 1;
        let own_end = self.state.own_generations();
        let termination = Termination {
            generations: Some(own_end.map_or(next, |own| next.min(own))),
            ..Termination::after(budget)
        };
        let reason = self.state.proceed(scorer, &termination, &mut self.history);
        let goes_on = self.state.generation() == next && own_end.is_none_or(|own| next < own);
        let ended = !goes_on && reason != StopReason::Scorer;
        self.stopped = ended.then_some(reason);
        reason
    }

    /// The best point so far.
    pub fn best(&self) -> Option<&Candidate> {
        match &self.state {
            State::DifferentialEvolution(run) => run.best(),
            State::CovarianceMatrix(run) => run.best(),
            State::Genetic(run) => run.best(),
        }
    }

    /// Evaluations so far.
    pub fn evaluations(&self) -> u64 {
        self.history.0.last().map_or(0, |last| last.evaluations)
    }

    /// The last generation.
    pub fn last(&self) -> Option<&Generation> {
        self.history.0.last()
    }
}

impl State {
    fn new(solver: Solver, seed: u64) -> Self {
        match solver {
            Solver::DifferentialEvolution => {
                let options = DifferentialEvolutionOptions::default();
                Self::DifferentialEvolution(Run::new(DifferentialEvolution::new(options, seed)))
            }
            Solver::CovarianceMatrix => {
                let options = CovarianceMatrixOptions::default();
                Self::CovarianceMatrix(Run::new(CovarianceMatrix::new(options, seed)))
            }
            Solver::AboutTheMiddle => {
                let options = CovarianceMatrixOptions {
                    population: 16,
                    doublings: 0,
                    step: 0.12,
                    middle: 0.2,
                    ..CovarianceMatrixOptions::default()
                };
                Self::CovarianceMatrix(Run::new(CovarianceMatrix::new(options, seed)))
            }
            Solver::Genetic => {
                Self::Genetic(Run::new(Genetic::new(GeneticOptions::default(), seed)))
            }
        }
    }

    fn generation(&self) -> u64 {
        match self {
            Self::DifferentialEvolution(run) => run.generation(),
            Self::CovarianceMatrix(run) => run.generation(),
            Self::Genetic(run) => run.generation(),
        }
    }

    /// Generations after which the solver has nothing left to do.
    fn own_generations(&self) -> Option<u64> {
        matches!(self, Self::Genetic(_)).then(|| u64::from(GeneticOptions::default().generations))
    }

    fn proceed(
        &mut self,
        scorer: &dyn Scorer,
        termination: &Termination,
        history: &mut History,
    ) -> StopReason {
        match self {
            Self::DifferentialEvolution(run) => run.proceed(scorer, termination, history),
            Self::CovarianceMatrix(run) => run.proceed(scorer, termination, history),
            Self::Genetic(run) => run.proceed(scorer, termination, history),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use prone_optim::{Answer, Failure, Interval, Problem, Query, Score, Threads};

    use super::*;

    /// A bowl whose lowest point is not feasible.
    struct Bowl([Interval; 3]);

    impl Bowl {
        fn new() -> Self {
            Self([Interval::new(-2.0, 3.0).unwrap(); 3])
        }
    }

    impl Problem for Bowl {
        fn bounds(&self) -> &[Interval] {
            &self.0
        }

        fn evaluate(&self, point: &[f64]) -> Result<Score, Failure> {
            let value = point.iter().map(|x| x * x).sum();
            Ok(Score::new((1.0 - point[0]).max(0.0), value))
        }
    }

    fn finished(solver: Solver) -> Search {
        let mut search = Search::new(solver, 5, 2, 2000);
        let end = search.proceed(&Threads(Bowl::new()), |_| ControlFlow::Continue(()));
        assert_eq!(end, SearchEnd::Finished);
        search
    }

    #[test]
    fn an_interrupted_search_ends_like_an_uninterrupted_one() {
        for solver in [
            Solver::DifferentialEvolution,
            Solver::CovarianceMatrix,
            Solver::Genetic,
        ] {
            let whole = finished(solver);
            let mut parts = Search::new(solver, 5, 2, 2000);
            let mut steps = 0;
            loop {
                let end = parts.proceed(&Threads(Bowl::new()), |_| {
                    steps += 1;
                    if steps % 7 == 0 {
                        ControlFlow::Break(())
                    } else {
                        ControlFlow::Continue(())
                    }
                });
                let text = serde_json::to_string(&parts).unwrap();
                parts = serde_json::from_str(&text).unwrap();
                if end == SearchEnd::Finished {
                    break;
                }
            }
            assert_eq!(whole, parts, "{solver:?}");
            assert!(whole.evaluations() <= whole.allowance());
        }
    }

    #[test]
    fn a_budget_that_is_raised_later_is_as_good_as_one_from_the_start() {
        for solver in [
            Solver::DifferentialEvolution,
            Solver::CovarianceMatrix,
            Solver::Genetic,
        ] {
            let whole = finished(solver);
            let mut raised = Search::new(solver, 5, 2, 500);
            raised.proceed(&Threads(Bowl::new()), |_| ControlFlow::Continue(()));
            assert!(raised.evaluations() <= 1000);
            raised.allow(2000).unwrap();
            raised.proceed(&Threads(Bowl::new()), |_| ControlFlow::Continue(()));
            assert_eq!(whole, raised, "{solver:?}");
            let refused = raised.allow(1999).unwrap_err();
            assert_eq!((refused.budget, refused.earlier), (1999, 2000));
        }
    }

    #[test]
    fn runs_that_are_stopped_are_about_as_far_as_each_other() {
        let mut search = Search::new(Solver::DifferentialEvolution, 5, 3, 2000);
        let mut steps = 0;
        search.proceed(&Threads(Bowl::new()), |_| {
            steps += 1;
            if steps == 7 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        let generations = search.runs().iter().map(|run| run.history.0.len());
        assert_eq!(generations.collect::<Vec<_>>(), [3, 2, 2]);
    }

    #[test]
    fn the_best_of_all_runs_is_feasible_and_near_the_minimum() {
        let search = finished(Solver::DifferentialEvolution);
        let (run, best) = search.best().unwrap();
        assert!(best.score.violation() == 0.0);
        assert!((best.score.value() - 1.0).abs() < 1e-3, "{best:?}");
        assert!(run.seed == 5 || run.seed == 6);
        assert_eq!(run.last().unwrap().best, best.score);
    }

    /// A scorer that leaves the last point of every fifth batch without a result, as one does that is
    /// stopped at work.
    struct Stopped {
        bowl: Threads<Bowl>,
        batches: Cell<u64>,
    }

    impl Scorer for Stopped {
        fn bounds(&self) -> &[Interval] {
            self.bowl.bounds()
        }

        fn score(&self, batch: &[Query]) -> Vec<Answer> {
            let mut answers = self.bowl.score(batch);
            self.batches.set(self.batches.get() + 1);
            if self.batches.get().is_multiple_of(5) {
                answers.pop();
            }
            answers
        }
    }

    #[test]
    fn a_generation_that_is_cut_short_is_done_again() {
        for solver in [Solver::DifferentialEvolution, Solver::CovarianceMatrix] {
            let scorer = Stopped {
                bowl: Threads(Bowl::new()),
                batches: Cell::new(0),
            };
            let mut search = Search::new(solver, 5, 2, 2000);
            let mut stops = 0;
            while search.proceed(&scorer, |_| ControlFlow::Continue(())) == SearchEnd::Interrupted {
                stops += 1;
            }
            assert!(stops > 3, "{stops}");
            assert_eq!(search, finished(solver), "{solver:?}");
        }
    }

    #[test]
    fn the_genetic_algorithm_ends_after_its_own_generations() {
        let mut search = Search::new(Solver::Genetic, 1, 1, 1_000_000);
        search.proceed(&Threads(Bowl::new()), |_| ControlFlow::Continue(()));
        assert_eq!(search.runs()[0].history.0.len(), 80);
    }
}
