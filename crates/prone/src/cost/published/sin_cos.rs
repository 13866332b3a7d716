//! Sine and cosine without a branch or a call, so that a loop over samples is vectorised.
//!
//! x = n π/2 + r with |r| ≤ π/4, π/2 in two parts of which n times the first is exact (Cody and
//! Waite); on r the polynomials of fdlibm (Sun Microsystems, `k_sin.c`, `k_cos.c`); n mod 4
//! exchanges the two and sets the signs. Within 3·10⁻¹⁶ of the library's for |x| < 10³ (a cubic
//! with coefficients in ±2 stays below 14); NaN gives NaN.

/// First 33 bits of π/2, and the rest.
const HALF_PI: (f64, f64) = (1.570_796_326_734_125_6, 6.077_100_506_506_192e-11);
/// Adding and subtracting 1.5·2⁵² rounds to an integer, left in the low bits in between.
const ROUND: f64 = 6_755_399_441_055_744.0;
const SIN: [f64; 6] = [
    -1.666_666_666_666_663_2e-1,
    8.333_333_333_322_49e-3,
    -1.984_126_982_985_795e-4,
    2.755_731_370_707_006_8e-6,
    -2.505_076_025_340_686_3e-8,
    1.589_690_995_211_55e-10,
];
const COS: [f64; 6] = [
    4.166_666_666_666_66e-2,
    -1.388_888_888_887_411e-3,
    2.480_158_728_947_673e-5,
    -2.755_731_435_139_066_3e-7,
    2.087_572_321_298_175e-9,
    -1.135_964_755_778_819_5e-11,
];

/// (sin x, cos x).
#[inline]
pub(super) fn sin_cos(x: f64) -> (f64, f64) {
    let shifted = x * std::f64::consts::FRAC_2_PI + ROUND;
    let quadrant = shifted.to_bits();
    let n = shifted - ROUND;
    let r = (x - n * HALF_PI.0) - n * HALF_PI.1;

    let z = r * r;
    let [s1, s2, s3, s4, s5, s6] = SIN;
    let sin = r + r * z * (s1 + z * (s2 + z * (s3 + z * (s4 + z * (s5 + z * s6)))));
    let [c1, c2, c3, c4, c5, c6] = COS;
    let cos = 1.0 - 0.5 * z + z * z * (c1 + z * (c2 + z * (c3 + z * (c4 + z * (c5 + z * c6)))));

    let exchange = 0_u64.wrapping_sub(quadrant & 1);
    let difference = (sin.to_bits() ^ cos.to_bits()) & exchange;
    let sin_sign = (quadrant & 2) << 62;
    let cos_sign = (quadrant.wrapping_add(1) & 2) << 62;
    (
        f64::from_bits(sin.to_bits() ^ difference ^ sin_sign),
        f64::from_bits(cos.to_bits() ^ difference ^ cos_sign),
    )
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn matches_the_library(x in -1000.0..1000.0_f64) {
            let (sin, cos) = sin_cos(x);
            // Both are good to about one unit in the last place of 1.
            prop_assert!((sin - x.sin()).abs() < 3e-16, "{x}: {sin}");
            prop_assert!((cos - x.cos()).abs() < 3e-16, "{x}: {cos}");
        }
    }

    #[test]
    fn nan_and_infinity_have_no_sine() {
        for x in [f64::NAN, f64::INFINITY] {
            let (sin, cos) = sin_cos(x);
            assert!(sin.is_nan() && cos.is_nan());
        }
    }
}
