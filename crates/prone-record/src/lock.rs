//! One writer at a time: of a result folder, a search or a torque map.
//!
//! A lock is an empty hidden file beside what it guards, `.NAME.prone.lock`, locked by the system
//! while its writer lives. The system gives it up when a process is killed, so what a kill leaves of
//! it is in nobody's way: the next writer takes it over.

use std::ffi::OsString;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use crate::leftovers::{self, Leftover};
use crate::real_path::{NoRealPath, real_path};

/// A file that is locked while this lives, and removed afterwards.
#[derive(Debug)]
pub struct Lock {
    held: Held,
    _file: File,
    _leftover: Leftover,
}

/// Why a lock is not held.
#[derive(Debug, thiserror::Error)]
pub enum LockError {
    /// Another process holds it.
    #[error("another {what} is at work: it holds {}", path.display())]
    Busy {
        /// What the lock keeps apart.
        what: &'static str,
        /// What is locked, without links.
        path: PathBuf,
    },
    /// The file system refuses.
    #[error("cannot lock {}: {source}", path.display())]
    Refused {
        /// What is to be locked, without links.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// What is to be locked has no place.
    #[error(transparent)]
    Place(#[from] NoRealPath),
}

impl Lock {
    /// Holds a result folder, under whatever name it is given, against others that write it. Missing
    /// folders above it are made, and removed with the lock if they are empty then.
    ///
    /// # Errors
    /// [`LockError`]; another `what` is [`LockError::Busy`].
    pub fn for_folder(folder: &Path, what: &'static str) -> Result<Self, LockError> {
        Self::take(&real_path(folder)?, what, Above::Made)
    }

    /// Holds a file in the same way; its folder must exist.
    ///
    /// # Errors
    /// As [`Lock::for_folder`].
    pub fn for_file(file: &Path, what: &'static str) -> Result<Self, LockError> {
        Self::take(&real_path(file)?, what, Above::Exists)
    }

    fn take(guarded: &Path, what: &'static str, above: Above) -> Result<Self, LockError> {
        let held = || {
            let path = beside(guarded);
            let mut held = Held {
                path,
                made: Vec::new(),
            };
            if above == Above::Made {
                let missing = held.path.ancestors().skip(1);
                let missing = missing.take_while(|above| !above.exists());
                held.made = missing.map(Path::to_owned).collect();
                if let Some(above) = held.path.parent() {
                    fs::create_dir_all(above).map_err(Some)?;
                }
            }
            let taken = held.take();
            if !matches!(taken, Ok(Some(_))) {
                held.remove_folders();
            }
            Ok((taken.map_err(Some)?.ok_or(None)?, held))
        };
        let made = leftovers::make(held, |(_, held): &(File, Held)| {
            let held = held.clone();
            move || held.remove()
        });
        let ((file, held), leftover) = made.map_err(|error: Option<io::Error>| {
            let path = guarded.to_owned();
            match error {
                None => LockError::Busy { what, path },
                Some(source) => LockError::Refused { path, source },
            }
        })?;
        Ok(Self {
            held,
            _file: file,
            _leftover: leftover,
        })
    }
}

/// Whether the folders above what is locked are made where they are missing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Above {
    Made,
    Exists,
}

/// What a lock consists of on disk.
#[derive(Debug, Clone)]
struct Held {
    path: PathBuf,
    /// Folders above it that were made for it, the inmost first.
    made: Vec<PathBuf>,
}

impl Held {
    /// Locks the file; `None` where another process has it.
    fn take(&self) -> io::Result<Option<File>> {
        // Looked at before it is opened: opening a pipe waits for its reader, and a link would lead
        // the lock elsewhere.
        if fs::symlink_metadata(&self.path).is_ok_and(|found| !found.is_file()) {
            return Err(io::Error::other(
                "what stands in the place of its lock is not a regular file",
            ));
        }
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(false)
            .open(&self.path)?;
        if !try_exclusive(&file)? {
            return Ok(None);
        }
        // Whoever had it may have removed it since it was opened.
        let ours = file.metadata()?;
        let same = fs::metadata(&self.path)
            .is_ok_and(|named| (named.dev(), named.ino()) == (ours.dev(), ours.ino()));
        Ok(same.then_some(file))
    }

