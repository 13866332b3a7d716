//! Rough ground: a grid of random heights between which the ground is plane.
//!
//! 1. A height of the grid is h = H · w · u, with H the bump height, u uniform in (0, 1] and w the
//!    weight of the border.
//! 2. w = t² (3 − 2t), t = min(1, d/4), where d counts grid spacings to the nearest border: the
//!    stretch rises from the floor and returns to it smoothly on all sides.
//! 3. u comes from `SplitMix64` (Steele, Lea and Flood 2014), row by row from the seed: the
//!    upper 53 bits of each number, plus one, over 2⁵³.

/// A stretch of bumps on the floor, its middle line on y = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Roughness {
    /// No bump is higher, m.
    pub height: f64,
    /// From bump to bump, m; rounded so that length and width hold whole numbers of them.
    pub spacing: f64,
    /// x where it begins, m.
    pub from_x: f64,
    /// Along x, m.
    pub length: f64,
    /// Along y, half of it on either side, m.
    pub width: f64,
    /// Of the heights.
    pub seed: u64,
}

/// Heights on a regular grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Heights {
    /// Points along x.
    pub columns: usize,
    /// Points along y.
    pub rows: usize,
    /// Above the floor, m; row by row towards +y, each row towards +x.
    pub metres: Vec<f64>,
}

/// The grid spacings over which the ground rises from its border.
const BORDER: f64 = 4.0;

impl Roughness {
    /// Unless said otherwise.
    pub const WIDTH: f64 = 1.0;

    /// The heights, a function of the seed, today and in any later version.
    pub fn heights(&self) -> Heights {
        let [columns, rows] = self.points();
        let mut random = SplitMix64(self.seed);
        let mut metres = Vec::with_capacity(columns * rows);
        for row in 0..rows {
            for column in 0..columns {
                let to_border = column
                    .min(columns - 1 - column)
                    .min(row)
                    .min(rows - 1 - row);
                let t = (to_border as f64 / BORDER).min(1.0);
                let weight = t * t * (3.0 - 2.0 * t);
                metres.push(self.height * weight * random.uniform());
            }
        }
        Heights {
            columns,
            rows,
            metres,
        }
    }

    /// Grid points along x and y: at least three, so that one lies inside.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a checked scene has between 2 and a million spacings"
    )]
    pub(super) fn points(&self) -> [usize; 2] {
        [self.length, self.width]
            .map(|extent| (extent / self.spacing).round().max(2.0) as usize + 1)
    }
}

impl Heights {
    /// The highest point, m.
    pub fn highest(&self) -> f64 {
        self.metres.iter().copied().fold(0.0, f64::max)
    }
}

struct SplitMix64(u64);

impl SplitMix64 {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In (0, 1].
    fn uniform(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        ((self.next() >> 11) + 1) as f64 * STEP
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROUGH: Roughness = Roughness {
        height: 0.01,
        spacing: 0.05,
        from_x: 0.3,
        length: 1.0,
        width: 0.8,
        seed: 7,
    };

    /// The sequence of seed 1234567 as printed beside the generator's public C source's ports.
    #[test]
    fn reference_split_mix() {
        let mut random = SplitMix64(1_234_567);
        for expected in [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
        ] {
            assert_eq!(random.next(), expected);
        }
    }

    #[test]
    fn identity_the_same_seed_gives_the_same_heights() {
        let heights = ROUGH.heights();
        assert_eq!(heights, ROUGH.heights());
        assert_ne!(heights, Roughness { seed: 8, ..ROUGH }.heights());
        assert_eq!((heights.columns, heights.rows), (21, 17));
        assert_eq!(heights.metres.len(), 21 * 17);
    }

    #[test]
    fn the_border_lies_on_the_floor_and_no_bump_passes_its_height() {
        let heights = ROUGH.heights();
        let at = |column: usize, row: usize| heights.metres[row * heights.columns + column];
        for row in 0..heights.rows {
            for column in 0..heights.columns {
                let height = at(column, row);
                let border = [0, heights.columns - 1].contains(&column)
                    || [0, heights.rows - 1].contains(&row);
                assert_eq!(height <= 0.0, border, "{column} {row}: {height}");
                assert!(height <= ROUGH.height);
            }
            // Equation 2 one spacing inside: t = 1/4.
            assert!(at(1, row) <= ROUGH.height * 0.156_25);
        }
        assert!(heights.highest() > 0.9 * ROUGH.height);
    }

    #[test]
    fn limit_the_smallest_stretch_has_one_bump() {
        let least = Roughness {
            length: 0.1,
            width: 0.1,
            ..ROUGH
        };
        let heights = least.heights();
        assert_eq!((heights.columns, heights.rows), (3, 3));
        assert_eq!(heights.metres.iter().filter(|&&h| h > 0.0).count(), 1);
    }
}
