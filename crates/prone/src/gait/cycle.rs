//! Whole crawl cycles: from an extension back to the next one, one advance further on.
//!
//! ```text
//! with a pull:  extension ──pull (closed chain)──> compression ──waypoint──> … ──approach──> extension
//! without one:  extension ──waypoint──> ──waypoint──> … ──last waypoint──> extension
//! ```
//!
//! In the pull toes and elbows are planted and a [`Gait`] moves the chain; head and other joints
//! may move along. On the way along the waypoints each limb is an open chain that goes from posture
//! to posture, joint by joint; whatever then touches the floor may push or be dragged. A cycle
//! without a pull is made of waypoints alone, and the posture of the last one is its extension.
//!
//! A turn command u, positive to the left, acts in two places:
//!
//! - in the pull, which it makes asymmetric: over the phase s the left arm is spread by k·u·(1 − 2s)
//!   more than the gait has it and the right arm by as much less, and the steering's joints (a
//!   robot's hip rolls, say) are set to their factor times u·(1 − 2s). Both elbows stay where they
//!   are, so that trunk and hips swing about them;
//! - at waypoints, to whose angles it adds: a joint's factor times w(u), where
//!
//! ```text
//! w(u) = u + d u / (|u| + d)                                          (1)
//! ```
//!
//! with the dead band d of the cycle: commands too small to overcome friction turn nothing, so that
//! small ones are made up to twice as large and large ones are larger by d. w is odd and rises with
//! u everywhere.
//!
//! A cycle may have a second command, the shift v, positive to the left, that adds to waypoints by
//! factors of its own: it moves the robot aside and turns it little. Where a limb pushes, the angle that
//! turns and the angle that shifts are not the same, and with one of them alone a robot that is pushed
//! aside must head askew to come back. A joint's factor is times
//!
//! ```text
//! x(v) = v |v| / v_limit                                              (2)
//! ```
//!
//! A limb that slides goes aside at the least difference between left and right: 0.5° moves the NAO by a
//! fifth to a half of what 12° do, so that a heading hold with the angle itself as its command would sway for
//! ever. Over (2) the way aside is nearly in proportion to v.
//!
//! [`CheckedCycle::plan`] holds all of it against a robot: stops, limits that depend on another
//! joint, joint speeds, the closed chain.

mod checked;
mod error;
mod plan;

pub use checked::{CheckedCycle, FastestJoint, RecoveryPath};
pub use error::CycleError;

use std::collections::BTreeMap;

use super::{Curve, Gait, LimitsPolicy, PhaseDuration};
use crate::mapping::{ArmMode, MappingVariant};

/// A crawl cycle. Joints carry the manufacturer's names; of a left and a right twin one is enough.
#[derive(Debug, Clone, PartialEq)]
pub struct Cycle {
    /// Short name, as used in file names.
    pub name: String,
    /// One sentence on where it comes from.
    pub description: String,
    /// What happens where a joint would pass its limit.
    pub limits: LimitsPolicy,
    /// The phase in which the closed chain carries the body, where there is one.
    pub pull: Option<Pull>,
    /// The way to the next extension, in order. Without a pull the last one is the extension.
    pub waypoints: Vec<Waypoint>,
    /// How long it rests at its end, in the posture from which the next cycle begins, s; a time scale
    /// does not stretch it.
    pub rest: f64,
    /// How it turns, where it can.
    pub steering: Option<Steering>,
}

/// The closed-chain phase of a cycle.
#[derive(Debug, Clone, PartialEq)]
pub struct Pull {
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
    /// How long it lasts, s.
    pub duration: PhaseDuration,
    /// Joints outside the chain over the phase of the pull, rad; those not named stay at zero.
    pub company: BTreeMap<String, Curve>,
    /// The last stretch of the cycle, from the last waypoint to the first posture of the next pull.
    pub approach: Approach,
}

/// A posture on the way to the next extension.
#[derive(Debug, Clone, PartialEq)]
pub struct Waypoint {
    /// What it is for, in a word.
    pub name: String,
    /// How it is reached.
    pub approach: Approach,
    /// Joint angles, rad. Those not named stay where they are.
    ///
    /// After a pull the first waypoint keeps what a turn has added to the arms, as they may still be
    /// planted; what it has moved beside them goes back to zero there.
    pub joints: BTreeMap<String, f64>,
    /// Factors of w(u), equation (1), that a turn adds to this waypoint's angles. Of two twins one
    /// is enough: the other one gets the opposite of its mirror image, since a turn to the left is
    /// the mirror image of one to the right.
    pub turn: BTreeMap<String, f64>,
    /// The same of v, which shifts.
    pub shift: BTreeMap<String, f64>,
}

/// What a cycle is steered by, rad, positive to the left.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Steer {
    /// u, which turns.
    pub turn: f64,
    /// v, which moves aside.
    pub shift: f64,
}

