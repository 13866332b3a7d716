//! `prone crawl run`.

mod experiment;
mod report;

use anyhow::anyhow;

use prone_record::experiment::Experiment;
use prone_record::resumption::Opening;
use prone_study::run::CrawlOutcome;

use crate::Failure;
use crate::args::{CrawlCommand, CrawlRunArgs};
use crate::outputs::Kind;
use crate::plan::{OnContact, Plan, Work};

pub(crate) use report::print;

pub(crate) fn plan(command: &CrawlCommand) -> Result<Plan, Failure> {
    match command {
        CrawlCommand::Run(args) => crawl_run(args),
        CrawlCommand::Under(args) => crate::passage::plan(args),
        CrawlCommand::Frontier(args) => crate::cycle_search::frontier(args),
    }
}

fn crawl_run(args: &CrawlRunArgs) -> Result<Plan, Failure> {
    let (experiment, read) = experiment::of(args)?;
    Ok(Plan {
        work: Work::Study(Experiment::Crawl(Box::new(experiment))),
        files: read.maybe_writing("--record", args.record.as_ref(), Kind::Folder),
        opening: Opening::Restart,
        threads: args.threads,
        json: args.json,
        on_contact: if args.fail_on_contact {
            OnContact::Fail
        } else {
            OnContact::Report
        },
    })
}

/// How often something was touched, in words.
fn times(count: usize) -> String {
    match count {
        1 => "touched an obstacle once".to_owned(),
        _ => format!("touched obstacles {count} times"),
    }
}

/// A crawl that was to end past its obstacles did not, or it touched what it was not to touch.
pub(crate) fn shortfall(outcome: &CrawlOutcome, on_contact: OnContact) -> Result<(), Failure> {
    let summary = &outcome.summary;
    if let Some(x) = outcome.missed_mm {
        return Err(Failure::Work(anyhow!(
            "{} is not past x = {x:.0} mm after {} cycles",
            summary.gait,
            summary.cycles
        )));
    }
    if on_contact == OnContact::Fail && summary.plate_contacts > 0 {
        return Err(Failure::Work(anyhow!(
            "{} {}, which --fail-on-contact takes for a failure",
            summary.gait,
            times(summary.plate_contacts)
        )));
    }
    Ok(())
}
