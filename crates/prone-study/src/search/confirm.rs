//! What was found beside other gaits in the full simulation: does the gain hold at other speeds, on
//! other ground, under the other contact regime?
//!
//! Every gait is moved in every setting; nothing here decides which gait is better: a search finds a
//! gait in some settings, and what the others say is printed beside it, whichever way it goes.

use prone_record::contact_story;
use prone_record::frontier::{Confirmed, ConfirmedSetting};
use prone_record::gait_search::{Confirmation, Refusal, Row, Verdict};
use prone_record::pulls::JOINTS;
use rayon::prelude::*;

use prone::cost::objective::Objective;
use prone::gait::cycle::Cycle;
use prone::gait::{Gait, PhaseDuration};
use prone::robot::Robot;
use prone_sim::World;
use prone_sim::crawl::CrawlError;
use prone_sim::pull::{self, Keep, Pull, PullError, Start};

use super::cycle_rules::{Bounds, holds};
use super::pull_trial;
use super::run::SearchError;
use super::setting::{Role, Setting};
use super::trial::{Trial, try_out_unless};
use crate::pulls::pull_record;
use crate::watch::{Progress, Watch};

/// How a pull is simulated, from its own first pose, settled.
#[derive(Debug, Clone)]
pub struct PullSetting {
    /// The robot on its floor under a regime.
    pub world: World,
    /// How long the pull lasts.
    pub duration: PhaseDuration,
}

/// Moves every gait in every setting, on the current rayon pool. What it comes to, a refusal
/// included, stands by gait and then by setting.
fn in_every<S: Sync, G: Sync, R: Send>(
    gaits: &[G],
    settings: &[S],
    watch: &dyn Watch,
    measure: impl Fn(&G, &S) -> Result<R, SearchError> + Sync,
) -> Result<Vec<Vec<R>>, SearchError> {
    watch.progress(&Progress::Simulating(gaits.len() * settings.len()));
    let pairs = gaits
        .iter()
        .flat_map(|gait| settings.iter().map(move |setting| (gait, setting)));
    let pairs: Vec<(&G, &S)> = pairs.collect();
    let measured = pairs
        .into_par_iter()
        .with_max_len(1)
        .map(|(gait, setting)| {
            if watch.stop() {
                return Err(SearchError::Stopped);
            }
            let measured = measure(gait, setting)?;
            watch.progress(&Progress::Done(1));
            Ok(measured)
        });
    let mut measured = measured.collect::<Result<Vec<R>, _>>()?.into_iter();
    let of_a_gait = |_: &G| measured.by_ref().take(settings.len()).collect();
    Ok(gaits.iter().map(of_a_gait).collect())
}

/// Cycles, each with its bounds, in settings.
pub fn cycles(
    cycles: &[(Cycle, Bounds)],
    settings: &[Setting],
    watch: &dyn Watch,
) -> Result<Vec<Confirmed>, SearchError> {
    let tried = in_every(
        cycles,
        settings,
        watch,
        |(cycle, _), setting| match try_out_unless(&|| watch.stop(), setting, cycle) {
            Err(CrawlError::Stopped) => Err(SearchError::Stopped),
            tried => Ok(tried),
        },
    )?;
    let confirmed = cycles.iter().zip(tried);
    let confirmed = confirmed.map(|((_, bounds), tried)| confirmed_cycle(settings, tried, *bounds));
    Ok(confirmed.collect())
}

fn confirmed_cycle(
    settings: &[Setting],
    tried: Vec<Result<Trial, CrawlError>>,
    bounds: Bounds,
) -> Confirmed {
    let mut first = None;
    let mut all_hold = true;
    let rows = settings.iter().zip(tried).map(|(setting, tried)| {
        let role = setting.spec.role;
        match tried {
            Ok(trial) => {
                let kept = trial.advance / *first.get_or_insert(trial.advance);
                all_hold &= holds(&setting.spec, &trial, kept, bounds);
                cycle_row(setting, &trial, kept)
            }
            Err(error) => {
                all_hold &= role == Role::Beside;
                ConfirmedSetting {
                    setting: setting.spec.kind,
                    refused: Some(error.to_string()),
                    ..ConfirmedSetting::default()
                }
            }
        }
    });
    Confirmed {
        settings: rows.collect(),
        holds: all_hold,
    }
}

/// What a record says of a trial.
pub(super) fn cycle_row(setting: &Setting, trial: &Trial, kept: f64) -> ConfirmedSetting {
    ConfirmedSetting {
        setting: setting.spec.kind,
        mm_per_cycle: Some(trial.advance * 1e3),
        mm_per_s: Some(trial.advance / trial.seconds * 1e3),
        yaw_deg: Some(trial.yaw.to_degrees()),
        top_mm: Some(trial.top.0 * 1e3),
        top_part: Some(trial.top.1.name().to_owned()),
        heat_per_metre_s: Some(trial.heat_per_metre).filter(|heat| heat.is_finite()),
        duty: Some(trial.duty.0).filter(|duty| duty.is_finite()),
        duty_joint: Some(trial.duty.1.clone()).filter(|_| trial.duty.0.is_finite()),
        peak_torque_over_rated: Some(trial.peak_over_limit.0),
        peak_joint: Some(trial.peak_over_limit.1.clone()),
        demanded_shoulder_nm: Some(trial.demanded_shoulder),
        head_n: Some(trial.head),
        kept: Some(kept),
        refused: None,
    }
}