impl Steer {
    /// Straight on.
    pub const STRAIGHT: Self = Self {
        turn: 0.0,
        shift: 0.0,
    };
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
    /// The largest |v|, rad; 0 where it cannot be shifted.
    pub shift_limit: f64,
    /// d of equation (1), rad: what of a command friction swallows.
    pub dead_band: f64,
    /// k: how much of u the arms are spread by in the pull.
    pub spread: f64,
    /// Factors of u for other joints in the pull. Here both twins are named.
    pub joints: BTreeMap<String, f64>,
}

impl Steering {
    /// Largest factor of a command, of either sign.
    pub const LARGEST_FACTOR: f64 = 10.0;

    /// w(u) of equation (1), rad, of a command u, rad.
    pub fn at_waypoints(&self, turn: f64) -> f64 {
        if self.dead_band == 0.0 {
            return turn;
        }
        turn + self.dead_band * turn / (turn.abs() + self.dead_band)
    }

    /// x(v) of equation (2), rad, of a shift command v, rad.
    pub fn shift_at_waypoints(&self, shift: f64) -> f64 {
        if self.shift_limit == 0.0 {
            return 0.0;
        }
        shift * shift.abs() / self.shift_limit
    }
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
        let ways = self.waypoints.iter().map(|waypoint| waypoint.approach);
        let approach = self.pull.as_ref().map(|pull| pull.approach);
        let ways: f64 = ways.chain(approach).map(|way| way.seconds).sum();
        (self.pull_seconds() + ways) * scale.value() + self.rest
    }

    /// How long its pull lasts as the file has it, s; 0 without one.
    pub fn pull_seconds(&self) -> f64 {
        let pull = self.pull.as_ref();
        pull.map_or(0.0, |pull| pull.duration.seconds())
    }

    /// The gait of its pull, under the cycle's name, where there is one.
    pub fn gait(&self) -> Option<Gait> {
        let pull = self.pull.as_ref()?;
        Some(Gait {
            name: self.name.clone(),
            description: self.description.clone(),
            knee: pull.knee.clone(),
            hip: pull.hip.clone(),
            upper_arm: pull.upper_arm.clone(),
            mapping: pull.mapping,
            arm: pull.arm,
            limits: self.limits,
        })
    }

    /// A command with no more of a shift than this cycle takes: what holds a line may ask one of a cycle that
    /// has none, or less.
    #[must_use]
    pub fn shifted_as_far(&self, Steer { turn, shift }: Steer) -> Steer {
        let most = self.steering.as_ref().map_or(0.0, |it| it.shift_limit);
        let shift = shift.clamp(-most, most);
        Steer { turn, shift }
    }

    /// Takes its steering away, with what it adds to the waypoints.
    pub fn forget_steering(&mut self) {
        self.steering = None;
        for waypoint in &mut self.waypoints {
            waypoint.turn.clear();
            waypoint.shift.clear();
        }
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
    fn a_turn_at_waypoints_is_odd_and_rises_with_the_command() {
        let steering = |dead_band: f64| Steering {
            limit: 0.2,
            shift_limit: 0.0,
            dead_band,
            spread: 0.0,
            joints: BTreeMap::new(),
        };
        for dead_band in [0.0, 0.02, 0.1] {
            let steering = steering(dead_band);
            let at = |k: i32| steering.at_waypoints(f64::from(k) * 0.01);
            assert!(at(0).abs() < f64::EPSILON);
            for k in 1..=20 {
                assert!((at(k) + at(-k)).abs() < 1e-15);
                assert!(at(k) > at(k - 1), "{k}");
                let more = at(k) - f64::from(k) * 0.01;
                assert!((0.0..=dead_band).contains(&more), "{more}");
            }
        }
    }

    /// All of it at its largest, none at none, and ever more of it on the way.
    #[test]
    fn a_shift_at_waypoints_is_odd_and_rises_with_the_command() {
        let steering = |shift_limit: f64| Steering {
            limit: 0.2,
            shift_limit,
            dead_band: 0.0,
            spread: 0.0,
            joints: BTreeMap::new(),
        };
        let at = |k: i32| steering(0.2).shift_at_waypoints(f64::from(k) * 0.01);
        assert!(at(0).abs() < f64::EPSILON && (at(20) - 0.2).abs() < 1e-15);
        assert!((at(10) - 0.05).abs() < 1e-15);
        for k in 1..=20 {
            assert!((at(k) + at(-k)).abs() < 1e-15);
            assert!(at(k) > at(k - 1), "{k}");
        }
        assert!(steering(0.0).shift_at_waypoints(0.0).abs() < f64::EPSILON);
    }

    #[test]
    fn limit_time_scales() {
        for value in [f64::NAN, 0.0, -1.0, 0.24, 21.0] {
            assert!(TimeScale::new(value).is_err(), "{value}");
        }
        assert!(TimeScale::new(1.7).is_ok());
    }
}
