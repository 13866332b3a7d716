//! The hidden folder in which a result is made, and in which the one that it replaces goes away.
//!
//! It is beside the target, so that moving is renaming, and locked while its run lives: one that
//! is not locked was left by a run that was killed, and the next run removes it.

use std::fs::{self, File};
use std::io;
use std::path::{Component, Path, PathBuf};

use rustix::fs::{CWD, RenameFlags, renameat_with};
use rustix::io::Errno;
use tempfile::TempDir;

use super::earlier::{Standing, standing};
use super::target::Target;
use super::{Artefacts, OutputError, RUN_FILE, without_hidden_name, write_error};
use crate::leftovers::{self, Leftover};
use crate::lock::try_exclusive;

/// How often another run may be faster before this one gives up.
const ATTEMPTS: usize = 100;

/// The result's name in its staging folder.
const RESULT: &str = "result";

/// A locked staging folder, removed when dropped.
#[derive(Debug)]
pub(super) struct Staging {
    folder: TempDir,
    leftover: Leftover,
    _lock: File,
}

/// Makes and removes a staging folder at the nearest place where one can be made now.
pub(super) fn probe(target: &Target) -> Result<(), OutputError> {
    let made = make(target.ground(), target);
    made.map(drop)
        .map_err(|source| write_error(&target.folder, source))
}

/// Removes what killed runs for the same target left. One that cannot be removed stays.
pub(super) fn sweep(target: &Target) {
    let Ok(entries) = fs::read_dir(&target.parent) else {
        return;
    };
    let prefix = prefix(target);
    for entry in entries.flatten() {
        if entry.file_name().to_string_lossy().starts_with(&prefix) {
            let _ = remove_abandoned(&entry.path());
        }
    }
}

fn remove_abandoned(folder: &Path) -> io::Result<()> {
    if !fs::symlink_metadata(folder)?.is_dir() {
        return Ok(());
    }
    let lock = File::open(folder)?;
    if !try_exclusive(&lock)? {
        return Ok(());
    }
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        // Whatever is in there must be ours, as in the target itself.
        if entry.file_name() != RESULT || standing(&entry.path()).is_err() {
            return Ok(());
        }
    }
    fs::remove_dir_all(folder)
}

fn prefix(target: &Target) -> String {
    format!(".{}.partial-", target.name)
}

fn make(parent: &Path, target: &Target) -> io::Result<(TempDir, Leftover)> {
    let make = || {
        let made = tempfile::Builder::new()
            .prefix(&prefix(target))
            .tempdir_in(parent);
        made.map_err(|error| without_hidden_name(&error))
    };
    leftovers::make(make, |made| remove(made.path()))
}

/// Removes a staging folder of which nothing is to stay.
fn remove(folder: &Path) -> impl FnOnce() + Send + use<> {
    let folder = folder.to_owned();
    // The next run removes what stays.
    move || drop(fs::remove_dir_all(folder))
}

impl Staging {
    /// A new one beside the target.
    pub(super) fn new(target: &Target) -> Result<Self, OutputError> {
        let error = |source| write_error(&target.folder, source);
        for _ in 0..ATTEMPTS {
            let (folder, leftover) = make(&target.parent, target).map_err(error)?;
            // Until it is locked, another run may take it for an abandoned one.
            let Ok(lock) = File::open(folder.path()) else {
                continue;
            };
            let locked = try_exclusive(&lock);
            // A file system without locks: then nothing is removed there either.
            if !matches!(locked, Ok(false)) && folder.path().exists() {
                return Ok(Self {
                    folder,
                    leftover,
                    _lock: lock,
                });
            }
        }
        Err(error(Errno::AGAIN.into()))
    }

    /// Where the result is made.
    fn result(&self) -> PathBuf {
        self.folder.path().join(RESULT)
    }

    /// Writes all files, `run.json` first: what is there is then listed at every instant.
    pub(super) fn write(
        &self,
        target: &Target,
        artefacts: &Artefacts,
        run_file: &[u8],
    ) -> Result<(), OutputError> {
        let result = self.result();
        fs::create_dir(&result).map_err(|source| write_error(&target.folder, source))?;
        let others = artefacts.iter().filter(|(name, _)| *name != RUN_FILE);
        let others = others.map(|(name, bytes)| (name.as_str(), bytes.as_slice()));
        for (name, bytes) in std::iter::once((RUN_FILE, run_file)).chain(others) {
            let stays = |part| matches!(part, Component::Normal(_));
            if !Path::new(name).components().all(stays) {
                let leads_out = io::Error::other("its name leads out of the result");
                return Err(write_error(&target.folder.join(name), leads_out));
            }
            let path = result.join(name);
            let folder = path.parent().unwrap_or(&result);
            fs::create_dir_all(folder)
                .and_then(|()| fs::write(&path, bytes))
                .map_err(|source| write_error(&target.folder.join(name), source))?;
        }
        Ok(())
    }

