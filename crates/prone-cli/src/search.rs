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

use crate::checkpoint::Checkpoint;
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
        let mut checkpoint = Checkpoint::beside(self.out, plan);
        let _lock = checkpoint.lock()?;
        let mut searches = self.begin(run, &checkpoint)?;

        let progress = Progress::searching()?;
        let time = self.time_budget.map(Duration::from_secs_f64);
        let done = pool.install(|| {
            let mut keep = |searches: &[&Search], due| match due {
                Due::NowAndThen => checkpoint.keep(&searches),
                Due::Now => checkpoint.write(&searches),
            };
            run::run(run, &mut searches, time, &progress, &mut keep)
        });
        progress.finish();
        // From here on a search that is stopped is kept.
        let suspended = || {
            let kept = checkpoint.path().display();
            Failure::Paused(format!(
                "the search is kept in {kept}, and --resume goes on from there"
            ))
        };
        let done = done.map_err(|error| match error {
            RunError::Checkpoint(failure) => failure,
            RunError::Search(SearchError::Stopped) => suspended(),
            RunError::Search(nothing @ SearchError::Nothing { .. }) => Failure::input(nothing),
            RunError::Search(error) => Failure::work(error),
        })?;
        let published = interrupt::publish(|| {
            output::publish(self.out, &done.artefacts).map_err(Failure::work)?;
            match done.end {
                SearchEnd::Finished => checkpoint.remove(),
                // One that a time budget ended can still go on.
                SearchEnd::Interrupted => Ok(()),
            }
        });
        published.map_err(|failure| match failure {
            Failure::Stopped => suspended(),
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

    /// New searches, or those that were interrupted.
    fn begin<R: SearchRun>(
        &self,
        run: &R,
        checkpoint: &Checkpoint,
    ) -> Result<Vec<Search>, Failure> {
        let fresh = run::begin(run);
        if !self.resume {
            checkpoint.announce_replacement();
            return Ok(fresh);
        }
        // Where nobody listens, the work goes on.
        let mut err = std::io::stderr();
        let path = checkpoint.path().display();
        let Some(mut searches) = checkpoint.read::<Vec<Search>>()? else {
            let _ = writeln!(err, "no checkpoint at {path}: beginning anew");
            return Ok(fresh);
        };
        if searches.len() != fresh.len() {
            return Err(Failure::Input(anyhow!(
                "{path} is the checkpoint of another search; without --resume it is replaced"
            )));
        }
        let budget = run.plan().head().budget.unwrap_or(0);
        for search in &mut searches {
            search.allow(budget).map_err(Failure::input)?;
        }
        let evaluations: u64 = searches.iter().map(Search::evaluations).sum();
        let _ = writeln!(err, "going on after {evaluations} evaluations");
        Ok(searches)
    }
}

fn as_json(record: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string_pretty(record).map_err(Failure::work)
}
