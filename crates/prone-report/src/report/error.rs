//! Why there is no report.

use std::io;
use std::path::PathBuf;

use crate::figures::FigureError;
use prone_record::head::HeadError;
use prone_record::recorded::ReadError;

/// Why there is no report.
#[derive(Debug, thiserror::Error)]
pub enum ReportError {
    /// There is no result of this version of the program.
    #[error(transparent)]
    Head(#[from] HeadError),
    /// A result that a report has no place for.
    #[error("{} holds a result of `prone {found}`, of which a report shows nothing", folder.display())]
    OtherCommand {
        /// The folder.
        folder: PathBuf,
        /// What wrote it.
        found: String,
    },
    /// A file of the result is missing.
    #[error("{} is not whole: it has no {file}", folder.display())]
    Missing {
        /// The folder.
        folder: PathBuf,
        /// What it does not have.
        file: String,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {source}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A JSON file is not what it should be.
    #[error("{}: {source}", file.display())]
    Json {
        /// The file.
        file: PathBuf,
        /// Where and why.
        source: serde_json::Error,
    },
    /// A table lacks a column.
    #[error("{} has no column {column}", file.display())]
    Column {
        /// The file.
        file: PathBuf,
        /// Its name.
        column: String,
    },
    /// A picture or a drawing cannot be read, or is too large, or may do more than be seen.
    #[error("{} is not a picture of ours: {reason}", file.display())]
    Picture {
        /// The file.
        file: PathBuf,
        /// Why.
        reason: String,
    },
    /// The record of a crawl cannot be read.
    #[error(transparent)]
    Record(#[from] ReadError),
    /// A figure cannot be drawn from a record.
    #[error("{run}: {source}")]
    Figure {
        /// The folder, as it was named.
        run: String,
        /// Why.
        source: FigureError,
    },
    /// What was read cannot be written again.
    #[error("JSON: {0}")]
    Encode(#[from] serde_json::Error),
    /// The records of a command cannot be set out to be read.
    #[error("cannot write a temporary file: {0}")]
    Temporary(io::Error),
}

impl ReportError {
    /// Whether what was given is at fault, not the writing of the report.
    pub const fn is_input(&self) -> bool {
        !matches!(self, Self::Encode(_) | Self::Temporary(_))
    }
}
