//! Rules that a gait's planned chain, and the joints it is mapped to, have to keep.

use prone::chain::{ChainAngles, GaitParameters};
use prone::cost::graded::{self, Phase, Rule, Rules, Violations};
use prone::gait::{Gait, LimitsPolicy, PhaseDuration};
use prone::mapping::{Mapping, MappingError};
use prone::robot::{Range, Robot};

use crate::gait_sheet;

/// Intervals in which a phase is held against the rules, as in the published objective twice over:
/// on smooth curves the steepest of 200 intervals is within 0.1 % of the steepest point in the
/// middle of a phase, and within 1 % of one at its end.
pub const INTERVALS: usize = 200;

/// Rules for the planned chain.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainRules {
    /// Fastest command of ankle, knee, hip and shoulder, rad per phase; infinite for none.
    pub rate: f64,
    /// What stays above the floor.
    pub clearance: Clearance,
    /// Between what stops each joint of the robot may be commanded, rad; `None` grades no joint.
    pub stops: Option<Vec<Range>>,
}

/// By how much a joint may pass [`widened_stops`], rad: the published gaits print five digits of the
/// same first pose, which is 1e-5 rad in the ankle.
const STOP_TOLERANCE: f64 = 2e-5;

/// The manufacturer's stops, widened to where a gait commands its joints: what gaits about it can
/// keep. A regime may move stops so that no joint leans on them, but nothing is planned to go there.
///
/// A gait whose joints stay within the stops, or must, widens nothing. Where one is clamped, as the
/// published ones are in the ankle, gaits about it may be: the same joints, no further, at any phase.
pub fn widened_stops(robot: &Robot, gait: &Gait) -> Result<Vec<Range>, MappingError> {
    let mapping = Mapping::new(robot, gait.mapping, gait.arm)?;
    let stops = robot.stops();
    let mut widened = stops.clone();
    if gait.limits == LimitsPolicy::Refuse {
        return Ok(widened);
    }
    for sample in samples(gait, INTERVALS) {
        let Ok(angles) = mapping.chain().close(sample) else {
            continue;
        };
        let Ok(joints) = mapping.joint_angles(robot, &angles) else {
            continue;
        };
        for (range, &angle) in widened.iter_mut().zip(joints.as_slice()) {
            range.lower = range.lower.min(angle);
            range.upper = range.upper.max(angle);
        }
    }
    for (range, stop) in widened.iter_mut().zip(&stops) {
        if range.lower < stop.lower {
            range.lower -= STOP_TOLERANCE;
        }
        if range.upper > stop.upper {
            range.upper += STOP_TOLERANCE;
        }
    }
    Ok(widened)
}

/// What of the planned robot stays how high.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Clearance {
    /// Nothing is asked.
    Free,
    /// The hip's centre, m.
    Hip(f64),
    /// The lowest point of trunk, head and legs, by the robot's own shapes, m.
    Body(f64),
}

impl ChainRules {
    /// No rules.
    pub const FREE: Self = Self {
        rate: f64::INFINITY,
        clearance: Clearance::Free,
        stops: None,
    };

    /// What a gait breaks.
    pub fn broken(
        &self,
        robot: &Robot,
        mapping: &Mapping,
        gait: &Gait,
        duration: PhaseDuration,
    ) -> Violations {
        let chain = mapping.chain();
        let (clearance, body) = match self.clearance {
            Clearance::Free => (0.0, false),
            Clearance::Hip(height) => (height, false),
            Clearance::Body(height) => (height, true),
        };
        let height = |angles: &ChainAngles| {
            if !body {
                return chain.posture(angles).hip.z();
            }
            // A forearm that cannot point forward is refused when the gait gets its cost.
            mapping
                .joint_angles(robot, angles)
                .map_or(f64::INFINITY, |joints| {
                    let poses = gait_sheet::planned_poses(robot, mapping, angles, &joints);
                    gait_sheet::body_bottom(robot, &poses)
                })
        };
        let rules = Rules {
            clearance,
            height,
            rate: self.rate / duration.seconds(),
        };
        let samples = samples(gait, INTERVALS);
        let mut violations = graded::violations(chain, phase(&samples, duration), &rules);
        if let Some(stops) = &self.stops {
            for angles in samples.iter().filter_map(|&at| chain.close(at).ok()) {
                match mapping.joint_angles(robot, &angles) {
                    Ok(joints) => violations.add_limits(joints.as_slice(), stops),
                    // The forearm cannot point forward: no robot, no torque.
                    Err(_) => violations.add(Rule::Torque, 1.0),
                }
            }
        }
        violations
    }
}

/// Gait parameters at equal intervals of the phase.
pub(super) fn samples(gait: &Gait, intervals: usize) -> Vec<GaitParameters> {
    let phase = |k: usize| k as f64 / intervals as f64;
    (0..=intervals).map(|k| gait.parameters(phase(k))).collect()
}

pub(super) fn phase(samples: &[GaitParameters], duration: PhaseDuration) -> Phase<'_> {
    Phase {
        samples,
        interval: duration.seconds() / (samples.len() - 1) as f64,
    }
}
