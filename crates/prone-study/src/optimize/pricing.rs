//! What it takes to price a gait: a source of torques, and rules that its planned chain keeps.

use prone::chain::{ChainAngles, ClosedChain, GaitParameters};
use prone::cost::graded::{self, Per, Phase, Price, Rule, Rules, Violations};
use prone::gait::{Gait, LimitsPolicy, PhaseDuration};
use prone::mapping::{Mapping, MappingError};
use prone::robot::{Range, Robot};

use crate::gait_sheet;

/// Prices gaits of one mapping.
pub trait Pricing: Sync {
    /// The price as a search needs it: what is already beaten by its violations may lack a torque
    /// part. Depends on nothing but the gait.
    fn price(&self, gait: &Gait) -> Price;

    /// The price with a torque part wherever there can be one, whatever rules are broken.
    fn quote(&self, gait: &Gait) -> Price {
        self.price(gait)
    }
}

/// Intervals in which a phase is held against the rules, as in the published objective twice over:
/// on smooth curves the steepest of 200 intervals is within 0.1 % of the steepest point in the middle of a phase, and
/// within 1 % of one at its end.
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

/// By how much a joint may pass the stops of [`reach`], rad: the published gaits print five digits
/// of the same first pose, which is 1e-5 rad in the ankle.
const STOP_TOLERANCE: f64 = 2e-5;

/// The maker's stops, widened to where a gait commands its joints: what gaits about it can keep. A
/// regime may move stops so that no joint leans on them, but nothing is planned to go there.
///
/// A gait whose joints stay within the stops, or must, widens nothing. One that is clamped somewhere, as the
/// published ones are in the ankle, may be so in the gaits about it: the same joints, no further, at any phase.
///
/// # Errors
/// [`MappingError`].
pub fn reach(robot: &Robot, gait: &Gait) -> Result<Vec<Range>, MappingError> {
    let mapping = Mapping::new(robot, gait.mapping, gait.arm)?;
    let stops = robot.stops();
    let mut reach = stops.clone();
    if gait.limits == LimitsPolicy::Refuse {
        return Ok(reach);
    }
    for sample in samples(gait, INTERVALS) {
        let Ok(angles) = mapping.chain().close(sample) else {
            continue;
        };
        let Ok(joints) = mapping.joint_angles(robot, &angles) else {
            continue;
        };
        for (range, &angle) in reach.iter_mut().zip(joints.as_slice()) {
            range.lower = range.lower.min(angle);
            range.upper = range.upper.max(angle);
        }
    }
    for (range, stop) in reach.iter_mut().zip(&stops) {
        if range.lower < stop.lower {
            range.lower -= STOP_TOLERANCE;
        }
        if range.upper > stop.upper {
            range.upper += STOP_TOLERANCE;
        }
    }
    Ok(reach)
}

/// What of the planned robot stays how high.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Clearance {
    /// Nothing is asked.
    Free,
    /// The hip's centre, m.
    Hip(f64),
    /// The lowest point of trunk and legs, by the robot's own shapes, m.
    Body(f64),
}

impl ChainRules {
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
            // A forearm that cannot point forward is refused when the gait is priced.
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

/// How far the shoulder of the planned chain advances, m.
pub(super) fn advance(chain: &ClosedChain, gait: &Gait) -> f64 {
    let arm = |s: f64| gait.upper_arm.value(s).cos();
    chain.shoulder_to_elbow * (arm(0.0) - arm(1.0))
}

/// A gait that has no price per metre.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AdvanceError {
    /// Its mapping does not fit the robot.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The ends of its upper arm's curve do not carry the shoulder forward.
    #[error(
        "gait {gait} has no price per metre: its shoulder advances {advance_mm:.1} mm in a pull"
    )]
    NoAdvance {
        /// The gait's name.
        gait: String,
        /// Planned advance, mm.
        advance_mm: f64,
    },
}

/// Shortest advance that a price is divided by, m.
const SHORTEST_ADVANCE: f64 = 1e-3;

/// Whether a gait, and with it every one whose upper arm has the same ends, has a price per metre.
///
/// # Errors
/// [`AdvanceError`].
pub fn check_advance(robot: &Robot, gait: &Gait) -> Result<(), AdvanceError> {
    let mapping = Mapping::new(robot, gait.mapping, gait.arm)?;
    let advance = advance(mapping.chain(), gait);
    if advance >= SHORTEST_ADVANCE {
        return Ok(());
    }
    Err(AdvanceError::NoAdvance {
        gait: gait.name.clone(),
        advance_mm: advance * 1e3,
    })
}

/// Whether a price is per phase or per metre of planned advance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Share {
    /// One phase.
    Phase,
    /// One metre.
    Metre,
}

impl Share {
    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Phase => "phase",
            Self::Metre => "metre",
        }
    }

    /// What the torque part of a gait is divided by.
    pub(super) fn of(self, chain: &ClosedChain, gait: &Gait) -> Per {
        match self {
            Self::Phase => Per::Phase,
            Self::Metre => Per::Metre {
                advance: advance(chain, gait),
            },
        }
    }
}
