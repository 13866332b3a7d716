//! What a whole cycle costs, by simulation in the locomotion regime.
//!
//! A cycle is crawled in one or more settings (friction, servo, time scale). In the main ones the
//! value is averaged: heat per metre (geometrically: with stiff servos it is five times that with
//! soft ones, and a percent is a percent), advance per cycle or speed. In all of them the rules are
//! held: nothing higher than the ceiling, enough advance, and where [`CycleRules`] ask for them no
//! more of a shoulder's servo and no more weight on trunk and legs in the pull. What is broken adds up, each in shares of its limit, and compares
//! before the value. The settings are taken in order, and those after one that breaks a rule are
//! not simulated: each counts as [`UNTRIED`].

use prone::gait::cycle::{CheckedCycle, Cycle, CycleError, TimeScale};
use prone::gait::{Clamp, LimitsPolicy, PhaseDuration};
use prone::robot::{JointAngles, JointId};
use prone_sim::World;
use prone_sim::crawl::{self, Crawl, CrawlError, CrawlPlan, Detail, End, Straight};
use prone_sim::self_collision::{SelfCollision, SelfCollisionError};

/// Violation of a setting that was not simulated, and of a cycle that cannot be crawled: more than
/// what is usually broken in one that was.
pub const UNTRIED: f64 = 1.0;

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CycleObjective {
    /// ∫ Σ (τ / nominal torque)² dt per metre, s/m.
    Heat,
    /// Minus the advance per cycle, m.
    Advance,
    /// Minus the speed, m/s.
    Speed,
}

impl CycleObjective {
    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Heat => "heat",
            Self::Advance => "advance",
            Self::Speed => "speed",
        }
    }
}

/// One way to crawl a cycle.
#[derive(Debug, Clone)]
pub struct Setting {
    /// In a word, for records.
    pub name: String,
    /// Floor, servos, limits.
    pub world: World,
    /// How slowly.
    pub scale: TimeScale,
    /// How long the pull lasts instead, before the scale.
    pub pull: Option<PhaseDuration>,
    /// What every commanded angle is off by, rad.
    pub offsets: Option<JointAngles>,
    /// How many cycles; the last one is measured.
    pub cycles: usize,
    /// Turn command, in shares of the cycle's limit; the first pull is straight all the same.
    pub turn: f64,
    /// What it is for.
    pub role: Role,
}

/// What a setting is for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// Its value counts.
    Value,
    /// It has to advance by at least that share of the first setting's advance.
    Keep(f64),
    /// It has to turn to the left by at least that angle a cycle, rad.
    Turn(f64),
    /// Nothing is asked of it; what it does is reported.
    Beside,
    /// It may not turn by more than that angle a cycle, rad, and keeps half of the advance.
    Straight(f64),
}

/// What holds in every setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CycleRules {
    /// Highest point of the robot, m.
    pub ceiling: f64,
    /// Least advance per cycle where values count, m.
    pub advance: f64,
    /// Largest share of the weight on trunk and legs during the pull, 0 to 1.
    pub body_share: f64,
    /// Largest duration of a cycle, s.
    pub seconds: f64,
    /// Largest torque that a shoulder's servo demands, N·m.
    pub demanded_shoulder: f64,
}

impl CycleRules {
    /// None but that it advances at all.
    pub const FREE: Self = Self {
        ceiling: f64::INFINITY,
        advance: 0.01,
        body_share: 1.0,
        seconds: f64::INFINITY,
        demanded_shoulder: f64::INFINITY,
    };
}

/// What a cycle came to in one setting; the last cycle of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// The setting's name.
    pub setting: String,
    /// Advance along the heading, m.
    pub advance: f64,
    /// How long it took, s.
    pub seconds: f64,
    /// Highest point of all cycles, m, and of which part of the body.
    pub top: (f64, &'static str),
    /// ∫ Σ (τ / nominal torque)² dt per metre, s/m.
    pub heat_per_metre: f64,
    /// Largest torque over the effort limit, and whose.
    pub peak_over_limit: (f64, String),
    /// Largest torque that a shoulder's servo demands, N·m.
    pub demanded_shoulder: f64,
    /// Share of the time for which it demands more than the effort limit.
    pub shoulder_saturated: f64,
    /// Share of the weight on trunk and legs in the pull.
    pub body_share: f64,
    /// Change of heading, rad.
    pub yaw: f64,
}

/// A cycle's price.
#[derive(Debug, Clone, PartialEq)]
pub struct CyclePrice {
    /// Mean of the objective where values count; NaN where the cycle could not be crawled.
    pub value: f64,
    /// What is broken, in shares of the limits.
    pub violation: f64,
    /// The settings that were simulated.
    pub trials: Vec<Trial>,
}

