//! What the costs of pulls are made of: what was asked for, completed by what the robot does.

use std::sync::Arc;

use prone::chain::ClosedChain;
use prone::cost::graded;
use prone::cost::objective::Objective;
use prone::cost::published::{PublishedRules, WEIGHTS};
use prone::gait::{Gait, PhaseDuration};
use prone::mapping::{ArmMode, Mapping, MappingError, MappingVariant};
use prone::robot::Robot;
use prone::torque_map::{self, TorqueMap};
use prone_files::gait_file;
use prone_record::experiment::{
    BodyShareOf, ClearanceChoice, Limit, LimitsChoice, PullCostChoice, PullObjective, PullRules,
    TextError, TorqueChoice,
};
use prone_record::program::RobotInfo;
use prone_record::search_plan::{GradedPlan, PullAimPlan, PullCostPlan, SourcePlan};
use prone_sim::pull::{self, Keep, PullError, Start};
use prone_sim::{LoadedRobot, World};

use super::chain_rules::{self, ChainRules, Clearance, samples};
use super::pull_error::{HEAVIEST, PullCostError};
use super::pull_trial;

pub use prone_record::experiment::Share;

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PullAim {
    /// The published cost: violated samples, then torque.
    Published(PublishedRules),
    /// Torque, with violations graded and kept apart.
    Graded(Objective),
}

/// Where torques come from.
#[derive(Debug, Clone)]
pub enum Source {
    /// A table of them.
    Map {
        /// The table.
        map: Arc<TorqueMap>,
        /// Its file, as the user named it.
        file: String,
        /// Of the file's text.
        sha256: String,
    },
    /// The static solver.
    Statics,
    /// A simulation of each gait.
    Dynamics,
}

/// Everything that decides a cost.
#[derive(Debug, Clone)]
pub struct PullTerms {
    /// What is minimised.
    pub aim: PullAim,
    /// Where torques come from.
    pub source: Source,
    /// The gait whose mapping, arms and ends hold.
    pub base: Gait,
    /// Per phase or per metre.
    pub share: Share,
    /// What the planned chain keeps to.
    pub rules: ChainRules,
    /// How long a pull lasts. A phase of equal postures costs in proportion to it.
    pub duration: PhaseDuration,
    /// Largest share of the weight on trunk, head and legs in simulation, 0 to 1.
    pub body_share: f64,
    /// The gait whose share that is, where it is one's.
    pub body_share_of: Option<String>,
}

/// How long a pull of the published objective lasts, s. It costs the same at any duration, and is
/// commanded at this one where its stops are looked at.
const PUBLISHED_DURATION_S: f64 = 3.0;

impl PullTerms {
    /// Completes what was asked for in a world: by the base gait's heights and stops, and by the share
    /// of the weight of the gait that is the limit.
    pub fn new(choice: &PullCostChoice, world: &World) -> Result<Self, PullCostError> {
        let base = choice.base.parse(gait_file::parse)?;
        let source = Source::new(&choice.source)?;
        let (objective, rules) = match choice.objective {
            PullObjective::Published {
                hip_threshold_mm,
                limit_tolerance_rad,
            } => {
                let not_negative = (0.0, f64::MAX);
                Limit::check("a height", " mm", hip_threshold_mm, not_negative)?;
                Limit::check("a tolerance", " rad", limit_tolerance_rad, not_negative)?;
                let published = PublishedRules {
                    hip_threshold: hip_threshold_mm / 1e3,
                    limit_tolerance: limit_tolerance_rad,
                };
                return Ok(Self {
                    aim: PullAim::Published(published),
                    source,
                    base,
                    share: Share::Phase,
                    rules: ChainRules::FREE,
                    duration: PhaseDuration::new(PUBLISHED_DURATION_S)?,
                    body_share: 1.0,
                    body_share_of: None,
                });
            }
            PullObjective::Torque { weights, rules } => {
                let weighs = weights.iter().all(|it| (0.0..=HEAVIEST).contains(it));
                if !weighs || weights.iter().all(|it| *it <= 0.0) {
                    return Err(PullCostError::Weights { weights });
                }
                (Objective::Torque { weights }, rules)
            }
            PullObjective::Peak { rules } => (Objective::Peak, rules),
            PullObjective::Heat { rules } => (Objective::Heat, rules),
        };
        rules.check()?;
        if objective == Objective::Peak && rules.per == Share::Metre {
            return Err(PullCostError::PeakPerMetre);
        }
        let duration = PhaseDuration::new(rules.duration_s)?;
        if rules.per == Share::Metre {
            check_advance(world.robot(), &base)?;
        }
        let (body_share, body_share_of) = match &choice.source {
            TorqueChoice::Dynamics { body_share_of } => {
                let gait = match body_share_of {
                    BodyShareOf::Gait(gait) => gait.parse(gait_file::parse)?,
                    BodyShareOf::Usual(gait) => {
                        let usual = gait.parse(gait_file::parse)?;
                        let followed = can_follow(world.robot(), &usual);
                        if followed { usual } else { base.clone() }
                    }
                };
                (self::body_share(world, &gait, duration)?, Some(gait.name))
            }
            TorqueChoice::Statics | TorqueChoice::Map(_) => (1.0, None),
        };
        Ok(Self {
            aim: PullAim::Graded(objective),
            source,
            share: rules.per,
            rules: chain_rules(&rules, world, &base)?,
            base,
            duration,
            body_share,
            body_share_of,
        })
    }

