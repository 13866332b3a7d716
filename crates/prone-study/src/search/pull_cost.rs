//! What a pull costs: by the published objective, or by torque with violations graded and kept apart.
//!
//! Torque comes from a map, from the statics or from a simulation of each gait. What the planned chain
//! breaks is graded first ([`graded::violations`]), and a search does not simulate such a gait. The
//! same holds for one that the robot cannot be commanded or that makes the simulation diverge: it has
//! the rule [`Rule::Torque`] broken, and a violation of at least 1 puts it behind every gait that was
//! simulated. In simulation the share of the weight on trunk, head and legs may not pass a limit, or the
//! search lays the robot on its belly, where torque costs nothing.
//!
//! [`graded::violations`]: prone::cost::graded::violations

use std::sync::Arc;

use prone::cost::graded::{self, Norm, Rule, Violations};
use prone::cost::published::{PublishedObjective, VIOLATION_COST};
use prone::gait::Gait;
use prone::mapping::{ArmMode, Mapping};
use prone::robot::Robot;
use prone::statics::{Stance, StaticTorques, SupportRule};
use prone::torque_map::{TorqueMap, TorqueSource};
use prone_optim::{Failure, Interval, Problem as _, Score};
use prone_record::gait_search::{Broken, PullCost};
use prone_sim::World;
use prone_sim::pull::{self, Keep, Pull, PullError, Start};

use super::candidates::{Candidates, Cost, Depth, PointError, Refusal};
use super::chain_rules::{phase, samples};
use super::published::{self, PublishedProblem};
use super::pull_error::PullCostError;
use super::pull_form::PullForm;
use super::pull_terms::{PullAim, PullTerms, Source, per};
use super::pull_trial::{self, Begun, PullTrialError};
use crate::torque_map::NodeGrid;

/// Grid of the table that the statics fills for the published objective: the finer published one,
/// with θ4 up to where the published gaits go (Bell 2015, table 2: 27.5°), degrees.
const STEP_DEG: f64 = 2.5;
const THETA4_MAX_DEG: f64 = 27.5;

/// Intervals of a phase whose torques are looked up, as in the published objective. The rules are
/// held against a finer grid.
const INTERVALS: usize = 100;

/// Costs of gaits that share mapping and arms.
#[derive(Debug)]
pub struct PullCosts {
    world: World,
    terms: PullTerms,
    method: Method,
}

/// How costs come about.
#[derive(Debug)]
enum Method {
    Published {
        /// As published.
        objective: Box<PublishedObjective>,
        /// As it is searched.
        problem: Box<PublishedProblem>,
    },
    Graded {
        mapping: Box<Mapping>,
        norm: Norm,
        torques: Torques,
    },
}

#[derive(Debug)]
enum Torques {
    Map(Arc<TorqueMap>),
    Statics(Box<StaticTorques<Arc<Robot>>>),
    Simulated(Box<Begun>),
}

impl PullCosts {
    /// Costs in a world, of gaits that share mapping and arms with the base of `terms`.
    pub fn new(world: &World, terms: PullTerms) -> Result<Self, PullCostError> {
        let robot = world.robot();
        let base = &terms.base;
        let method = match terms.aim {
            PullAim::Published(rules) => {
                let map = match &terms.source {
                    Source::Map { map, .. } => Arc::clone(map),
                    Source::Statics => {
                        let grid = NodeGrid::new(STEP_DEG, THETA4_MAX_DEG)?;
                        Arc::new(TorqueMap::measure(*grid.grid(), &statics(world, base)?))
                    }
                    Source::Dynamics => return Err(PullCostError::PublishedNeedsTable),
                };
                Method::Published {
                    objective: Box::new(published::objective(robot, &map, rules)?),
                    problem: Box::new(PublishedProblem::new(robot, &map, rules)?),
                }
            }
            PullAim::Graded(objective) => Method::Graded {
                norm: objective.norm(robot)?,
                mapping: Box::new(Mapping::new(robot, base.mapping, base.arm)?),
                torques: match &terms.source {
                    Source::Map { map, .. } => Torques::Map(Arc::clone(map)),
                    Source::Statics => Torques::Statics(Box::new(statics(world, base)?)),
                    Source::Dynamics => {
                        Torques::Simulated(Box::new(Begun::settle(world, base, terms.duration)))
                    }
                },
            },
        };
        Ok(Self {
            world: world.clone(),
            terms,
            method,
        })
    }