    /// Moves the result into place; what stands there is looked at once more, before and after.
    pub(super) fn place(self, target: &Target) -> Result<(), OutputError> {
        let Self {
            folder,
            leftover,
            _lock: lock,
        } = self;
        // What comes out of the target may be a stranger, and no leftover.
        let staged = Staged {
            folder,
            _lock: lock,
        };
        leftover.settle(|| staged.place(target))
    }
}

/// The same, once the result is complete.
#[derive(Debug)]
struct Staged {
    folder: TempDir,
    _lock: File,
}

impl Staged {
    fn result(&self) -> PathBuf {
        self.folder.path().join(RESULT)
    }

    fn place(self, target: &Target) -> Result<(), OutputError> {
        for _ in 0..ATTEMPTS {
            let moved = match standing(&target.folder)? {
                Standing::Nothing => rename_new(&self.result(), &target.folder),
                // Exchanged, so that at no instant there is no result.
                Standing::Replaceable => exchange(&self.result(), &target.folder),
            };
            match moved {
                Ok(()) => return self.check_replaced(target),
                // Something appeared or went away meanwhile.
                Err(Errno::EXIST | Errno::NOTEMPTY | Errno::NOENT) => {}
                Err(source) => return Err(write_error(&target.folder, source.into())),
            }
        }
        Err(write_error(&target.folder, Errno::AGAIN.into()))
    }

    /// Checks what came out of the target before it is removed, and puts a stranger back.
    fn check_replaced(self, target: &Target) -> Result<(), OutputError> {
        let Err(error) = standing(&self.result()) else {
            return Ok(());
        };
        if exchange(&self.result(), &target.folder).is_ok() {
            return Err(match error {
                OutputError::Foreign { stranger, .. } => OutputError::Foreign {
                    folder: target.folder.clone(),
                    stranger,
                },
                OutputError::NotAFolder { .. } => OutputError::NotAFolder {
                    folder: target.folder.clone(),
                },
                // Not where it was looked at.
                OutputError::Write { source, .. } => write_error(&target.folder, source),
                other => other,
            });
        }
        let kept = self.result();
        // Not removed: it is not ours.
        let _ = self.folder.keep();
        Err(OutputError::Displaced {
            folder: target.folder.clone(),
            kept,
        })
    }
}

/// Renames a folder to where nothing is.
fn rename_new(from: &Path, to: &Path) -> Result<(), Errno> {
    match renameat_with(CWD, from, CWD, to, RenameFlags::NOREPLACE) {
        // A file system that cannot: there renaming replaces at most an empty folder.
        Err(Errno::INVAL | Errno::NOSYS) => rustix::fs::rename(from, to),
        done => done,
    }
}

fn exchange(one: &Path, other: &Path) -> Result<(), Errno> {
    renameat_with(CWD, one, CWD, other, RenameFlags::EXCHANGE)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{entries, files};
    use super::super::{earlier, publish};
    use super::*;

    fn staged(target: &Target) -> Staging {
        let staging = Staging::new(target).unwrap();
        let files = files("mine");
        let run_file = earlier::record(&files).unwrap();
        staging.write(target, &files, &run_file).unwrap();
        staging
    }

    #[test]
    fn a_stranger_that_comes_at_the_last_instant_stays() {
        let home = tempfile::tempdir().unwrap();
        let target = Target::resolve(&home.path().join("result")).unwrap();
        let staging = staged(&target);
        fs::create_dir(&target.folder).unwrap();
        fs::write(target.folder.join("cat.jpg"), b"cat").unwrap();
        // Between the last look and the exchange.
        exchange(&staging.result(), &target.folder).unwrap();
        let Staging {
            folder,
            _lock: lock,
            ..
        } = staging;
        let complete = Staged {
            folder,
            _lock: lock,
        };
        let refused = complete.check_replaced(&target);
        assert!(matches!(refused, Err(OutputError::Foreign { .. })));
        assert_eq!(entries(&target.folder), ["cat.jpg"]);
        assert_eq!(entries(home.path()), ["result"], "the staging is gone");
        let refused = staged(&target).place(&target);
        assert!(matches!(refused, Err(OutputError::Foreign { .. })));
        assert_eq!(
            rename_new(home.path(), &target.folder),
            Err(Errno::EXIST),
            "nothing is replaced where nothing was seen"
        );
    }

    #[test]
    fn only_what_no_run_holds_is_swept() {
        let home = tempfile::tempdir().unwrap();
        let target = Target::resolve(&home.path().join("result")).unwrap();
        let living = staged(&target);
        let killed = staged(&target);
        let left = killed.folder.path().to_owned();
        let Staging {
            folder,
            _lock: lock,
            ..
        } = killed;
        let _ = folder.keep();
        drop(lock);
        let foreign = home.path().join(".result.partial-album");
        fs::create_dir(&foreign).unwrap();
        fs::write(foreign.join("cat.jpg"), b"cat").unwrap();
        sweep(&target);
        assert!(living.result().join(RUN_FILE).is_file());
        assert!(foreign.join("cat.jpg").is_file());
        assert!(!left.exists());
        drop(living);
        publish(&target.folder, &files("mine")).unwrap();
        assert_eq!(entries(home.path()), [".result.partial-album", "result"]);
    }
}