    /// What was asked for and found out, as the plan of a search says it.
    pub fn plan(&self, world: &World, robot: &LoadedRobot) -> PullCostPlan {
        let graded = |weights| GradedPlan {
            weights,
            rules: PullRules {
                per: self.share,
                duration_s: self.duration.seconds(),
                rate_deg_per_phase: Some(self.rules.rate.to_degrees())
                    .filter(|rate| rate.is_finite()),
                clearance: match self.rules.clearance {
                    Clearance::Free => ClearanceChoice::None,
                    Clearance::Hip(height) => ClearanceChoice::HipMm(height * 1e3),
                    Clearance::Body(height) => ClearanceChoice::BodyMm(height * 1e3),
                },
                limits: match self.rules.stops {
                    None => LimitsChoice::None,
                    Some(_) => LimitsChoice::Base,
                },
            },
            body_share_of: self.body_share_of.clone(),
            body_share_percent: self.body_share_of.as_ref().map(|_| self.body_share * 100.0),
            regime: world.regime().name.to_owned(),
            start: "the gait's own first pose, settled".to_owned(),
        };
        PullCostPlan {
            aim: match self.aim {
                PullAim::Published(rules) => PullAimPlan::Published {
                    hip_threshold_mm: rules.hip_threshold * 1e3,
                    limit_tolerance_rad: rules.limit_tolerance,
                },
                PullAim::Graded(Objective::Torque { weights }) => {
                    PullAimPlan::Torque(graded(Some(weights)))
                }
                PullAim::Graded(Objective::Peak) => PullAimPlan::Peak(graded(None)),
                PullAim::Graded(Objective::Heat) => PullAimPlan::Heat(graded(None)),
            },
            source: match &self.source {
                Source::Map { file, sha256, .. } => SourcePlan::Map {
                    file: file.clone(),
                    sha256: sha256.clone(),
                },
                other => SourcePlan::Named(other.name().to_owned()),
            },
            from: self.base.name.clone(),
            mapping: self.base.mapping.name().to_owned(),
            arm: self.base.arm.name().to_owned(),
            robot: RobotInfo::of(robot.robot(), robot.files()),
        }
    }
}

/// Whether a robot has what a gait's mapping and arms need.
pub fn can_follow(robot: &Robot, gait: &Gait) -> bool {
    let mapped = match gait.mapping {
        MappingVariant::Original => robot.chain.published.is_some(),
        MappingVariant::Exact => true,
    };
    let armed = match gait.arm {
        ArmMode::Fixed => robot.chain.fixed_arm.is_some(),
        ArmMode::FlatForearm => true,
    };
    mapped && armed
}

