//! Reading result folders whose drawings are shown as they are: searches of whole cycles, frontiers,
//! torque maps.

use serde::Deserialize;

use super::ReportError;
use super::folder::Folder;
use crate::cycle_search::frontier::Confirmed;
use crate::figure_list::FigureEntry;

/// What such a command left behind.
pub(super) struct DrawnRun {
    pub(super) folder: Folder,
    pub(super) recorded: Vec<FigureEntry>,
    /// Of a search of whole cycles.
    pub(super) cycles: Option<CycleResult>,
}

/// What is needed of the `result.json` of a search of cycles.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct CycleResult {
    pub(super) objective: String,
    pub(super) margin_mm: f64,
    pub(super) found: Vec<FoundCycle>,
}

/// What one search found.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct FoundCycle {
    pub(super) ceiling_mm: Option<f64>,
    pub(super) seed: u64,
    pub(super) evaluations: u64,
    pub(super) gait: String,
    pub(super) violation: f64,
    pub(super) confirmed: Confirmed,
}

impl DrawnRun {
    /// A search of whole cycles.
    pub(super) fn cycles(folder: Folder) -> Result<Self, ReportError> {
        Ok(Self {
            recorded: folder.figures()?,
            cycles: Some(folder.json("result.json")?),
            folder,
        })
    }

    /// Slices of a torque map.
    pub(super) fn map(folder: Folder) -> Result<Self, ReportError> {
        Ok(Self {
            recorded: folder.figures()?,
            cycles: None,
            folder,
        })
    }
}
