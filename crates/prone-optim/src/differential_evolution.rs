//! Differential evolution that adapts its own parameters and begins anew when it stands still.
//!
//! JADE's mutation and archive (Zhang and Sanderson 2009) with the success history of SHADE
//! (Tanabe and Fukunaga 2013). For each member `x_i`, with `x_p` one of the best share p of the
//! population, `x_r` a member and `x_a` a member or an archived parent, all different:
//!
//! ```text
//! v = x_i + F (x_p − x_i) + F (x_r − x_a)          current-to-pbest/1            (1)
//! u_j = v_j with chance CR and for one j always, else x_ij          binomial      (2)
//! F ~ Cauchy(M_F, 0.1) in (0, 1],   CR ~ N(M_CR, 0.1) in [0, 1]                  (3)
//! ```
//!
//! `M_F` and `M_CR` are drawn from a ring of memories; after each generation one memory takes the
//! Lehmer mean of the F and the mean of the CR that made better children. Children compete with
//! their parents by [`Score`]: violation, then value. A component of v beyond a
//! bound becomes the midpoint of parent and bound.
//!
//! The population begins anew, its memories with it, when its best score has not changed for
//! `patience` generations, when its points have become one, or when it has gathered behind the
//! best of an earlier population and cannot be expected to overtake it (`surrender`). The run
//! keeps the best of all.
//!
//! **Why small and many.** On the published problem (Bell 2015, chapter IV) with its hip rule
//! lowered to 13.7 mm (`docs/decisions/0007-optimisers.md`) the first
//! population already holds a feasible gait, and still most searches end in the neighbouring
//! basins (0.7249, 0.7265 beside 0.7003): the torque itself has several minima, and neither
//! plateaus nor a narrow feasible set are to blame. Run to its end, a population of 15, 30, 60,
//! 120 members finds the best basin in 13, 24, 33, 60 % of attempts of 8.6, 12.8, 24.9, 55.7
//! thousand evaluations: per evaluation 30 members do best, but are far from certain. Surrender
//! cuts the losing attempts to 3.6 thousand, which leaves time for 28 of them in 100,000
//! evaluations, and then the chance that none succeeds is below 0.1 %.

use serde::{Deserialize, Serialize};

use crate::{Candidate, Evaluator, Interval, NoScores, Random, Score, Solver};

/// Parameters of differential evolution.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct DifferentialEvolutionOptions {
    /// Members; at least 4.
    pub population: usize,
    /// p: share of the population that counts as its best, 0 to 1.
    pub best_share: f64,
    /// Generations without a better best before the population begins anew.
    pub patience: u64,
    /// Largest extent of the population, in widths of the bounds, that counts as one point.
    pub collapse: f64,
    /// A population that lies behind the best of an earlier one begins anew when its worst is
    /// behind its best by less than this many times that gap; 0 never.
    pub surrender: f64,
}

impl Default for DifferentialEvolutionOptions {
    fn default() -> Self {
        Self {
            population: 30,
            best_share: 0.1,
            patience: 60,
            collapse: 1e-7,
            surrender: 2.0,
        }
    }
}

/// Places in the ring of memories (SHADE's H).
const MEMORIES: usize = 6;
/// Spread of F and CR about their memories.
const SPREAD: f64 = 0.1;

/// The solver and its state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DifferentialEvolution {
    options: DifferentialEvolutionOptions,
    random: Random,
    members: Vec<Candidate>,
    archive: Vec<Vec<f64>>,
    memory: [Memory; MEMORIES],
    oldest: usize,
    unchanged: u64,
    starts: u64,
    earlier_best: Option<Score>,
}

/// Where F and CR are drawn about, or what was drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct Memory {
    scale: f64,
    crossover: f64,
}

const FRESH: Memory = Memory {
    scale: 0.5,
    crossover: 0.5,
};

impl DifferentialEvolution {
    /// A search that has not begun.
    pub fn new(options: DifferentialEvolutionOptions, seed: u64) -> Self {
        Self {
            options,
            random: Random::new(seed),
            members: Vec::new(),
            archive: Vec::new(),
            memory: [FRESH; MEMORIES],
            oldest: 0,
            unchanged: 0,
            starts: 0,
            earlier_best: None,
        }
    }

    fn start(&mut self, evaluator: &mut Evaluator<'_>) -> Result<(), NoScores> {
        let bounds = evaluator.bounds();
        if let Some(best) = self.members.first() {
            let earlier = self.earlier_best.get_or_insert(best.score);
            if best.score.beats(earlier) {
                *earlier = best.score;
            }
        }
        let population = 0..self.options.population.max(4);
        let points = population.map(|_| self.random.point(bounds)).collect();
        self.members = evaluator.evaluate(points)?;
        self.sort();
        self.archive.clear();
        self.memory = [FRESH; MEMORIES];
        (self.oldest, self.unchanged) = (0, 0);
        self.starts += 1;
        Ok(())
    }

    fn sort(&mut self) {
        self.members.sort_by(|a, b| a.score.order(&b.score));
    }

