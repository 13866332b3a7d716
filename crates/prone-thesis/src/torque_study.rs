//! The published torque study: closed-chain phases at several durations, simulated in parallel.

mod plan;

use rayon::prelude::*;

use prone::cost::{CostError, squared_torque_integral};
use prone::gait::cycle::CycleError;
use prone::gait::{CheckedTrajectory, Gait, PhaseDuration, TrajectoryError};
use prone::mapping::MappingVariant;
use prone::robot::Robot;
use prone_sim::crawl::CrawlError;
use prone_sim::pull::{self, Keep, Pull, PullError, Start};
use prone_sim::{World, WorldError};

use prone_study::pulls::{chain_record, plan_chain, pull_record};
use prone_study::watch::{Progress, Watch};

use crate::published;
use prone_record::pulls::{ChainRecord, ClampRecord, CostRecord, PullRecord, RunRecord};

pub use plan::{Plan, PlanError};

/// Instants at which pictures of a pull are taken.
pub const PICTURES: usize = 5;

/// What came out.
#[derive(Debug, Default)]
pub struct TorqueStudy {
    /// Every gait at every duration.
    pub pulls: Vec<PullRecord>,
    /// What else was measured in each of [`TorqueStudy::pulls`].
    pub runs: Vec<RunRecord>,
    /// The planned chain of each gait.
    pub chains: Vec<ChainRecord>,
    /// Joints stopped at their limits, by gait.
    pub clamps: Vec<ClampRecord>,
    /// Costs in the order of the pulls.
    pub costs: Vec<CostRecord>,
    /// Costs of the same gaits under the mapping `exact`, at the showcase duration.
    pub exact_costs: Vec<CostRecord>,
    /// Each gait at the showcase duration, with what pictures and replay show.
    pub shown: Vec<(Gait, Pull)>,
    /// The duration that pictures and the contact story show.
    pub showcase_s: f64,
    /// Engine steps done in all.
    pub engine_steps: usize,
}

