use std::ops::ControlFlow;

use proptest::prelude::*;

use crate::{
    Answer, CovarianceMatrix, CovarianceMatrixOptions, DifferentialEvolution,
    DifferentialEvolutionOptions, Failure, Generation, Genetic, GeneticOptions, History, Interval,
    Observer, Problem, Query, QueryId, Run, Score, Scorer, Solver, StopReason, Termination,
    Threads,
};

/// Ends the run after four generations.
#[derive(Default)]
struct Four(Vec<Generation>);

impl Observer for Four {
    fn observe(&mut self, generation: &Generation) -> ControlFlow<()> {
        self.0.push(*generation);
        if self.0.len() < 4 {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    }
}

/// The disc of radius 1 about the origin is forbidden; the value is the distance from (½, ½, …),
/// with ripples.
struct Ripples(Vec<Interval>);

impl Ripples {
    fn new() -> Self {
        Self(vec![Interval::new(-3.0, 3.0).unwrap(); 4])
    }
}

impl Problem for Ripples {
    fn bounds(&self) -> &[Interval] {
        &self.0
    }

    fn evaluate(&self, point: &[f64]) -> Result<Score, Failure> {
        assert!(
            point.iter().all(|x| (-3.0..=3.0).contains(x)),
            "{point:?} is out of bounds"
        );
        let radius: f64 = point.iter().map(|x| x * x).sum::<f64>().sqrt();
        let value = point
            .iter()
            .map(|x| (x - 0.5).powi(2) - 0.1 * (20.0 * x).cos())
            .sum();
        Ok(Score::new((1.0 - radius).max(0.0), value))
    }
}

/// Everything a result consists of, as text: equal text, equal bytes.
fn result<S: Solver + serde::Serialize>(run: &Run<S>, history: &History) -> String {
    serde_json::to_string(&(run, history)).unwrap()
}

fn interrupted_equals_whole<S>(solver: S, pieces: &[u64])
where
    S: Solver + serde::Serialize + serde::de::DeserializeOwned,
{
    let problem = Ripples::new();
    let (mut whole, mut whole_history) = (Run::new(solver.clone()), History::default());
    whole.proceed(
        &Threads(&problem),
        &Termination::after(6000),
        &mut whole_history,
    );

    let (mut run, mut history) = (Run::new(solver), History::default());
    for &generations in pieces {
        let piece = Termination {
            generations: Some(generations),
            ..Termination::after(6000)
        };
        run.proceed(&Threads(&problem), &piece, &mut history);
        run = serde_json::from_str(&serde_json::to_string(&run).unwrap()).unwrap();
    }
    run.proceed(&Threads(&problem), &Termination::after(6000), &mut history);
    assert_eq!(result(&run, &history), result(&whole, &whole_history));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]
    #[test]
    fn identity_a_resumed_run_equals_an_uninterrupted_one(seed: u64, first in 1..30_u64, more in 1..30_u64) {
        let pieces = [first, first + more];
        interrupted_equals_whole(DifferentialEvolution::new(DifferentialEvolutionOptions::default(), seed), &pieces);
        interrupted_equals_whole(Genetic::new(GeneticOptions::default(), seed), &pieces);
        interrupted_equals_whole(CovarianceMatrix::new(CovarianceMatrixOptions::default(), seed), &pieces);
    }
}

#[test]
fn identity_any_number_of_threads_gives_the_same_bytes() {
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut run = Run::new(DifferentialEvolution::new(
                DifferentialEvolutionOptions::default(),
                11,
            ));
            let mut history = History::default();
            run.proceed(
                &Threads(Ripples::new()),
                &Termination::after(5000),
                &mut history,
            );
            result(&run, &history)
        })
    };
    let one = with(1);
    assert_eq!(one, with(2));
    assert_eq!(one, with(5));
}

/// Answers last point first, some of them twice, and for a point that nobody asked for.
struct Backwards(Threads<Ripples>);

impl Scorer for Backwards {
    fn bounds(&self) -> &[Interval] {
        self.0.bounds()
    }

    fn score(&self, batch: &[Query]) -> Vec<Answer> {
        let mut answers = self.0.score(batch);
        answers.reverse();
        let again = (answers[0].0, Ok(Score::feasible(-1e9)));
        answers.push(again);
        answers.push((QueryId(u64::MAX), Ok(Score::feasible(-1e9))));
        answers
    }
}

