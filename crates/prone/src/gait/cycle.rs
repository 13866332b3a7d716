//! Whole crawl cycles: extension, pull, and the way back to the next extension.
//!
//! ```text
//! extension ──pull (closed chain)──> compression ──waypoint──> … ──approach──> extension
//! ```
//!
//! In the pull toes and elbows are planted and a [`Gait`] moves the chain; head and other joints
//! may move along. In the recovery each limb is an open chain that goes from waypoint to waypoint,
//! joint by joint, while the body lies on the floor or on knees and forearms; it may move on too.
//! The cycle ends where it began, one advance further on.
//!
//! A turn command u makes the pull asymmetric: over the phase s the left arm is spread by
//! k·u·(1 − 2s) more than the gait has it and the right arm by as much less, and the steering's
//! joints (a robot's hip rolls, say) are set to their factor times u·(1 − 2s). Both elbows stay
//! where they are, so that trunk and hips swing about them. Positive u turns to the left.
//!
//! [`CheckedCycle::plan`] holds all of it against a robot: stops, joint speeds, the closed chain.

mod checked;
mod error;
mod plan;

pub use checked::{CheckedCycle, FastestJoint, RecoveryPath};
pub use error::CycleError;

use std::collections::BTreeMap;

use super::{Curve, Gait, PhaseDuration};

/// A crawl cycle. Joints carry the manufacturer's names; of a left and a right twin one is enough.
#[derive(Debug, Clone, PartialEq)]
pub struct Cycle {
    /// The closed chain; its name and description are the cycle's.
    pub pull: Gait,
    /// How long the pull lasts, s.
    pub pull_duration: PhaseDuration,
    /// Joints outside the chain over the phase of the pull, rad; those not named stay at zero.
    pub company: BTreeMap<String, Curve>,
    /// The way back, in order.
    pub recovery: Vec<Waypoint>,
    /// The last stretch, to the first posture of the next pull.
    pub approach: Approach,
    /// How long it rests at its end, in the posture from which the next pull begins, s; a time scale
    /// does not stretch it.
    pub rest: f64,
    /// How it turns, where it can.
    pub steering: Option<Steering>,
}

/// A posture on the way back.
#[derive(Debug, Clone, PartialEq)]
pub struct Waypoint {
    /// What it is for, in a word.
    pub name: String,
    /// How it is reached.
    pub approach: Approach,
    /// Joint angles, rad. Those not named stay where they are.
    ///
    /// The first waypoint keeps what a turn has added to the arms, as they may still be planted;
    /// what it has moved beside them goes back to zero there.
    pub joints: BTreeMap<String, f64>,
}

/// How a posture is reached from the one before.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Approach {
    /// In which time, s.
    pub seconds: f64,
    /// With which course.
    pub easing: Easing,
}

/// The course from one posture to the next.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Easing {
    /// 3x² − 2x³: at rest at both ends.
    #[default]
    Smoothstep,
    /// At constant speed.
    Linear,
}

/// How a cycle turns.
#[derive(Debug, Clone, PartialEq)]
pub struct Steering {
    /// The largest |u|, rad.
    pub limit: f64,
    /// k: how much of u the arms are spread by.
    pub spread: f64,
    /// Factors of u for other joints. Here both twins are named, as a turn is not symmetric.
    pub joints: BTreeMap<String, f64>,
}

/// What all durations of a cycle are multiplied by.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct TimeScale(f64);

/// A time scale that no crawl can have.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "a time scale of {value} is outside {}..{}",
    TimeScale::LEAST,
    TimeScale::GREATEST
)]
pub struct TimeScaleError {
    /// What was asked for.
    pub value: f64,
}

impl TimeScale {
    /// As the gait file has it.
    pub const ONE: Self = Self(1.0);
    /// Four times as fast.
    pub const LEAST: f64 = 0.25;
    /// Twenty times as slow.
    pub const GREATEST: f64 = 20.0;

    /// A factor of all durations.
    ///
    /// # Errors
    /// [`TimeScaleError`] outside 0.25 to 20, and for NaN.
    pub fn new(value: f64) -> Result<Self, TimeScaleError> {
        if (Self::LEAST..=Self::GREATEST).contains(&value) {
            Ok(Self(value))
        } else {
            Err(TimeScaleError { value })
        }
    }

    /// The factor.
    pub const fn value(self) -> f64 {
        self.0
    }
}

impl Easing {
    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Smoothstep => "smoothstep",
            Self::Linear => "linear",
        }
    }

    /// Share of the way at a share of the time, both 0 to 1.
    pub fn share(self, time: f64) -> f64 {
        let x = time.clamp(0.0, 1.0);
        match self {
            Self::Smoothstep => x * x * (3.0 - 2.0 * x),
            Self::Linear => x,
        }
    }

    /// The fastest part's speed over the mean.
    pub const fn peak_speed(self) -> f64 {
        match self {
            Self::Smoothstep => 1.5,
            Self::Linear => 1.0,
        }
    }
}

impl Cycle {
    /// Shortest and longest stretch of a recovery, s.
    pub const STRETCH_SECONDS: (f64, f64) = (0.05, 60.0);

    /// How long a cycle lasts at a time scale, s.
    pub fn duration(&self, scale: TimeScale) -> f64 {
        let ways = self.recovery.iter().map(|waypoint| waypoint.approach);
        let recovery: f64 = ways.chain([self.approach]).map(|way| way.seconds).sum();
        (self.pull_duration.seconds() + recovery) * scale.value() + self.rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn easings_begin_and_end_where_they_should() {
        for easing in [Easing::Smoothstep, Easing::Linear] {
            assert!(easing.share(0.0).abs() < f64::EPSILON);
            assert!((easing.share(1.0) - 1.0).abs() < f64::EPSILON);
            assert!((easing.share(2.0) - 1.0).abs() < f64::EPSILON);
            let speeds = (0..1000).map(|k| f64::from(k) / 1000.0);
            let steepest = speeds
                .map(|x| (easing.share(x + 1e-3) - easing.share(x)) / 1e-3)
                .fold(0.0, f64::max);
            assert!((steepest - easing.peak_speed()).abs() < 1e-5, "{easing:?}");
        }
    }

    #[test]
    fn limit_time_scales() {
        for value in [f64::NAN, 0.0, -1.0, 0.24, 21.0] {
            assert!(TimeScale::new(value).is_err(), "{value}");
        }
        assert!(TimeScale::new(1.7).is_ok());
    }
}