/// Pulls in settings, by what a search minimised; the found gait is the last, ratios are to the
/// first.
pub fn pulls(
    gaits: &[Gait],
    settings: &[PullSetting],
    objective: &Objective,
    watch: &dyn Watch,
) -> Result<Confirmation, SearchError> {
    let tried = in_every(gaits, settings, watch, |gait, setting| {
        pull_row(gait, setting, objective, watch)
    })?;
    let regime = |setting: &PullSetting| setting.world.regime().name;
    let mut regimes: Vec<&str> = settings.iter().map(regime).collect();
    regimes.dedup();
    let mut confirmation = Confirmation {
        rows: Vec::new(),
        refused: Vec::<Refusal>::new(),
        verdicts: Vec::new(),
    };
    for &own in &regimes {
        for tried in &tried {
            let rows = settings.iter().zip(tried);
            for (_, row) in rows.filter(|(setting, _)| regime(setting) == own) {
                match row.clone() {
                    Ok(row) => confirmation.rows.push(row),
                    // One reason per gait and regime says enough.
                    Err(it) if confirmation.refused.iter().any(|r| r.is_about(&it)) => {}
                    Err(refusal) => confirmation.refused.push(refusal),
                }
            }
        }
    }
    fill_ratios(&mut confirmation.rows, gaits);
    confirmation.verdicts = verdicts(&confirmation.rows, &regimes, gaits);
    Ok(confirmation)
}

/// What became of a pull. That one cannot be simulated is a result, no failure.
fn pull_row(
    gait: &Gait,
    setting: &PullSetting,
    objective: &Objective,
    watch: &dyn Watch,
) -> Result<Result<Row, Refusal>, SearchError> {
    let (world, duration) = (&setting.world, setting.duration);
    let robot = world.robot();
    let stopped = || watch.stop();
    let (start, keep) = (Start::FirstPose, Keep::Rows);
    let pull = match pull::run_unless(&stopped, world, gait, duration, start, keep) {
        Ok(pull) => pull,
        Err(PullError::Stopped) => return Err(SearchError::Stopped),
        Err(error) => {
            return Ok(Err(Refusal {
                regime: world.regime().name.into(),
                gait: gait.name.clone(),
                reason: error.to_string(),
            }));
        }
    };
    let value = |objective: &Objective| -> Result<f64, SearchError> {
        let norm = objective.norm(robot)?;
        Ok(pull_trial::torque_part(robot, &pull, &norm)?)
    };
    let (peak_of_effort, peak_joint) = peak(robot, &pull);
    let story = contact_story::of(&pull_record(robot, gait, duration, &pull));
    let end = pull.rows.last();
    let end = end.map_or(pull.start, |row| row.ground_from_root);
    let tops = pull.rows.iter().map(|row| row.top);
    Ok(Ok(Row {
        regime: world.regime().name,
        gait: gait.name.clone(),
        duration_s: duration.seconds(),
        objective: value(objective)?,
        ratio: f64::NAN,
        torque_n2m2s: value(&Objective::TORQUE)?,
        heat_s: value(&Objective::Heat).ok(),
        peak_of_effort,
        peak_joint,
        body_share_percent: story.body_share_percent,
        carried_from_percent: story.carried_from_percent,
        advance_mm: (end.origin().x() - pull.start.origin().x()) * 1e3,
        top_mm: tops.fold(f64::NEG_INFINITY, f64::max) * 1e3,
    }))
}

/// The largest torque over the effort limit of its joint, and which joint it is.
fn peak(robot: &Robot, pull: &Pull) -> (f64, &'static str) {
    let limits = robot.chain.right.pitch_joints();
    let limits = limits.map(|joint| robot.joints[joint.0].effort_limit);
    let mut peak = (0.0, JOINTS[0]);
    for row in pull_trial::torques(robot, pull) {
        for ((torque, limit), joint) in row.into_iter().zip(limits).zip(JOINTS) {
            if torque.abs() / limit > peak.0 {
                peak = (torque.abs() / limit, joint);
            }
        }
    }
    peak
}

fn fill_ratios(rows: &mut [Row], gaits: &[Gait]) {
    let Some(base) = gaits.first() else {
        return;
    };
    let bases = rows.iter().filter(|row| row.gait == base.name);
    let bases: Vec<Row> = bases.cloned().collect();
    for row in rows {
        let own = bases.iter().find(|base| row.is_beside(base));
        row.ratio = own.map_or(f64::NAN, |base| row.objective / base.objective);
    }
}

fn verdicts(rows: &[Row], regimes: &[&'static str], gaits: &[Gait]) -> Vec<Verdict> {
    let Some((found, others)) = gaits.split_last() else {
        return Vec::new();
    };
    let mut verdicts = Vec::new();
    for &regime in regimes {
        for other in others {
            let own = rows
                .iter()
                .filter(|row| row.regime == regime && row.gait == found.name);
            let ratios: Vec<f64> = own
                .filter_map(|own| {
                    let mut others = rows.iter().filter(|row| row.gait == other.name);
                    let other = others.find(|row| row.is_beside(own))?;
                    Some(own.objective / other.objective)
                })
                .collect();
            verdicts.push(Verdict {
                regime: regime.into(),
                against: other.name.clone(),
                cheaper_at: ratios.iter().filter(|ratio| **ratio < 1.0).count(),
                of: ratios.len(),
                best_ratio: ratios.iter().copied().reduce(f64::min),
                worst_ratio: ratios.iter().copied().reduce(f64::max),
            });
        }
    }
    verdicts
}
