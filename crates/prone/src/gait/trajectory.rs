//! From a gait to joint angles that have been checked against a robot's limits.

use super::{Gait, LimitsPolicy};
use crate::chain::{ChainAngles, ChainPosture};
use crate::mapping::{Mapping, MappingError};
use crate::robot::{BeyondCoupled, JointAngles, JointId, Range, Robot};

/// How long one closed-chain phase lasts, s.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct PhaseDuration(f64);

/// A duration that no phase can have.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error(
    "a phase of {seconds} s is outside {}..{} s",
    PhaseDuration::SHORTEST,
    PhaseDuration::LONGEST
)]
pub struct PhaseDurationError {
    /// What was asked for.
    pub seconds: f64,
}

impl PhaseDuration {
    /// Shortest phase, s: two control steps of the original's simulator.
    pub const SHORTEST: f64 = 0.1;
    /// Longest phase, s: far beyond the ten seconds of the published study.
    pub const LONGEST: f64 = 600.0;

    /// A duration in seconds.
    ///
    /// # Errors
    /// [`PhaseDurationError`] outside 0.1 to 600 s, and for NaN.
    pub fn new(seconds: f64) -> Result<Self, PhaseDurationError> {
        if (Self::SHORTEST..=Self::LONGEST).contains(&seconds) {
            Ok(Self(seconds))
        } else {
            Err(PhaseDurationError { seconds })
        }
    }

    /// In seconds.
    pub const fn seconds(self) -> f64 {
        self.0
    }
}

/// One instant of a trajectory.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Phase, 0 to 1.
    pub s: f64,
    /// The closed chain before any clamp.
    pub chain: ChainAngles,
    /// Its joint centres.
    pub posture: ChainPosture,
    /// Turn of the root about +y, rad, with which the chain lies on a level floor.
    pub root_pitch: f64,
    /// Joint angles within the stops.
    pub joints: JointAngles,
}

/// What moves beside the chain at one phase.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Company {
    /// How much further than the mapping has them the arms are spread, rad: left, right.
    pub(super) spread: [f64; 2],
    /// Joints that the chain does not command, rad.
    pub(super) joints: Vec<(JointId, f64)>,
}

/// A joint that a gait with [`LimitsPolicy::Clamp`] stopped at its limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clamp {
    /// Which joint.
    pub joint: JointId,
    /// In how many samples.
    pub samples: usize,
    /// The largest amount cut off, rad, with the sign of the side it was cut on.
    pub largest: f64,
    /// Phase of the first clamped sample.
    pub from: f64,
    /// Phase of the last clamped sample.
    pub to: f64,
}

/// A trajectory all of whose joint angles lie within the stops it was planned for.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedTrajectory {
    duration: PhaseDuration,
    samples: Vec<Sample>,
    clamps: Vec<Clamp>,
}

