//! Random numbers that are a function of the seed, today and in any later version.
//!
//! Xoshiro256++ (Blackman and Vigna 2019), seeded through `SplitMix64` as its authors advise. The
//! distributions are written out here, because those of `rand` may change their values between
//! versions.

use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use crate::Interval;

/// A generator, and its place in the sequence.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Random(Xoshiro256PlusPlus);

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }

    /// A seed for someone else's generator.
    pub fn seed(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// Uniform in [0, 1): the upper 53 bits.
    pub fn uniform(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.0.next_u64() >> 11) as f64 * STEP
    }

    /// Uniform within the bounds of each variable.
    pub fn point(&mut self, bounds: &[Interval]) -> Vec<f64> {
        let numbers = bounds.iter().map(|interval| interval.at(self.uniform()));
        numbers.collect()
    }

    /// Uniform in 0..count (`count` not zero); the bias is below count/2⁶⁴.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the upper half is below count"
    )]
    pub fn below(&mut self, count: usize) -> usize {
        ((u128::from(self.0.next_u64()) * count as u128) >> 64) as usize
    }

    /// Standard normal (Box and Muller 1958, the cosine half).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }

    /// Cauchy about `centre`, by the inverse of its distribution.
    pub fn cauchy(&mut self, centre: f64, scale: f64) -> f64 {
        centre + scale * (std::f64::consts::PI * (self.uniform() - 0.5)).tan()
    }

    /// Puts a slice into random order (Fisher and Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regression_the_sequence_of_a_seed_never_changes() {
        let mut random = Random::new(1);
        assert_eq!(random.seed(), 14_971_601_782_005_023_387);
    }

    /// Mean and variance within five standard errors of 10⁵ draws.
    #[test]
    fn identity_moments() {
        let mut random = Random::new(7);
        let n = 100_000;
        let (mut sum, mut squares, mut uniform) = (0.0, 0.0, 0.0);
        for _ in 0..n {
            let z = random.normal();
            sum += z;
            squares += z * z;
            uniform += random.uniform();
        }
        let n = f64::from(n);
        assert!((sum / n).abs() < 5.0 / n.sqrt());
        assert!((squares / n - 1.0).abs() < 5.0 * (2.0 / n).sqrt());
        assert!((uniform / n - 0.5).abs() < 5.0 / (12.0 * n).sqrt());
    }

    #[test]
    fn limit_below_stays_below() {
        let mut random = Random::new(3);
        let mut seen = [0; 3];
        for _ in 0..300 {
            seen[random.below(3)] += 1;
        }
        assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
    }
}
