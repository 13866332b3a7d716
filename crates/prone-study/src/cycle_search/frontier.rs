//! The curve of ceiling against advance, and whether a robot gets under a given one.

use std::cmp::Ordering;

use prone::gait::cycle::Cycle;
use prone::robot::Robot;
use prone_record::frontier::{Confirmed, ConfirmedSetting, Found, SettingKind};
use prone_sim::LoadedRobot;
use prone_sim::crawl::CrawlError;

use super::CycleProblem;
use super::form::{CycleForm, CycleFormError, PointError};
use super::price::{Aim, CyclePrice, CyclePricer, PricerError};
use super::setting::{Role, Setting};
use super::settings::{HOLDS, SettingError};
use super::trial::{Trial, try_out};
use prone_record::search::{Search, SearchEnd};

/// Why nothing can be said.
#[derive(Debug, thiserror::Error)]
pub enum FrontierError {
    /// A setting cannot be made.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// There is no box about the base cycle.
    #[error(transparent)]
    Form(#[from] CycleFormError),
    /// Cycles cannot be priced.
    #[error(transparent)]
    Pricer(#[from] PricerError),
    /// No cycle to begin with.
    #[error(
        "there is no cycle that {robot} can crawl to begin with{}",
        listed(refused)
    )]
    NoCycle {
        /// The robot's name.
        robot: String,
        /// Names of the cycles that were tried, and why they cannot be crawled.
        refused: Vec<(String, CrawlError)>,
    },
}

/// One line a cycle.
fn listed(refused: &[(String, CrawlError)]) -> String {
    let lines = refused.iter();
    let lines: Vec<String> = lines
        .map(|(cycle, error)| format!("\n  {cycle}: {error}"))
        .collect();
    lines.concat()
}

/// What is searched about one cycle.
pub struct Hunt<'a> {
    form: CycleForm,
    pricer: CyclePricer<'a>,
}

impl<'a> Hunt<'a> {
    /// Searches about a cycle in settings made by [`super::settings`].
    ///
    /// # Errors
    /// [`FrontierError`].
    pub fn new(
        robot: &Robot,
        settings: &'a [Setting],
        aim: Aim,
        base: &Cycle,
    ) -> Result<Self, FrontierError> {
        Ok(Self {
            form: CycleForm::about(robot, base)?,
            pricer: CyclePricer::new(settings, aim, base)?,
        })
    }

    /// Numbers of a point.
    pub fn variables(&self) -> usize {
        self.form.bounds().len()
    }

    /// Goes on with a search.
    pub fn proceed(
        &self,
        search: &mut Search,
        between: impl FnMut(&Search) -> std::ops::ControlFlow<()>,
    ) -> SearchEnd {
        let problem = CycleProblem {
            form: &self.form,
            pricer: &self.pricer,
        };
        search.proceed(&problem, between)
    }

    /// The cycle of a point, with its price in every setting.
    ///
    /// # Errors
    /// [`PointError`] where the point has no cycle.
    pub fn quote(&self, point: &[f64]) -> Result<(Cycle, CyclePrice), PointError> {
        let cycle = self.form.cycle(point)?;
        let price = self.pricer.quote(&cycle);
        Ok((cycle, price))
    }
}

/// Crawls a cycle in the settings of a confirmation, under a ceiling, m.
pub fn confirm(settings: &[Setting], cycle: &Cycle, ceiling: f64) -> Confirmed {
    let mut rows: Vec<ConfirmedSetting> = Vec::with_capacity(settings.len());
    let mut first = None;
    let mut holds = true;
    for setting in settings {
        let row = match try_out(setting, cycle) {
            Ok(trial) => {
                let advance = *first.get_or_insert(trial.advance);
                let kept = trial.advance / advance;
                holds &= does_hold(setting.spec.role, &trial, kept, ceiling);
                row(setting, &trial, kept)
            }
            Err(error) => {
                holds &= setting.spec.role == Role::Beside;
                refused(setting, error.to_string())
            }
        };
        rows.push(row);
    }
    Confirmed {
        holds,
        settings: rows,
    }
}

/// Whether a cycle does in a setting what its role asks: it stays below the ceiling, m, goes where it
/// should, advances, and keeps its share of the first setting's advance.
fn does_hold(role: Role, trial: &Trial, kept: f64, ceiling: f64) -> bool {
    let enough = kept >= role.keep().unwrap_or(HOLDS);
    let directed = role.misdirected(trial) <= 0.0;
    role == Role::Beside || (trial.top.0 < ceiling && enough && directed && trial.advance > 0.0)
}

