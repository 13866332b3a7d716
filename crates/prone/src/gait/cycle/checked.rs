//! A cycle held against a robot: the only thing that a crawl commands.

use std::sync::Arc;

use super::super::{CheckedTrajectory, Clamp};
use super::{Approach, CycleError, Steer};
use crate::robot::{CoupledLimit, JointAngles, Range};

/// A cycle whose every posture lies within the stops it was planned for and whose every joint
/// speed lies within the robot's limits.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedCycle {
    pub(super) name: String,
    pub(super) steer: Steer,
    pub(super) pull: Option<CheckedTrajectory>,
    /// The posture in which it begins.
    pub(super) extension: JointAngles,
    /// Turn of the root about +y there, rad.
    pub(super) root_pitch: f64,
    /// The way to the extension, waypoint by waypoint.
    pub(super) stretches: Vec<Stretch>,
    /// By how much the turn has moved each joint at the end of the pull, rad; 0 for those that the
    /// recovery puts back at once.
    pub(super) aside: Vec<f64>,
    pub(super) stops: Vec<Range>,
    pub(super) clamps: Vec<Clamp>,
    pub(super) fastest: FastestJoint,
    pub(super) speed_limits: Vec<(String, f64)>,
    pub(super) coupled: Arc<[CoupledLimit]>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Stretch {
    pub(super) name: String,
    pub(super) approach: Approach,
    /// Where each joint goes, rad; `None` where it stays.
    pub(super) targets: Vec<Option<f64>>,
}

/// The joint that comes nearest to its speed limit.
#[derive(Debug, Clone, PartialEq)]
pub struct FastestJoint {
    /// The manufacturer's name.
    pub joint: String,
    /// Its largest commanded speed, rad/s.
    pub speed: f64,
    /// The manufacturer's limit, rad/s.
    pub limit: f64,
}

/// The way along the waypoints from a given posture, over time.
#[derive(Debug, Clone, PartialEq)]
pub struct RecoveryPath {
    from: JointAngles,
    legs: Vec<(Approach, JointAngles)>,
    coupled: Arc<[CoupledLimit]>,
}

impl CheckedCycle {
    /// The cycle's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The turn command, rad.
    pub const fn turn(&self) -> f64 {
        self.steer.turn
    }

    /// What it is steered by, rad.
    pub const fn steer(&self) -> Steer {
        self.steer
    }

    /// The posture in which it begins.
    pub const fn extension(&self) -> &JointAngles {
        &self.extension
    }

    /// Turn of the root about +y in the extension, on level ground, rad: of the closed chain; of a
    /// cycle without a pull that of a trunk that lies flat on the belly.
    pub const fn root_pitch(&self) -> f64 {
        self.root_pitch
    }

    /// The posture from which it goes along its waypoints: that of the end of its pull, or the
    /// extension.
    pub fn compression(&self) -> &JointAngles {
        let pull = self.pull.as_ref();
        pull.map_or(&self.extension, |pull| &pull.last().joints)
    }

    /// The closed-chain phase, where there is one.
    pub const fn pull(&self) -> Option<&CheckedTrajectory> {
        self.pull.as_ref()
    }

    /// How long the pull lasts, s; 0 without one.
    pub fn pull_seconds(&self) -> f64 {
        let pull = self.pull.as_ref();
        pull.map_or(0.0, |pull| pull.duration().seconds())
    }

    /// Joint angles at a time since the pull began, s, rad.
    pub fn pull_at(&self, seconds: f64) -> JointAngles {
        let pull = self.pull.as_ref();
        pull.map_or_else(
            || self.extension.clone(),
            |pull| pull.at(seconds / pull.duration().seconds()),
        )
    }

    /// How long the recovery lasts, s.
    pub fn recovery_seconds(&self) -> f64 {
        let stretches = self.stretches.iter();
        stretches.map(|stretch| stretch.approach.seconds).sum()
    }

    /// Names of the recovery's stretches, each with the time at which it ends, s.
    pub fn recovery_ends(&self) -> Vec<(&str, f64)> {
        let mut end = 0.0;
        let stretches = self.stretches.iter().map(|stretch| {
            end += stretch.approach.seconds;
            (stretch.name.as_str(), end)
        });
        stretches.collect()
    }

    /// The way to this cycle's extension from where the pull of `previous`, planned for the same
    /// robot and stops, has ended.
    ///
    /// # Errors
    /// [`CycleError::Speed`] where a joint would have to be too fast, [`CycleError::OtherRobot`]
    /// where the robots have not equally many joints.
    pub fn recovery_after(&self, previous: &Self) -> Result<RecoveryPath, CycleError> {
        let (joints, others) = (self.speed_limits.len(), previous.speed_limits.len());
        if joints != others {
            return Err(CycleError::OtherRobot {
                cycle: self.name.clone(),
                joints,
                previous: previous.name.clone(),
                others,
            });
        }
        let path = self.path(previous);
        self.recovery_speed(&path)?;
        Ok(path)
    }