/// Why a study has no result.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A phase could not be run.
    #[error(transparent)]
    Pull(#[from] PullError),
    /// A gait has no trajectory.
    #[error(transparent)]
    Trajectory(#[from] TrajectoryError),
    /// The robot does not compile with the table.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The cycle does not fit the robot.
    #[error(transparent)]
    Cycle(#[from] CycleError),
    /// The crawl under the table has no record.
    #[error(transparent)]
    Crawl(#[from] CrawlError),
    /// The cost of a record cannot be computed.
    #[error("gait {gait} at {duration_s} s: {source}")]
    Cost {
        /// The gait's name.
        gait: String,
        /// Duration of the phase, s.
        duration_s: f64,
        /// What is wrong with the record.
        source: CostError,
    },
    /// The user asked to stop.
    #[error("stopped before the end; nothing was written")]
    Stopped,
}

/// One phase to simulate.
struct Job {
    gait: Gait,
    duration: PhaseDuration,
    /// Whether it belongs to the study proper, not to the comparison of mappings.
    proper: bool,
    /// Whether it is shown.
    showcase: bool,
}

impl Job {
    const fn keep(&self) -> Keep {
        if self.showcase {
            Keep::Shown { pictures: PICTURES }
        } else {
            Keep::Rows
        }
    }
}

/// Runs the study on the current rayon pool.
pub fn run(world: &World, plan: &Plan, watch: &dyn Watch) -> Result<TorqueStudy, StudyError> {
    run_jobs(world, plan, &jobs(plan), watch)
}

/// Runs its pulls alone: no pictures, and no comparison of mappings.
pub fn run_pulls(world: &World, plan: &Plan, watch: &dyn Watch) -> Result<TorqueStudy, StudyError> {
    let jobs = jobs(plan).into_iter().filter(|job| job.proper);
    let unseen = |job| Job {
        showcase: false,
        ..job
    };
    run_jobs(world, plan, &jobs.map(unseen).collect::<Vec<_>>(), watch)
}

fn run_jobs(
    world: &World,
    plan: &Plan,
    jobs: &[Job],
    watch: &dyn Watch,
) -> Result<TorqueStudy, StudyError> {
    let showcase = plan.showcase;
    let results: Vec<Result<Pull, StudyError>> = jobs
        .par_iter()
        .with_max_len(1)
        .map(|job| {
            if watch.stop() {
                return Err(StudyError::Stopped);
            }
            let (gait, duration, keep) = (&job.gait, job.duration, job.keep());
            let stopped = || watch.stop();
            let pull = pull::run_unless(&stopped, world, gait, duration, Start::Recorded, keep);
            let pull = pull.map_err(|error| match error {
                PullError::Stopped => StudyError::Stopped,
                error => StudyError::Pull(error),
            })?;
            watch.progress(&Progress::Done(1));
            Ok(pull)
        })
        .collect();

    let mut study = TorqueStudy {
        showcase_s: showcase.seconds(),
        ..TorqueStudy::default()
    };
    for gait in &plan.gaits {
        let trajectory = plan_chain(world, gait, showcase)?;
        study.chains.push(chain_record(gait, &trajectory));
        let clamps = clamp_records(world.robot(), gait, &trajectory);
        study.clamps.extend(clamps);
    }
    for (job, result) in jobs.iter().zip(results) {
        let pull = result?;
        study.engine_steps += pull.engine_steps;
        let record = pull_record(world.robot(), &job.gait, job.duration, &pull);
        let cost = cost_record(&record)?;
        if job.proper {
            study.costs.push(cost);
            study.runs.push(run_record(job, &pull));
            study.pulls.push(record);
            if job.showcase {
                study.shown.push((job.gait.clone(), pull));
            }
        } else {
            study.exact_costs.push(cost);
        }
    }
    Ok(study)
}

fn jobs(plan: &Plan) -> Vec<Job> {
    let proper = plan.gaits.iter().flat_map(|gait| {
        plan.durations.iter().map(|&duration| Job {
            gait: gait.clone(),
            duration,
            proper: true,
            showcase: duration == plan.showcase,
        })
    });
    let exact = plan.gaits.iter().map(|gait| Job {
        gait: Gait {
            mapping: MappingVariant::Exact,
            ..gait.clone()
        },
        duration: plan.showcase,
        proper: false,
        showcase: false,
    });
    proper.chain(exact).collect()
}

fn clamp_records<'a>(
    robot: &'a Robot,
    gait: &'a Gait,
    trajectory: &'a CheckedTrajectory,
) -> impl Iterator<Item = ClampRecord> + 'a {
    trajectory.clamps().iter().map(|clamp| ClampRecord {
        gait: gait.name.clone(),
        joint: robot.joints[clamp.joint.0].name.clone(),
        samples: clamp.samples,
        of_samples: trajectory.samples().len(),
        from_percent: clamp.from * 100.0,
        to_percent: clamp.to * 100.0,
        largest_deg: clamp.largest.to_degrees(),
    })
}

fn run_record(job: &Job, pull: &Pull) -> RunRecord {
    let last = pull.rows.last();
    let end = last.map_or(pull.start, |row| row.ground_from_root);
    let travel = end.origin().metres() - pull.start.origin().metres();
    let tops = |top: fn(&prone_sim::pull::Row) -> f64| {
        pull.rows.iter().map(top).fold(f64::NEG_INFINITY, f64::max) * 1e3
    };
    RunRecord {
        gait: job.gait.name.clone(),
        duration_s: job.duration.seconds(),
        advance_mm: travel.x * 1e3,
        lateral_mm: travel.y * 1e3,
        top_mm: tops(|row| row.top),
        head_top_mm: tops(|row| row.head_top),
    }
}

fn cost_record(pull: &PullRecord) -> Result<CostRecord, StudyError> {
    let rows = pull.rows.iter();
    let (times, torques): (Vec<_>, Vec<_>) = rows.map(|row| (row.time_s, row.torque_nm)).unzip();
    let cost = squared_torque_integral(&times, &torques).map_err(|source| StudyError::Cost {
        gait: pull.gait.clone(),
        duration_s: pull.duration_s,
        source,
    })?;
    Ok(CostRecord {
        gait: pull.gait.clone(),
        duration_s: pull.duration_s,
        cost_n2m2s: cost,
        published_n2m2s: published::cost(&pull.gait, pull.duration_s),
    })
}
