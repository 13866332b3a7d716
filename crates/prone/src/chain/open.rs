//! The open chain: a free limb of two links in the sagittal plane.
//!
//! From a base (x0, z0), with absolute first angle θ1 and relative second angle θ2:
//!
//! ```text
//! x = x0 + l1 cos θ1 + l2 cos(θ1+θ2),   z = z0 + l1 sin θ1 + l2 sin(θ1+θ2)     (5)
//! cos θ2 = (r² − l1² − l2²) / (2 l1 l2),   r the distance from base to tip      (6)
//! ```
//!
//! Of the two roots ±θ2 the one whose middle joint is higher is chosen: a limb that is swung
//! forward close to the floor must not pass through it.

use crate::frames::{Ground, Point};

/// Two links swung freely from a base, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OpenChain {
    /// Where the limb is hinged.
    pub base: Point<Ground>,
    /// l1: base to middle joint.
    pub first_link: f64,
    /// l2: middle joint to tip.
    pub second_link: f64,
}

/// Why a limb does not reach.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum OpenChainError {
    /// The target is nearer or farther than the two links allow; NaN input ends here too.
    #[error(
        "the limb cannot reach {distance:.4} m from its base: it spans {shortest:.4} to {longest:.4} m"
    )]
    OutOfReach {
        /// Base to target, metres.
        distance: f64,
        /// |l1 − l2|, metres.
        shortest: f64,
        /// l1 + l2, metres.
        longest: f64,
    },
    /// Both roots put the middle joint below the floor.
    #[error("the limb's middle joint would be {depth:.4} m below the floor")]
    BelowFloor {
        /// How far the better root is below z = 0, metres.
        depth: f64,
    },
}

impl OpenChain {
    /// Tip position for an absolute first and a relative second angle, radians: equation (5).
    pub fn tip(&self, first: f64, second: f64) -> Point<Ground> {
        let middle = self.middle(first);
        Point::sagittal(
            middle.x() + self.second_link * (first + second).cos(),
            middle.z() + self.second_link * (first + second).sin(),
        )
    }

    /// Middle joint for an absolute first angle, radians.
    pub fn middle(&self, first: f64) -> Point<Ground> {
        Point::sagittal(
            self.base.x() + self.first_link * first.cos(),
            self.base.z() + self.first_link * first.sin(),
        )
    }

    /// Angles (θ1, θ2), radians, that bring the tip to `target` with the middle joint up.
    ///
    /// # Errors
    /// [`OpenChainError`] where the target is out of reach or the limb would pass the floor.
    pub fn reach(&self, target: Point<Ground>) -> Result<(f64, f64), OpenChainError> {
        let (l1, l2) = (self.first_link, self.second_link);
        let (dx, dz) = (target.x() - self.base.x(), target.z() - self.base.z());
        let distance = dx.hypot(dz);
        let cosine = (distance * distance - l1 * l1 - l2 * l2) / (2.0 * l1 * l2);
        if !(-1.0..=1.0).contains(&cosine) {
            return Err(OpenChainError::OutOfReach {
                distance,
                shortest: (l1 - l2).abs(),
                longest: l1 + l2,
            });
        }
        let root = |second: f64| {
            let first = dz.atan2(dx) - (l2 * second.sin()).atan2(l1 + l2 * second.cos());
            (first, second)
        };
        let (one, other) = (root(cosine.acos()), root(-cosine.acos()));
        let best = if self.middle(one.0).z() >= self.middle(other.0).z() {
            one
        } else {
            other
        };
        let height = self.middle(best.0).z();
        if height < 0.0 {
            return Err(OpenChainError::BelowFloor { depth: -height });
        }
        Ok(best)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const SHIN_AND_THIGH: OpenChain = OpenChain {
        base: Point::sagittal(0.2, 0.05),
        first_link: 0.1,
        second_link: 0.1029,
    };

    proptest! {
        #[test]
        fn reaching_recovers_the_tip(first in 0.0..3.1_f64, second in -2.5..2.5_f64) {
            // Built forwards from a posture whose middle joint is above the floor.
            let target = SHIN_AND_THIGH.tip(first, second);
            let (a, b) = SHIN_AND_THIGH.reach(target).unwrap();
            let again = SHIN_AND_THIGH.tip(a, b);
            prop_assert!((again.metres() - target.metres()).length() < 1e-9);
            prop_assert!(SHIN_AND_THIGH.middle(a).z() >= SHIN_AND_THIGH.middle(first).z() - 1e-9);
        }
    }

    #[test]
    fn a_target_out_of_reach_is_refused() {
        let far = SHIN_AND_THIGH.reach(Point::sagittal(1.0, 0.0));
        assert!(matches!(far, Err(OpenChainError::OutOfReach { .. })));
        let nan = SHIN_AND_THIGH.reach(Point::sagittal(f64::NAN, 0.0));
        assert!(matches!(nan, Err(OpenChainError::OutOfReach { .. })));
    }

    #[test]
    fn a_limb_below_the_floor_is_refused() {
        let low = OpenChain {
            base: Point::sagittal(0.0, -0.2),
            ..SHIN_AND_THIGH
        };
        let error = low.reach(Point::sagittal(0.19, -0.2)).unwrap_err();
        assert!(matches!(error, OpenChainError::BelowFloor { .. }));
    }
}