    pub(super) fn path(&self, previous: &Self) -> RecoveryPath {
        let from = previous.compression().clone();
        let planted = previous.pull.is_some() && self.stretches.len() > 1;
        let mut posture = from.clone();
        let legs = self.stretches.iter().enumerate().map(|(index, stretch)| {
            posture = posture.map(|joint, now| match stretch.targets[joint.0] {
                None => now,
                // At the first waypoint the arms are still planted where the last turn has put them.
                Some(to) if index == 0 && planted => {
                    self.stops[joint.0].clamp(to + previous.aside[joint.0])
                }
                Some(to) => to,
            });
            (stretch.approach, posture.clone())
        });
        let legs = legs.collect();
        RecoveryPath {
            from,
            legs,
            coupled: Arc::clone(&self.coupled),
        }
    }

    /// What was clamped, by joint. A waypoint that is beyond a stop counts as a sample at phase 1; what is
    /// beyond a limit by another joint has the share of the recovery at which it is so.
    pub fn clamps(&self) -> &[Clamp] {
        &self.clamps
    }

    /// The joint that comes nearest to its speed limit.
    pub const fn fastest(&self) -> &FastestJoint {
        &self.fastest
    }

    pub(super) fn pull_speed(&self) -> Result<FastestJoint, CycleError> {
        let Some(pull) = &self.pull else {
            return Ok(self.fastest.clone());
        };
        let samples = pull.samples();
        let step = pull.duration().seconds() / (samples.len() - 1) as f64;
        let mut fastest = vec![0.0_f64; self.speed_limits.len()];
        for pair in samples.windows(2) {
            let ways = pair[0].joints.pairs(&pair[1].joints);
            for (fastest, (from, to)) in fastest.iter_mut().zip(ways) {
                *fastest = fastest.max((to - from).abs() / step);
            }
        }
        self.within_speeds("pull", &fastest)
    }

    pub(super) fn recovery_speed(&self, path: &RecoveryPath) -> Result<FastestJoint, CycleError> {
        let mut nearest = self.fastest.clone();
        let mut from = &path.from;
        for (stretch, (approach, to)) in self.stretches.iter().zip(&path.legs) {
            let mean = approach.easing.peak_speed() / approach.seconds;
            let ways = from.pairs(to);
            let speeds: Vec<f64> = ways.map(|(from, to)| mean * (to - from).abs()).collect();
            let fastest = self.within_speeds(&stretch.name, &speeds)?;
            if fastest.share() > nearest.share() {
                nearest = fastest;
            }
            from = to;
        }
        Ok(nearest)
    }

    /// The joint of largest speed over limit; an error where it is over.
    fn within_speeds(&self, place: &str, speeds: &[f64]) -> Result<FastestJoint, CycleError> {
        let joints = self.speed_limits.iter().zip(speeds);
        let fastest = joints
            .map(|((joint, limit), &speed)| FastestJoint {
                joint: joint.clone(),
                speed,
                limit: *limit,
            })
            // NaN of either sign is above all numbers.
            .max_by(|a, b| a.share().abs().total_cmp(&b.share().abs()));
        let fastest = fastest.unwrap_or_else(|| self.fastest.clone());
        let within = fastest.share() <= 1.0;
        if !within {
            return Err(CycleError::Speed {
                cycle: self.name.clone(),
                place: place.to_owned(),
                joint: fastest.joint,
                speed: fastest.speed,
                limit: fastest.limit,
            });
        }
        Ok(fastest)
    }
}

impl FastestJoint {
    /// Speed over limit.
    pub fn share(&self) -> f64 {
        self.speed / self.limit
    }
}

impl RecoveryPath {
    /// When each waypoint is reached, and at last the next extension, s since the recovery began.
    pub fn ends(&self) -> impl Iterator<Item = f64> {
        self.legs.iter().scan(0.0, |end, (approach, _)| {
            *end += approach.seconds;
            Some(*end)
        })
    }

    /// Joint angles at a time since the recovery began, s, rad.
    pub fn at(&self, seconds: f64) -> JointAngles {
        let mut posture = self.straight(seconds);
        for limit in self.coupled.iter() {
            limit.clamp(&mut posture);
        }
        posture
    }

    /// The same without limits that depend on another joint.
    pub(super) fn straight(&self, seconds: f64) -> JointAngles {
        let mut begin = 0.0;
        let mut from = &self.from;
        for (approach, to) in &self.legs {
            let share = (seconds - begin) / approach.seconds;
            if share < 1.0 {
                return from.towards(to, approach.easing.share(share));
            }
            begin += approach.seconds;
            from = to;
        }
        from.clone()
    }
}
