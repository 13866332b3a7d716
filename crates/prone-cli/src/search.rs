//! Carrying out a search: worker threads, checkpoint, result folder.

use std::io::Write as _;
use std::path::Path;
use std::time::Duration;

use anyhow::anyhow;
use serde::Serialize;

use prone_record::output;
use prone_record::search::{Search, SearchEnd};
use prone_record::search_plan::{SearchHead, SearchSolver};
use prone_study::search::run::{self, Due, RunError, SearchError, SearchRun};

use crate::checkpoint::{self, suspended, unwritten};
use crate::progress::Progress;
use crate::{Failure, interrupt};

/// Where a search goes, and how.
pub(crate) struct Carried<'a> {
    pub(crate) out: &'a Path,
    pub(crate) threads: Option<u16>,
    pub(crate) resume: bool,
    pub(crate) time_budget: Option<f64>,
    pub(crate) json: bool,
}

/// By whom a search is made, with which seeds and budget.
pub(crate) fn head(
    command: &str,
    solver: SearchSolver,
    seed: u64,
    runs: u64,
    budget: u64,
) -> SearchHead {
    SearchHead {
        program: "prone".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        commit: env!("PRONE_COMMIT").to_owned(),
        engine: prone_sim::engine_version(),
        command: command.to_owned(),
        solver,
        seed,
        runs,
        budget: Some(budget),
        base_sha256: std::collections::BTreeMap::new(),
    }
}

/// Worker threads.
pub(crate) fn pool(threads: Option<u16>) -> Result<rayon::ThreadPool, Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))
}

impl Carried<'_> {
    /// Searches, confirms, puts the result folder in place and prints: the record as JSON, or what
    /// `print` writes of it.
    pub(crate) fn carry_out<R: SearchRun>(
        &self,
        run: &R,
        print: impl FnOnce(&R::Outcome, &mut dyn std::io::Write) -> std::io::Result<()>,
    ) -> Result<(), Failure>
    where
        R::Outcome: Send,
    {
        interrupt::listen()?;
        output::check(self.out).map_err(Failure::input)?;
        let pool = pool(self.threads)?;
        // A search may be given more than it had.
        let plan = serde_json::to_value(run.plan().without_budget()).map_err(Failure::work)?;
        let (mut checkpoint, earlier) = checkpoint::open(self.out, &plan, self.resume)?;
        let mut searches = begin(run, earlier)?;

        let progress = Progress::searching()?;
        let time = self.time_budget.map(Duration::from_secs_f64);
        let done = pool.install(|| {
            let mut keep = |searches: &[&Search], due| {
                let searches: Vec<Search> = searches.iter().copied().cloned().collect();
                match due {
                    Due::NowAndThen => checkpoint.keep(&searches),
                    Due::Now => checkpoint.write(&searches),
                }
            };
            run::run(run, &mut searches, time, &progress, &mut keep)
        });
        progress.finish();
        // From here on a search that is stopped is kept.
        let done = done.map_err(|error| match error {
            RunError::Checkpoint(error) => unwritten(error),
            RunError::Search(SearchError::Stopped) => suspended(checkpoint.path()),
            RunError::Search(nothing @ SearchError::Nothing { .. }) => Failure::input(nothing),
            RunError::Search(error) => Failure::work(error),
        })?;
        let published = interrupt::publish(|| {
            output::publish(self.out, &done.artefacts).map_err(Failure::work)?;
            match done.end {
                SearchEnd::Finished => checkpoint.remove().map_err(unwritten),
                // One that a time budget ended can still go on.
                SearchEnd::Interrupted => Ok(()),
            }
        });
        published.map_err(|failure| match failure {
            Failure::Stopped => suspended(checkpoint.path()),
            other => other,
        })?;

        let mut out = std::io::stdout().lock();
        if self.json {
            writeln!(out, "{}", as_json(&done.outcome)?)?;
        } else {
            print(&done.outcome, &mut out)?;
        }
        Ok(())
    }
}

/// New searches, or those that were interrupted.
fn begin<R: SearchRun>(run: &R, earlier: Option<Vec<Search>>) -> Result<Vec<Search>, Failure> {
    let fresh = run::begin(run);
    let Some(mut searches) = earlier else {
        return Ok(fresh);
    };
    if searches.len() != fresh.len() {
        return Err(Failure::Input(anyhow!(
            "the checkpoint holds {} searches in place of {}; without --resume it is replaced",
            searches.len(),
            fresh.len()
        )));
    }
    let budget = run.plan().head().budget.unwrap_or(0);
    for search in &mut searches {
        search.allow(budget).map_err(Failure::input)?;
    }
    let evaluations: u64 = searches.iter().map(Search::evaluations).sum();
    // Where nobody listens, the work goes on.
    let _ = writeln!(
        std::io::stderr(),
        "going on after {evaluations} evaluations"
    );
    Ok(searches)
}

fn as_json(record: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(record).map_err(Failure::work)
}
