//! `run.json`: under which conditions a record was made, and how long its tables are.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::ReadError;
use super::error::text;
use super::model::MODEL_FILE;
use crate::output::RUN_FILE;
use crate::program::version_name;

/// Longest time between two rows, s: a record of a robot that is slower is none.
const LONGEST_STEP_S: f64 = 10.0;

/// What `run.json` says of a record.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct RecordedRun {
    /// Of the program that wrote it.
    pub version: String,
    /// From which that was built.
    pub commit: String,
    /// What wrote it.
    pub command: Command,
    /// What crawled.
    pub robot: RecordedRobot,
    /// With which cycle.
    pub gait: RecordedGait,
    /// Where.
    pub scene: RecordedScene,
    /// What was asked for beside them.
    pub options: RecordedOptions,
    /// How long the tables are.
    pub record: Extent,
    /// The whole file.
    #[serde(skip)]
    said: Value,
}

/// Which command has written a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Command {
    /// A crawl.
    #[serde(rename = "crawl run")]
    Crawl,
    /// A pull of the published study: no cycle, no way back.
    #[serde(rename = "reproduce pull")]
    ReproducePull,
    /// A crawl under the published table.
    #[serde(rename = "reproduce crawl")]
    ReproduceCrawl,
}

impl Command {
    /// All of them.
    const ALL: [Self; 3] = [Self::Crawl, Self::ReproducePull, Self::ReproduceCrawl];

    /// Its name in `run.json`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Crawl => "crawl run",
            Self::ReproducePull => "reproduce pull",
            Self::ReproduceCrawl => "reproduce crawl",
        }
    }
}

/// Which robot it was.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct RecordedRobot {
    /// The manufacturer's name.
    pub name: String,
    /// Of which family it is a version; records of earlier builds do not say.
    #[serde(default)]
    pub family: Option<String>,
    /// Which version of it.
    #[serde(default)]
    pub version: Option<String>,
    /// Its folder, as the user named it.
    pub folder: String,
    /// Of its files.
    pub sha256: String,
}

impl RecordedRobot {
    /// Which version of which family it was, `unknown` where the record does not say.
    pub fn version_name(&self) -> String {
        version_name(self.family.as_deref(), self.version.as_deref())
    }
}

/// Which cycle or gait it was.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct RecordedGait {
    /// Its name.
    pub name: String,
    /// Its file, as the user named it.
    pub file: String,
    /// The text of that file.
    pub text: String,
}

/// Which scene it was.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct RecordedScene {
    /// Its name.
    pub name: String,
}

/// Options that an export needs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct RecordedOptions {
    /// What durations were multiplied by.
    pub time_scale: f64,
    /// Text of the scene's file, where there is one.
    pub scene_text: Option<String>,
}

/// How long the tables of a record are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Extent {
    /// Rows of `rows.csv`.
    pub rows: usize,
    /// Time between two of them, and of the first one, s.
    pub row_step_s: f64,
}

impl RecordedRun {
    /// Reads `run.json` of a record that this version of the program has written.
    ///
    /// # Errors
    /// [`ReadError`].
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let shown = folder.display().to_string();
        let file = folder.join(RUN_FILE).display().to_string();
        let not = |reason: &str| ReadError::NotARecord {
            folder: shown.clone(),
            reason: reason.to_owned(),
        };
        if !folder.is_dir() {
            return Err(not(if folder.exists() {
                "it is not a folder"
            } else {
                "there is no such folder"
            }));
        }
        let text = text(folder, RUN_FILE)?;
        let json = |source| ReadError::Json {
            file: file.clone(),
            source,
        };
        let said: Value = serde_json::from_str(&text).map_err(json)?;
        let word = |key: &str| said.get(key).and_then(Value::as_str);
        if word("program") != Some("prone") {
            return Err(not(&format!(
                "its {RUN_FILE} does not say that prone wrote it"
            )));
        }
        let command = word("command");
        if Command::ALL
            .into_iter()
            .all(|known| command != Some(known.name()))
        {
            return Err(ReadError::Command {
                folder: shown,
                found: command.map_or_else(
                    || "another command".to_owned(),
                    |command| format!("`prone {command}`"),
                ),
                inside: inside(folder, &said),
            });
        }
        let ours = env!("CARGO_PKG_VERSION");
        let version = word("version").unwrap_or("of unknown version");
        if version != ours {
            return Err(ReadError::Version {
                folder: shown,
                found: version.to_owned(),
                ours,
            });
        }
        if said.get("record").is_none() {
            return Err(ReadError::Uncounted {
                folder: shown,
                ours,
            });
        }
        let run: Self = serde_json::from_str(&text).map_err(json)?;
        let step = run.record.row_step_s;
        if !(step > 0.0 && step <= LONGEST_STEP_S) {
            return Err(ReadError::Model {
                file,
                problem: format!("row_step_s {step} is outside 0..{LONGEST_STEP_S} s"),
            });
        }
        Ok(Self { said, ..run })
    }

    /// What the file says at a JSON pointer, a text or a number; nothing where it says null or
    /// nothing.
    pub fn said(&self, pointer: &str) -> Option<String> {
        match self.said.pointer(pointer) {
            None | Some(Value::Null) => None,
            Some(Value::String(text)) => Some(text.clone()),
            Some(other) => Some(other.to_string()),
        }
    }
}

/// Recorded runs in the folder of another result, by the list of its files.
fn inside(folder: &Path, said: &Value) -> Vec<String> {
    let files = said.get("artefacts").and_then(Value::as_array);
    let names = files.into_iter().flatten().filter_map(Value::as_str);
    let folders = names.filter_map(|name| name.strip_suffix(MODEL_FILE)?.strip_suffix('/'));
    folders
        .map(|inner| folder.join(inner).display().to_string())
        .collect()
}
