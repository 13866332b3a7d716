//! From what is to be minimised, and by what it is measured, to something that prices gaits.

use prone::cost::graded::{Price, Rule};
use prone::cost::published::{PublishedObjective, PublishedRules};
use prone::gait::{Gait, PhaseDuration};
use prone::mapping::{ArmMode, Mapping, MappingError};
use prone::statics::{Stance, StaticTorques, SupportRule, SymmetryError};
use prone::torque_map::TorqueMap;
use prone_record::gait_search::{Broken, Priced};
use prone_sim::World;

use super::dynamic::{DynamicPricing, DynamicSetup, TrialError};
use super::pricing::{Pricing, Share};
use super::published_problem::{self, PublishedProblem, PublishedProblemError};
use super::rules::{self, ChainRules, Clearance};
use super::static_pricing::StaticPricing;
use crate::torque_map::{NodeGrid, NodeGridError};
use prone::cost::objective::{NoMotor, Objective};

/// Grid of the table that the statics fills for the published objective: the finer published one,
/// with θ4 up to where the published gaits go (Bell 2015, table 2: 27.5°), degrees.
const STEP_DEG: f64 = 2.5;
const THETA4_MAX_DEG: f64 = 27.5;

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Aim {
    /// The published cost: violated samples, then torque.
    Published(PublishedRules),
    /// Torque, with violations graded and kept apart.
    Graded(Objective),
}

/// Where torques come from.
#[derive(Debug, Clone, Copy)]
pub enum Source<'a> {
    /// A table of them.
    Map(&'a TorqueMap),
    /// The static solver.
    Statics,
    /// A simulation of each gait.
    Dynamics,
}

/// Everything that decides a price.
#[derive(Debug, Clone)]
pub struct Terms<'a> {
    /// What is minimised.
    pub aim: Aim,
    /// Where torques come from.
    pub source: Source<'a>,
    /// The gait whose mapping, arms and ends hold.
    pub base: &'a Gait,
    /// Per phase or per metre.
    pub share: Share,
    /// What the planned chain keeps to.
    pub rules: ChainRules,
    /// How long a pull lasts.
    pub duration: PhaseDuration,
    /// Largest share of the weight on trunk and legs in simulation, 0 to 1.
    pub body_share: f64,
}

/// Something that prices gaits.
pub enum Pricer<'a> {
    /// By the published objective.
    Published {
        /// As published.
        objective: Box<PublishedObjective>,
        /// As it is searched.
        problem: Box<PublishedProblem>,
    },
    /// With graded violations.
    Graded(Box<dyn Pricing + 'a>),
}

/// Why gaits cannot be priced so.
#[derive(Debug, thiserror::Error)]
pub enum PricerError {
    /// The published objective cannot be made.
    #[error(transparent)]
    Published(#[from] PublishedProblemError),
    /// There is no grid to measure a table on, which constants exclude.
    #[error(transparent)]
    Grid(#[from] NodeGridError),
    /// It looks torques up; a simulation of a whole gait has no table.
    #[error(
        "the objective `published` looks torques up in a table; its source is a file or `statics`"
    )]
    PublishedNeedsTable,
    /// The robot lacks what the objective needs.
    #[error(transparent)]
    NoMotor(#[from] NoMotor),
    /// The base gait's mapping does not fit the robot.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The statics needs a mirrored robot.
    #[error(transparent)]
    Symmetry(#[from] SymmetryError),
}

/// A gait that the published objective cannot price.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "gait {gait} has a curve that is no polynomial of degree 3 or less, and the objective `published` prices nothing else"
)]
pub struct NotCubic {
    /// The gait's name.
    pub gait: String,
}

/// The pricing of gaits in one world.
///
/// # Errors
/// [`PricerError`].
pub fn pricer<'a>(world: &'a World, terms: &Terms<'a>) -> Result<Pricer<'a>, PricerError> {
    match terms.aim {
        Aim::Published(rules) => published(world, terms, rules),
        Aim::Graded(objective) => graded(world, terms, objective).map(Pricer::Graded),
    }
}

fn published<'a>(
    world: &'a World,
    terms: &Terms<'a>,
    rules: PublishedRules,
) -> Result<Pricer<'a>, PricerError> {
    let robot = world.robot();
    let measured;
    let map = match terms.source {
        Source::Map(map) => map,
        Source::Statics => {
            let grid = NodeGrid::new(STEP_DEG, THETA4_MAX_DEG)?;
            measured = TorqueMap::measure(*grid.grid(), &statics(world, terms.base)?);
            &measured
        }
        Source::Dynamics => return Err(PricerError::PublishedNeedsTable),
    };
    Ok(Pricer::Published {
        objective: Box::new(published_problem::objective(robot, map, rules)?),
        problem: Box::new(PublishedProblem::new(robot, map, rules)?),
    })
}

