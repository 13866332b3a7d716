//! What a whole cycle costs, by simulation in the locomotion regime.
//!
//! A cycle is crawled in one or more settings (friction, servo, time scale). In the main ones the
//! value counts: heat per metre, merged over servos ([`Merge`]), advance per cycle, speed, or what a
//! shoulder's servo demands. In all but those of [`Role::Beside`] nothing may be higher than the
//! ceiling and the advance has to be enough; [`CycleRules`] may ask for no more of a shoulder's servo
//! (with the robot's own gains), no more weight on trunk and legs in the pull (where values count),
//! no more heat. Limbs are kept apart in the plan, not in what lags behind it. What is broken adds
//! up, mostly in shares of its limit (stops in rad, limbs in one another in centimetres), and
//! compares before the value. The settings are taken in order, and those after one that
//! breaks a rule are not simulated: each counts as [`UNTRIED`].

use prone::crawl::CrawlerError;
use prone::gait::cycle::{CheckedCycle, Cycle, CycleError, TimeScale};
use prone::gait::{Clamp, LimitsPolicy};
use prone::robot::{JointAngles, JointId};
use prone_sim::crawl::CrawlError;
use prone_sim::regime::Servo;
use prone_sim::self_collision::{SelfCollision, SelfCollisionError};

use super::setting::{Role, Setting};
use super::trial::{Trial, try_out};

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
    /// Largest torque that a shoulder's servo demands, with the robot's own servo gains, N·m.
    Peak,
}

impl CycleObjective {
    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Heat => "heat",
            Self::Advance => "advance",
            Self::Speed => "speed",
            Self::Peak => "peak",
        }
    }

    /// Of trials where values count, the one with the robot's own servos first.
    fn value(self, trials: &[&Trial], merge: &Merge) -> f64 {
        let first = |of: fn(&Trial) -> f64| trials.first().map_or(f64::NAN, |trial| of(trial));
        match self {
            Self::Heat => merge.heat(trials),
            Self::Advance => first(|trial| -trial.advance),
            Self::Speed => first(|trial| -trial.advance / trial.seconds),
            Self::Peak => first(|trial| trial.demanded_shoulder),
        }
    }
}

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
            Self::WorstOver(others) => heats
                .zip(others)
                .map(|(heat, other)| heat / other)
                .fold(f64::NAN, f64::max),
        }
    }
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
    /// Largest torque that a shoulder's servo demands, N·m, with the robot's own servo gains: a
    /// servo that is five times as stiff asks for five times as much of the same lag, and no gait
    /// would be left.
    pub demanded_shoulder: f64,
    /// Largest heat, merged over servos.
    pub heat: f64,
}

impl CycleRules {
    /// None but that it advances at all.
    pub const FREE: Self = Self {
        ceiling: f64::INFINITY,
        advance: 0.01,
        body_share: 1.0,
        seconds: f64::INFINITY,
        demanded_shoulder: f64::INFINITY,
        heat: f64::INFINITY,
    };
}

/// What a search goes after.
#[derive(Debug, Clone, PartialEq)]
pub struct Aim {
    /// What is minimised.
    pub objective: CycleObjective,
    /// Of several settings.
    pub merge: Merge,
    /// What holds.
    pub rules: CycleRules,
}

/// A cycle's price.
#[derive(Debug, Clone, PartialEq)]
pub struct CyclePrice {
    /// The objective where values count, merged; NaN where the cycle could not be crawled.
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
    aim: Aim,
    allowed_clamps: Vec<Clamp>,
    collision: SelfCollision,
}

