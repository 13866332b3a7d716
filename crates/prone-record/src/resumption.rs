//! Unfinished work that is kept on disk, so that an interrupted or killed program goes on from it.
//!
//! There is one format. The first line, the head, says what is being done; every other line is a
//! part of what has been done:
//!
//! ```text
//! {"format":"prone unfinished work","format_version":1,"work":"search","plan":{…}}
//! ["<checksum>",<state>]
//! ```
//!
//! The *plan* is everything that decides the result, the program's version and commit among it.
//! Work is taken up only under an equal plan. The checksum is the beginning of the SHA-256 of the
//! state's text, so that a changed number is found. A line without its end was torn by whatever
//! killed the program, and is dropped.
//!
//! A [`Journal`] appends a line for each part as it is done; a [`Snapshot`] replaces the whole file,
//! whose only line then is the newest state. Both hold the [`Lock`] of the result that they belong
//! to, and neither overwrites a file that is not its own.
//!
//! A search that is done leaves its state in its result folder, as [`STATE_FILE`] and in the same
//! format ([`text`]): a longer search goes on from there.

mod journal;
mod snapshot;

use std::ffi::OsString;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde::de::{DeserializeOwned, IgnoredAny};
use serde::{Deserialize, Serialize};
use serde_json::Value;

use prone_files::text_file::{self, sha256};

use crate::lock::{Lock, LockError};
use crate::single_file::WriteError;

pub use journal::Journal;
pub use snapshot::{Earlier, Snapshot};

/// Name of the file of a result folder in which the state of its search is.
pub const STATE_FILE: &str = "search.state.json";

/// What every head begins with; the number of the format follows.
const MAGIC: &str = "{\"format\":\"prone unfinished work\",\"format_version\":";
const FORMAT_VERSION: u64 = 1;

/// What torque maps were kept in before there was one format; its number followed.
const OLD_JOURNAL: &[u8] = b"# prone torque-map journal ";
/// What a search was kept in then begins so.
const OLD_CHECKPOINT: &[u8] = b"{\"plan\":{";

/// Letters of a checksum: 64 bits.
const CHECKSUM: usize = 16;

/// The largest file that is read; the longest searches keep some ten megabytes.
const LARGEST_BYTES: u64 = 256 << 20;

/// Kinds of work that can be taken up again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Work {
    /// A search for gaits, whose result is a folder.
    Search,
    /// The build of a torque map, whose result is a file.
    TorqueMap,
}

/// What to do with earlier unfinished work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Opening {
    /// Go on from it.
    Resume,
    /// Discard it.
    Restart,
}

/// Why work cannot be kept or taken up.
#[derive(Debug, thiserror::Error)]
pub enum ResumptionError {
    /// Another process does the same, or the lock cannot be made.
    #[error(transparent)]
    Lock(#[from] LockError),
    /// It cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// It cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
    /// Something else has that name.
    #[error("{} is no {} of prone, and would be overwritten: move it away", path.display(), work.file())]
    Foreign {
        /// The file.
        path: PathBuf,
        /// What it should be.
        work: Work,
    },
    /// Another version of the program wrote it.
    #[error(
        "{} is in {format}, which this version of prone cannot go on from: finish it with the version that wrote it; {}",
        path.display(), work.discarding()
    )]
    OtherFormat {
        /// The file.
        path: PathBuf,
        /// What it should be.
        work: Work,
        /// Its format.
        format: String,
    },
    /// It was kept under another plan.
    #[error(
        "{} is the {} of another {}: {key} was {then}, and is {now} now; {}",
        path.display(), work.file(), work.name(), work.discarding()
    )]
    OtherPlan {
        /// The file.
        path: PathBuf,
        /// What it should be.
        work: Work,
        /// The most telling entry that differs, with those that it is in.
        key: String,
        /// Its value in the file.
        then: Value,
        /// Its value now.
        now: Value,
    },
    /// A line is not what was written.
    #[error(
        "{}, line {line}: `{content}` is damaged, or no part of this {}; {}",
        path.display(), work.name(), work.discarding()
    )]
    Damaged {
        /// The file.
        path: PathBuf,
        /// What it should be.
        work: Work,
        /// The line, from 1.
        line: usize,
        /// Its beginning.
        content: String,
    },
}

impl Work {
    /// Name in files and messages.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Search => "search",
            Self::TorqueMap => "torque-map build",
        }
    }

    /// What its file is called in messages.
    const fn file(self) -> &'static str {
        match self {
            Self::Search => "checkpoint",
            Self::TorqueMap => "journal",
        }
    }

    /// How a user discards it.
    const fn discarding(self) -> &'static str {
        match self {
            Self::Search => "without --resume it is replaced",
            Self::TorqueMap => "--restart discards it",
        }
    }

    /// Where the unfinished work for a result is kept: beside it.
    pub fn beside(self, result: &Path) -> PathBuf {
        let ending = match self {
            Self::Search => ".checkpoint.json",
            Self::TorqueMap => ".partial",
        };
        // Without the slash that may follow a folder's name.
        let mut name = OsString::from(result.components().as_path());
        name.push(ending);
        PathBuf::from(name)
    }

    fn lock(self, result: &Path) -> Result<Lock, LockError> {
        match self {
            Self::Search => Lock::for_folder(result, "search for this folder"),
            Self::TorqueMap => Lock::for_file(result, "build of this map"),
        }
    }
}

