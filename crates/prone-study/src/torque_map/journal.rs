//! The journal of a build: rows as they are measured, so that a killed build can be taken up.
//!
//! The first line names the build; every other one is a row, in the order in which they were done:
//!
//! ```text
//! # prone torque-map journal 1 {"alpha":"-90..-30 deg",…}
//! 17,<τ2>,<τ3>,<τ4>,<τ5>,<toe>,<elbow>,<torso>,<leg>
//! 18,open
//! ```
//!
//! Numbers are written so that reading gives the same bits. A line without its end was torn by
//! whatever killed the build, and is dropped. The file is locked while its build lives.

use std::fmt::Write as _;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _, Seek as _, SeekFrom, Write as _};
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use prone::torque_map::{ContactForces, JointTorques, Mask};
use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;

use super::gauge::Entry;
use super::job::Identity;

/// What every journal begins with; the number is that of the format.
const MAGIC: &str = "# prone torque-map journal 1 ";

/// Rows kept in memory until they are written: a third of a second of simulation.
const BATCH: usize = 32;

/// What to do with a journal that is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Opening {
    /// Take over its rows.
    Resume,
    /// Discard it.
    Restart,
}

/// Why there is no journal to write to.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// It cannot be opened or made.
    #[error("cannot open {}: {source}", path.display())]
    Open {
        /// The journal.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A batch of rows cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The journal.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Something else has that name.
    #[error("{} is no journal of a torque map, and would be overwritten: move it away", path.display())]
    Foreign {
        /// The file.
        path: PathBuf,
    },
    /// Another build, alive, writes to it.
    #[error("another build is writing {}", path.display())]
    Busy {
        /// The journal.
        path: PathBuf,
    },
    /// It belongs to a build with other options.
    #[error(
        "{} is the journal of another build, with {differences}; take that one up, or discard it with --restart",
        path.display()
    )]
    Other {
        /// The journal.
        path: PathBuf,
        /// Name, value there and value here of whatever differs.
        differences: String,
    },
    /// A line is none of ours.
    #[error("{}, line {line}: `{content}` is no row of this build; --restart discards the journal", path.display())]
    Damaged {
        /// The journal.
        path: PathBuf,
        /// The line, from 1.
        line: usize,
        /// Its beginning.
        content: String,
    },
}

/// A journal, open and locked.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    /// Bytes of whole lines in the file.
    written: u64,
    batch: String,
    batched: usize,
}

impl Journal {
    /// Where the journal of a map is: beside it.
    pub fn beside(map: &Path) -> PathBuf {
        let mut name = map.as_os_str().to_owned();
        name.push(".partial");
        PathBuf::from(name)
    }

    /// Opens the journal of a build with `rows` rows, and reads those that it holds.
    pub(super) fn open(
        path: &Path,
        identity: &Identity,
        rows: usize,
        opening: Opening,
    ) -> Result<(Self, Vec<Option<Entry>>), JournalError> {
        let error = |source| JournalError::Open {
            path: path.to_owned(),
            source,
        };
        let foreign = || JournalError::Foreign {
            path: path.to_owned(),
        };
        // Looked at before it is opened: opening a pipe waits for its reader.
        if fs::symlink_metadata(path).is_ok_and(|found| !found.is_file()) {
            return Err(foreign());
        }
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(error)?;
        lock(&file, path)?;
        let mut journal = Self {
            path: path.to_owned(),
            file,
            written: 0,
            batch: String::new(),
            batched: 0,
        };
        let mut bytes = Vec::new();
        journal.file.read_to_end(&mut bytes).map_err(error)?;
        let magic = MAGIC.as_bytes();
        if !(bytes.starts_with(magic) || magic.starts_with(&bytes)) {
            return Err(foreign());
        }
        let whole = bytes.iter().rposition(|byte| *byte == b'\n');
        let (entries, kept) = match (whole, opening) {
            // Torn in its first line, or new.
            (None, _) | (_, Opening::Restart) => (vec![None; rows], 0),
            (Some(end), Opening::Resume) => {
                let text = String::from_utf8_lossy(&bytes[..end]);
                (journal.read(&text, identity, rows)?, end + 1)
            }
        };
        journal.written = kept as u64;
        journal.cut().map_err(error)?;
        if kept == 0 {
            journal.batch = first_line(identity);
            journal.flush()?;
        }
        Ok((journal, entries))
    }

    /// Adds a row; it is on disk with the batch that it fills.
    pub(super) fn append(&mut self, index: usize, entry: &Entry) -> Result<(), JournalError> {
        // Writing to a string does not fail.
        let _ = write!(self.batch, "{index}");
        match entry {
            Entry::Held { torques, contacts } => {
                for number in torques.to_array().into_iter().chain(contacts.to_array()) {
                    let _ = write!(self.batch, ",{number:?}");
                }
            }
            Entry::Masked(mask) => {
                let _ = write!(self.batch, ",{}", mask.name());
            }
        }
        self.batch.push('\n');
        self.batched += 1;
        if self.batched < BATCH {
            return Ok(());
        }
        self.flush()
    }

