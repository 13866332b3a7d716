//! What a search leaves behind, whatever was searched: `result.json`.

use serde::Serialize;

use crate::frontier::Frontier;
use crate::gait_search::Outcome;

/// The result of a search.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum SearchResult {
    /// Of pulls.
    Pulls(Box<Outcome>),
    /// Of whole cycles.
    Cycles(Box<Frontier>),
}
