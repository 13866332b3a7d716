//! One writer at a time.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::os::unix::fs::MetadataExt as _;
use std::path::{Path, PathBuf};

use anyhow::anyhow;

use crate::Failure;

/// A file that is locked while this lives, and removed afterwards. What a kill leaves of it is in
/// nobody's way.
#[derive(Debug)]
pub(crate) struct Lock {
    path: PathBuf,
    _file: File,
}

impl Lock {
    /// Makes the file and locks it; `what` is refused where another process has it.
    pub(crate) fn take(path: &Path, what: &str) -> Result<Self, Failure> {
        let shown = path.display();
        let refused = |error: io::Error| Failure::Input(anyhow!("cannot lock {shown}: {error}"));
        let busy = || Failure::Input(anyhow!("another {what} is at work: it holds {shown}"));
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(refused)?;
        }
        let file = OpenOptions::new()
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(refused)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(busy()),
            Err(TryLockError::Error(error)) => return Err(refused(error)),
        }
        // Whoever had it may have removed it since it was opened.
        let ours = file.metadata().map_err(refused)?;
        match fs::metadata(path) {
            Ok(named) if (named.dev(), named.ino()) == (ours.dev(), ours.ino()) => Ok(Self {
                path: path.to_owned(),
                _file: file,
            }),
            _ => Err(busy()),
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Still locked, so that it is nobody else's. One that stays is taken over by the next.
        let _ = fs::remove_file(&self.path);
    }
}
