//! Reading `run.json` of a record.

use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use super::ReadError;
use super::model::MODEL_FILE;
use crate::head::Head;
use crate::output::RUN_FILE;
use crate::record_info::{Command, FORMAT, Part, RecordInfo};

/// Longest time between two rows, s: a record of a robot that is slower is none.
const LONGEST_STEP_S: f64 = 10.0;

impl RecordInfo {
    /// Reads `run.json` of a record that this version of the program has written.
    ///
    /// # Errors
    /// [`ReadError`].
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let (head, run) = Head::read(folder)?;
        Self::from_json(folder, &head, &run)
    }

    /// The same of a `run.json` whose head was read.
    ///
    /// # Errors
    /// [`ReadError`].
    pub fn from_json(folder: &Path, head: &Head, run: &Value) -> Result<Self, ReadError> {
        let file = folder.join(RUN_FILE).display().to_string();
        let mut commands = Command::ALL.into_iter();
        if !commands.any(|known| head.command == known.name()) {
            return Err(ReadError::Command {
                folder: folder.display().to_string(),
                found: format!("`prone {}`", head.command),
                inside: inside(folder, run),
            });
        }
        let format = run.pointer("/record/format").and_then(Value::as_u64);
        let found = format.unwrap_or(1);
        if found != FORMAT {
            return Err(ReadError::Format {
                file,
                found,
                version: head.version.clone(),
                commit: head.commit.clone(),
            });
        }
        let info = match Self::deserialize(run) {
            Ok(info) => info,
            Err(source) => return Err(ReadError::Json { file, source }),
        };
        match info.problem() {
            Some(problem) => Err(ReadError::Model { file, problem }),
            None => Ok(info),
        }
    }

    /// By what the file contradicts itself, if it does.
    fn problem(&self) -> Option<String> {
        let extent = &self.record;
        if let Some(step) = extent.row_step_s
            && !(step > 0.0 && step <= LONGEST_STEP_S)
        {
            return Some(format!(
                "row_step_s {step} is outside 0..{LONGEST_STEP_S} s"
            ));
        }
        let counted = extent
            .columns(Part::Rows)
            .any(|column| column == super::rows::CONTACTS);
        (extent.has(Part::Contacts) && !counted).then(|| {
            "record.channels lists contacts.csv without the column contacts of rows.csv".to_owned()
        })
    }
}

/// Recorded runs in the folder of another result, by the list of its files.
fn inside(folder: &Path, run: &Value) -> Vec<String> {
    let files = run.get("artefacts").and_then(Value::as_array);
    let names = files.into_iter().flatten().filter_map(Value::as_str);
    let folders = names.filter_map(|name| name.strip_suffix(MODEL_FILE)?.strip_suffix('/'));
    folders
        .map(|inner| folder.join(inner).display().to_string())
        .collect()
}
