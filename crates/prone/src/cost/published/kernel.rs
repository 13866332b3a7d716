//! The published objective at speed: all samples of one quantity at a time.
//!
//! **Hip height without an inverse function.** Points of the plane as complex numbers x + iz.
//! With the shoulder S = x̂ + iẑ, the rigid piece from ankle to shoulder in the shin's frame
//! K = K1 − iK2 and D = |S|, R = |K|, the ankle A is where circles of radius l1 about the toe and
//! R about S meet, above the line to S (the root of [`crate::chain`]):
//!
//! ```text
//! p = (D² + l1² − R²)/2,   q = √(l1² D² − p²)                               (1)
//! A = S (p + iq) / D²                                                       (2)
//! hip = A + (S − A) K* (l2 + l3 e^{iθ3}) / R²                               (3)
//! ```
//!
//! q is not a number exactly where the chain does not close, and so is then the height.

use crate::chain::ClosedChain;

use super::sin_cos::sin_cos;
use super::{Coefficients, EXCESS_PER_METRE, PublishedObjective, SAMPLES, START, ViolatedSamples};
use crate::torque_map::Axis;

type Samples = [f64; SAMPLES];

/// The gait parameters at every sample, rad.
pub(super) struct Path {
    knee: Samples,
    hip: Samples,
    upper_arm: Samples,
}

impl Path {
    pub(super) fn new(phases: &Samples, gait: &Coefficients) -> Self {
        let cubic = |parameter: usize| {
            let ([c3, c2, c1], c0) = (gait.0[parameter], START[parameter]);
            phases.map(|s| ((c3 * s + c2) * s + c1) * s + c0)
        };
        Self {
            knee: cubic(0),
            hip: cubic(1),
            upper_arm: cubic(2),
        }
    }

    pub(super) fn samples(&self) -> impl Iterator<Item = [f64; 3]> + '_ {
        (0..SAMPLES).map(|k| [self.knee[k], self.hip[k], self.upper_arm[k]])
    }

    /// Height of the hip centre, m; NaN where the chain does not close.
    pub(super) fn hip_heights(&self, chain: &ClosedChain) -> Samples {
        let [l1, l2, l3, l4, l5] = chain.links();
        let mut heights = [0.0; SAMPLES];
        for (k, height) in heights.iter_mut().enumerate() {
            let (sin_knee, cos_knee) = sin_cos(self.knee[k]);
            let (sin_trunk, cos_trunk) = sin_cos(self.knee[k] + self.hip[k]);
            let (sin_arm, cos_arm) = sin_cos(self.upper_arm[k]);
            let (shoulder_x, shoulder_z) = (chain.span - l5 * cos_arm, -l5 * sin_arm);
            let (thigh_x, thigh_z) = (l2 + l3 * cos_knee, l3 * sin_knee);
            let (rigid_x, rigid_z) = (thigh_x + l4 * cos_trunk, thigh_z + l4 * sin_trunk);

            let d2 = shoulder_x * shoulder_x + shoulder_z * shoulder_z;
            let r2 = rigid_x * rigid_x + rigid_z * rigid_z;
            let p = 0.5 * (d2 + l1 * l1 - r2);
            let q = (l1 * l1 * d2 - p * p).sqrt();
            // One division serves both: 1/D² = R²/(D²R²).
            let inverse = 1.0 / (d2 * r2);
            let ankle_x = (shoulder_x * p - shoulder_z * q) * (inverse * r2);
            let ankle_z = (shoulder_x * q + shoulder_z * p) * (inverse * r2);

            // K* (l2 + l3 e^{iθ3}): the thigh's end as seen along the rigid piece.
            let along = rigid_x * thigh_x + rigid_z * thigh_z;
            let across = rigid_x * thigh_z - rigid_z * thigh_x;
            let turned = (shoulder_x - ankle_x) * across + (shoulder_z - ankle_z) * along;
            *height = ankle_z + turned * (inverse * d2);
        }
        heights
    }
}

impl PublishedObjective {
    /// Broken rules, counted, and by how much.
    #[expect(
        clippy::needless_bitwise_bool,
        reason = "a lazy `or` is a branch, which keeps the loop from being vectorised"
    )]
    pub(super) fn violations(&self, path: &Path, hip_height: &Samples) -> (ViolatedSamples, f64) {
        let threshold = self.rules.hip_threshold;
        let (mut returns, mut low) = (0, 0);
        let mut excess = 0.0;
        for pair in path.upper_arm.windows(2) {
            let increase = pair[1] - pair[0];
            returns += u32::from(increase > 0.0);
            excess += increase.max(0.0);
        }
        for &height in hip_height {
            // NaN is too low as well, and as deep as the floor.
            let high_enough = height >= threshold;
            low += u32::from(!high_enough);
            let height = if height.is_nan() { 0.0 } else { height };
            excess += EXCESS_PER_METRE * (threshold - height).max(0.0);
        }
        let mut range = |axis: &Axis, values: &Samples| {
            let tolerance = self.rules.limit_tolerance;
            let (least, most) = (axis.low() - tolerance, axis.high() + tolerance);
            let mut outside = 0;
            for &value in values {
                outside += u32::from((value < least) | (value > most));
                excess += (least - value).max(value - most).max(0.0);
            }
            outside
        };
        let violated = ViolatedSamples {
            arm_returns: returns,
            hip_low: low,
            knee_range: range(&self.grid.knee, &path.knee),
            hip_range: range(&self.grid.hip, &path.hip),
            arm_range: range(&self.grid.upper_arm, &path.upper_arm),
        };
        (violated, excess)
    }

    /// [τ2, τ3, τ4, τ5], trilinear, clamped at the edges.
    #[inline]
    pub(super) fn look_up(&self, knee: f64, hip: f64, upper_arm: f64) -> [f64; 4] {
        let [knee_ladder, hip_ladder, arm_ladder] = &self.ladders;
        let (knee, u) = knee_ladder.clamped(knee);
        let (hip, v) = hip_ladder.clamped(hip);
        let (arm, w) = arm_ladder.clamped(upper_arm);
        let along_hip = |knee: usize, arm: usize| {
            let row = self.grid.index(knee, hip, arm);
            let corners = &self.table[row..row + 2];
            between(corners[0], corners[1], v)
        };
        let along_knee = |arm| between(along_hip(knee, arm), along_hip(knee + 1, arm), u);
        between(along_knee(arm), along_knee(arm + 1), w)
    }
}

#[inline]
fn between(low: [f64; 4], high: [f64; 4], place: f64) -> [f64; 4] {
    std::array::from_fn(|joint| low[joint] + place * (high[joint] - low[joint]))
}

/// An axis made ready for look-ups: no division left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ladder {
    low: f64,
    steps_per_radian: f64,
    last: f64,
    last_cell: i32,
}

impl Ladder {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_possible_wrap,
        reason = "an axis has some tens of nodes"
    )]
    pub(super) fn new(axis: &Axis) -> Self {
        Self {
            low: axis.low(),
            steps_per_radian: axis.step().recip(),
            last: (axis.len() - 1) as f64,
            last_cell: axis.len() as i32 - 2,
        }
    }

    /// Node below and place between it and the next; the edge's beyond the edge.
    #[inline]
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the place is in 0..=last, and truncating is the floor"
    )]
    fn clamped(&self, value: f64) -> (usize, f64) {
        let place = ((value - self.low) * self.steps_per_radian).clamp(0.0, self.last);
        let node = (place as i32).min(self.last_cell);
        (node as usize, place - f64::from(node))
    }
}
