//! `prone crawl run`.

mod experiment;
mod report;

use anyhow::anyhow;

use prone_record::experiment::Experiment;
use prone_record::resumption::Opening;
use prone_study::run::CrawlOutcome;

use crate::Failure;
use crate::args::{CrawlCommand, CrawlRunArgs};
use crate::plan::{Plan, Work};

pub(crate) use report::print;

pub(crate) fn plan(command: &CrawlCommand) -> Result<Plan, Failure> {
    match command {
        CrawlCommand::Run(args) => crawl_run(args),
        CrawlCommand::Under(args) => crate::passage::plan(args),
        CrawlCommand::Frontier(args) => crate::cycle_search::frontier(args),
    }
}

fn crawl_run(args: &CrawlRunArgs) -> Result<Plan, Failure> {
    let experiment = Experiment::Crawl(Box::new(experiment::of(args)?));
    Ok(Plan {
        work: Work::Study(experiment),
        out: args.record.clone(),
        opening: Opening::Restart,
        threads: args.threads,
        json: args.json,
    })
}

/// A crawl that was to end past its obstacles did not.
pub(crate) fn shortfall(outcome: &CrawlOutcome) -> Result<(), Failure> {
    let summary = &outcome.summary;
    match outcome.missed_mm {
        None => Ok(()),
        Some(x) => Err(Failure::Work(anyhow!(
            "{} is not past x = {x:.0} mm after {} cycles",
            summary.gait,
            summary.cycles
        ))),
    }
}
