//! Gaits: how the three chain angles move while toes and elbows are planted, and the whole cycles
//! around them ([`cycle`]).
//!
//! A [`Gait`] is three [`Curve`]s over the phase s = t / duration ∈ [0, 1], the mapping it was
//! made for and what happens at a joint's limit. [`CheckedTrajectory::plan`] turns it into joint
//! angles that a robot may follow; nothing else may be sent to one.

mod curve;
pub mod cycle;
mod trajectory;

pub use curve::{Curve, CurveError, CurveForm};
pub use trajectory::{
    CheckedTrajectory, Clamp, PhaseDuration, PhaseDurationError, Sample, TrajectoryError,
};

use crate::chain::GaitParameters;
use crate::mapping::{ArmMode, MappingVariant};

/// A closed-chain gait.
#[derive(Debug, Clone, PartialEq)]
pub struct Gait {
    /// Short name, as used in file names.
    pub name: String,
    /// One sentence on where it comes from.
    pub description: String,
    /// θ3(s), rad.
    pub knee: Curve,
    /// θ4(s), rad.
    pub hip: Curve,
    /// α(s), rad.
    pub upper_arm: Curve,
    /// Which chain and which offsets turn chain angles into joints.
    pub mapping: MappingVariant,
    /// What the forearms do.
    pub arm: ArmMode,
    /// What happens where a joint would pass its limit.
    pub limits: LimitsPolicy,
}

/// What happens where a gait asks a joint for more than its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LimitsPolicy {
    /// The gait is an error.
    #[default]
    Refuse,
    /// The joint stops at its limit and the clamp is reported.
    Clamp,
}

impl Gait {
    /// The gait parameters at phase `s` ∈ [0, 1].
    pub fn parameters(&self, s: f64) -> GaitParameters {
        GaitParameters {
            knee: self.knee.value(s),
            hip: self.hip.value(s),
            upper_arm: self.upper_arm.value(s),
        }
    }
}