/// Why a gait gives no trajectory.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TrajectoryError {
    /// The gait's mapping does not fit the robot.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The stops are those of another robot.
    #[error("gait {gait}: {stops} stops are given, robot {robot} has {joints} joints")]
    Stops {
        /// The gait's name.
        gait: String,
        /// How many stops there are.
        stops: usize,
        /// The robot's name.
        robot: String,
        /// How many joints it has.
        joints: usize,
    },
    /// The chain does not close somewhere, or the forearm cannot be pointed.
    #[error("gait {gait}, sample {sample} (s = {s:.3}): {source}")]
    OutOfReach {
        /// The gait's name.
        gait: String,
        /// The sample, from 0.
        sample: usize,
        /// Its phase.
        s: f64,
        /// What is out of reach.
        source: MappingError,
    },
    /// A joint centre of the planned chain would lie below the floor.
    #[error(
        "gait {gait}: the {centre} would be {depth_mm:.1} mm below the floor at sample {sample} (s = {s:.3})"
    )]
    BelowFloor {
        /// The gait's name.
        gait: String,
        /// Which joint centre.
        centre: &'static str,
        /// The sample, from 0.
        sample: usize,
        /// Its phase.
        s: f64,
        /// How far below, mm.
        depth_mm: f64,
    },
    /// A joint passes its limit and the gait's policy is to refuse.
    #[error(
        "gait {gait}: {joint} {angle:.4} rad is outside {lower:.4}..{upper:.4} at sample {sample} (s = {s:.3}), by {excess:.4} rad; \
         `limits = \"clamp\"` in the gait file would stop it there"
    )]
    Limit {
        /// The gait's name.
        gait: String,
        /// The joint's name.
        joint: String,
        /// What the gait asks for, rad.
        angle: f64,
        /// The lower stop, rad.
        lower: f64,
        /// The upper stop, rad.
        upper: f64,
        /// The sample, from 0.
        sample: usize,
        /// Its phase.
        s: f64,
        /// How far outside, rad.
        excess: f64,
    },
    /// A joint passes the limit that another joint's angle sets it, and the policy is to refuse.
    #[error(
        "gait {gait}: {beyond} at sample {sample} (s = {s:.3}); `limits = \"clamp\"` in the gait file would stop it there"
    )]
    Coupled {
        /// The gait's name.
        gait: String,
        /// The sample, from 0.
        sample: usize,
        /// Its phase.
        s: f64,
        /// What lies beyond, boxed as all other errors are smaller.
        beyond: Box<BeyondCoupled>,
    },
}

impl CheckedTrajectory {
    /// Samples a gait at `intervals + 1` equally spaced phases and holds every joint against
    /// `stops`, one per joint of the robot (at least one interval is taken).
    ///
    /// # Errors
    /// [`TrajectoryError`], naming gait, sample, joint and amount.
    pub fn plan(
        robot: &Robot,
        stops: &[Range],
        gait: &Gait,
        duration: PhaseDuration,
        intervals: usize,
    ) -> Result<Self, TrajectoryError> {
        let alone = |_| Company::default();
        Self::plan_in_company(robot, stops, gait, duration, intervals, alone)
    }

    /// [`CheckedTrajectory::plan`] with what else moves at each phase.
    ///
    /// # Errors
    /// [`TrajectoryError`], naming gait, sample, joint and amount.
    pub(super) fn plan_in_company(
        robot: &Robot,
        stops: &[Range],
        gait: &Gait,
        duration: PhaseDuration,
        intervals: usize,
        company: impl Fn(f64) -> Company,
    ) -> Result<Self, TrajectoryError> {
        if stops.len() != robot.joints.len() {
            return Err(TrajectoryError::Stops {
                gait: gait.name.clone(),
                stops: stops.len(),
                robot: robot.name.clone(),
                joints: robot.joints.len(),
            });
        }
        let mapping = Mapping::new(robot, gait.mapping, gait.arm)?;
        let intervals = intervals.max(1);
        let mut samples = Vec::with_capacity(intervals + 1);
        let mut clamps: Vec<Clamp> = Vec::new();
        for sample in 0..=intervals {
            let s = sample as f64 / intervals as f64;
            let out_of_reach = |source| TrajectoryError::OutOfReach {
                gait: gait.name.clone(),
                sample,
                s,
                source,
            };
            let chain = mapping.chain().close(gait.parameters(s));
            let chain = chain.map_err(|open| out_of_reach(open.into()))?;
            let posture = mapping.chain().posture(&chain);
            if let Some((centre, height)) = below_floor(&posture) {
                return Err(TrajectoryError::BelowFloor {
                    gait: gait.name.clone(),
                    centre,
                    sample,
                    s,
                    depth_mm: -height * 1e3,
                });
            }
            let company = company(s);
            let mut joints = mapping
                .spread_joint_angles(robot, &chain, company.spread)
                .map_err(out_of_reach)?;
            for (id, angle) in company.joints {
                joints[id] = angle;
            }
            for (index, (joint, stop)) in robot.joints.iter().zip(stops).enumerate() {
                let id = JointId(index);
                let angle = joints[id];
                if stop.contains(angle) {
                    continue;
                }
                let excess = stop.excess(angle);
                if gait.limits == LimitsPolicy::Refuse || excess.is_nan() {
                    return Err(TrajectoryError::Limit {
                        gait: gait.name.clone(),
                        joint: joint.name.clone(),
                        angle,
                        lower: stop.lower,
                        upper: stop.upper,
                        sample,
                        s,
                        excess: excess.abs(),
                    });
                }
                joints[id] = stop.clamp(angle);
                note(&mut clamps, id, excess, s);
            }
            for limit in &robot.coupled_limits {
                let excess = limit.excess(&joints);
                if excess == 0.0 {
                    continue;
                }
                if gait.limits == LimitsPolicy::Refuse || excess.is_nan() {
                    return Err(TrajectoryError::Coupled {
                        gait: gait.name.clone(),
                        sample,
                        s,
                        beyond: Box::new(limit.beyond(robot, &joints)),
                    });
                }
                limit.clamp(&mut joints);
                note(&mut clamps, limit.joint, excess, s);
            }
            samples.push(Sample {
                s,
                chain,
                posture,
                root_pitch: mapping.root_pitch(&chain),
                joints,
            });
        }
        clamps.sort_by_key(|clamp| clamp.joint);
        Ok(Self {
            duration,
            samples,
            clamps,
        })
    }

