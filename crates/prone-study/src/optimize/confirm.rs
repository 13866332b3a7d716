//! A found gait beside others in the full simulation: does the gain hold at other speeds, and
//! under the other contact regime?
//!
//! Every gait starts in its own first pose, settled. Nothing here decides which gait is better: a
//! search finds a gait under one regime at one duration, and what the others say is printed beside
//! it, whichever way it goes.

use prone_record::gait_search::{Confirmation, Refusal, Row, Verdict};
use rayon::prelude::*;

use prone::cost::CostError;
use prone::gait::{Gait, PhaseDuration};
use prone::robot::Robot;
use prone_sim::World;
use prone_sim::pull::{self, Keep, Pull, PullError, Start};

use super::dynamic::{self, TrialError};
use crate::pulls::{Observer, pull_record};
use prone::cost::objective::{NoMotor, Objective};
use prone_record::contact_story;
use prone_record::pulls::JOINTS;

/// What is simulated.
#[derive(Debug, Clone)]
pub struct ConfirmPlan<'a> {
    /// The found gait last, the one that ratios are to first.
    pub gaits: &'a [Gait],
    /// Worlds, one per regime.
    pub worlds: &'a [&'a World],
    /// Durations of the pull.
    pub durations: &'a [PhaseDuration],
    /// What the search minimised.
    pub objective: &'a Objective,
}

/// Why there is no confirmation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ConfirmError {
    /// The objective does not fit the robot.
    #[error(transparent)]
    NoMotor(#[from] NoMotor),
    /// A record has no price.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// The user asked to stop.
    #[error("stopped before the end")]
    Stopped,
}

/// One pull to simulate.
#[derive(Clone, Copy)]
struct Job<'a> {
    world: &'a World,
    gait: &'a Gait,
    duration: PhaseDuration,
}

/// What became of a pull. That one cannot be simulated is a result, no failure.
enum Outcome {
    Measured(Box<Row>),
    Refused(Refusal),
}

/// Simulates on the current rayon pool.
///
/// # Errors
/// [`ConfirmError`].
pub fn run(plan: &ConfirmPlan<'_>, observer: &dyn Observer) -> Result<Confirmation, ConfirmError> {
    let mut jobs = Vec::new();
    for &world in plan.worlds {
        for gait in plan.gaits {
            for &duration in plan.durations {
                jobs.push(Job {
                    world,
                    gait,
                    duration,
                });
            }
        }
    }
    let measured: Vec<_> = jobs
        .par_iter()
        .with_max_len(1)
        .map(|job| {
            if observer.stop() {
                return Err(ConfirmError::Stopped);
            }
            let row = job.measure(plan.objective);
            observer.phase_done();
            row
        })
        .collect::<Result<_, _>>()?;

    let mut confirmation = Confirmation {
        rows: Vec::new(),
        refused: Vec::new(),
        verdicts: Vec::new(),
    };
    for outcome in measured {
        match outcome {
            Outcome::Measured(row) => confirmation.rows.push(*row),
            // One reason per gait and regime says enough.
            Outcome::Refused(it) if confirmation.refused.iter().any(|r| r.is_about(&it)) => {}
            Outcome::Refused(refusal) => confirmation.refused.push(refusal),
        }
    }
    fill_ratios(&mut confirmation.rows, plan);
    confirmation.verdicts = verdicts(&confirmation.rows, plan);
    Ok(confirmation)
}

impl Job<'_> {
    fn measure(&self, objective: &Objective) -> Result<Outcome, ConfirmError> {
        let robot = self.world.robot();
        let pull = match pull::run(
            self.world,
            self.gait,
            self.duration,
            Start::FirstPose,
            Keep::Rows,
        ) {
            Ok(pull) => pull,
            Err(error) => return Ok(Outcome::Refused(self.refusal(&error))),
        };
        let value = |objective: &Objective| -> Result<f64, ConfirmError> {
            let norm = objective.norm(robot)?;
            Ok(dynamic::torque_part(robot, &pull, &norm)?)
        };
        let (peak_of_effort, peak_joint) = peak(robot, &pull);
        let record = pull_record(robot, self.gait, self.duration, &pull);
        let story = contact_story::of(&record);
        let end = pull
            .rows
            .last()
            .map_or(pull.start, |row| row.ground_from_root);
        let tops = pull.rows.iter().map(|row| row.top);
        Ok(Outcome::Measured(Box::new(Row {
            regime: self.world.regime().name,
            gait: self.gait.name.clone(),
            duration_s: self.duration.seconds(),
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
        })))
    }

    fn refusal(&self, error: &PullError) -> Refusal {
        Refusal {
            regime: self.world.regime().name,
            gait: self.gait.name.clone(),
            reason: TrialError::from(error.clone()).to_string(),
        }
    }
}

/// The largest torque over the effort limit of its joint, and which joint it is.
fn peak(robot: &Robot, pull: &Pull) -> (f64, &'static str) {
    let limits = robot.chain.right.pitch_joints();
    let limits = limits.map(|joint| robot.joints[joint.0].effort_limit);
    let mut peak = (0.0, JOINTS[0]);
    for row in dynamic::torques(robot, pull) {
        for ((torque, limit), joint) in row.into_iter().zip(limits).zip(JOINTS) {
            if torque.abs() / limit > peak.0 {
                peak = (torque.abs() / limit, joint);
            }
        }
    }
    peak
}

fn fill_ratios(rows: &mut [Row], plan: &ConfirmPlan<'_>) {
    let Some(base) = plan.gaits.first() else {
        return;
    };
    let bases: Vec<Row> = rows
        .iter()
        .filter(|row| row.gait == base.name)
        .cloned()
        .collect();
    for row in rows {
        let own = bases.iter().find(|base| row.is_beside(base));
        row.ratio = own.map_or(f64::NAN, |base| row.objective / base.objective);
    }
}

fn verdicts(rows: &[Row], plan: &ConfirmPlan<'_>) -> Vec<Verdict> {
    let Some((found, others)) = plan.gaits.split_last() else {
        return Vec::new();
    };
    let mut verdicts = Vec::new();
    for world in plan.worlds {
        let regime = world.regime().name;
        for other in others {
            let ratios: Vec<f64> = rows
                .iter()
                .filter(|row| row.regime == regime && row.gait == found.name)
                .filter_map(|own| {
                    let mut others = rows.iter().filter(|row| row.gait == other.name);
                    let other = others.find(|row| row.is_beside(own))?;
                    Some(own.objective / other.objective)
                })
                .collect();
            verdicts.push(Verdict {
                regime,
                against: other.name.clone(),
                cheaper_at: ratios.iter().filter(|ratio| **ratio < 1.0).count(),
                of: ratios.len(),
                best_ratio: ratios.iter().copied().fold(f64::INFINITY, f64::min),
                worst_ratio: ratios.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            });
        }
    }
    verdicts
}
