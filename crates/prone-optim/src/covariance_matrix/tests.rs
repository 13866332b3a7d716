use super::*;
use crate::{Failure, Problem, Run, Score, Termination, Threads};

struct Rosenbrock(Vec<Interval>);

impl Problem for Rosenbrock {
    fn bounds(&self) -> &[Interval] {
        &self.0
    }

    fn evaluate(&self, point: &[f64]) -> Result<Score, Failure> {
        let valley =
            |pair: &[f64]| 100.0 * (pair[1] - pair[0] * pair[0]).powi(2) + (1.0 - pair[0]).powi(2);
        Ok(Score::feasible(point.windows(2).map(valley).sum()))
    }
}

#[test]
fn reference_follows_the_bent_valley() {
    let problem = Rosenbrock(vec![Interval::new(-2.0, 2.0).unwrap(); 4]);
    let mut run = Run::new(CovarianceMatrix::new(CovarianceMatrixOptions::default(), 3));
    run.proceed(&Threads(&problem), &Termination::after(30_000), &mut ());
    assert!(
        run.best().unwrap().score.value() < 1e-10,
        "{:?}",
        run.best()
    );
}

/// A search asked generation by generation visits what the crate visits when it runs by itself.
#[test]
fn reference_asks_for_what_the_crate_asks_for() {
    let problem = Rosenbrock(vec![Interval::new(-2.0, 2.0).unwrap(); 3]);
    let mut solver = CovarianceMatrix::new(CovarianceMatrixOptions::default(), 7);
    let search = solver.begin(3);
    let place = |shares: &[f64]| -> Vec<f64> {
        let bounds = problem.bounds().iter();
        bounds.zip(shares).map(|(b, s)| b.at(fold(*s))).collect()
    };
    let visited = RefCell::new(Vec::new());
    let objective = |shares: &DVector<f64>| {
        visited.borrow_mut().push(shares.as_slice().to_vec());
        problem.evaluate(&place(shares.as_slice())).unwrap().value()
    };
    let mut alone = CMAESOptions::new(search.mean.clone(), search.step)
        .population_size(search.population)
        .seed(search.seed)
        .build(objective)
        .unwrap();
    alone.run();
    drop(alone);
    let visited = visited.into_inner();

    let mut asked = search;
    let mut points = Vec::new();
    while let Some(generation) = asked.ask().unwrap() {
        for shares in &generation {
            asked
                .told
                .push(problem.evaluate(&place(shares)).unwrap().value());
        }
        points.extend(generation);
    }
    assert!(points.len() > 100);
    assert_eq!(points, visited);
}

/// A generation is a generation of the crate, so that budgets, checkpoints and records are as fine.
#[test]
fn a_generation_is_one_population() {
    let problem = Rosenbrock(vec![Interval::new(-2.0, 2.0).unwrap(); 4]);
    let mut run = Run::new(CovarianceMatrix::new(CovarianceMatrixOptions::default(), 3));
    let mut history = crate::History::default();
    run.proceed(&Threads(&problem), &Termination::after(250), &mut history);
    let evaluations: Vec<_> = history.0.iter().map(|g| g.evaluations).collect();
    assert_eq!(evaluations, (1..=20).map(|k| 12 * k).collect::<Vec<_>>());
}

/// A valley with a point of it that is known.
struct Known(Rosenbrock, Vec<f64>);

impl crate::Scorer for Known {
    fn bounds(&self) -> &[Interval] {
        self.0.bounds()
    }

    fn known(&self) -> Option<&[f64]> {
        Some(&self.1)
    }

    fn score(&self, batch: &[crate::Query]) -> Vec<crate::Answer> {
        Threads(&self.0).score(batch)
    }
}

/// Where a good point is known, nothing worse is found, however short the search.
#[test]
fn a_point_that_is_known_to_be_good_is_scored_first() {
    let problem = Rosenbrock(vec![Interval::new(-2.0, 1.5).unwrap(); 4]);
    let known = Known(problem, vec![1.0; 4]);
    let mut run = Run::new(CovarianceMatrix::new(CovarianceMatrixOptions::default(), 3));
    let mut history = crate::History::default();
    run.proceed(&known, &Termination::after(1), &mut history);
    assert_eq!(run.best().unwrap().point, vec![1.0; 4]);
    run.proceed(&known, &Termination::after(30), &mut history);
    let evaluations: Vec<_> = history.0.iter().map(|g| g.evaluations).collect();
    assert_eq!(evaluations, [1, 13, 25]);
    assert_eq!(run.best().unwrap().point, vec![1.0; 4]);
}

#[test]
fn nothing_to_search_is_no_endless_search() {
    let mut run = Run::new(CovarianceMatrix::new(CovarianceMatrixOptions::default(), 3));
    let reason = run.proceed(
        &Threads(Rosenbrock(Vec::new())),
        &Termination::after(100),
        &mut (),
    );
    assert_eq!(
        (reason, run.evaluations()),
        (crate::StopReason::Evaluations, 0)
    );
}

#[test]
fn identity_folding_keeps_the_inside_and_mirrors_the_outside() {
    for (share, folded) in [
        (0.0, 0.0),
        (0.3, 0.3),
        (1.0, 1.0),
        (1.2, 0.8),
        (-0.2, 0.2),
        (2.1, 0.1),
    ] {
        assert!((fold(share) - folded).abs() < 1e-12, "{share}");
    }
}