    /// What decides these costs.
    pub const fn terms(&self) -> &PullTerms {
        &self.terms
    }

    /// The world in which they hold.
    pub const fn world(&self) -> &World {
        &self.world
    }

    /// The cost of a gait.
    pub fn cost(&self, gait: &Gait, depth: Depth) -> Cost {
        let cost = self.cost_unless(&|| false, gait, depth);
        cost.unwrap_or_else(Cost::unknown)
    }

    /// The same; none where `stopped` said so before it was known.
    pub fn cost_unless(
        &self,
        stopped: &dyn Fn() -> bool,
        gait: &Gait,
        depth: Depth,
    ) -> Option<Cost> {
        Some(match &self.method {
            Method::Published { objective, .. } => published_cost(objective, gait),
            Method::Graded {
                mapping,
                norm,
                torques,
            } => {
                let (robot, terms) = (self.world.robot(), &self.terms);
                let broken = terms.rules.broken(robot, mapping, gait, terms.duration);
                match torques {
                    Torques::Map(map) => self.looked_up(gait, map.as_ref(), mapping, norm, broken),
                    Torques::Statics(statics) => {
                        self.looked_up(gait, statics.as_ref(), mapping, norm, broken)
                    }
                    Torques::Simulated(_)
                        if depth == Depth::UntilBroken && broken.total() > 0.0 =>
                    {
                        unsimulated(broken, None)
                    }
                    Torques::Simulated(_) => {
                        return self.simulated(stopped, gait, (mapping, norm), broken);
                    }
                }
            }
        })
    }

    /// The simulated pull of a gait, whatever rules it breaks.
    pub fn pull(&self, gait: &Gait) -> Result<Pull, PullError> {
        self.pull_unless(&|| false, gait)
    }

    fn pull_unless(&self, stopped: &dyn Fn() -> bool, gait: &Gait) -> Result<Pull, PullError> {
        let (world, duration) = (&self.world, self.terms.duration);
        match &self.method {
            Method::Graded {
                torques: Torques::Simulated(begun),
                ..
            } => begun.pull(stopped, world, gait, duration),
            _ => pull::run_unless(stopped, world, gait, duration, Start::FirstPose, Keep::Rows),
        }
    }

    /// By a source of static torques: the statics, or a torque map.
    fn looked_up(
        &self,
        gait: &Gait,
        torques: &impl TorqueSource,
        mapping: &Mapping,
        norm: &Norm,
        mut violations: Violations,
    ) -> Cost {
        let samples = samples(gait, INTERVALS);
        let phase = phase(&samples, self.terms.duration);
        let (torque, gaps) = graded::torque_part(phase, torques, norm);
        violations.add(Rule::Torque, f64::from(gaps));
        let torque = per(self.terms.share, mapping.chain(), gait).of(torque);
        graded_cost(torque, &violations, None)
    }

    fn simulated(
        &self,
        stopped: &dyn Fn() -> bool,
        gait: &Gait,
        (mapping, norm): (&Mapping, &Norm),
        mut violations: Violations,
    ) -> Option<Cost> {
        let terms = &self.terms;
        let trial = || {
            let pull = self.pull_unless(stopped, gait)?;
            let torque = pull_trial::torque_part(self.world.robot(), &pull, norm)?;
            Ok::<_, PullTrialError>((torque, pull_trial::body_share(&pull)))
        };
        let (torque, body_share) = match trial() {
            Ok(trial) => trial,
            Err(PullTrialError::Pull(PullError::Stopped)) => return None,
            Err(error) => return Some(unsimulated(violations, Some(error))),
        };
        let torque = per(terms.share, mapping.chain(), gait).of(torque);
        if terms.body_share < 1.0 {
            let excess = (body_share - terms.body_share) / (1.0 - terms.body_share);
            violations.add(Rule::BodyShare, excess);
        }
        Some(graded_cost(torque, &violations, None))
    }