/// Why cycles cannot be priced.
#[derive(Debug, thiserror::Error)]
pub enum PricerError {
    /// There is nothing to simulate.
    #[error("cycles are priced in at least one setting")]
    NoSettings,
    /// The base cannot be crawled.
    #[error(transparent)]
    Cycle(#[from] CycleError),
    /// Its limbs cannot be compared.
    #[error(transparent)]
    SelfCollision(#[from] SelfCollisionError),
}

/// Prices cycles.
pub struct CyclePricer<'a> {
    settings: &'a [Setting],
    objective: CycleObjective,
    rules: CycleRules,
    allowed_clamps: Vec<Clamp>,
    collision: SelfCollision,
}

impl<'a> CyclePricer<'a> {
    /// A pricer; no joint may be asked further past its stop than `base` asks it.
    ///
    /// # Errors
    /// [`PricerError`] where the base cannot be crawled.
    pub fn new(
        settings: &'a [Setting],
        objective: CycleObjective,
        rules: CycleRules,
        base: &Cycle,
    ) -> Result<Self, PricerError> {
        let first = settings.first().ok_or(PricerError::NoSettings)?;
        let world = &first.world;
        let checked = CheckedCycle::plan(world.robot(), world.stops(), base, 0.0, TimeScale::ONE)?;
        Ok(Self {
            settings,
            objective,
            rules,
            allowed_clamps: checked.clamps().to_vec(),
            collision: SelfCollision::new(world)?,
        })
    }

    /// The price of a cycle; settings after a broken one are left out.
    pub fn price(&self, cycle: &Cycle) -> CyclePrice {
        self.tried(cycle, Thoroughness::UntilBroken)
    }

    /// The price with every setting simulated.
    pub fn quote(&self, cycle: &Cycle) -> CyclePrice {
        self.tried(cycle, Thoroughness::Everything)
    }

    fn tried(&self, cycle: &Cycle, thoroughness: Thoroughness) -> CyclePrice {
        let mut price = CyclePrice {
            value: f64::NAN,
            violation: self.broken_in_plan(cycle),
            trials: Vec::new(),
        };
        let (mut sum, mut count) = (0.0, 0.0);
        for (index, setting) in self.settings.iter().enumerate() {
            let left = (self.settings.len() - index) as f64;
            if price.violation > 0.0 && thoroughness == Thoroughness::UntilBroken {
                price.violation += UNTRIED * left;
                break;
            }
            let trial = match try_out(setting, cycle) {
                Ok(trial) => trial,
                Err(error) => {
                    price.violation += UNTRIED * left + excess_speed(&error);
                    break;
                }
            };
            let first = price
                .trials
                .first()
                .map_or(trial.advance, |first: &Trial| first.advance);
            price.violation += self.broken(setting, &trial, first);
            if setting.role == Role::Value {
                sum += match self.objective {
                    CycleObjective::Heat => self.value(&trial).ln(),
                    CycleObjective::Advance | CycleObjective::Speed => self.value(&trial),
                };
                count += 1.0;
            }
            price.trials.push(trial);
        }
        if count > 0.0 {
            price.value = match self.objective {
                CycleObjective::Heat => (sum / count).exp(),
                CycleObjective::Advance | CycleObjective::Speed => sum / count,
            };
        }
        price
    }

    fn value(&self, trial: &Trial) -> f64 {
        match self.objective {
            CycleObjective::Heat => trial.heat_per_metre,
            CycleObjective::Advance => -trial.advance,
            CycleObjective::Speed => -trial.advance / trial.seconds,
        }
    }

    /// What is broken before anything moves.
    fn broken_in_plan(&self, cycle: &Cycle) -> f64 {
        let Some(first) = self.settings.first() else {
            return UNTRIED;
        };
        let world = &first.world;
        let robot = world.robot();
        let over = |value: f64, limit: f64| (value / limit - 1.0).max(0.0);
        let mut broken = over(cycle.duration(TimeScale::ONE), self.rules.seconds);
        let clamping = Cycle {
            pull: prone::gait::Gait {
                limits: LimitsPolicy::Clamp,
                ..cycle.pull.clone()
            },
            ..cycle.clone()
        };
        // The fastest setting decides whether joints are fast enough.
        let fastest = self.settings.iter().map(|setting| setting.scale);
        let fastest = fastest.fold(
            TimeScale::ONE,
            |a, b| if b.value() < a.value() { b } else { a },
        );
        match CheckedCycle::plan(robot, world.stops(), &clamping, 0.0, fastest) {
            Ok(checked) => {
                broken += self.clamped_further(&checked);
                broken += collides(&self.collision, &checked);
            }
            Err(error) => broken += UNTRIED + excess_speed(&CrawlError::Cycle(error)),
        }
        broken
    }

    /// By how much more than in the base joints are stopped at their limits, rad.
    fn clamped_further(&self, checked: &CheckedCycle) -> f64 {
        let allowed = |joint: JointId| {
            let same = self
                .allowed_clamps
                .iter()
                .find(|clamp| clamp.joint == joint);
            same.map_or(0.0, |clamp| clamp.largest.abs())
        };
        let further = checked.clamps().iter();
        further
            .map(|clamp| (clamp.largest.abs() - allowed(clamp.joint)).max(0.0))
            .sum()
    }