impl<'a> CyclePricer<'a> {
    /// A pricer; no joint may be asked further past its stop than `base` asks it.
    ///
    /// # Errors
    /// [`PricerError`] where the base cannot be crawled.
    pub fn new(settings: &'a [Setting], aim: Aim, base: &Cycle) -> Result<Self, PricerError> {
        let first = settings.first().ok_or(PricerError::NoSettings)?;
        let world = &first.world;
        let checked = CheckedCycle::plan(world.robot(), world.stops(), base, 0.0, TimeScale::ONE)?;
        Ok(Self {
            settings,
            aim,
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
        for (index, setting) in self.settings.iter().enumerate() {
            let left = (self.settings.len() - index) as f64;
            if price.violation > 0.0 && thoroughness == Thoroughness::UntilBroken {
                price.violation += UNTRIED * left;
                break;
            }
            let trial = match try_out(setting, cycle) {
                Ok(trial) => trial,
                Err(error) => {
                    price.violation += UNTRIED * left + excess_speed_of_crawl(&error);
                    break;
                }
            };
            let first = price
                .trials
                .first()
                .map_or(trial.advance, |first: &Trial| first.advance);
            price.violation += self.broken(setting, &trial, first);
            price.trials.push(trial);
        }
        let tried = self.settings.iter().zip(&price.trials);
        let valued: Vec<&Trial> = tried
            .filter(|(setting, _)| setting.spec.role == Role::Value)
            .map(|(_, trial)| trial)
            .collect();
        let Aim {
            objective,
            merge,
            rules,
        } = &self.aim;
        price.value = objective.value(&valued, merge);
        if rules.heat < f64::INFINITY {
            price.violation += (merge.heat(&valued) / rules.heat - 1.0).max(0.0);
        }
        price
    }

    /// What is broken before anything moves.
    fn broken_in_plan(&self, cycle: &Cycle) -> f64 {
        let Some(first) = self.settings.first() else {
            return UNTRIED;
        };
        let world = &first.world;
        let robot = world.robot();
        let over = |value: f64, limit: f64| (value / limit - 1.0).max(0.0);
        let mut broken = over(cycle.duration(TimeScale::ONE), self.aim.rules.seconds);
        let clamping = Cycle {
            pull: prone::gait::Gait {
                limits: LimitsPolicy::Clamp,
                ..cycle.pull.clone()
            },
            ..cycle.clone()
        };
        // The fastest setting decides whether joints are fast enough.
        let fastest = self.settings.iter().map(|setting| setting.spec.scale);
        let fastest = fastest.fold(
            TimeScale::ONE,
            |a, b| if b.value() < a.value() { b } else { a },
        );
        match CheckedCycle::plan(robot, world.stops(), &clamping, 0.0, fastest) {
            Ok(checked) => {
                broken += self.clamped_further(&checked);
                broken += collides(&self.collision, &checked);
            }
            Err(error) => broken += UNTRIED + excess_speed(&error),
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
        let rules = &self.aim.rules;
        let over = |value: f64, limit: f64| (value / limit - 1.0).max(0.0);
        if setting.spec.role == Role::Beside {
            return 0.0;
        }
        let least = match setting.spec.role.keep() {
            None => rules.advance,
            Some(share) => share * first_advance.max(rules.advance),
        };
        let mut broken = (1.0 - trial.advance / least).max(0.0);
        broken += setting.spec.role.misdirected(trial);
        broken += over(trial.top.0, rules.ceiling);
        if rules.body_share < 1.0 && setting.spec.role == Role::Value {
            broken += (trial.body_share - rules.body_share).max(0.0);
        }
        if setting.world.regime().servo == Servo::Robot {
            broken += over(trial.demanded_shoulder, rules.demanded_shoulder);
        }
        broken
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Thoroughness {
    UntilBroken,
    Everything,
}

/// Of a cycle that asks too much of a joint's speed, how much too much: a search can go down that
/// slope.
fn excess_speed(error: &CycleError) -> f64 {
    match error {
        CycleError::Speed { speed, limit, .. } => speed / limit - 1.0,
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

#[cfg(test)]
mod tests {
    use super::super::setting::SettingKind;
    use super::*;

    fn warm(heat_per_metre: f64) -> Trial {
        Trial {
            setting: SettingKind::AsItIs,
            advance: 0.1,
            seconds: 2.0,
            top: (0.2, "head"),
            heat_per_metre,
            peak_over_limit: (1.0, String::new()),
            demanded_shoulder: heat_per_metre,
            shoulder_saturated: 0.0,
            body_share: 0.0,
            yaw: 0.0,
        }
    }

    #[test]
    fn heats_merge_geometrically_or_to_the_worst_of_shares() {
        let (four, nine, much) = (warm(4.0), warm(9.0), warm(81.0));
        let mean = Merge::Mean.heat(&[&four, &nine]);
        assert!((mean - 6.0).abs() < 1e-12, "{mean}");
        let over = Merge::WorstOver(vec![8.0, 90.0]);
        assert!((over.heat(&[&four, &nine]) - 0.5).abs() < 1e-12);
        assert!((over.heat(&[&four, &much]) - 0.9).abs() < 1e-12);
        // Of other objectives the robot's own servos decide.
        let value = |objective: CycleObjective| objective.value(&[&four, &much], &Merge::Mean);
        assert!((value(CycleObjective::Peak) - 4.0).abs() < 1e-12);
        assert!((value(CycleObjective::Speed) + 0.05).abs() < 1e-12);
    }

    /// A cycle over itself is 1, whatever the servos.
    #[test]
    fn a_cycle_is_as_warm_as_itself() {
        use prone_files::shipped;
        use prone_sim::{LoadedRobot, RobotFiles};

        let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let cycle = shipped::cycle("thesis-nominal").unwrap().unwrap();
        let settings = super::super::settings::for_heat(&robot).unwrap();
        let merge = Merge::worst_over(&settings, &cycle).unwrap();
        let aim = Aim {
            objective: CycleObjective::Heat,
            merge,
            rules: CycleRules {
                demanded_shoulder: 1.0,
                heat: 0.5,
                ..CycleRules::FREE
            },
        };
        let price = CyclePricer::new(&settings, aim, &cycle)
            .unwrap()
            .quote(&cycle);
        assert!((price.value - 1.0).abs() < 1e-12, "{}", price.value);
        // Stiff servos demand several times as much; only the robot's own are held to the rule.
        let [own, stiff] = &price.trials[..] else {
            panic!("two servos");
        };
        assert!(stiff.demanded_shoulder > 2.0 * own.demanded_shoulder);
        // Twice the heat that is allowed, and what is demanded above 1 N·m.
        assert!((price.violation - own.demanded_shoulder).abs() < 1e-12);
    }
}