    /// Equations (1) to (3): a point, and the F and CR that it was made with.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of the population is below its number"
    )]
    fn child(&mut self, parent: usize, bounds: &[Interval]) -> (Vec<f64>, Memory) {
        let memory = self.memory[self.random.below(MEMORIES)];
        let scale = loop {
            let scale = self.random.cauchy(memory.scale, SPREAD);
            if scale > 0.0 {
                break scale.min(1.0);
            }
        };
        let crossover = (memory.crossover + SPREAD * self.random.normal()).clamp(0.0, 1.0);

        let count = self.members.len();
        let best = ((self.options.best_share * count as f64) as usize).clamp(2, count);
        let best = self.random.below(best);
        let other = self.other(count, &[parent]);
        let away = self.other(count + self.archive.len(), &[parent, other]);

        let away = match away.checked_sub(count) {
            Some(archived) => &self.archive[archived],
            None => &self.members[away].point,
        };
        let (best, other) = (&self.members[best].point, &self.members[other].point);
        let parent = &self.members[parent].point;
        let kept = self.random.below(bounds.len());
        let point = (0..bounds.len())
            .map(|j| {
                if j != kept && self.random.uniform() >= crossover {
                    return parent[j];
                }
                let mutant =
                    parent[j] + scale * (best[j] - parent[j]) + scale * (other[j] - away[j]);
                if mutant < bounds[j].low() {
                    0.5 * (parent[j] + bounds[j].low())
                } else if mutant > bounds[j].high() {
                    0.5 * (parent[j] + bounds[j].high())
                } else {
                    mutant
                }
            })
            .collect();
        (point, Memory { scale, crossover })
    }

    /// A number below `count` that is none of `taken`.
    fn other(&mut self, count: usize, taken: &[usize]) -> usize {
        loop {
            let index = self.random.below(count);
            if !taken.contains(&index) {
                return index;
            }
        }
    }

    fn remember(&mut self, successes: &[Memory]) {
        if successes.is_empty() {
            return;
        }
        let sum = |of: fn(&Memory) -> f64| successes.iter().map(of).sum::<f64>();
        self.memory[self.oldest] = Memory {
            scale: sum(|drawn| drawn.scale * drawn.scale) / sum(|drawn| drawn.scale),
            crossover: sum(|drawn| drawn.crossover) / successes.len() as f64,
        };
        self.oldest = (self.oldest + 1) % MEMORIES;
    }

    /// Whether the population has gathered behind the best of an earlier one.
    fn is_beaten(&self) -> bool {
        let (Some(earlier), [best, .., worst]) = (&self.earlier_best, &self.members[..]) else {
            return false;
        };
        let (best, worst) = (&best.score, &worst.score);
        if !earlier.beats(best) {
            return false;
        }
        let level = |score: &Score| score.violation().total_cmp(&best.violation()).is_eq();
        let (spread, gap) = if level(worst) && level(earlier) {
            (worst.value() - best.value(), best.value() - earlier.value())
        } else {
            let spread = worst.violation() - best.violation();
            (spread, best.violation() - earlier.violation())
        };
        spread < self.options.surrender * gap
    }

    fn stands_still(&self, bounds: &[Interval]) -> bool {
        let extent = |j: usize| {
            let values = self.members.iter().map(|member| member.point[j]);
            let (low, high) = values.fold((f64::MAX, f64::MIN), |(low, high), value| {
                (low.min(value), high.max(value))
            });
            (high - low) / bounds[j].width()
        };
        self.is_beaten()
            || self.unchanged >= self.options.patience
            || (0..bounds.len()).all(|j| extent(j) <= self.options.collapse)
    }
}

impl Solver for DifferentialEvolution {
    fn advance(&mut self, evaluator: &mut Evaluator<'_>) -> Result<(), NoScores> {
        let bounds = evaluator.bounds();
        if self.members.is_empty() || self.stands_still(bounds) {
            return self.start(evaluator);
        }
        let (points, drawn): (_, Vec<Memory>) = (0..self.members.len())
            .map(|parent| self.child(parent, bounds))
            .unzip();
        let children = evaluator.evaluate(points)?;

        let before = self.members[0].score;
        let mut successes = Vec::new();
        for ((member, child), drawn) in self.members.iter_mut().zip(children).zip(drawn) {
            if member.score.beats(&child.score) {
                continue;
            }
            let parent = std::mem::replace(member, child);
            if member.score.beats(&parent.score) {
                successes.push(drawn);
                self.archive.push(parent.point);
            }
        }
        while self.archive.len() > self.members.len() {
            let forgotten = self.random.below(self.archive.len());
            self.archive.swap_remove(forgotten);
        }
        self.remember(&successes);
        self.sort();
        self.unchanged = if self.members[0].score.beats(&before) {
            0
        } else {
            self.unchanged + 1
        };
        Ok(())
    }

    fn restarts(&self) -> u64 {
        self.starts.saturating_sub(1)
    }
}

#[cfg(test)]
mod tests;