    fn broken(&self, setting: &Setting, trial: &Trial, first_advance: f64) -> f64 {
        let rules = &self.rules;
        let over = |value: f64, limit: f64| (value / limit - 1.0).max(0.0);
        let least = match setting.role {
            Role::Value => rules.advance,
            Role::Keep(share) => share * first_advance.max(rules.advance),
            Role::Beside => return 0.0,
            Role::Turn(_) | Role::Straight(_) => 0.5 * first_advance.max(rules.advance),
        };
        let mut broken = (1.0 - trial.advance / least).max(0.0);
        broken += match setting.role {
            Role::Turn(angle) => (1.0 - trial.yaw / angle).max(0.0),
            Role::Straight(angle) => over(trial.yaw.abs(), angle),
            Role::Value | Role::Keep(_) | Role::Beside => 0.0,
        };
        broken += over(trial.top.0, rules.ceiling);
        if rules.body_share < 1.0 && setting.role == Role::Value {
            broken += (trial.body_share - rules.body_share).max(0.0);
        }
        broken + over(trial.demanded_shoulder, rules.demanded_shoulder)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Thoroughness {
    UntilBroken,
    Everything,
}

/// Of a cycle that asks too much of a joint's speed, how much too much: a search can go down that
/// slope.
fn excess_speed(error: &CrawlError) -> f64 {
    match error {
        CrawlError::Cycle(CycleError::Speed { speed, limit, .. }) => speed / limit - 1.0,
        _ => UNTRIED,
    }
}

/// How deep limbs are in one another in the planned cycle, over 10 mm; 0 where they are not.
fn collides(collision: &SelfCollision, checked: &CheckedCycle) -> f64 {
    let seconds = checked.pull().duration().seconds();
    let share = |k: usize, of: usize| k as f64 / of as f64;
    let mut postures: Vec<JointAngles> = (0..=PLAN_SAMPLES)
        .map(|k| checked.pull_at(seconds * share(k, PLAN_SAMPLES)))
        .collect();
    if let Ok(path) = checked.recovery_after(checked) {
        let (seconds, count) = (checked.recovery_seconds(), 3 * PLAN_SAMPLES);
        postures.extend((1..count).map(|k| path.at(seconds * share(k, count))));
    }
    // Its engine data is scratch.
    let scan = collision.clone().scan(&postures, f64::NEG_INFINITY);
    scan.map_or(UNTRIED, |scan| {
        (-scan.closest.closest.distance_m).max(0.0) / 0.01
    })
}

/// Postures of a pull that are looked at for collisions; three times as many of a recovery.
const PLAN_SAMPLES: usize = 8;

/// Crawls a cycle in one setting.
///
/// # Errors
/// [`CrawlError`].
pub fn try_out(setting: &Setting, cycle: &Cycle) -> Result<Trial, CrawlError> {
    let cycle = Cycle {
        pull_duration: setting.pull.unwrap_or(cycle.pull_duration),
        ..cycle.clone()
    };
    let cycles = std::slice::from_ref(&cycle);
    let plan = CrawlPlan {
        cycles,
        scale: setting.scale,
        end: End::Cycles(setting.cycles),
        offsets: setting.offsets.clone(),
        detail: Detail::Sums,
    };
    let limit = cycle
        .steering
        .as_ref()
        .map_or(0.0, |steering| steering.limit);
    let mut pilot = Straight {
        turn: setting.turn * limit,
    };
    let crawl = crawl::run(&setting.world, &plan, &mut pilot)?;
    Ok(measured(setting, &crawl))
}

fn measured(setting: &Setting, crawl: &Crawl) -> Trial {
    let robot = setting.world.robot();
    let Some(last) = crawl.cycles.last() else {
        return nothing(setting);
    };
    let advance = last.advance();
    let (peak, joint) = last.effort.peak_over_limit(robot);
    let shoulders = robot.chain.sides().map(|side| side.shoulder);
    let demanded = shoulders.map(|id| last.effort.joints[id.0].demanded_peak);
    let saturated = shoulders.map(|id| last.effort.joints[id.0].saturated);
    Trial {
        setting: setting.name.clone(),
        advance: advance.forward,
        seconds: last.seconds,
        top: (crawl.tops.highest(), crawl.tops.part().name()),
        heat_per_metre: per_metre(last.effort.heat(robot), advance.forward),
        peak_over_limit: (peak, robot.joints[joint.0].name.clone()),
        demanded_shoulder: demanded[0].max(demanded[1]),
        shoulder_saturated: saturated[0].max(saturated[1]) / last.seconds,
        body_share: last.body_share,
        yaw: advance.yaw,
    }
}

/// A cost per metre; of what does not advance, infinite.
fn per_metre(cost: f64, advance: f64) -> f64 {
    if advance > 0.0 {
        cost / advance
    } else {
        f64::INFINITY
    }
}

fn nothing(setting: &Setting) -> Trial {
    Trial {
        setting: setting.name.clone(),
        advance: 0.0,
        seconds: 0.0,
        top: (f64::INFINITY, ""),
        heat_per_metre: f64::INFINITY,
        peak_over_limit: (0.0, String::new()),
        demanded_shoulder: 0.0,
        shoulder_saturated: 0.0,
        body_share: 0.0,
        yaw: 0.0,
    }
}
