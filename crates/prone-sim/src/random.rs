//! Random numbers of what a simulated robot has wrong with it: noise, bias, lateness.
//!
//! `SplitMix64` (Steele, Lea and Flood 2014), whose sequence never changes. The optimisers have a
//! generator of their own in a crate that knows no robot; noise needs no long period.

use std::f64::consts::TAU;

use glam::DVec3;

/// A generator, and its place in the sequence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Random(u64);

impl Random {
    /// The sequence of a seed.
    pub(crate) const fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1): the upper 53 bits.
    pub(crate) fn uniform(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.next() >> 11) as f64 * STEP
    }

    /// Uniform in 0..=`most`; the bias is below (most + 1)/2⁵³.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of a small count"
    )]
    pub(crate) fn up_to(&mut self, most: usize) -> usize {
        (self.uniform() * (most + 1) as f64) as usize
    }

    /// Standard normal (Box and Muller 1958, the cosine half).
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }

    /// Each component uniform within ± the bound.
    pub(crate) fn bias(&mut self, bound: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| bound * (2.0 * self.uniform() - 1.0)))
    }

    /// Each component normal, with a mean of zero.
    pub(crate) fn noise(&mut self, standard_deviation: f64) -> DVec3 {
        DVec3::from_array([(); 3].map(|()| standard_deviation * self.normal()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published first values of `SplitMix64` for the seed 1234567.
    #[test]
    fn reference_the_generator() {
        let mut random = Random::new(1_234_567);
        assert_eq!(random.next(), 6_457_827_717_110_365_317);
        assert_eq!(random.next(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn limit_up_to_reaches_both_ends_and_none_beyond() {
        let mut random = Random::new(3);
        let mut seen = [0; 3];
        for _ in 0..300 {
            seen[random.up_to(2)] += 1;
        }
        assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
        assert_eq!(random.up_to(0), 0);
    }
}
