//! What a whole cycle costs, by simulation in the locomotion regime.
//!
//! A cycle is crawled in one or more settings (friction, servo, time scale). In the main ones the
//! value counts: heat per metre, merged over servos ([`Merge`]), advance per cycle, speed, duty of the
//! worst motor, height, or what a shoulder's servo demands. In all but those of [`Role::Beside`] nothing may be higher than the
//! ceiling and the advance has to be enough; [`CycleRules`] may ask for no more of a shoulder's servo
//! (with the robot's own gains), no more weight on trunk, head and legs in the pull (where values count),
//! no more heat. Parts of the robot are kept apart in the plan, not in what lags behind it. What is broken adds
//! up, mostly in shares of its limit (stops in rad, limbs in one another in centimetres), and
//! compares before the value. The settings are taken in order, and those after one that
//! breaks a rule are not simulated: each counts as [`UNTRIED`]. So does a cycle that cannot be
//! planned or crawled, with the reason.

use std::sync::Arc;

use prone::crawl::CrawlerError;
use prone::gait::cycle::{CheckedCycle, Cycle, CycleError, TimeScale};
use prone::gait::{Clamp, LimitsPolicy};
use prone::motor::UnknownMotor;
use prone::robot::{JointAngles, JointId, Robot};
use prone_optim::Interval;
use prone_record::frontier::CycleObjective;
use prone_sim::crawl::CrawlError;
use prone_sim::self_collision::{SelfCollision, SelfCollisionError};

use super::candidates::{Candidates, Cost, Depth, PointError, Refusal};
use super::cycle_form::{CycleForm, CycleFormError, Free};
use super::cycle_rules::{CycleRules, UNTRIED, above};
use super::setting::{Role, Setting};
use super::trial::{Trial, try_out, try_out_unless};

/// How the heats with different servos become one.
#[derive(Debug, Clone, PartialEq)]
pub enum Merge {
    /// Their geometric mean, s/m: with stiff servos it is several times that with soft ones, and a
    /// percent is a percent.
    Mean,
    /// The largest share, each over what another cycle has in that setting; these values, s/m, in
    /// the order of the settings.
    WorstOver(Vec<f64>),
}

impl Merge {
    /// The worst over a cycle's own heats.
    ///
    /// # Errors
    /// [`CrawlError`] where that cycle cannot be crawled in one of the settings.
    pub fn worst_over(settings: &[Setting], cycle: &Cycle) -> Result<Self, CrawlError> {
        let valued = settings
            .iter()
            .filter(|setting| setting.spec.role == Role::Value);
        let heats = valued.map(|setting| Ok(try_out(setting, cycle)?.heat_per_metre));
        heats.collect::<Result<_, _>>().map(Self::WorstOver)
    }

    /// One heat; NaN where there is none.
    fn heat(&self, trials: &[&Trial]) -> f64 {
        let heats = trials.iter().map(|trial| trial.heat_per_metre);
        match self {
            Self::Mean => (heats.map(f64::ln).sum::<f64>() / trials.len() as f64).exp(),
            Self::WorstOver(others) => {
                let shares = heats.zip(others).map(|(heat, other)| heat / other);
                // NaN of either sign is above all numbers.
                let worst = shares.max_by(|a, b| a.abs().total_cmp(&b.abs()));
                worst.unwrap_or(f64::NAN)
            }
        }
    }
}

/// What a search goes after.
#[derive(Debug, Clone, PartialEq)]
pub struct CycleAim {
    /// What is minimised.
    pub objective: CycleObjective,
    /// Of several settings.
    pub merge: Merge,
    /// What holds.
    pub rules: CycleRules,
}

