//! `prone crawl run`.

mod plan;
mod report;

use std::io::Write as _;
use std::sync::Arc;

use anyhow::anyhow;
use serde_json::json;

use prone_record::lock::Lock;
use prone_record::output;
use prone_study::crawl::CrawlSetup;
use prone_study::run::{RunError, Session, Took};

use crate::args::{CrawlCommand, CrawlRunArgs};
use crate::{Failure, interrupt};

pub(crate) fn run(command: &CrawlCommand) -> Result<(), Failure> {
    match command {
        CrawlCommand::Run(args) => crawl_run(args),
        CrawlCommand::Under(args) => crate::passage::run(args),
        CrawlCommand::Frontier(args) => crate::cycle_search::frontier(args),
    }
}

fn crawl_run(args: &CrawlRunArgs) -> Result<(), Failure> {
    let experiment = plan::experiment(args)?;
    let setup = CrawlSetup::new(&experiment).map_err(plan::refused)?;
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
    let session = Session {
        program: crate::program(),
        threads: args.threads.map(usize::from),
        joint_ranges: Arc::new(prone_thesis::published::crawl_range),
    };
    let outcome = session
        .crawl(&setup, &interrupt::Interrupted)
        .map_err(failure)?;
    let summary = &outcome.summary;
    if let (Some(folder), Some(mut artefacts)) = (&args.record, outcome.artefacts) {
        artefacts.insert("timing.json".into(), timing(&outcome.took)?);
        interrupt::publish(|| output::publish(folder, &artefacts).map_err(Failure::work))?;
    }
    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string_pretty(summary).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
    } else {
        report::print(summary, &mut out)?;
        if let Some(folder) = &args.record {
            writeln!(out, "\nrecord: {}", folder.display())?;
        }
    }
    match outcome.missed_mm {
        None => Ok(()),
        Some(x) => Err(Failure::Work(anyhow!(
            "{} is not past x = {x:.0} mm after {} cycles",
            summary.gait,
            summary.cycles
        ))),
    }
}

fn timing(took: &Took) -> Result<Vec<u8>, Failure> {
    let timing = json!({
        "wall_s": took.wall.as_secs_f64(),
        "threads": took.threads,
        "engine_steps": took.engine_steps,
    });
    serde_json::to_vec_pretty(&timing).map_err(Failure::work)
}

/// A cycle that the robot cannot follow is wrong input, a diverging simulation is not.
fn failure(error: RunError) -> Failure {
    match error {
        RunError::Stopped => Failure::Stopped,
        RunError::Crawl(error) if error.is_input() => Failure::input(error),
        RunError::Cycle(_) | RunError::Setup(_) | RunError::Changed(_) => Failure::input(error),
        other => Failure::work(other),
    }
}