fn graded<'a>(
    world: &'a World,
    terms: &Terms<'a>,
    objective: Objective,
) -> Result<Box<dyn Pricing + 'a>, PricerError> {
    let robot = world.robot();
    let Terms {
        base,
        share,
        rules,
        duration,
        body_share,
        ..
    } = terms.clone();
    let norm = objective.norm(robot)?;
    Ok(match terms.source {
        Source::Map(map) => Box::new(StaticPricing::new(
            robot, base, map, norm, share, rules, duration,
        )?),
        Source::Statics => Box::new(StaticPricing::new(
            robot,
            base,
            statics(world, base)?,
            norm,
            share,
            rules,
            duration,
        )?),
        Source::Dynamics => Box::new(DynamicPricing::new(
            world,
            base,
            DynamicSetup {
                norm,
                share,
                rules,
                duration,
                body_share,
            },
        )?),
    })
}

/// The statics of gaits with the base's mapping and arms. Flat forearms rest on their elbows.
fn statics<'a>(world: &'a World, base: &Gait) -> Result<StaticTorques<'a>, PricerError> {
    let supports = match base.arm {
        ArmMode::FlatForearm => SupportRule::ElbowNotHand,
        ArmMode::Fixed => SupportRule::AnyShape,
    };
    let mapping = Mapping::new(world.robot(), base.mapping, base.arm)?;
    let stance = Stance::unsqueezed(supports);
    Ok(StaticTorques::new(
        world.robot(),
        mapping,
        world.stops(),
        stance,
    )?)
}

/// What a hip may be lower than the base gait's, m: the published gaits print five digits of the
/// same first pose, which is 5e-7 m.
const HIP_TOLERANCE: f64 = 1e-5;

/// The lowest hip of a gait's planned chain, m: a clearance that gaits about it can keep.
///
/// # Errors
/// [`MappingError`].
pub fn lowest_hip(world: &World, gait: &Gait) -> Result<Clearance, MappingError> {
    let mapping = Mapping::new(world.robot(), gait.mapping, gait.arm)?;
    let chain = mapping.chain();
    let heights = rules::samples(gait, rules::INTERVALS)
        .into_iter()
        .filter_map(|at| chain.close(at).ok())
        .map(|angles| chain.posture(&angles).hip.z());
    let lowest = heights.fold(f64::INFINITY, f64::min);
    Ok(Clearance::Hip(lowest - HIP_TOLERANCE))
}

/// The share of the weight on trunk and legs in a gait's simulated pull, 0 to 1.
///
/// # Errors
/// [`TrialError`] where it cannot be simulated.
pub fn body_share(world: &World, gait: &Gait, duration: PhaseDuration) -> Result<f64, TrialError> {
    let setup = DynamicSetup {
        norm: prone::cost::graded::Norm::SquaredTorque { weights: [1.0; 4] },
        share: Share::Phase,
        rules: ChainRules {
            rate: f64::INFINITY,
            clearance: Clearance::Free,
            stops: None,
        },
        duration,
        body_share: 1.0,
    };
    let pricing = DynamicPricing::new(world, gait, setup)
        .map_err(|error| prone_sim::pull::PullError::Trajectory(error.into()))?;
    Ok(pricing.trial(gait)?.body_share)
}

impl Pricer<'_> {
    /// Prices a gait.
    ///
    /// # Errors
    /// [`NotCubic`] by the published objective.
    pub fn price(&self, gait: &Gait) -> Result<Priced, NotCubic> {
        match self {
            Self::Graded(pricing) => Ok(priced(&pricing.quote(gait))),
            Self::Published { objective, .. } => {
                let coefficients =
                    published_problem::coefficients_of(gait).ok_or_else(|| NotCubic {
                        gait: gait.name.clone(),
                    })?;
                let price = objective.price(&coefficients);
                let violated = price.violated;
                let counts = [
                    ("arm-returns", violated.arm_returns),
                    ("hip-low", violated.hip_low),
                    ("knee-range", violated.knee_range),
                    ("hip-range", violated.hip_range),
                    ("arm-range", violated.arm_range),
                ];
                let broken = counts.into_iter().filter(|(_, count)| *count > 0);
                Ok(Priced {
                    cost: Some(price.cost()),
                    torque: Some(price.torque),
                    violations: f64::from(violated.total()),
                    broken: broken
                        .map(|(rule, count)| Broken {
                            rule,
                            count,
                            sum: f64::from(count),
                        })
                        .collect(),
                })
            }
        }
    }
}

/// A graded price, in the form of a record.
fn priced(price: &Price) -> Priced {
    let torque = (!price.torque.is_nan()).then_some(price.torque);
    let broken = |(rule, excess): (Rule, prone::cost::graded::Excess)| Broken {
        rule: rule.name(),
        count: excess.count,
        sum: excess.sum,
    };
    Priced {
        cost: torque,
        torque,
        violations: price.violations.total(),
        broken: price.violations.iter().map(broken).collect(),
    }
}
