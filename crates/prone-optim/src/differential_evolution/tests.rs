use super::*;
use crate::{Failure, Problem, Run, Termination, Threads};

/// Rastrigin's function in five variables: 11⁵ local minima, the least at 0.3.
struct Rastrigin(Vec<Interval>);

impl Problem for Rastrigin {
    fn bounds(&self) -> &[Interval] {
        &self.0
    }

    fn evaluate(&self, point: &[f64]) -> Result<Score, Failure> {
        let ripple = |x: f64| x * x + 10.0 * (1.0 - (std::f64::consts::TAU * x).cos());
        Ok(Score::feasible(point.iter().map(|x| ripple(x - 0.3)).sum()))
    }
}

#[test]
fn reference_finds_the_least_of_many_minima() {
    let problem = Rastrigin(vec![Interval::new(-5.12, 5.12).unwrap(); 5]);
    for seed in 0..5 {
        let mut run = Run::new(DifferentialEvolution::new(
            DifferentialEvolutionOptions::default(),
            seed,
        ));
        run.proceed(&Threads(&problem), &Termination::after(30_000), &mut ());
        let best = run.best().unwrap();
        assert!(best.score.value() < 1e-9, "seed {seed}: {best:?}");
    }
}

#[test]
fn identity_surrender_buys_more_beginnings() {
    let problem = Rastrigin(vec![Interval::new(-5.12, 5.12).unwrap(); 5]);
    let restarts = |surrender| {
        let options = DifferentialEvolutionOptions {
            population: 10,
            surrender,
            ..DifferentialEvolutionOptions::default()
        };
        let mut run = Run::new(DifferentialEvolution::new(options, 8));
        run.proceed(&Threads(&problem), &Termination::after(50_000), &mut ());
        run.solver().restarts()
    };
    let (never, usual, at_once) = (restarts(0.0), restarts(2.0), restarts(1e6));
    assert!(
        never < usual && usual < at_once,
        "{never}, {usual}, {at_once}"
    );
}

/// Feasible only on a ball of radius 0.05 in a cube of width 4; inside, less is better upwards.
struct Needle(Vec<Interval>);

impl Problem for Needle {
    fn bounds(&self) -> &[Interval] {
        &self.0
    }

    fn evaluate(&self, point: &[f64]) -> Result<Score, Failure> {
        let distance = point.iter().map(|x| (x - 1.0).powi(2)).sum::<f64>().sqrt();
        Ok(Score::new((distance - 0.05).max(0.0), -point[0]))
    }
}

#[test]
fn limit_a_narrow_feasible_set_is_found_and_used() {
    let problem = Needle(vec![Interval::new(-2.0, 2.0).unwrap(); 4]);
    let mut run = Run::new(DifferentialEvolution::new(
        DifferentialEvolutionOptions::default(),
        9,
    ));
    run.proceed(&Threads(&problem), &Termination::after(20_000), &mut ());
    let best = run.best().unwrap();
    assert!(
        best.score.violation() == 0.0 && best.score.value() < -1.0499,
        "{best:?}"
    );
}

#[test]
fn identity_a_flat_problem_begins_anew_and_ends() {
    struct Flat(Vec<Interval>);
    impl Problem for Flat {
        fn bounds(&self) -> &[Interval] {
            &self.0
        }
        fn evaluate(&self, _: &[f64]) -> Result<Score, Failure> {
            Ok(Score::feasible(1.0))
        }
    }
    let problem = Flat(vec![Interval::new(0.0, 1.0).unwrap()]);
    let mut run = Run::new(DifferentialEvolution::new(
        DifferentialEvolutionOptions::default(),
        0,
    ));
    run.proceed(&Threads(&problem), &Termination::after(10_000), &mut ());
    assert!(run.solver().restarts() > 1);
}
