//! `prone crawl run`.

mod plan;
mod report;

use std::io::Write as _;
use std::time::Instant;

use anyhow::anyhow;
use serde_json::json;

use prone::crawl::CrawlerError;
use prone_record::crawl_summary::CrawlSummary;
use prone_record::lock::Lock;
use prone_record::output;
use prone_record::program::Program;
use prone_sim::World;
use prone_sim::crawl::{self, Crawl, CrawlError, CrawlPlan, Detail};
use prone_study::crawl::record::{self, Recording};
use prone_study::crawl::summary;

use crate::args::{CrawlCommand, CrawlRunArgs};
use crate::{Failure, interrupt};
use plan::Plan;

pub(crate) fn run(command: &CrawlCommand) -> Result<(), Failure> {
    match command {
        CrawlCommand::Run(args) => crawl_run(args),
        CrawlCommand::Under(args) => crate::passage::run(args),
        CrawlCommand::Frontier(args) => crate::cycle_search::frontier(args),
    }
}

fn crawl_run(args: &CrawlRunArgs) -> Result<(), Failure> {
    let plan = Plan::new(args)?;
    interrupt::listen()?;
    // Of two crawls into one folder, the first to end would be lost.
    let _lock = match &args.record {
        Some(folder) => {
            output::check(folder).map_err(Failure::input)?;
            let what = "crawl that is recorded in this folder";
            Some(Lock::for_folder(folder, what).map_err(Failure::input)?)
        }
        None => None,
    };
    let started = Instant::now();
    let crawl = simulate(&plan, args)?;
    let past = plan.past;
    let summary = summary::of(&plan.world, &plan.gait.cycle, args.time_scale, &crawl, past)
        .map_err(Failure::input)?;
    if let Some(folder) = &args.record {
        let artefacts = files(args, &plan, &crawl, &summary, started)?;
        interrupt::publish(|| output::publish(folder, &artefacts).map_err(Failure::work))?;
    }
    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string_pretty(&summary).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
    } else {
        report::print(&summary, &mut out)?;
        if let Some(folder) = &args.record {
            writeln!(out, "\nrecord: {}", folder.display())?;
        }
    }
    match past {
        Some(past) if !crawl.arrived => Err(Failure::Work(anyhow!(
            "{} is not past x = {:.0} mm after {} cycles",
            summary.gait,
            past.x * 1e3,
            summary.cycles
        ))),
        _ => Ok(()),
    }
}

fn simulate(plan: &Plan, args: &CrawlRunArgs) -> Result<Crawl, Failure> {
    let crawl_plan = CrawlPlan {
        cycles: plan.cycles(),
        scale: args.time_scale,
        end: plan.end,
        offsets: plan.offsets.clone(),
        imu_seed: plan.imu_seed,
        detail: if args.record.is_some() {
            Detail::Rows
        } else {
            Detail::Sums
        },
    };
    let crawl = crawl::run_unless(
        &interrupt::requested,
        &plan.world,
        &crawl_plan,
        plan.pilot(),
    );
    crawl.map_err(|error| plan.failure(error))
}

/// A cycle that the robot cannot follow is wrong input, a diverging simulation is not.
pub(crate) fn failure(error: CrawlError) -> Failure {
    match error {
        CrawlError::Stopped => Failure::Stopped,
        CrawlError::Crawler(CrawlerError::Cycle { .. } | CrawlerError::Mapping { .. })
        | CrawlError::Imu(_) => Failure::input(error),
        CrawlError::Crawler(_)
        | CrawlError::Timing(_)
        | CrawlError::Simulation { .. }
        | CrawlError::Port { .. } => Failure::work(error),
    }
}

fn files(
    args: &CrawlRunArgs,
    plan: &Plan,
    crawl: &Crawl,
    summary: &CrawlSummary,
    started: Instant,
) -> Result<output::Artefacts, Failure> {
    let world: &World = &plan.world;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))?;
    let program = Program {
        version: env!("CARGO_PKG_VERSION").into(),
        commit: env!("PRONE_COMMIT").into(),
    };
    let recording = Recording {
        robot: &plan.robot,
        world,
        gait: &plan.gait,
        conditions: &plan.conditions,
        crawl,
        summary,
    };
    let mut artefacts = pool
        .install(|| record::files(&recording, &program, &prone_thesis::published::crawl_range))
        .map_err(Failure::work)?;
    let timing = json!({
        "wall_s": started.elapsed().as_secs_f64(),
        "threads": pool.current_num_threads(),
        "engine_steps": crawl.engine_steps,
    });
    let timing = serde_json::to_vec_pretty(&timing).map_err(Failure::work)?;
    artefacts.insert("timing.json".into(), timing);
    Ok(artefacts)
}