    /// Writes what is still in memory.
    pub(super) fn flush(&mut self) -> Result<(), JournalError> {
        let batch = std::mem::take(&mut self.batch);
        self.batched = 0;
        if let Err(source) = self.file.write_all(batch.as_bytes()) {
            // A full disk may have taken half of it.
            let _ = self.cut();
            return Err(JournalError::Write {
                path: self.path.clone(),
                source,
            });
        }
        self.written += batch.len() as u64;
        Ok(())
    }

    /// Cuts off what is not a whole line.
    fn cut(&mut self) -> io::Result<()> {
        self.file.set_len(self.written)?;
        self.file.seek(SeekFrom::Start(self.written)).map(drop)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Removes it: the map is in place, or there was nothing to keep.
    ///
    /// # Errors
    /// [`io::Error`].
    pub fn remove(self) -> io::Result<()> {
        // Still locked meanwhile, so that it is nobody else's.
        fs::remove_file(&self.path)
    }

    fn read(
        &self,
        text: &str,
        identity: &Identity,
        rows: usize,
    ) -> Result<Vec<Option<Entry>>, JournalError> {
        let damaged = |line: usize, content: &str| JournalError::Damaged {
            path: self.path.clone(),
            line,
            content: content.chars().take(60).collect(),
        };
        let mut lines = text.split('\n').enumerate();
        let first = lines.next().map_or("", |(_, line)| line);
        let theirs: Identity = first
            .strip_prefix(MAGIC)
            .and_then(|json| serde_json::from_str(json).ok())
            .ok_or_else(|| damaged(1, first))?;
        if theirs != *identity {
            return Err(JournalError::Other {
                path: self.path.clone(),
                differences: differences(&theirs, identity),
            });
        }
        let mut entries = vec![None; rows];
        for (index, line) in lines {
            let row = row(line).filter(|(row, _)| *row < rows);
            let (row, entry) = row.ok_or_else(|| damaged(index + 1, line))?;
            entries[row] = Some(entry);
        }
        Ok(entries)
    }
}

fn lock(file: &File, path: &Path) -> Result<(), JournalError> {
    let busy = || JournalError::Busy {
        path: path.to_owned(),
    };
    let error = |source| JournalError::Open {
        path: path.to_owned(),
        source,
    };
    match flock(file, FlockOperation::NonBlockingLockExclusive) {
        Ok(()) => {}
        Err(Errno::WOULDBLOCK) => return Err(busy()),
        Err(source) => return Err(error(source.into())),
    }
    // Another build may have ended, and removed it, since it was opened.
    let ours = file.metadata().map_err(error)?;
    match fs::metadata(path) {
        Ok(named) if (named.dev(), named.ino()) == (ours.dev(), ours.ino()) => Ok(()),
        _ => Err(busy()),
    }
}

fn first_line(identity: &Identity) -> String {
    // A map of strings, whose writing does not fail.
    let json = serde_json::to_string(identity).unwrap_or_default();
    format!("{MAGIC}{json}\n")
}

/// One row of a journal.
fn row(line: &str) -> Option<(usize, Entry)> {
    let (index, rest) = line.split_once(',')?;
    let index = index.parse().ok()?;
    let masks = [Mask::Open, Mask::Failed];
    if let Some(mask) = masks.into_iter().find(|mask| mask.name() == rest) {
        return Some((index, Entry::Masked(mask)));
    }
    let numbers: Vec<f64> = rest
        .split(',')
        .map(|cell| cell.parse().ok().filter(|number: &f64| number.is_finite()))
        .collect::<Option<_>>()?;
    let [t2, t3, t4, t5, toe, elbow, torso, leg] = numbers.try_into().ok()?;
    let entry = Entry::Held {
        torques: JointTorques::from_array([t2, t3, t4, t5]),
        contacts: ContactForces::from_array([toe, elbow, torso, leg]),
    };
    Some((index, entry))
}

/// `source simulation in place of statics, …`: theirs, then ours.
fn differences(theirs: &Identity, ours: &Identity) -> String {
    let mut names: Vec<&String> = theirs.keys().chain(ours.keys()).collect();
    names.sort();
    names.dedup();
    let value = |identity: &Identity, name: &String| {
        let value = identity.get(name).map(String::as_str);
        value.unwrap_or("nothing").to_owned()
    };
    let differing = names.into_iter().filter_map(|name| {
        let (theirs, ours) = (value(theirs, name), value(ours, name));
        (theirs != ours).then(|| format!("{name} {theirs} in place of {ours}"))
    });
    differing.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests;