    /// Removes it, locked as it is. One that stays is taken over by the next.
    fn remove(&self) {
        // Ours is empty.
        if fs::metadata(&self.path).is_ok_and(|found| found.len() == 0) {
            let _ = fs::remove_file(&self.path);
        }
        self.remove_folders();
    }

    fn remove_folders(&self) {
        for folder in &self.made {
            // One that holds a result by now is not empty, and stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        self.held.remove();
    }
}

/// Locks an open file or folder for this process, until it is closed; `false` where another process
/// has it.
pub(crate) fn try_exclusive(file: &File) -> io::Result<bool> {
    match file.try_lock() {
        Ok(()) => Ok(true),
        Err(TryLockError::WouldBlock) => Ok(false),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// The lock of a path without links.
fn beside(guarded: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(guarded.file_name().unwrap_or_default());
    name.push(".prone.lock");
    guarded.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn a_lock_leaves_what_was_there() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("new/deep/result");
        let held = Lock::for_folder(&folder, "test").unwrap();
        let again = Lock::for_folder(&folder.join("."), "test").unwrap_err();
        assert!(matches!(again, LockError::Busy { what: "test", .. }));
        drop(held);
        assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
        // What is not empty is not ours, whatever its name.
        let theirs = home.path().join(".theirs.prone.lock");
        fs::write(&theirs, b"words").unwrap();
        drop(Lock::for_file(&home.path().join("theirs"), "test").unwrap());
        assert_eq!(fs::read(theirs).unwrap(), b"words");
    }

    #[test]
    fn one_folder_by_two_names_has_one_lock() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        fs::create_dir(at("there")).unwrap();
        symlink("there", at("link")).unwrap();
        let held = Lock::for_folder(&at("there"), "search").unwrap();
        let other = Lock::for_folder(&at("link"), "search").unwrap_err();
        let path = at("there").canonicalize().unwrap().display().to_string();
        assert_eq!(
            other.to_string(),
            format!("another search is at work: it holds {path}")
        );
        drop(held);
        assert!(Lock::for_folder(&at("link"), "search").is_ok());
    }

    #[test]
    fn limit_a_file_needs_its_folder_and_a_pipe_is_no_lock() {
        let home = tempfile::tempdir().unwrap();
        let lost = Lock::for_file(&home.path().join("none/map.csv"), "test").unwrap_err();
        assert!(
            lost.to_string().contains("No such file or directory"),
            "{lost}"
        );
        assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
        fs::create_dir(home.path().join(".map.csv.prone.lock")).unwrap();
        let refused = Lock::for_file(&home.path().join("map.csv"), "test").unwrap_err();
        assert!(
            refused.to_string().ends_with("is not a regular file"),
            "{refused}"
        );
    }

    /// The system gives up the lock of a process that is killed: what stays is an empty file.
    #[test]
    fn the_lock_of_a_killed_process_is_taken_over() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("result");
        let left = home.path().join(".result.prone.lock");
        fs::write(&left, b"").unwrap();
        let is_free = || try_exclusive(&File::open(&left).unwrap()).unwrap();
        let mut child = std::process::Command::new("flock")
            .arg("--no-fork")
            .arg(&left)
            .args(["sleep", "60"])
            .spawn()
            .unwrap();
        while is_free() {
            assert!(child.try_wait().unwrap().is_none(), "flock has ended");
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
        let busy = Lock::for_folder(&folder, "test").unwrap_err();
        assert!(matches!(busy, LockError::Busy { .. }));
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(fs::metadata(&left).unwrap().len(), 0);
        drop(Lock::for_folder(&folder, "test").unwrap());
        assert!(!left.exists());
    }
}
