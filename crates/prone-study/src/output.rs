//! A result folder that appears whole or not at all.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use rustix::fs::{CWD, RenameFlags, renameat_with};

/// The file by which a folder is recognised as an earlier result.
pub const RUN_FILE: &str = "run.json";

/// The files of a result, by path relative to its folder.
pub type Artefacts = BTreeMap<String, Vec<u8>>;

/// Why a result folder cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The folder holds something that is not an earlier result.
    #[error(
        "{} is not empty and holds no {RUN_FILE}: it is not an earlier result, so it is not replaced",
        folder.display()
    )]
    Foreign {
        /// The folder.
        folder: PathBuf,
    },
    /// There is something of that name that is no folder.
    #[error("{} is not a folder", folder.display())]
    NotAFolder {
        /// The path.
        folder: PathBuf,
    },
    /// A path that ends in `..` or `/` has no name of its own.
    #[error("{} does not name a folder", folder.display())]
    Nameless {
        /// The path.
        folder: PathBuf,
    },
    /// The file system refuses.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// What could not be written.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// Checks that a result can be put at `folder`, by making and removing an empty one beside it.
/// Nothing is left behind but the folders above it.
///
/// # Errors
/// [`OutputError`].
pub fn check(folder: &Path) -> Result<(), OutputError> {
    match fs::metadata(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(source) => return Err(write_error(folder, source)),
        Ok(found) if !found.is_dir() => {
            return Err(OutputError::NotAFolder {
                folder: folder.to_owned(),
            });
        }
        Ok(_) => {
            let mut entries = fs::read_dir(folder).map_err(|e| write_error(folder, e))?;
            if entries.next().is_some() && !folder.join(RUN_FILE).is_file() {
                return Err(OutputError::Foreign {
                    folder: folder.to_owned(),
                });
            }
        }
    }
    staging(folder).map(drop)
}

/// Writes all files beside `folder` and moves them into place in one step; an earlier result is
/// replaced.
///
/// # Errors
/// [`OutputError`]; the folder is then as it was.
pub fn publish(folder: &Path, artefacts: &Artefacts) -> Result<(), OutputError> {
    let staging = staging(folder)?;
    for (name, bytes) in artefacts {
        let path = staging.path().join(name);
        let written = match path.parent() {
            Some(parent) => fs::create_dir_all(parent),
            None => Ok(()),
        }
        .and_then(|()| fs::write(&path, bytes));
        written.map_err(|e| write_error(&path, e))?;
    }
    if folder.exists() {
        // Exchanged, so that at no instant there is no result; the old one goes with the staging.
        renameat_with(CWD, staging.path(), CWD, folder, RenameFlags::EXCHANGE)
            .map_err(|e| write_error(folder, e.into()))
    } else {
        fs::rename(staging.path(), folder).map_err(|e| write_error(folder, e))
    }
}

/// A hidden folder beside the target, removed when dropped, readable as the target will be.
fn staging(folder: &Path) -> Result<tempfile::TempDir, OutputError> {
    let name = folder.file_name().ok_or_else(|| OutputError::Nameless {
        folder: folder.to_owned(),
    })?;
    let parent = match folder.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    fs::create_dir_all(parent).map_err(|e| write_error(parent, e))?;
    let staging = tempfile::Builder::new()
        .prefix(&format!(".{}.partial-", name.to_string_lossy()))
        .permissions(std::os::unix::fs::PermissionsExt::from_mode(0o755))
        .tempdir_in(parent);
    staging.map_err(|e| write_error(folder, e))
}

fn write_error(path: &Path, source: io::Error) -> OutputError {
    OutputError::Write {
        path: path.to_owned(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(content: &str) -> Artefacts {
        let mut files = Artefacts::new();
        files.insert(RUN_FILE.to_owned(), content.as_bytes().to_vec());
        files.insert("sub/table.csv".to_owned(), b"a,b\n".to_vec());
        files
    }

    fn entries(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap();
        names
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect()
    }

    #[test]
    fn a_result_appears_and_replaces_an_earlier_one_without_traces() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("deep/result");
        check(&folder).unwrap();
        assert!(!folder.exists(), "checking makes no result");
        for content in ["first", "second"] {
            publish(&folder, &files(content)).unwrap();
            assert_eq!(fs::read_to_string(folder.join(RUN_FILE)).unwrap(), content);
            assert!(folder.join("sub/table.csv").is_file());
            assert_eq!(entries(folder.parent().unwrap()), ["result"]);
            check(&folder).unwrap();
        }
    }

    #[test]
    fn strangers_are_not_replaced() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("photos");
        fs::create_dir(&folder).unwrap();
        check(&folder).unwrap();
        fs::write(folder.join("cat.jpg"), b"cat").unwrap();
        assert!(matches!(check(&folder), Err(OutputError::Foreign { .. })));
        let file = folder.join("cat.jpg");
        assert!(matches!(check(&file), Err(OutputError::NotAFolder { .. })));
        assert!(matches!(
            check(&file.join("below")),
            Err(OutputError::Write { .. })
        ));
        assert!(matches!(
            check(Path::new("/")),
            Err(OutputError::NotAFolder { .. }
                | OutputError::Foreign { .. }
                | OutputError::Nameless { .. })
        ));
    }
}
