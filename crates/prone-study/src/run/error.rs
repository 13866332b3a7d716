//! Why an experiment has no outcome.

use std::path::PathBuf;

use rayon::ThreadPoolBuildError;

use prone::gait::PhaseDurationError;
use prone_record::experiment::{ChangedText, Limit, TextError};
use prone_record::lock::LockError;
use prone_record::output::OutputError;
use prone_record::resumption::ResumptionError;
use prone_record::search::SmallerBudget;
use prone_record::single_file::WriteError;
use prone_sim::pull::PullError;
use prone_sim::{LoadError, WorldError};

use crate::crawl::record::RecordError;
use crate::crawl::{CrawlRunError, CrawlSetupError, RefusedCycle};
use crate::frames::FramesError;
use crate::search::cycle_jobs::CycleSearchError;
use crate::search::pull_error::PullCostError;
use crate::search::room::NoRoom;
use crate::search::run::SearchError;
use crate::search::settings::SettingError;
use crate::torque_map::BuildError;

/// Why an experiment has no outcome.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A number that no experiment can have.
    #[error(transparent)]
    Limit(#[from] Limit),
    /// The robot's text is not the one that was asked for.
    #[error(transparent)]
    Changed(#[from] ChangedText),
    /// The robot cannot be loaded.
    #[error(transparent)]
    Robot(#[from] LoadError),
    /// A gait or a map cannot be read.
    #[error(transparent)]
    Text(#[from] TextError),
    /// The robot does not compile with its floor.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A duration that no pull can have.
    #[error(transparent)]
    Duration(#[from] PhaseDurationError),
    /// A crawl cannot be set up.
    #[error(transparent)]
    Setup(#[from] CrawlSetupError),
    /// A pull has no record.
    #[error(transparent)]
    Pull(PullError),
    /// A crawl has no record.
    #[error(transparent)]
    Crawl(CrawlRunError),
    /// The robot cannot crawl a cycle.
    #[error(transparent)]
    Cycle(#[from] RefusedCycle),
    /// A record has no files.
    #[error(transparent)]
    Record(RecordError),
    /// A margin that is as large as its ceiling.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// Cycles cannot be tried.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// Pulls have no costs, or cannot be searched.
    #[error(transparent)]
    Pulls(#[from] PullCostError),
    /// Cycles cannot be searched.
    #[error(transparent)]
    CycleSearch(Box<CycleSearchError>),
    /// A search has no result.
    #[error(transparent)]
    Search(Box<SearchError>),
    /// An interrupted search had more evaluations than it may have now.
    #[error(transparent)]
    Budget(#[from] SmallerBudget),
    /// A checkpoint holds another number of searches.
    #[error("the checkpoint holds {found} searches in place of {expected}")]
    Searches {
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// There is no torque map.
    #[error(transparent)]
    Build(Box<BuildError>),
    /// Earlier work cannot be taken up, or its place is taken.
    #[error(transparent)]
    Resumption(Box<ResumptionError>),
    /// The result cannot be put where it should be; nothing was done.
    #[error(transparent)]
    Place(OutputError),
    /// A result that is one file cannot be put where it should be; nothing was done.
    #[error(transparent)]
    PlaceOfFile(WriteError),
    /// Another process makes the same result.
    #[error(transparent)]
    Lock(#[from] LockError),
    /// The result is there, and cannot be put in place.
    #[error(transparent)]
    Publish(#[from] OutputError),
    /// A result that is one file is there, and cannot be written; rows of a torque map stay in its journal.
    #[error("{source}{}", kept(journal.as_ref()))]
    PublishFile {
        /// Why.
        source: WriteError,
        /// Where rows are kept.
        journal: Option<PathBuf>,
    },
    /// What was found has no text.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// The worker threads cannot be started.
    #[error("cannot start worker threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
    /// [`Watch::stop`](crate::watch::Watch::stop) said so; nothing is kept.
    #[error("stopped")]
    Stopped,
    /// A search was stopped; what was searched so far is in its checkpoint.
    #[error("stopped; the search is kept in {}", checkpoint.display())]
    StoppedSearch {
        /// The checkpoint.
        checkpoint: PathBuf,
    },
    /// A torque map was stopped; the rows that were measured are in its journal.
    #[error("stopped; {done} of {rows} rows are in {}", journal.display())]
    StoppedMap {
        /// Rows done.
        done: usize,
        /// Rows of the map.
        rows: usize,
        /// The journal.
        journal: PathBuf,
    },
}

fn kept(journal: Option<&PathBuf>) -> String {
    journal.map_or_else(String::new, |path| {
        format!("; all rows are in {}", path.display())
    })
}

impl RunError {
    /// Whether the work failed, and not what was asked for: it may succeed another time.
    pub fn is_work(&self) -> bool {
        match self {
            Self::Crawl(error) => !error.is_input(),
            Self::Search(error) => !matches!(**error, SearchError::Nothing { .. }),
            Self::Build(error) => error.is_work(),
            Self::Resumption(error) => matches!(**error, ResumptionError::Write(_)),
            Self::Pull(error) => !matches!(
                error,
                PullError::Trajectory(_) | PullError::StartPosture { .. }
            ),
            Self::Record(_)
            | Self::Publish(_)
            | Self::PublishFile { .. }
            | Self::Json(_)
            | Self::Threads(_) => true,
            _ => false,
        }
    }
}

impl From<PullError> for RunError {
    fn from(error: PullError) -> Self {
        match error {
            PullError::Stopped => Self::Stopped,
            other => Self::Pull(other),
        }
    }
}

impl From<RecordError> for RunError {
    fn from(error: RecordError) -> Self {
        match error {
            RecordError::Frames(FramesError::Stopped) => Self::Stopped,
            other => Self::Record(other),
        }
    }
}

impl From<CycleSearchError> for RunError {
    fn from(error: CycleSearchError) -> Self {
        match error {
            CycleSearchError::Stopped => Self::Stopped,
            other => Self::CycleSearch(Box::new(other)),
        }
    }
}

impl From<SearchError> for RunError {
    fn from(error: SearchError) -> Self {
        match error {
            SearchError::Stopped => Self::Stopped,
            other => Self::Search(Box::new(other)),
        }
    }
}

impl From<ResumptionError> for RunError {
    fn from(error: ResumptionError) -> Self {
        Self::Resumption(Box::new(error))
    }
}

impl From<BuildError> for RunError {
    fn from(error: BuildError) -> Self {
        match error {
            BuildError::Stopped {
                kept,
                rows,
                journal: Some(journal),
            } if kept > 0 => Self::StoppedMap {
                done: kept,
                rows,
                journal,
            },
            BuildError::Stopped { .. } => Self::Stopped,
            other => Self::Build(Box::new(other)),
        }
    }
}
