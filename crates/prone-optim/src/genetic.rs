//! A genetic algorithm with the defaults of MATLAB's `ga`: the replication of the published
//! search, not a recommendation.
//!
//! Defaults for more than five variables (Global Optimization Toolbox, "Genetic Algorithm
//! Options"): population 200, uniform over the bounds; rank scaling; stochastic uniform
//! selection; 5 % elite; of the rest 80 % by scattered crossover, 20 % by Gaussian mutation.
//!
//! ```text
//! expectation of rank r ∝ 1/√r                                                    (1)
//! child_j = either parent's gene, by a fair coin                  scattered        (2)
//! child = parent + σ_k w N(0, 1),   σ_k = σ_{k−1} (1 − shrink k / generations)     (3)
//! ```
//!
//! with w the width of the bounds and `σ_0` = 1. Where bounds or linear constraints are given,
//! MATLAB takes a mutation (`mutationadaptfeasible`) whose steps its manual does not state;
//! here a mutant is clamped to the bounds, and any further constraint is a violation.

use serde::{Deserialize, Serialize};

use crate::{Candidate, Evaluator, Interval, NoScores, Random, Solver};

/// Parameters of the genetic algorithm.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct GeneticOptions {
    /// Individuals; at least 2.
    pub population: usize,
    /// Generations over which the mutation shrinks.
    pub generations: u32,
    /// Share of the population that survives unchanged, 0 to 1.
    pub elite_share: f64,
    /// Share of the children made by crossover, 0 to 1.
    pub crossover_share: f64,
    /// Standard deviation of the first mutations, widths of the bounds.
    pub scale: f64,
    /// How much of it is gone after all generations, 0 to 1.
    pub shrink: f64,
}

impl Default for GeneticOptions {
    fn default() -> Self {
        Self {
            population: 200,
            generations: 80,
            elite_share: 0.05,
            crossover_share: 0.8,
            scale: 1.0,
            shrink: 1.0,
        }
    }
}

/// The solver and its state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Genetic {
    options: GeneticOptions,
    random: Random,
    /// Best first.
    population: Vec<Candidate>,
    /// `σ_k`.
    deviation: f64,
    /// k.
    generation: u32,
}

impl Genetic {
    /// A search that has not begun.
    pub fn new(options: GeneticOptions, seed: u64) -> Self {
        Self {
            options,
            random: Random::new(seed),
            population: Vec::new(),
            deviation: options.scale,
            generation: 0,
        }
    }

    /// `count` parents by equation (1): one line of equal steps through the expectations laid
    /// end to end, from one random start; then shuffled.
    fn parents(&mut self, count: usize) -> Vec<usize> {
        let expectation = |rank: usize| 1.0 / ((rank + 1) as f64).sqrt();
        let total: f64 = (0..self.population.len()).map(expectation).sum();
        let step = total / count as f64;
        let (mut at, mut rank, mut end) = (self.random.uniform() * step, 0, expectation(0));
        let mut parents = Vec::with_capacity(count);
        for _ in 0..count {
            while at >= end && rank + 1 < self.population.len() {
                rank += 1;
                end += expectation(rank);
            }
            parents.push(rank);
            at += step;
        }
        self.random.shuffle(&mut parents);
        parents
    }

    /// Equation (2).
    fn cross(&mut self, first: usize, second: usize) -> Vec<f64> {
        let genes = self.population[first]
            .point
            .iter()
            .zip(&self.population[second].point);
        let random = &mut self.random;
        genes
            .map(|(&a, &b)| if random.uniform() < 0.5 { a } else { b })
            .collect()
    }

    /// Equation (3).
    fn mutate(&mut self, parent: usize, bounds: &[Interval]) -> Vec<f64> {
        let genes = self.population[parent].point.iter().zip(bounds);
        let (random, deviation) = (&mut self.random, self.deviation);
        genes
            .map(|(&gene, interval)| {
                interval.clamp(gene + deviation * interval.width() * random.normal())
            })
            .collect()
    }

    /// The next generation's points but for the elite, which alone is kept of this one.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of the population is below its number"
    )]
    fn children(&mut self, bounds: &[Interval]) -> Vec<Vec<f64>> {
        let count = self.population.len();
        let elite = (self.options.elite_share.clamp(0.0, 1.0) * count as f64).ceil() as usize;
        let elite = elite.min(count - 1);
        let children = count - elite;
        let crossed =
            (self.options.crossover_share.clamp(0.0, 1.0) * children as f64).round() as usize;
        let parents = self.parents(crossed + children);
        let (couples, mutants) = parents.split_at(2 * crossed);
        let mut points: Vec<_> = couples
            .chunks_exact(2)
            .map(|couple| self.cross(couple[0], couple[1]))
            .collect();
        points.extend(mutants.iter().map(|&parent| self.mutate(parent, bounds)));
        self.population.truncate(elite);
        points
    }
}

impl Solver for Genetic {
    fn advance(&mut self, evaluator: &mut Evaluator<'_>) -> Result<(), NoScores> {
        let bounds = evaluator.bounds();
        let points = if self.population.is_empty() {
            let population = 0..self.options.population.max(2);
            population.map(|_| self.random.point(bounds)).collect()
        } else {
            self.generation += 1;
            let share = f64::from(self.generation) / f64::from(self.options.generations.max(1));
            self.deviation *= (1.0 - self.options.shrink * share).max(0.0);
            self.children(bounds)
        };
        self.population.extend(evaluator.evaluate(points)?);
        self.population.sort_by(|a, b| a.score.order(&b.score));
        Ok(())
    }
}

#[cfg(test)]
mod tests;
