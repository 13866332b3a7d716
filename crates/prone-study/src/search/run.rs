//! Carrying out a search, whatever is searched: under a budget of evaluations and of time, with
//! checkpoints, until it ends or is stopped; then the confirmation and the result.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use prone::cost::CostError;
use prone::cost::objective::NoMotor;
use prone_record::measure::Measure;
use prone_record::output::{self, Artefacts};
use prone_record::resumption::{self, ResumptionError, STATE_FILE, Snapshot, Work};
use prone_record::search::{Search, SearchEnd};
use prone_record::search_plan::SearchPlan;
use prone_record::search_result::SearchResult;
use prone_report::figure_list::FigureList;
use prone_report::figures::{Figure, FigureError, PNG_SCALE};
use serde::Serialize;
use serde_json::json;

use super::candidates::{Candidates, PointError, Watched};
use crate::watch::Watch;

/// One box of gaits to search.
#[derive(Debug)]
pub struct Job<C> {
    /// Where a quantity is held, in its unit, where one is.
    pub at: Option<f64>,
    /// Name of the gait that is searched about.
    pub base: String,
    /// What is searched.
    pub candidates: C,
}

/// A search with all that it needs.
pub trait SearchRun: Send + Sync + 'static {
    /// What is searched.
    type Candidates: Candidates;

    /// What was asked for: `run.json`.
    fn plan(&self) -> &SearchPlan;

    /// How the values of its searches are read.
    fn measure(&self) -> Measure;

    /// Boxes, searched one after the other.
    fn jobs(&self) -> &[Job<Self::Candidates>];

    /// Confirms what was found, and makes the files of the result folder; one search a job.
    fn conclude(
        &self,
        searches: &[Search],
        end: SearchEnd,
        watch: &dyn Watch,
    ) -> Result<(SearchResult, Artefacts), SearchError>;
}