/// Why cycles have no costs.
#[derive(Debug, thiserror::Error)]
pub enum CycleCostError {
    /// There is no box about the base.
    #[error(transparent)]
    Form(#[from] CycleFormError),
    /// There is nothing to simulate.
    #[error("cycles have costs in at least one setting")]
    NoSettings,
    /// Heats are compared with those of other settings.
    #[error("{others} heats to compare with are given, and {settings} settings have a value")]
    Merge {
        /// How many heats [`Merge::WorstOver`] has.
        others: usize,
        /// In how many settings values count.
        settings: usize,
    },
    /// Nothing is known of the heat of some joint.
    #[error(transparent)]
    Motor(#[from] UnknownMotor),
    /// The base cannot be crawled.
    #[error(transparent)]
    Cycle(#[from] CycleError),
    /// Its limbs cannot be compared.
    #[error(transparent)]
    SelfCollision(#[from] SelfCollisionError),
}

/// Costs of cycles.
#[derive(Debug)]
pub struct CycleCosts {
    settings: Arc<[Setting]>,
    aim: CycleAim,
    allowed_clamps: Vec<Clamp>,
    collision: SelfCollision,
}

impl CycleCosts {
    /// Costs in settings; no joint may be asked further past its stop than `base` asks it.
    ///
    /// # Errors
    /// [`CycleCostError`] where the base cannot be crawled, or nothing can be compared.
    pub fn new(
        settings: Arc<[Setting]>,
        aim: CycleAim,
        base: &Cycle,
    ) -> Result<Self, CycleCostError> {
        let first = settings.first().ok_or(CycleCostError::NoSettings)?;
        let world = &first.world;
        if let Merge::WorstOver(others) = &aim.merge {
            let valued = settings.iter().filter(|it| it.spec.role == Role::Value);
            let (others, settings) = (others.len(), valued.count());
            if others != settings {
                return Err(CycleCostError::Merge { others, settings });
            }
        }
        let warm = matches!(
            aim.objective,
            CycleObjective::Heat | CycleObjective::HeatRate | CycleObjective::Duty
        ) || aim.rules.heat < f64::INFINITY
            || aim.rules.most_duty < f64::INFINITY;
        if warm {
            world.robot().check_motors()?;
        }
        let checked = CheckedCycle::plan(world.robot(), world.stops(), base, 0.0, TimeScale::ONE)?;
        Ok(Self {
            allowed_clamps: checked.clamps().to_vec(),
            collision: SelfCollision::new(world)?,
            settings,
            aim,
        })
    }

    /// The cost of a cycle; a search leaves out the settings after a broken one.
    pub fn cost(&self, cycle: &Cycle, depth: Depth) -> Cost {
        let cost = self.cost_unless(&|| false, cycle, depth);
        cost.unwrap_or_else(Cost::unknown)
    }

    /// The same; none where `stopped` said so before it was known.
    pub fn cost_unless(
        &self,
        stopped: &dyn Fn() -> bool,
        cycle: &Cycle,
        depth: Depth,
    ) -> Option<Cost> {
        let CycleAim {
            objective,
            merge,
            rules,
        } = &self.aim;
        let mut cost = self.cost_of_plan(cycle);
        for (index, setting) in self.settings.iter().enumerate() {
            let left = (self.settings.len() - index) as f64;
            if cost.violation > 0.0 && depth == Depth::UntilBroken {
                cost.add("untried", UNTRIED * left);
                break;
            }
            let trial = match try_out_unless(stopped, setting, cycle) {
                Ok(trial) => trial,
                Err(CrawlError::Stopped) => return None,
                Err(source) => {
                    cost.add("untried", UNTRIED * left + excess_speed_of_crawl(&source));
                    cost.refusal.get_or_insert(Refusal::Crawl {
                        setting: setting.spec.kind,
                        source,
                    });
                    break;
                }
            };
            let first = cost
                .trials
                .first()
                .map_or(trial.advance, |first: &Trial| first.advance);
            cost.add_all(&rules.broken_by_trial(&setting.spec, &trial, first));
            cost.trials.push(trial);
        }
        let of = |counts: fn(Role) -> bool| {
            let tried = self.settings.iter().zip(&cost.trials);
            let counted = tried.filter(|(setting, _)| counts(setting.spec.role));
            counted.map(|(_, trial)| trial).collect::<Vec<_>>()
        };
        let valued = of(|role| role == Role::Value);
        let kept = of(|role| matches!(role, Role::Value | Role::Keep(_)));
        cost.value = value(*objective, &valued, &kept, merge);
        if !valued.is_empty() {
            cost.add("heat", rules.broken_by_heat(merge.heat(&valued)));
        }
        Some(cost)
    }

    /// What is broken before anything moves, and why it will not move, where it will not.
    fn cost_of_plan(&self, cycle: &Cycle) -> Cost {
        let mut cost = Cost {
            value: f64::NAN,
            ..Cost::default()
        };
        let Some(first) = self.settings.first() else {
            cost.add("untried", UNTRIED);
            return cost;
        };
        let world = &first.world;
        let robot = world.robot();
        let duration = cycle.duration(TimeScale::ONE);
        cost.add("duration", self.aim.rules.broken_by_duration(duration));
        let clamping = Cycle {
            limits: LimitsPolicy::Clamp,
            ..cycle.clone()
        };
        // The fastest setting decides whether joints are fast enough.
        let fastest = self.settings.iter().map(|setting| setting.spec.scale);
        let fastest = fastest.fold(
            TimeScale::ONE,
            |a, b| if b.value() < a.value() { b } else { a },
        );
        let plan = CheckedCycle::plan(robot, world.stops(), &clamping, 0.0, fastest);
        let plan = plan.and_then(|checked| Ok((planned_postures(&checked)?, checked)));
        let (postures, checked) = match plan {
            Ok(plan) => plan,
            Err(error) => {
                cost.add("plan", UNTRIED + excess_speed(&error));
                cost.refusal = Some(error.into());
                return cost;
            }
        };
        let further = clamped_further(&self.allowed_clamps, checked.clamps());
        cost.add("limits", further);
        // Its engine data is scratch.
        match self.collision.clone().scan(&postures) {
            Ok(nearest) => cost.add("limbs", depth_of(nearest.distance_m)),
            Err(error) => {
                cost.add("limbs", UNTRIED);
                cost.refusal = Some(error.into());
            }
        }
        cost
    }
}

/// Cycles about one, and what they cost.
#[derive(Debug)]
pub struct CycleSearch {
    form: CycleForm,
    costs: CycleCosts,
}

impl CycleSearch {
    /// Searches about a cycle in settings made by [`super::settings`].
    pub fn new(
        robot: &Robot,
        settings: &Arc<[Setting]>,
        aim: CycleAim,
        base: &Cycle,
        free: Free,
    ) -> Result<Self, CycleCostError> {
        Ok(Self {
            form: CycleForm::about(robot, base, free)?,
            costs: CycleCosts::new(Arc::clone(settings), aim, base)?,
        })
    }

    /// The rules that its cycles are held against.
    pub const fn rules(&self) -> &CycleRules {
        &self.costs.aim.rules
    }
}

impl Candidates for CycleSearch {
    type Gait = Cycle;

    fn bounds(&self) -> &[Interval] {
        self.form.bounds()
    }

    fn known(&self) -> Option<&[f64]> {
        Some(self.form.known())
    }

    fn gait(&self, point: &[f64]) -> Result<Cycle, PointError> {
        self.form.cycle(point)
    }

    fn cost_unless(&self, stopped: &dyn Fn() -> bool, cycle: &Cycle, depth: Depth) -> Option<Cost> {
        self.costs.cost_unless(stopped, cycle, depth)
    }
}

/// Of trials where values count, the one with the robot's own servos first; of advance and speed that
/// of the worst of all the settings in which the advance has to be kept.
fn value(objective: CycleObjective, valued: &[&Trial], kept: &[&Trial], merge: &Merge) -> f64 {
    let first = |of: fn(&Trial) -> f64| valued.first().map_or(f64::NAN, |trial| of(trial));
    let worst = |of: fn(&Trial) -> f64| {
        let values = kept.iter().map(|trial| of(trial));
        // NaN of either sign is below all numbers.
        let least = values.min_by(|a, b| nan_last(*a).total_cmp(&nan_last(*b)));
        least.map_or(f64::NAN, |least| -least)
    };
    match objective {
        CycleObjective::Heat => merge.heat(valued),
        CycleObjective::HeatRate => first(|trial| trial.heat_per_metre * trial.speed()),
        CycleObjective::Advance => worst(|trial| trial.advance),
        CycleObjective::Speed => worst(Trial::speed),
        CycleObjective::Peak => first(|trial| trial.demanded_shoulder),
        CycleObjective::Duty => first(|trial| trial.duty.0),
        CycleObjective::Height => first(|trial| trial.top.0),
    }
}

/// What is not a number, as the least of all.
fn nan_last(value: f64) -> f64 {
    if value.is_nan() {
        f64::NEG_INFINITY
    } else {
        value
    }
}

/// By how much more than is allowed joints are stopped at their limits, rad.
fn clamped_further(allowed: &[Clamp], clamps: &[Clamp]) -> f64 {
    let most = |joint: JointId| {
        let same = allowed.iter().find(|clamp| clamp.joint == joint);
        same.map_or(0.0, |clamp| clamp.largest.abs())
    };
    clamps
        .iter()
        .map(|clamp| (clamp.largest.abs() - most(clamp.joint)).max(0.0))
        .sum()
}

/// Of a cycle that asks too much of a joint's speed, how much too much: a search can go down that
/// slope.
fn excess_speed(error: &CycleError) -> f64 {
    match error {
        CycleError::Speed { speed, limit, .. } => above(*speed, *limit),
        _ => UNTRIED,
    }
}

/// The same of a cycle that could not be crawled.
fn excess_speed_of_crawl(error: &CrawlError) -> f64 {
    match error {
        CrawlError::Crawler(CrawlerError::Cycle { source, .. }) => excess_speed(source),
        _ => UNTRIED,
    }
}

/// How deep limbs are in one another, over 10 mm, where they are `distance` apart, m; 0 where they
/// are not in one another, and as much as an untried setting where they are nowhere.
fn depth_of(distance: f64) -> f64 {
    if distance.is_finite() {
        (-distance).max(0.0) / 0.01
    } else {
        UNTRIED
    }
}

/// Postures of a planned cycle, pull and recovery.
fn planned_postures(checked: &CheckedCycle) -> Result<Vec<JointAngles>, CycleError> {
    let share = |k: usize, of: usize| k as f64 / of as f64;
    let seconds = checked.pull_seconds();
    let count = if checked.pull().is_some() {
        PLAN_SAMPLES
    } else {
        0
    };
    let mut postures: Vec<JointAngles> = (0..=count)
        .map(|k| checked.pull_at(seconds * share(k, count.max(1))))
        .collect();
    let path = checked.recovery_after(checked)?;
    let (seconds, count) = (checked.recovery_seconds(), 4 * PLAN_SAMPLES - count);
    postures.extend((1..count).map(|k| path.at(seconds * share(k, count))));
    Ok(postures)
}

/// Postures of a pull that are looked at for collisions; three times as many of the way back, and
/// four times as many of a cycle without a pull.
const PLAN_SAMPLES: usize = 8;

#[cfg(test)]
mod tests;