/// The locked place of unfinished work.
#[derive(Debug)]
struct Place {
    work: Work,
    path: PathBuf,
    plan: Value,
    /// None of a file in a result folder, which the lock of the folder covers.
    _lock: Option<Lock>,
}

/// What is at a place, if it is no stranger.
#[derive(Debug)]
enum Standing {
    /// Nothing, or a file that was torn in its head.
    Nothing,
    /// A file of this format: its bytes.
    Kept(Vec<u8>),
    /// A file of another format of ours.
    Other(String),
}

#[derive(Serialize, Deserialize)]
struct Head {
    format: String,
    format_version: u64,
    work: String,
    plan: Value,
}

impl Place {
    /// Locks the place; nothing is read or written yet.
    fn new(work: Work, result: &Path, plan: &impl Serialize) -> Result<Self, ResumptionError> {
        let path = work.beside(result);
        let plan = serde_json::to_value(plan).map_err(|error| unwritten(&path, error.into()))?;
        Ok(Self {
            work,
            plan,
            _lock: Some(work.lock(result)?),
            path,
        })
    }

    /// The state that a finished work has left in its result folder, under the same plan.
    fn within(&self, result: &Path) -> Self {
        Self {
            work: self.work,
            path: result.join(STATE_FILE),
            plan: self.plan.clone(),
            _lock: None,
        }
    }

    /// The first line.
    fn head(&self) -> Result<String, ResumptionError> {
        let text = head(self.work, self.plan.clone());
        text.map_err(|error| unwritten(&self.path, error.into()))
    }

    /// One line.
    fn line(&self, state: &impl Serialize) -> Result<String, ResumptionError> {
        line(state).map_err(|error| unwritten(&self.path, error.into()))
    }

    /// Looks at the place; strangers are refused.
    fn standing(&self) -> Result<Standing, ResumptionError> {
        let foreign = || ResumptionError::Foreign {
            path: self.path.clone(),
            work: self.work,
        };
        // Looked at before it is opened: opening a pipe waits for its writer.
        match fs::symlink_metadata(&self.path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Standing::Nothing),
            Err(error) => return Err(self.unread(error)),
            Ok(found) if !found.is_file() => return Err(foreign()),
            Ok(_) => {}
        }
        let bytes =
            text_file::read_bytes(&self.path, LARGEST_BYTES).map_err(|error| self.unread(error))?;
        if let Some(format) = old_format(&bytes) {
            return Ok(Standing::Other(format));
        }
        let ours = format!("{MAGIC}{FORMAT_VERSION},");
        if bytes.starts_with(ours.as_bytes()) {
            Ok(Standing::Kept(bytes))
        } else if ours.as_bytes().starts_with(&bytes) {
            Ok(Standing::Nothing)
        } else if let Some(rest) = bytes.strip_prefix(MAGIC.as_bytes()) {
            let number: String = rest.iter().map(|byte| char::from(*byte)).take(20).collect();
            let number = number.split(',').next().unwrap_or_default();
            Ok(Standing::Other(format!("format {}", number.escape_debug())))
        } else {
            Err(foreign())
        }
    }

    /// The states of a file, and how many of its bytes are whole lines.
    fn states<S: DeserializeOwned>(
        &self,
        bytes: &[u8],
    ) -> Result<(Vec<S>, usize), ResumptionError> {
        let Some(end) = bytes.iter().rposition(|byte| *byte == b'\n') else {
            // Torn in its head.
            return Ok((Vec::new(), 0));
        };
        let text = String::from_utf8_lossy(&bytes[..end]);
        let mut lines = text.split('\n');
        self.check_head(lines.next().unwrap_or_default())?;
        let state = |(index, line)| state(line).ok_or_else(|| self.damaged(index + 2, line));
        let states: Result<Vec<S>, _> = lines.enumerate().map(state).collect();
        Ok((states?, end + 1))
    }

    fn check_head(&self, line: &str) -> Result<(), ResumptionError> {
        let head: Head = serde_json::from_str(line).map_err(|_| self.damaged(1, line))?;
        let [then, now] = [head.work.as_str(), self.work.name()].map(Value::from);
        let other_work = (then != now).then(|| ("work".to_owned(), then, now));
        match other_work.or_else(|| difference(&head.plan, &self.plan)) {
            None => Ok(()),
            Some((key, then, now)) => Err(ResumptionError::OtherPlan {
                path: self.path.clone(),
                work: self.work,
                key,
                then,
                now,
            }),
        }
    }

    fn other_format(&self, format: String) -> ResumptionError {
        ResumptionError::OtherFormat {
            path: self.path.clone(),
            work: self.work,
            format,
        }
    }

    fn damaged(&self, line: usize, content: &str) -> ResumptionError {
        ResumptionError::Damaged {
            path: self.path.clone(),
            work: self.work,
            line,
            content: content.chars().take(60).collect(),
        }
    }

    fn unread(&self, source: io::Error) -> ResumptionError {
        ResumptionError::Read {
            path: self.path.clone(),
            source,
        }
    }

    /// The result is in place, or there was nothing to keep. Still locked meanwhile.
    fn remove(&self) -> Result<(), ResumptionError> {
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                Err(unwritten(&self.path, error))
            }
            _ => Ok(()),
        }
    }
}

