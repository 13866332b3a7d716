//! One writer at a time.

use std::ffi::OsString;
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
    /// Folders above it that were made for it, the inmost first.
    made: Vec<PathBuf>,
}

impl Lock {
    /// Holds a result folder, under whatever name it is given, against others that write it.
    pub(crate) fn beside(folder: &Path, what: &str) -> Result<Self, Failure> {
        let real = real_path(folder);
        let mut name = OsString::from(".");
        name.push(real.file_name().unwrap_or_default());
        name.push(".prone.lock");
        Self::take(&real.with_file_name(name), what)
    }

    /// Makes the file and locks it; `what` is refused where another process has it.
    pub(crate) fn take(path: &Path, what: &str) -> Result<Self, Failure> {
        let shown = path.display();
        let refused = |error: io::Error| Failure::Input(anyhow!("cannot lock {shown}: {error}"));
        let busy = || Failure::Input(anyhow!("another {what} is at work: it holds {shown}"));
        let mut made = Vec::new();
        if let Some(folder) = path.parent() {
            let missing = folder.ancestors().take_while(|above| !above.exists());
            let missing = missing.filter(|above| !above.as_os_str().is_empty());
            made.extend(missing.map(Path::to_owned));
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
                made,
            }),
            _ => Err(busy()),
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Ours is empty. Still locked, so that it is nobody else's. One that stays is taken over by
        // the next.
        if fs::metadata(&self.path).is_ok_and(|found| found.len() == 0) {
            let _ = fs::remove_file(&self.path);
        }
        for folder in &self.made {
            // One that holds a result by now is not empty, and stays.
            let _ = fs::remove_dir(folder);
        }
    }
}

/// A path without links; what does not exist yet is appended to what does.
fn real_path(path: &Path) -> PathBuf {
    match (path.canonicalize(), path.parent(), path.file_name()) {
        (Ok(real), ..) => real,
        (Err(_), Some(above), Some(name)) if above.as_os_str().is_empty() => {
            real_path(Path::new(".")).join(name)
        }
        (Err(_), Some(above), Some(name)) => real_path(above).join(name),
        _ => path.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lock_leaves_what_was_there() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("new/deep/result");
        let held = Lock::beside(&folder, "test").unwrap();
        let again = Lock::beside(&folder.join("."), "test").unwrap_err();
        assert!(matches!(again, Failure::Input(_)));
        drop(held);
        assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
        // What is not empty is not ours, whatever its name.
        let theirs = home.path().join("theirs");
        fs::write(&theirs, b"words").unwrap();
        drop(Lock::take(&theirs, "test").unwrap());
        assert_eq!(fs::read(theirs).unwrap(), b"words");
    }
}