fn row(setting: &Setting, trial: &Trial, kept: f64) -> ConfirmedSetting {
    ConfirmedSetting {
        setting: setting.spec.kind,
        mm_per_cycle: Some(trial.advance * 1e3),
        mm_per_s: Some(trial.advance / trial.seconds * 1e3),
        yaw_deg: Some(trial.yaw.to_degrees()),
        top_mm: Some(trial.top.0 * 1e3),
        top_part: Some(trial.top.1.name().to_owned()),
        heat_per_metre_s: Some(trial.heat_per_metre).filter(|heat| heat.is_finite()),
        peak_torque_over_rated: Some(trial.peak_over_limit.0),
        peak_joint: Some(trial.peak_over_limit.1.clone()),
        demanded_shoulder_nm: Some(trial.demanded_shoulder),
        kept: Some(kept),
        refused: None,
    }
}

fn refused(setting: &Setting, reason: String) -> ConfirmedSetting {
    ConfirmedSetting {
        setting: setting.spec.kind,
        mm_per_cycle: None,
        mm_per_s: None,
        yaw_deg: None,
        top_mm: None,
        top_part: None,
        heat_per_metre_s: None,
        peak_torque_over_rated: None,
        peak_joint: None,
        demanded_shoulder_nm: None,
        kept: None,
        refused: Some(reason),
    }
}

/// What a record says of a run's best cycle.
pub fn found(
    ceiling_mm: Option<f64>,
    seed: u64,
    evaluations: u64,
    cycle: &Cycle,
    price: &CyclePrice,
    confirmed: Confirmed,
) -> Found {
    Found {
        ceiling_mm,
        seed,
        evaluations,
        gait: cycle.pull.name.clone(),
        value: Some(price.value).filter(|value| value.is_finite()),
        violation: price.violation,
        refused: price.refusal.as_ref().map(ToString::to_string),
        unsteered: None,
        confirmed,
    }
}

/// Why a cycle cannot be steered.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotSteered {
    /// Something else turns it more.
    #[error(
        "its largest turn command turns it by {:.2}° a cycle, and uneven ground and joints that are \
         off by {:.2}°",
        turned.to_degrees(), thrown_off.to_degrees()
    )]
    ThrownOff {
        /// By the largest command, rad, positive to the left, as the command is.
        turned: f64,
        /// By what throws it off, rad, to whichever side.
        thrown_off: f64,
    },
    /// It cannot be crawled in a setting.
    #[error("{setting}: {source}")]
    Crawl {
        /// Which.
        setting: SettingKind,
        /// Why.
        source: CrawlError,
    },
}

/// Finds out whether a cycle can be steered: its largest command turns it by more than uneven ground
/// and joints that are off do, in the settings of
/// [`super::settings::for_steering_confirmation`]. A cycle that was searched for something else has
/// the steering of the one that it was searched about, which may do nothing in it, or turn it the
/// wrong way.
///
/// # Errors
/// [`NotSteered`].
pub fn check_steering(settings: &[Setting], cycle: &Cycle) -> Result<(), NotSteered> {
    // Not a number steers nothing, and throws a robot off as far as can be.
    let further = |one: f64, other: f64| match one.total_cmp(&other.abs()) {
        Ordering::Less => other.abs(),
        _ => one,
    };
    let (mut turned, mut thrown_off) = (f64::NEG_INFINITY, 0.0_f64);
    for setting in settings {
        let trial = try_out(setting, cycle).map_err(|source| NotSteered::Crawl {
            setting: setting.spec.kind,
            source,
        })?;
        match setting.spec.role {
            Role::Turn(_) => turned = turned.max(trial.yaw),
            Role::Value | Role::Keep(_) | Role::Beside | Role::Straight { .. } => {
                thrown_off = further(thrown_off, trial.yaw);
            }
        }
    }
    if turned > thrown_off {
        return Ok(());
    }
    Err(NotSteered::ThrownOff { turned, thrown_off })
}

/// The base of a search under a height, m: of the cycles that stay below it, the one that advances
/// most in the first of the settings; where none does, the lowest.
///
/// # Errors
/// [`FrontierError::NoCycle`].
pub fn base<'c>(
    robot: &LoadedRobot,
    setting: &Setting,
    cycles: &'c [Cycle],
    height: f64,
) -> Result<&'c Cycle, FrontierError> {
    let mut tried: Vec<(&Cycle, Trial)> = Vec::with_capacity(cycles.len());
    let mut refused = Vec::new();
    for cycle in cycles {
        match try_out(setting, cycle) {
            Ok(trial) => tried.push((cycle, trial)),
            Err(error) => refused.push((cycle.pull.name.clone(), error)),
        }
    }
    let below = tried.iter().filter(|(_, trial)| trial.top.0 <= height);
    let farthest = below.max_by(|a, b| a.1.advance.total_cmp(&b.1.advance));
    let lowest = || tried.iter().min_by(|a, b| a.1.top.0.total_cmp(&b.1.top.0));
    let chosen = farthest.or_else(lowest).map(|(cycle, _)| *cycle);
    chosen.ok_or_else(|| FrontierError::NoCycle {
        robot: robot.robot().name.clone(),
        refused,
    })
}

#[cfg(test)]
mod tests;