fn chain_rules(rules: &PullRules, world: &World, base: &Gait) -> Result<ChainRules, MappingError> {
    Ok(ChainRules {
        rate: rules
            .rate_deg_per_phase
            .map_or(f64::INFINITY, f64::to_radians),
        clearance: match rules.clearance {
            ClearanceChoice::None => Clearance::Free,
            ClearanceChoice::Base => lowest_hip(world, base)?,
            ClearanceChoice::HipMm(mm) => Clearance::Hip(mm / 1e3),
            ClearanceChoice::BodyMm(mm) => Clearance::Body(mm / 1e3),
        },
        stops: match rules.limits {
            LimitsChoice::None => None,
            LimitsChoice::Base => Some(chain_rules::widened_stops(world.robot(), base)?),
        },
    })
}

/// By what a gait's cost is divided.
pub(super) fn per(share: Share, chain: &ClosedChain, gait: &Gait) -> graded::Per {
    match share {
        Share::Phase => graded::Per::Phase,
        Share::Metre => graded::Per::Metre {
            advance: advance(chain, gait),
        },
    }
}

impl PullAim {
    /// The torque objective, the published one's weights included.
    pub const fn objective(&self) -> Objective {
        match self {
            Self::Graded(objective) => *objective,
            Self::Published(_) => Objective::Torque { weights: WEIGHTS },
        }
    }
}

impl Source {
    fn new(choice: &TorqueChoice) -> Result<Self, PullCostError> {
        match choice {
            TorqueChoice::Statics => Ok(Self::Statics),
            TorqueChoice::Dynamics { .. } => Ok(Self::Dynamics),
            TorqueChoice::Map(text) => {
                let map = torque_map::parse(text.checked().map_err(TextError::from)?);
                Ok(Self::Map {
                    map: Arc::new(map.map_err(|source| PullCostError::Map {
                        file: text.file.clone(),
                        source,
                    })?),
                    file: text.file.clone(),
                    sha256: text.sha256.clone(),
                })
            }
        }
    }

    /// In a word: of a file its name, wherever it is.
    pub fn name(&self) -> &str {
        match self {
            Self::Map { file, .. } => {
                let name = std::path::Path::new(file).file_name();
                name.and_then(|name| name.to_str()).unwrap_or(file)
            }
            Self::Statics => "statics",
            Self::Dynamics => "dynamics",
        }
    }
}

/// How far the shoulder of the planned chain advances, m.
fn advance(chain: &ClosedChain, gait: &Gait) -> f64 {
    let arm = |s: f64| gait.upper_arm.value(s).cos();
    chain.shoulder_to_elbow * (arm(0.0) - arm(1.0))
}

/// Shortest advance that a cost is divided by, m.
const SHORTEST_ADVANCE: f64 = 1e-3;

/// Whether a gait, and with it every one whose upper arm has the same ends, has a cost per metre.
pub fn check_advance(robot: &Robot, gait: &Gait) -> Result<(), PullCostError> {
    let mapping = Mapping::new(robot, gait.mapping, gait.arm)?;
    let advance = advance(mapping.chain(), gait);
    if advance >= SHORTEST_ADVANCE {
        return Ok(());
    }
    Err(PullCostError::NoAdvance {
        gait: gait.name.clone(),
        advance_mm: advance * 1e3,
    })
}

/// What a hip may be lower than the base gait's, m: the published gaits print five digits of the
/// same first pose, which is 5e-7 m.
const HIP_TOLERANCE: f64 = 1e-5;

/// The lowest hip of a gait's planned chain, m: a clearance that gaits about it can keep.
pub fn lowest_hip(world: &World, gait: &Gait) -> Result<Clearance, MappingError> {
    let mapping = Mapping::new(world.robot(), gait.mapping, gait.arm)?;
    let chain = mapping.chain();
    let heights = samples(gait, chain_rules::INTERVALS)
        .into_iter()
        .filter_map(|at| chain.close(at).ok())
        .map(|angles| chain.posture(&angles).hip.z());
    let lowest = heights.fold(f64::INFINITY, f64::min);
    Ok(Clearance::Hip(lowest - HIP_TOLERANCE))
}

/// The share of the weight on trunk, head and legs in a gait's simulated pull, 0 to 1.
///
/// # Errors
/// [`PullError`] where it cannot be simulated.
pub fn body_share(world: &World, gait: &Gait, duration: PhaseDuration) -> Result<f64, PullError> {
    let pull = pull::run(world, gait, duration, Start::FirstPose, Keep::Rows)?;
    Ok(pull_trial::body_share(&pull))
}
