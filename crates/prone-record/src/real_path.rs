//! Paths without links, also of what does not exist yet.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Why a path leads to no place.
#[derive(Debug, thiserror::Error)]
pub enum NoRealPath {
    /// A link that leads nowhere.
    #[error("{} is a link to something that does not exist", link.display())]
    Dangling {
        /// The link.
        link: PathBuf,
    },
    /// `..` below a folder that does not exist.
    #[error("{} does not name a place", path.display())]
    Nameless {
        /// The path.
        path: PathBuf,
    },
    /// The file system refuses.
    #[error("cannot read {}: {source}", path.display())]
    Unreadable {
        /// The path.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// A path without links; what does not exist yet is appended to what does.
pub fn real_path(given: &Path) -> Result<PathBuf, NoRealPath> {
    let given = if given.as_os_str().is_empty() {
        Path::new(".")
    } else {
        given
    };
    let unreadable = |source| NoRealPath::Unreadable {
        path: given.to_owned(),
        source,
    };
    match fs::symlink_metadata(given) {
        Ok(found) => fs::canonicalize(given).map_err(|source| {
            if found.is_symlink() && source.kind() == io::ErrorKind::NotFound {
                NoRealPath::Dangling {
                    link: given.to_owned(),
                }
            } else {
                unreadable(source)
            }
        }),
        Err(source) if source.kind() == io::ErrorKind::NotFound => {
            match (given.parent(), given.file_name()) {
                (Some(parent), Some(name)) => Ok(real_path(parent)?.join(name)),
                _ => Err(NoRealPath::Nameless {
                    path: given.to_owned(),
                }),
            }
        }
        Err(source) => Err(unreadable(source)),
    }
}
