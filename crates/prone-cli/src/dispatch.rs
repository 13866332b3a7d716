//! Carrying out what was typed: whatever can be run is run here, and what came out is shown.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use serde::Serialize;

use prone_record::experiment::Experiment;
use prone_record::search_result::SearchResult;
use prone_study::run::{Outcome, Place, Session};
use prone_thesis::published;
use prone_thesis::reproduce::Reproduction;

use crate::plan::{Plan, Work};
use crate::printed;
use crate::progress::Progress;
use crate::{Failure, cost, crawl, cycle_search, failure, interrupt, optimize, passage, refusal};
use crate::{program, reproduce, torque_map};

/// What came out.
enum Done {
    Study(Outcome),
    Reproduction(Box<Reproduction>),
}

/// Runs what a plan says, puts its result in place, and prints it.
pub(crate) fn carry_out(plan: &Plan) -> Result<(), Failure> {
    plan.files.check()?;
    let kept = plan.kept();
    interrupt::work(plan.work.step(), kept);
    let session = Session {
        program: program(),
        threads: plan.threads.map(usize::from),
        joint_ranges: Arc::new(published::crawl_range),
        place: plan.out().map(|path| Place {
            path: path.to_owned(),
            opening: plan.opening,
        }),
    };
    let progress = Progress::new()?;
    let done = match &plan.work {
        Work::Study(experiment) => {
            let outcome = session.run(experiment, &progress);
            outcome
                .map(Done::Study)
                .map_err(|error| refusal::of_study(error, experiment))
        }
        Work::Reproduction(experiment) => {
            let made = prone_thesis::reproduce::run(experiment, &session, &progress);
            let made = made.map(|made| Done::Reproduction(Box::new(made)));
            made.map_err(refusal::of_reproduction)
        }
    };
    progress.finish();
    let done = done?;
    interrupt::ended();
    done.remark();
    let mut out = printed::out();
    if plan.json {
        writeln!(out, "{}", done.json()?)?;
    } else {
        done.print(plan, &mut out)?;
    }
    done.shortfall(plan)
}

impl Done {
    /// The record of what came out.
    fn json(&self) -> Result<String, Failure> {
        match self {
            Self::Reproduction(it) => json(&it.summary),
            Self::Study(Outcome::Pull(it)) => json(&it.record),
            Self::Study(Outcome::Crawl(it)) => json(&it.summary),
            Self::Study(Outcome::Passage(it)) => json(&it.passage),
            Self::Study(Outcome::Cost(it)) => json(&it.cost),
            Self::Study(Outcome::CycleCost(it)) => json(it),
            Self::Study(Outcome::Search(it)) => json(&it.result),
            Self::Study(Outcome::TorqueMap(it)) => json(&it.summary),
        }
    }

    /// What came out as tables, and the place of the files.
    fn print(&self, plan: &Plan, out: &mut dyn Write) -> std::io::Result<()> {
        let place = |out: &mut dyn Write, noun: &str, file: Option<&str>| {
            plan.out().map_or(Ok(()), |folder| {
                let path = file.map_or_else(|| folder.to_owned(), |file| folder.join(file));
                writeln!(out, "\n{noun}: {}", path.display())
            })
        };
        match self {
            Self::Reproduction(it) => {
                reproduce::print(&it.summary, out)?;
                place(out, "report", Some("report.html"))
            }
            Self::Study(Outcome::Pull(_)) => place(out, "record", None),
            Self::Study(Outcome::Crawl(it)) => {
                crawl::print(&it.summary, out)?;
                place(out, "record", None)
            }
            Self::Study(Outcome::Passage(it)) => {
                let searched = matches!(&plan.work, Work::Study(Experiment::Passage(it)) if it.search.is_some());
                passage::print(&it.passage, searched, out)
            }
            Self::Study(Outcome::Cost(it)) => cost::print(it, out),
            Self::Study(Outcome::CycleCost(it)) => cost::print_cycle(it, out),
            Self::Study(Outcome::Search(done)) => match &done.result {
                SearchResult::Pulls(it) => {
                    optimize::print(it, out)?;
                    place(out, "gait", Some("gait.toml"))
                }
                SearchResult::Cycles(it) => {
                    cycle_search::print(it, out)?;
                    place(out, "result", None)
                }
            },
            Self::Study(Outcome::TorqueMap(it)) => {
                let map = plan.out().unwrap_or(Path::new(""));
                torque_map::build::print(&it.summary, map, out)
            }
        }
    }

    /// What goes to standard error.
    fn remark(&self) {
        if let Self::Study(Outcome::TorqueMap(map)) = self {
            let (wall_s, threads) = (map.wall.as_secs_f64(), map.threads);
            failure::say(&format!("done in {wall_s:.1} s, threads: {threads}"));
        }
    }

    /// What the result is short of: a crawl that was to end past its obstacles did not, or touched one.
    fn shortfall(&self, plan: &Plan) -> Result<(), Failure> {
        match self {
            Self::Study(Outcome::Crawl(it)) => crawl::shortfall(it, plan.on_contact),
            _ => Ok(()),
        }
    }
}

fn json(record: &impl Serialize) -> Result<String, Failure> {
    prone_record::output::json_text(record).map_err(Failure::work)
}
