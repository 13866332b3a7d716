use super::*;
use crate::{Run, Score, Termination};

struct Rosenbrock(Vec<Interval>);

impl Problem for Rosenbrock {
    fn bounds(&self) -> &[Interval] {
        &self.0
    }

    fn evaluate(&self, point: &[f64]) -> Score {
        let valley =
            |pair: &[f64]| 100.0 * (pair[1] - pair[0] * pair[0]).powi(2) + (1.0 - pair[0]).powi(2);
        Score::feasible(point.windows(2).map(valley).sum())
    }
}

#[test]
fn reference_follows_the_bent_valley() {
    let problem = Rosenbrock(vec![Interval::new(-2.0, 2.0).unwrap(); 4]);
    let mut run = Run::new(CovarianceMatrix::new(CovarianceMatrixOptions::default(), 3));
    run.proceed(&problem, &Termination::after(30_000), &mut ());
    assert!(
        run.best().unwrap().score.value() < 1e-10,
        "{:?}",
        run.best()
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
