//! Why a folder cannot be read as a record.

use std::path::Path;

use prone_files::compiled_robot::CompiledRobotError;
use prone_files::text_file;

use crate::head::HeadError;

/// Why a folder cannot be read as a record.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// There is no record.
    #[error("{folder} is not a recorded run: {reason}")]
    NotARecord {
        /// The folder.
        folder: String,
        /// By what that is known.
        reason: String,
    },
    /// It is another result of this program.
    #[error(
        "{folder} is not a recorded run, but a result of {found}; {}",
        match inside.as_slice() {
            [] => "`prone crawl run --record` makes one".to_owned(),
            inside => format!("recorded runs in it: {}", inside.join(", ")),
        }
    )]
    Command {
        /// The folder.
        folder: String,
        /// What wrote it.
        found: String,
        /// Folders in it that are recorded runs.
        inside: Vec<String>,
    },
    /// There is no result of this version of the program.
    #[error(transparent)]
    Head(#[from] HeadError),
    /// The compiled robot cannot be used.
    #[error(transparent)]
    Robot(#[from] CompiledRobotError),
    /// A file cannot be read.
    #[error(transparent)]
    File(#[from] text_file::ReadError),
    /// A file is not what it should be, or contradicts itself or another one.
    #[error("{file}: {problem}")]
    Content {
        /// The file's path.
        file: String,
        /// What is wrong, and where.
        problem: String,
    },
    /// A table lacks a column.
    #[error("{file} has no column {column}")]
    Column {
        /// The file's path.
        file: String,
        /// Its name.
        column: String,
    },
    /// A table has nothing to show.
    #[error("{folder} has no whole row: {cut}")]
    NoRows {
        /// The folder.
        folder: String,
        /// Why.
        cut: super::Cut,
    },
}

/// A file's text; what is cut within a letter is cut in its line too.
pub(super) fn text(folder: &Path, file: &'static str) -> Result<String, ReadError> {
    let path = folder.join(file);
    match text_file::read_within(folder, file, text_file::LARGEST_TABLE_BYTES) {
        Ok(bytes) => Ok(String::from_utf8_lossy(&bytes).into_owned()),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(ReadError::NotARecord {
            folder: folder.display().to_string(),
            reason: format!("it has no {file}"),
        }),
        Err(source) => Err(text_file::ReadError { path, source }.into()),
    }
}