    /// How long the phase lasts.
    pub const fn duration(&self) -> PhaseDuration {
        self.duration
    }

    /// The samples, first at s = 0, last at s = 1.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The first sample.
    pub fn first(&self) -> &Sample {
        &self.samples[0]
    }

    /// The last sample.
    pub fn last(&self) -> &Sample {
        &self.samples[self.samples.len() - 1]
    }

    /// Joint angles at phase `s` ∈ [0, 1], rad, between samples on the straight line.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the number of samples; NaN becomes 0"
    )]
    pub fn at(&self, s: f64) -> JointAngles {
        let place = self.place(s);
        let before = (place as usize).min(self.samples.len() - 2);
        let [from, to] = [before, before + 1].map(|sample| &self.samples[sample].joints);
        from.towards(to, place - before as f64)
    }

    /// The sample that is nearest to phase `s` ∈ [0, 1].
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and the number of samples; NaN becomes 0"
    )]
    pub fn nearest(&self, s: f64) -> &Sample {
        &self.samples[self.place(s).round() as usize]
    }

    /// Where phase `s` lies among the samples, counted from the first.
    fn place(&self, s: f64) -> f64 {
        s.clamp(0.0, 1.0) * (self.samples.len() - 1) as f64
    }

    /// What was clamped, by joint.
    pub fn clamps(&self) -> &[Clamp] {
        &self.clamps
    }
}

/// The first joint centre below the floor, toe to shoulder, and its height, m.
fn below_floor(posture: &ChainPosture) -> Option<(&'static str, f64)> {
    let centres = [
        ("ankle", posture.ankle),
        ("knee", posture.knee),
        ("hip", posture.hip),
        ("shoulder", posture.shoulder),
    ];
    centres
        .into_iter()
        .map(|(name, centre)| (name, centre.z()))
        .find(|(_, height)| *height < 0.0)
}

pub(super) fn note(clamps: &mut Vec<Clamp>, joint: JointId, excess: f64, s: f64) {
    match clamps.iter_mut().find(|clamp| clamp.joint == joint) {
        Some(clamp) => {
            clamp.samples += 1;
            clamp.to = s;
            if excess.abs() > clamp.largest.abs() {
                clamp.largest = excess;
            }
        }
        None => clamps.push(Clamp {
            joint,
            samples: 1,
            largest: excess,
            from: s,
            to: s,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_that_no_phase_can_have_are_refused() {
        for seconds in [f64::NAN, -1.0, 0.0, 0.09, 601.0, f64::INFINITY] {
            assert!(PhaseDuration::new(seconds).is_err(), "{seconds}");
        }
        assert!(PhaseDuration::new(5.0).is_ok());
    }
}
