//! Pointing the forearm with two hinges: Paden and Kahan's second subproblem.
//!
//! Unit axes a (upper) and b (lower), unit vector f at zero angles; find the angles with
//! `R(a, p) R(b, q) f = w`. The vector c = R(b, q) f lies on both cones, about b through f and
//! about a through w:
//!
//! ```text
//! c = λ a + μ b + ν a×b,
//! λ = (a·b · b·f − a·w) / ((a·b)² − 1),   μ = (a·b · a·w − b·f) / ((a·b)² − 1)
//! ν² = (1 − λ² − μ² − 2 λ μ a·b) / |a×b|²
//! ```
//!
//! Two solutions, ±ν. The one that violates the limits least is taken, then the smaller one.

use glam::DVec3;

use super::MappingError;
use crate::robot::Range;

/// How far ν² may be below zero by rounding at the edge of the hinges' reach.
const ROUNDING: f64 = 1e-12;

pub(super) fn point(
    [a, b]: [DVec3; 2],
    f: DVec3,
    w: DVec3,
    ranges: [Range; 2],
) -> Result<[f64; 2], MappingError> {
    let (ab, bf, aw) = (a.dot(b), b.dot(f), a.dot(w));
    let cross = a.cross(b);
    let denominator = ab * ab - 1.0;
    let lambda = (ab * bf - aw) / denominator;
    let mu = (ab * aw - bf) / denominator;
    let nu_squared =
        (1.0 - lambda * lambda - mu * mu - 2.0 * lambda * mu * ab) / cross.length_squared();
    // Parallel axes make NaN, which is out of reach too.
    if nu_squared
        .partial_cmp(&-ROUNDING)
        .is_none_or(std::cmp::Ordering::is_lt)
    {
        return Err(MappingError::ForearmOutOfReach {
            miss: (-nu_squared).sqrt(),
        });
    }
    let nu = nu_squared.max(0.0).sqrt();
    let solution = |nu: f64| {
        let c = lambda * a + mu * b + nu * cross;
        [angle_about(a, c, w), angle_about(b, f, c)]
    };
    let violation = |angles: [f64; 2]| -> f64 {
        angles
            .iter()
            .zip(&ranges)
            .map(|(&angle, range)| range.excess(angle).abs())
            .sum()
    };
    let (one, other) = (solution(nu), solution(-nu));
    let size = |angles: [f64; 2]| angles[0].abs() + angles[1].abs();
    let better = violation(one)
        .total_cmp(&violation(other))
        .then(size(one).total_cmp(&size(other)));
    Ok(if better.is_le() { one } else { other })
}

/// The angle that turns `from` into `to` about a unit `axis`, rad.
fn angle_about(axis: DVec3, from: DVec3, to: DVec3) -> f64 {
    let flat = |v: DVec3| v - axis * axis.dot(v);
    let (from, to) = (flat(from), flat(to));
    axis.dot(from.cross(to)).atan2(from.dot(to))
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use proptest::prelude::*;

    use super::*;

    const ANY: [Range; 2] = [Range {
        lower: -7.0,
        upper: 7.0,
    }; 2];

    proptest! {
        /// Built forwards from the hinge angles, for axes that are not square to each other.
        #[test]
        fn pointing_recovers_the_direction(
            p in -3.0..3.0_f64, q in -3.0..3.0_f64, skew in 0.2..2.9_f64, tilt in 0.1..1.5_f64,
        ) {
            let a = DVec3::X;
            let b = DQuat::from_rotation_y(skew) * DVec3::X;
            let f = DQuat::from_rotation_z(tilt) * b;
            let reached = |p, q| DQuat::from_axis_angle(a, p) * DQuat::from_axis_angle(b, q) * f;
            let w = reached(p, q);
            let [p2, q2] = point([a, b], f, w, ANY).unwrap();
            prop_assert!((reached(p2, q2) - w).length() < 1e-7);
        }
    }

    #[test]
    fn the_solution_within_limits_is_taken() {
        let ranges = [
            ANY[0],
            Range {
                lower: -1.6,
                upper: 0.0,
            },
        ];
        let w = DVec3::new(0.5, 0.0, 0.75_f64.sqrt());
        let [_, roll] = point([DVec3::X, DVec3::Z], DVec3::X, w, ranges).unwrap();
        assert!((roll + 0.5_f64.acos()).abs() < 1e-12, "{roll}");
    }

    #[test]
    fn a_direction_outside_the_cone_is_refused() {
        // The lower hinge turns about the forearm itself: it cannot leave its axis.
        let error = point([DVec3::X, DVec3::Z], DVec3::Z, DVec3::X, ANY);
        assert!(matches!(error, Err(MappingError::ForearmOutOfReach { .. })));
    }
}