#[test]
fn identity_any_order_of_answers_gives_the_same_bytes() {
    fn compared<S: Solver + serde::Serialize>(solver: &S) {
        let with = |scorer: &dyn Scorer| {
            let mut run = Run::new(solver.clone());
            let mut history = History::default();
            run.proceed(scorer, &Termination::after(5000), &mut history);
            result(&run, &history)
        };
        let straight = with(&Threads(Ripples::new()));
        assert_eq!(straight, with(&Backwards(Threads(Ripples::new()))));
    }
    compared(&DifferentialEvolution::new(
        DifferentialEvolutionOptions::default(),
        3,
    ));
    compared(&CovarianceMatrix::new(
        CovarianceMatrixOptions::default(),
        3,
    ));
    compared(&Genetic::new(GeneticOptions::default(), 3));
}

/// Has no score where the first number is negative.
struct HalfUnknown(Ripples);

impl Problem for HalfUnknown {
    fn bounds(&self) -> &[Interval] {
        self.0.bounds()
    }

    fn evaluate(&self, point: &[f64]) -> Result<Score, Failure> {
        if point[0] < 0.0 {
            let reason = "it is negative".to_owned();
            return Err(Failure { reason });
        }
        self.0.evaluate(point)
    }
}

#[test]
fn a_point_without_a_score_is_the_worst_and_the_run_goes_on() {
    let mut run = Run::new(DifferentialEvolution::new(
        DifferentialEvolutionOptions::default(),
        1,
    ));
    let mut history = History::default();
    let problem = HalfUnknown(Ripples::new());
    run.proceed(&Threads(&problem), &Termination::after(6000), &mut history);
    let best = run.best().unwrap();
    assert!(best.point[0] >= 0.0 && best.score.violation() == 0.0);
    assert!(history.0[0].mean_violation > 1e300);
}

#[test]
fn limit_the_budget_is_never_passed() {
    let passes = |evaluations: u64, budget: u64| assert!(evaluations <= budget, "{evaluations}");
    for budget in [0, 1, 29, 30, 31, 1000] {
        let termination = Termination::after(budget);
        let mut run = Run::new(DifferentialEvolution::new(
            DifferentialEvolutionOptions::default(),
            1,
        ));
        assert_eq!(
            run.proceed(&Threads(Ripples::new()), &termination, &mut ()),
            StopReason::Evaluations
        );
        passes(run.evaluations(), budget);
        assert_eq!(run.best().is_some(), budget >= 30);
        let mut run = Run::new(CovarianceMatrix::new(CovarianceMatrixOptions::default(), 1));
        run.proceed(&Threads(Ripples::new()), &termination, &mut ());
        passes(run.evaluations(), budget);
        let mut run = Run::new(Genetic::new(GeneticOptions::default(), 1));
        run.proceed(&Threads(Ripples::new()), &termination, &mut ());
        passes(run.evaluations(), budget);
    }
}

#[test]
fn limit_targets_generations_and_observers_end_a_run() {
    let problem = Ripples::new();
    let new = || {
        Run::new(DifferentialEvolution::new(
            DifferentialEvolutionOptions::default(),
            5,
        ))
    };
    let any = Termination {
        target: Some(Score::new(1.0, 1e9)),
        ..Termination::after(1000)
    };
    assert_eq!(
        new().proceed(&Threads(&problem), &any, &mut ()),
        StopReason::Target
    );

    let mut run = new();
    let three = Termination {
        generations: Some(3),
        ..Termination::after(1000)
    };
    assert_eq!(
        run.proceed(&Threads(&problem), &three, &mut ()),
        StopReason::Generations
    );
    assert_eq!(run.generation(), 3);

    let mut observer = Four::default();
    let mut run = new();
    assert_eq!(
        run.proceed(&Threads(&problem), &Termination::after(1000), &mut observer),
        StopReason::Observer
    );
    assert_eq!(observer.0.len(), 4);
}

/// The history's best never worsens, its means lie between best and worst, its counts add up.
#[test]
fn identity_history_tells_the_run() {
    let mut run = Run::new(Genetic::new(GeneticOptions::default(), 2));
    let mut history = History::default();
    run.proceed(
        &Threads(Ripples::new()),
        &Termination::after(4000),
        &mut history,
    );
    let records = &history.0;
    assert_eq!(records[0].evaluations, 200);
    assert_eq!(records[1].evaluations, 390);
    assert!(
        records
            .windows(2)
            .all(|pair| !pair[0].best.beats(&pair[1].best))
    );
    assert!(
        records
            .iter()
            .all(|r| r.mean_violation >= r.generation_best.violation())
    );
    assert_eq!(
        records.last().map(|r| r.best),
        run.best().map(|best| best.score)
    );
    let mut nothing = ();
    assert!(nothing.observe(&records[0]).is_continue());
}
