//! What a search says of the checkpoint beside its result folder.

use std::io::Write as _;
use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use prone_record::resumption::{Earlier, Opening, ResumptionError, Snapshot, Work};

use crate::Failure;

/// Locks the checkpoint of a search and gives the state to go on from, `None` to begin anew. What is
/// kept there is not lost without a word.
pub(crate) fn open<S: Serialize + DeserializeOwned>(
    out: &Path,
    plan: &Value,
    resume: bool,
) -> Result<(Snapshot<S>, Option<S>), Failure> {
    let opening = if resume {
        Opening::Resume
    } else {
        Opening::Restart
    };
    let (snapshot, earlier) =
        Snapshot::open(Work::Search, out, plan, opening).map_err(Failure::input)?;
    let path = snapshot.path().display();
    let (message, state) = match earlier {
        Earlier::State(state) => (None, Some(state)),
        Earlier::Nothing => {
            let message = format!("no search is kept in {path}: starting from the beginning");
            (resume.then_some(message), None)
        }
        Earlier::Torn => {
            let message = format!(
                "{path} breaks off before its search is whole: starting from the beginning"
            );
            (Some(message), None)
        }
        Earlier::Discarded { readable: true } => {
            let message = format!(
                "replacing {path}, which an earlier search has left: --resume goes on from there"
            );
            (Some(message), None)
        }
        Earlier::Discarded { readable: false } => {
            let message = format!("replacing {path}, which another version of prone has left");
            (Some(message), None)
        }
    };
    if let Some(message) = message {
        // Where nobody listens, the work goes on.
        let _ = writeln!(std::io::stderr(), "{message}");
    }
    Ok((snapshot, state))
}

/// A checkpoint that cannot be written is no fault of what was typed.
pub(crate) fn unwritten(error: ResumptionError) -> Failure {
    Failure::work(error)
}

/// The user has stopped the search, which is kept.
pub(crate) fn suspended(path: &Path) -> Failure {
    Failure::Paused(format!(
        "the search is kept in {}, and --resume goes on from there",
        path.display()
    ))
}
