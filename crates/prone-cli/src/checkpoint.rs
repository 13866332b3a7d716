//! The file in which a search is kept until its result folder appears.

use std::ffi::OsString;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::anyhow;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::lock::Lock;
use crate::{Failure, table_file};

/// Time between two writes at least: a cheap search has thousands of generations a second.
const INTERVAL: Duration = Duration::from_secs(2);

/// A search's checkpoint beside its result folder.
pub(crate) struct Checkpoint {
    path: PathBuf,
    /// What is searched, by whom.
    plan: Value,
    written: Option<Instant>,
}

#[derive(Serialize)]
struct Written<'a, S> {
    plan: &'a Value,
    search: &'a S,
}

#[derive(Deserialize)]
struct Read<S> {
    plan: Value,
    search: S,
}

impl Checkpoint {
    /// The checkpoint of the search of a result folder; nothing is read or written yet.
    pub(crate) fn beside(out: &Path, plan: Value) -> Self {
        let mut name = OsString::from(out.components().as_path());
        name.push(".checkpoint.json");
        Self {
            path: PathBuf::from(name),
            plan,
            written: None,
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Holds the checkpoint against other searches with the same result folder.
    pub(crate) fn lock(&self) -> Result<Lock, Failure> {
        Lock::take(&self.path.with_extension("lock"), "search for this folder")
    }

    /// Says that what another search has kept here is about to be lost.
    pub(crate) fn announce_replacement(&self) {
        if self.path.exists() {
            // Where nobody listens, the work goes on.
            let _ = writeln!(
                std::io::stderr(),
                "replacing {}, which an earlier search has left: --resume goes on from there",
                self.path.display()
            );
        }
    }

    /// The search that was interrupted, `None` if there was none.
    pub(crate) fn read<S: DeserializeOwned>(&self) -> Result<Option<S>, Failure> {
        let path = self.path.display();
        let text = match fs::read(&self.path) {
            Ok(text) => text,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            Err(error) => return Err(Failure::Input(anyhow!("cannot read {path}: {error}"))),
        };
        let read: Read<S> = serde_json::from_slice(&text)
            .map_err(|error| Failure::Input(anyhow!("{path} is no checkpoint: {error}")))?;
        if let Some((key, then, now)) = difference("", &read.plan, &self.plan) {
            return Err(Failure::Input(anyhow!(
                "{path} is the checkpoint of another search: {key} was {then}, and is {now} now; without --resume it is replaced"
            )));
        }
        Ok(Some(read.search))
    }

    /// Writes now and then; whole or not at all.
    pub(crate) fn keep(&mut self, search: &impl Serialize) -> Result<(), Failure> {
        if self.written.is_some_and(|at| at.elapsed() < INTERVAL) {
            return Ok(());
        }
        self.write(search)
    }

    /// Writes; whole or not at all.
    pub(crate) fn write(&mut self, search: &impl Serialize) -> Result<(), Failure> {
        let written = Written {
            plan: &self.plan,
            search,
        };
        let text = serde_json::to_vec(&written).map_err(Failure::work)?;
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder).map_err(|error| self.refused(&error))?;
        }
        table_file::write(&self.path, &text).map_err(|error| self.refused(&error))?;
        self.written = Some(Instant::now());
        Ok(())
    }

    /// The result is in place.
    pub(crate) fn remove(&self) -> Result<(), Failure> {
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(self.refused(&error)),
            _ => Ok(()),
        }
    }

    fn refused(&self, error: &io::Error) -> Failure {
        Failure::Work(anyhow!("cannot write {}: {error}", self.path.display()))
    }
}

/// The first place where two plans differ: its name, then, now.
fn difference(name: &str, then: &Value, now: &Value) -> Option<(String, Value, Value)> {
    if then == now {
        return None;
    }
    if let (Value::Object(old), Value::Object(new)) = (then, now) {
        let mut keys = old.keys().chain(new.keys());
        let inner = |key: &String| {
            let of =
                |map: &serde_json::Map<String, Value>| map.get(key).cloned().unwrap_or_default();
            difference(key, &of(old), &of(new))
        };
        if let Some(found) = keys.find_map(inner) {
            return Some(found);
        }
    }
    Some((name.to_owned(), then.clone(), now.clone()))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn a_checkpoint_of_another_search_says_what_differs() {
        let then = json!({ "seed": 1, "aim": { "objective": "torque", "per": "phase" } });
        let now = json!({ "seed": 1, "aim": { "objective": "heat", "per": "phase" } });
        let (key, old, new) = difference("", &then, &now).unwrap();
        assert_eq!(
            (key.as_str(), old, new),
            ("objective", json!("torque"), json!("heat"))
        );
        assert!(difference("", &then, &then).is_none());
        let missing = json!({ "seed": 1 });
        assert_eq!(difference("", &missing, &then).unwrap().0, "aim");
    }
}
