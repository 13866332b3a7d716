//! The head of a result: the first keys of every `run.json`, and the only check of who wrote it.

use std::io;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use prone::foreign_text;
use prone_files::text_file::{self, ReadError};

use crate::output::RUN_FILE;
use crate::program::Program;
use crate::unique_json;

/// What the key `program` says.
pub const PROGRAM: &str = "prone";

/// What made a result: the first keys of its `run.json`.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Head<C = String> {
    /// Name of the program, [`PROGRAM`].
    pub program: String,
    /// Version of the program.
    pub version: String,
    /// Commit that the program was built from, `unknown` outside a checkout.
    pub commit: String,
    /// The command that made the result, without the program's name.
    pub command: C,
    /// Name and version of the physics engine, where one was used.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub engine: Option<String>,
}

/// Why a folder is not read as a result of this version of the program.
#[derive(Debug, thiserror::Error)]
pub enum HeadError {
    /// There is no result of this program.
    #[error("{folder} is not a result folder of prone: {reason}")]
    NotAResult {
        /// The folder.
        folder: String,
        /// By what that is known.
        reason: String,
    },
    /// `run.json` cannot be read.
    #[error(transparent)]
    File(#[from] ReadError),
    /// `run.json` is not JSON.
    #[error("{file}: {source}")]
    Json {
        /// Path of the file.
        file: String,
        /// Where and why.
        source: serde_json::Error,
    },
    /// Another version of the program wrote it.
    #[error(
        "{file} was written by prone {found}, this is prone {ours}, which reads its own results \
         only: make it anew"
    )]
    Version {
        /// Path of the file, which begins with the folder.
        file: String,
        /// Version of the program that wrote it.
        found: String,
        /// Version of the program that reads it.
        ours: &'static str,
    },
}

impl<C> Head<C> {
    /// The head of what a build of this program makes with a command, and with an engine if it
    /// uses one.
    pub fn new(program: &Program, command: C, engine: Option<String>) -> Self {
        Self {
            program: PROGRAM.to_owned(),
            version: program.version.clone().into_owned(),
            commit: program.commit.clone().into_owned(),
            command,
            engine,
        }
    }
}

impl Head {
    /// The same head with the command as a type.
    pub(crate) fn with<C>(self, command: C) -> Head<C> {
        Head {
            program: self.program,
            version: self.version,
            commit: self.commit,
            command,
            engine: self.engine,
        }
    }

    /// Reads the head of a result folder of this version of the program, and the whole `run.json`.
    pub fn read(folder: &Path) -> Result<(Self, Value), HeadError> {
        let not = |reason: &str| HeadError::NotAResult {
            folder: folder.display().to_string(),
            reason: reason.to_owned(),
        };
        if !folder.exists() {
            return Err(not("there is no such folder"));
        }
        if !folder.is_dir() {
            return Err(not("it is not a folder"));
        }
        let path = folder.join(RUN_FILE);
        let bytes = match text_file::read_within(folder, RUN_FILE, text_file::LARGEST_BYTES) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Err(not(&format!("it holds no {RUN_FILE}")));
            }
            Err(source) => return Err(ReadError { path, source }.into()),
        };
        let file = path.display().to_string();
        let run: Value = match unique_json::parse(&bytes) {
            Ok(run) => run,
            Err(source) => return Err(HeadError::Json { file, source }),
        };
        let word = |key: &str| run.get(key).and_then(Value::as_str).map(str::to_owned);
        if word("program").as_deref() != Some(PROGRAM) {
            return Err(not(&format!(
                "its {RUN_FILE} does not say that prone wrote it"
            )));
        }
        let ours = env!("CARGO_PKG_VERSION");
        let version = word("version").unwrap_or_else(|| "of unknown version".to_owned());
        if version != ours {
            return Err(HeadError::Version {
                file,
                found: foreign_text::cut(&version).into_owned(),
                ours,
            });
        }
        let command =
            word("command").ok_or_else(|| not(&format!("its {RUN_FILE} names no command")))?;
        let head = Self {
            program: PROGRAM.to_owned(),
            version,
            commit: word("commit").unwrap_or_else(|| "unknown".to_owned()),
            command,
            engine: word("engine"),
        };
        Ok((head, run))
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_head_is_read_as_it_is_written() {
        let home = tempfile::tempdir().unwrap();
        let program = Program {
            version: env!("CARGO_PKG_VERSION").into(),
            commit: "c".into(),
        };
        let head = Head::new(&program, "optimize".to_owned(), Some("MuJoCo 3".to_owned()));
        let text = serde_json::to_string(&head).unwrap();
        fs::write(home.path().join(RUN_FILE), &text).unwrap();
        let (read, run) = Head::read(home.path()).unwrap();
        assert_eq!(read, head);
        assert_eq!(run["engine"], "MuJoCo 3");
        // Without an engine there is no such key.
        let head = Head::new(&program, "report".to_owned(), None);
        let text = serde_json::to_value(&head).unwrap();
        assert_eq!(text.get("engine"), None);
    }

    #[test]
    fn another_version_is_named_with_the_file() {
        let home = tempfile::tempdir().unwrap();
        let text = r#"{"program": "prone", "version": "9.9.9", "commit": "c", "command": "x"}"#;
        fs::write(home.path().join(RUN_FILE), text).unwrap();
        let said = Head::read(home.path()).unwrap_err().to_string();
        let expected = format!(
            "{}/run.json was written by prone 9.9.9, this is prone {}, which reads its own results \
             only: make it anew",
            home.path().display(),
            env!("CARGO_PKG_VERSION")
        );
        assert_eq!(said, expected);
    }
}