/// A whole file of one state: what a result folder keeps of its work.
///
/// # Errors
/// Where plan or state cannot be written as JSON.
pub fn text(
    work: Work,
    plan: &impl Serialize,
    state: &impl Serialize,
) -> Result<String, serde_json::Error> {
    Ok(head(work, serde_json::to_value(plan)?)? + &line(state)?)
}

fn head(work: Work, plan: Value) -> Result<String, serde_json::Error> {
    let head = Head {
        format: "prone unfinished work".to_owned(),
        format_version: FORMAT_VERSION,
        work: work.name().to_owned(),
        plan,
    };
    Ok(serde_json::to_string(&head)? + "\n")
}

fn line(state: &impl Serialize) -> Result<String, serde_json::Error> {
    let text = serde_json::to_string(state)?;
    Ok(format!("[\"{}\",{text}]\n", checksum(&text)))
}

fn unwritten(path: &Path, source: io::Error) -> ResumptionError {
    let path = path.to_owned();
    WriteError { path, source }.into()
}

/// The beginning of the SHA-256 of a text, hexadecimal.
fn checksum(text: &str) -> String {
    let mut sum = sha256(&[text]);
    sum.truncate(CHECKSUM);
    sum
}

/// The state of a line, `None` where it is not what was written.
fn state<S: DeserializeOwned>(line: &str) -> Option<S> {
    let (sum, text) = line.strip_prefix("[\"")?.split_once("\",")?;
    let text = text.strip_suffix(']')?;
    let whole = sum == checksum(text);
    whole.then(|| serde_json::from_str(text).ok()).flatten()
}

/// The name of a format that was used before this one, `None` of a stranger.
fn old_format(bytes: &[u8]) -> Option<String> {
    #[derive(Deserialize)]
    struct Plan {
        program: String,
    }
    #[derive(Deserialize)]
    struct Checkpoint {
        plan: Plan,
        #[serde(rename = "search")]
        _search: IgnoredAny,
    }
    if bytes.starts_with(OLD_JOURNAL) {
        return Some("the first format of journals".to_owned());
    }
    if !bytes.starts_with(OLD_CHECKPOINT) {
        return None;
    }
    let read: Checkpoint = serde_json::from_slice(bytes).ok()?;
    (read.plan.program == "prone").then(|| "the first format of checkpoints".to_owned())
}

/// Entries of a plan, by how much they tell: of two plans that differ in many places, what was asked
/// for comes before what follows from it, such as a bound that the robot or the objective sets.
const TELLING: [&str; 15] = [
    "command",
    "program",
    "objective",
    "source",
    "robot",
    "robot sha256",
    "solver",
    "seed",
    "runs",
    "from",
    "bases",
    "base_sha256",
    "form",
    "ends",
    "held",
];

/// An entry in which two plans differ: its name with those around it, then, now.
type Difference = (String, Value, Value);

/// The most telling entry in which two plans differ.
fn difference(then: &Value, now: &Value) -> Option<Difference> {
    let mut all = Vec::new();
    differences("", then, now, &mut all);
    // The first of those that tell as much.
    all.into_iter().min_by_key(|(path, _, _)| {
        let mut parts = path.split('.');
        let rank = |part| TELLING.iter().position(|telling| *telling == part);
        let rank = parts.clone().filter_map(rank).min();
        // A name follows from the objective where none is given.
        let usual = TELLING.len() + usize::from(parts.any(|part| part == "name"));
        rank.unwrap_or(usual)
    })
}

fn differences(path: &str, then: &Value, now: &Value, all: &mut Vec<Difference>) {
    if then == now {
        return;
    }
    let (Value::Object(old), Value::Object(new)) = (then, now) else {
        all.push((path.to_owned(), then.clone(), now.clone()));
        return;
    };
    let added = new.keys().filter(|key| !old.contains_key(*key));
    for key in old.keys().chain(added) {
        let path = match path {
            "" => key.clone(),
            around => format!("{around}.{key}"),
        };
        let [old, new] = [old, new].map(|map| map.get(key).unwrap_or(&Value::Null));
        differences(&path, old, new, all);
    }
}

#[cfg(test)]
mod tests;
