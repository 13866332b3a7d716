use super::*;
use crate::{Failure, Problem, Run, Score, Termination, Threads};

struct Sphere(Vec<Interval>);

impl Problem for Sphere {
    fn bounds(&self) -> &[Interval] {
        &self.0
    }

    fn evaluate(&self, point: &[f64]) -> Result<Score, Failure> {
        Ok(Score::feasible(point.iter().map(|x| x * x).sum()))
    }
}

#[test]
fn limit_a_bowl_is_descended() {
    let problem = Sphere(vec![Interval::new(-2.0, 2.0).unwrap(); 6]);
    let mut run = Run::new(Genetic::new(GeneticOptions::default(), 4));
    run.proceed(&Threads(&problem), &Termination::after(16_000), &mut ());
    assert!(run.best().unwrap().score.value() < 0.05, "{:?}", run.best());
}

/// Stochastic uniform selection takes each rank its expectation, rounded down or up.
#[test]
fn identity_selection_keeps_to_the_expectations() {
    let mut genetic = Genetic::new(GeneticOptions::default(), 1);
    let score = Score::feasible(0.0);
    genetic.population = vec![
        Candidate {
            point: vec![0.0],
            score
        };
        20
    ];
    let parents = genetic.parents(50);
    let total: f64 = (1..=20).map(|r| 1.0 / f64::from(r).sqrt()).sum();
    for rank in 0..20 {
        let taken = parents.iter().filter(|&&parent| parent == rank).count() as f64;
        let expected = 50.0 / ((rank + 1) as f64).sqrt() / total;
        assert!(
            (taken - expected).abs() < 1.0,
            "rank {rank}: {taken}, not {expected}"
        );
    }
}