    /// A cost in the form of a record.
    pub fn record(&self, cost: &Cost) -> PullCost {
        let known = Some(cost.value).filter(|value| !value.is_nan());
        PullCost {
            cost: match self.method {
                Method::Published { .. } => known.map(|it| it + VIOLATION_COST * cost.violation),
                Method::Graded { .. } => known,
            },
            torque: known,
            violations: cost.violation,
            broken: cost.broken.clone(),
        }
    }
}

/// Pulls of one form, and what they cost; the published objective has a form of its own.
#[derive(Debug)]
pub struct PullSearch {
    /// What they cost.
    pub costs: PullCosts,
    /// What they are made of.
    pub form: PullForm,
}

impl Candidates for PullSearch {
    type Gait = Gait;

    fn bounds(&self) -> &[Interval] {
        match &self.costs.method {
            Method::Published { problem, .. } => problem.bounds(),
            Method::Graded { .. } => self.form.bounds(),
        }
    }

    fn gait(&self, point: &[f64]) -> Result<Gait, PointError> {
        match &self.costs.method {
            Method::Published { .. } => Ok(published::gait(
                "published",
                &published::coefficients(point)?,
            )?),
            Method::Graded { .. } => Ok(self.form.gait(point)?),
        }
    }

    fn cost_unless(&self, stopped: &dyn Fn() -> bool, gait: &Gait, depth: Depth) -> Option<Cost> {
        self.costs.cost_unless(stopped, gait, depth)
    }

    fn score_unless(
        &self,
        stopped: &dyn Fn() -> bool,
        point: &[f64],
    ) -> Result<Option<(Score, Vec<Broken>)>, Failure> {
        match &self.costs.method {
            // Its rules are searched with a margin.
            Method::Published { problem, .. } => Ok(Some((problem.evaluate(point)?, Vec::new()))),
            Method::Graded { .. } => {
                let gait = self.form.gait(point);
                let gait = gait.map_err(|error| Failure::from_error(&error))?;
                let cost = self.cost_unless(stopped, &gait, Depth::UntilBroken);
                Ok(cost.map(|cost| (cost.score(), cost.broken)))
            }
        }
    }
}

fn published_cost(objective: &PublishedObjective, gait: &Gait) -> Cost {
    let Some(coefficients) = published::coefficients_of(gait) else {
        return Cost {
            value: f64::NAN,
            violation: f64::MAX,
            refusal: Some(Refusal::NotCubic),
            ..Cost::default()
        };
    };
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
    let broken = broken.map(|(rule, count)| Broken {
        rule: rule.into(),
        count,
        sum: f64::from(count),
    });
    Cost {
        value: price.torque,
        violation: f64::from(violated.total()),
        broken: broken.collect(),
        ..Cost::default()
    }
}

fn graded_cost(torque: f64, violations: &Violations, refusal: Option<Refusal>) -> Cost {
    let broken = violations.iter().map(|(rule, excess)| Broken {
        rule: rule.name().into(),
        count: excess.count,
        sum: excess.sum,
    });
    Cost {
        value: torque,
        violation: violations.total(),
        broken: broken.collect(),
        trials: Vec::new(),
        refusal,
    }
}

/// The cost of a gait that was not simulated: its torque part is not known.
fn unsimulated(mut violations: Violations, why: Option<PullTrialError>) -> Cost {
    violations.add(Rule::Torque, 1.0);
    graded_cost(f64::NAN, &violations, why.map(Refusal::from))
}

/// The statics of gaits with the base's mapping and arms. Flat forearms rest on their elbows.
fn statics(world: &World, base: &Gait) -> Result<StaticTorques<Arc<Robot>>, PullCostError> {
    let supports = match base.arm {
        ArmMode::FlatForearm => SupportRule::ElbowNotHand,
        ArmMode::Fixed => SupportRule::AnyShape,
    };
    let robot = world.shared_robot();
    let mapping = Mapping::new(&robot, base.mapping, base.arm)?;
    let stance = Stance::unsqueezed(supports);
    Ok(StaticTorques::new(robot, mapping, world.stops(), stance)?)
}