/// Why a search has no result.
#[derive(Debug, thiserror::Error)]
pub enum SearchError {
    /// Nothing was evaluated.
    #[error("the budget of {budget} evaluations is too small for one generation")]
    Nothing {
        /// The budget of all runs.
        budget: u64,
    },
    /// The user asked to stop; the searches are as they were after the last generation.
    #[error("stopped before the end")]
    Stopped,
    /// A found point makes no gait.
    #[error(transparent)]
    Point(#[from] PointError),
    /// The checkpoint cannot be written.
    #[error(transparent)]
    Checkpoint(#[from] ResumptionError),
    /// The objective of a confirmation does not fit the robot.
    #[error(transparent)]
    NoMotor(#[from] NoMotor),
    /// A simulated pull has no cost.
    #[error(transparent)]
    Cost(#[from] CostError),
    /// A table cannot be written.
    #[error(transparent)]
    Table(#[from] csv::Error),
    /// A record cannot be written.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// A figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
}

/// A search that is done.
#[derive(Debug)]
pub struct Done {
    /// What `result.json` says.
    pub result: SearchResult,
    /// All files of the result folder.
    pub artefacts: Artefacts,
    /// Whether every run came to its own end, or the time was over.
    pub end: SearchEnd,
}

/// Where searches are kept between generations: all of a run, one a job.
pub type Checkpoint = Snapshot<Vec<Search>>;

/// Searches that have not begun, one a job.
pub fn begin<R: SearchRun>(run: &R) -> Vec<Search> {
    let fresh = |_: &_| run.plan().head().new_search();
    run.jobs().iter().map(fresh).collect()
}

/// Goes on with searches on the current rayon pool, from wherever they are, to the result. Of the time
/// each search has an equal share of what those before it have left.
///
/// # Errors
/// [`SearchError`]; a search that was stopped is in its checkpoint, where there is one.
pub fn run<R: SearchRun>(
    run: &R,
    searches: &mut [Search],
    time: Option<Duration>,
    watch: &dyn Watch,
    mut checkpoint: Option<&mut Checkpoint>,
) -> Result<Done, SearchError> {
    let started = Instant::now();
    let evaluations = |searches: &[Search]| searches.iter().map(Search::evaluations).sum::<u64>();
    let before = evaluations(searches);
    let mut end = SearchEnd::Finished;
    for index in 0..run.jobs().len().min(searches.len()) {
        let left = time.map(|time| time.saturating_sub(started.elapsed()));
        let others = u32::try_from(searches.len() - index).unwrap_or(u32::MAX);
        let share = left.map(|left| started.elapsed() + left / others);
        let out_of_time = || share.is_some_and(|share| started.elapsed() >= share);
        let kept = checkpoint.as_deref_mut();
        if proceed(run, searches, index, watch, &out_of_time, kept)? == SearchEnd::Interrupted {
            end = SearchEnd::Interrupted;
        }
        if watch.stop() {
            return Err(SearchError::Stopped);
        }
    }
    if searches.iter().all(|search| search.best().is_none()) {
        let budget = searches.iter().map(Search::allowance).sum();
        return Err(SearchError::Nothing { budget });
    }
    let searched = started.elapsed();
    let (result, mut artefacts) = run.conclude(searches, end, watch)?;
    if watch.stop() {
        return Err(SearchError::Stopped);
    }
    let timing = json!({
        "wall_s": started.elapsed().as_secs_f64(),
        "search_s": searched.as_secs_f64(),
        "evaluations": evaluations(searches) - before,
        "threads": rayon::current_num_threads(),
    });
    artefacts.insert("timing.json".into(), pretty(&timing)?);
    let plan = serde_json::to_value(run.plan())?;
    artefacts.insert("run.json".into(), pretty(&plan)?);
    artefacts.insert("result.json".into(), pretty(&result)?);
    // From there a longer search goes on.
    let state = resumption::text(Work::Search, &run.plan().without_budget(), &searches)?;
    artefacts.insert(STATE_FILE.into(), state.into_bytes());
    Ok(Done {
        result,
        artefacts,
        end,
    })
}

/// Goes on with one search, and leaves a checkpoint of all.
fn proceed<R: SearchRun>(
    run: &R,
    searches: &mut [Search],
    index: usize,
    watch: &dyn Watch,
    out_of_time: &dyn Fn() -> bool,
    mut checkpoint: Option<&mut Checkpoint>,
) -> Result<SearchEnd, ResumptionError> {
    let (before, rest) = searches.split_at_mut(index);
    let Some((search, after)) = rest.split_first_mut() else {
        return Ok(SearchEnd::Finished);
    };
    let Some(job) = run.jobs().get(index) else {
        return Ok(SearchEnd::Finished);
    };
    let measure = run.measure();
    let scorer = Watched::new(&job.candidates, watch);
    scorer.tell(search, measure);
    let all = |search: &Search| -> Vec<Search> {
        let around = before.iter().chain([search]).chain(after.iter());
        around.cloned().collect()
    };
    let mut kept = Ok(());
    let end = search.proceed(&scorer, |search| {
        scorer.tell(search, measure);
        // A budget too small for one generation leaves nothing to keep.
        if let (Some(checkpoint), true) = (&mut checkpoint, search.best().is_some()) {
            kept = checkpoint.keep(&all(search));
        }
        if kept.is_err() || out_of_time() || watch.stop() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    kept?;
    // The confirmation may still be stopped.
    if let (Some(checkpoint), true) = (checkpoint, search.best().is_some()) {
        checkpoint.write(&all(search))?;
    }
    Ok(end)
}

/// A record as a file.
pub(super) fn pretty(value: &impl Serialize) -> Result<Vec<u8>, SearchError> {
    Ok(output::json_text(value)?.into_bytes())
}

/// Figures and the list of them.
pub(super) fn draw(
    artefacts: &mut Artefacts,
    figures: impl IntoIterator<Item = Figure>,
) -> Result<(), SearchError> {
    let mut list = FigureList::default();
    for figure in figures {
        let png = figure.png(PNG_SCALE)?;
        list.drawing(artefacts, "figures/", figure, png);
    }
    list.finish(artefacts)?;
    Ok(())
}
