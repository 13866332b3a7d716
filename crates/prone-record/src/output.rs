//! A result folder that appears whole or not at all.

mod earlier;
mod staging;
mod target;

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use serde::Serialize;

use prone::foreign_text;

use crate::real_path::NoRealPath;
use earlier::Standing;
use staging::Staging;
use target::{Parents, Target};

/// The file by which a folder is recognised as an earlier result; [`publish`] adds the list of all
/// files to it.
pub const RUN_FILE: &str = "run.json";

/// The files of a result, by path relative to its folder.
pub type Artefacts = BTreeMap<String, Vec<u8>>;

/// A value as the text of a JSON file.
///
/// # Errors
/// [`serde_json::Error`] where the value has no JSON.
pub fn json(value: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
    Ok((json_text(value)? + "\n").into_bytes())
}

/// The same as text, without a line end after it. Letters that are not seen, or that turn others round,
/// stand as escapes of JSON: who reads it has them, a terminal has not.
///
/// # Errors
/// As [`json`].
pub fn json_text(value: &impl Serialize) -> Result<String, serde_json::Error> {
    let text = serde_json::to_string_pretty(value)?;
    Ok(foreign_text::escaped_json(&text).into_owned())
}

/// Why a result folder cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum OutputError {
    /// The folder holds something that is not an earlier result.
    #[error(
        "{} is not an earlier result, so it is not replaced: {stranger}",
        folder.display()
    )]
    Foreign {
        /// The folder.
        folder: PathBuf,
        /// By what that is known.
        stranger: String,
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
    /// A link that leads nowhere.
    #[error("{} is a link to something that does not exist", link.display())]
    Dangling {
        /// The link.
        link: PathBuf,
    },
    /// A mounted file system cannot be replaced in one step.
    #[error(
        "{} is a file system of its own, which cannot be replaced in one step: name a folder in it",
        folder.display()
    )]
    MountPoint {
        /// The folder.
        folder: PathBuf,
    },
    /// `run.json` cannot be recognised later.
    #[error("{RUN_FILE} is not an object that names its program: {0}")]
    Unrecorded(serde_json::Error),
    /// Something appeared in the folder at the last instant and cannot be put back.
    #[error("what stood at {} is not an earlier result; it is now {}", folder.display(), kept.display())]
    Displaced {
        /// The folder.
        folder: PathBuf,
        /// Where it is now.
        kept: PathBuf,
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

/// Checks that a result can be put at `folder`, and removes what killed runs left beside it.
/// Nothing is made, not even the folders above.
pub fn check(folder: &Path) -> Result<(), OutputError> {
    let target = Target::resolve(folder)?;
    if earlier::standing(&target.folder)? == Standing::Replaceable {
        target.check_movable()?;
    }
    staging::sweep(&target);
    staging::probe(&target)
}

/// Writes all files beside `folder` and moves them into place in one step; an earlier result is
/// replaced. [`RUN_FILE`] must be among them.
///
/// # Errors
/// [`OutputError`]; the folder, and those above it, are then as they were.
pub fn publish(folder: &Path, artefacts: &Artefacts) -> Result<(), OutputError> {
    let run_file = earlier::record(artefacts)?;
    let target = Target::resolve(folder)?;
    let parents = Parents::make(&target.parent)?;
    let staging = Staging::new(&target)?;
    staging.write(&target, artefacts, &run_file)?;
    staging.place(&target)?;
    parents.keep();
    Ok(())
}

/// The result folder that a folder is part of: one above it whose list of files names one in it,
/// else itself.
pub fn result_around(folder: &Path) -> PathBuf {
    let above = folder.ancestors().skip(1);
    let mut results = above.filter(|result| earlier::lists_files_in(result, folder));
    results.next().unwrap_or(folder).to_owned()
}

/// The result folder whose list of files names one in a folder, if there is one: that folder or one
/// above it.
pub fn result_with(folder: &Path) -> Option<PathBuf> {
    let mut above = folder.ancestors();
    let result = above.find(|result| earlier::lists_files_in(result, folder));
    result.map(Path::to_owned)
}

/// The command of which a folder is the result, as its [`RUN_FILE`] says.
pub fn command_of(folder: &Path) -> Option<String> {
    earlier::command(folder)
}

/// The same error without the hidden name of a file or folder in which something was to be made: a
/// user knows the name that it would have got.
pub fn without_hidden_name(error: &io::Error) -> io::Error {
    let text = error.to_string();
    // So `tempfile` names the place.
    let reason = text.split(" at path ").next().unwrap_or_default();
    io::Error::new(error.kind(), reason)
}

impl From<NoRealPath> for OutputError {
    fn from(error: NoRealPath) -> Self {
        match error {
            NoRealPath::Dangling { link } => Self::Dangling { link },
            NoRealPath::Nameless { path } => Self::Nameless { folder: path },
            NoRealPath::Unreadable { path, source } => Self::Write { path, source },
        }
    }
}

fn write_error(path: &Path, source: io::Error) -> OutputError {
    OutputError::Write {
        path: path.to_owned(),
        source,
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::os::unix::fs::symlink;

    use super::*;

    pub(super) fn files(content: &str) -> Artefacts {
        let run = format!("{{\n  \"program\": \"prone\",\n  \"content\": \"{content}\"\n}}\n");
        let mut files = Artefacts::new();
        files.insert(RUN_FILE.to_owned(), run.into_bytes());
        files.insert("sub/table.csv".to_owned(), b"a,b\n".to_vec());
        files
    }

    pub(super) fn entries(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = names
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn is_foreign(folder: &Path, reason: &str) -> bool {
        let error = check(folder).unwrap_err();
        let foreign = matches!(&error, OutputError::Foreign { stranger, .. } if stranger == reason);
        assert!(foreign, "{error}");
        // Neither is it replaced when it appears after the check.
        publish(folder, &files("late")).is_err()
    }

    #[test]
    fn a_result_appears_and_replaces_an_earlier_one_without_traces() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("deep/result");
        check(&folder).unwrap();
        assert_eq!(entries(home.path()), [""; 0], "checking makes nothing");
        for content in ["first", "second"] {
            publish(&folder, &files(content)).unwrap();
            assert_eq!(
                fs::read_to_string(folder.join(RUN_FILE)).unwrap(),
                format!(
                    "{{\n  \"program\": \"prone\",\n  \"content\": \"{content}\",\n  \"artefacts\": [\n    \
                     \"run.json\",\n    \"sub/table.csv\"\n  ]\n}}\n"
                )
            );
            assert!(folder.join("sub/table.csv").is_file());
            assert_eq!(entries(folder.parent().unwrap()), ["result"]);
            check(&folder).unwrap();
        }
        fs::remove_file(folder.join("sub/table.csv")).unwrap();
        check(&folder).unwrap();
    }

    #[test]
    fn strangers_are_not_replaced() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("photos");
        fs::create_dir(&folder).unwrap();
        check(&folder).unwrap();
        let cat = folder.join("cat.jpg");
        fs::write(&cat, b"cat").unwrap();
        assert!(is_foreign(&folder, "it holds no run.json"));
        for theirs in [
            "",
            "[]",
            r#"{"program": "jog", "artefacts": ["cat.jpg", "run.json"]}"#,
            r#"{"program": "prone"}"#,
        ] {
            fs::write(folder.join(RUN_FILE), theirs).unwrap();
            let reason = "its run.json does not list what prone wrote";
            assert!(is_foreign(&folder, reason), "{theirs}");
        }
        assert!(matches!(check(&cat), Err(OutputError::NotAFolder { .. })));
        let below = check(&cat.join("below"));
        assert!(matches!(below, Err(OutputError::Write { .. })));
        for nameless in ["/", "..", "."] {
            let refused = check(Path::new(nameless));
            assert!(matches!(refused, Err(OutputError::Nameless { .. })));
        }
        assert_eq!(fs::read(cat).unwrap(), b"cat");
    }

    #[test]
    fn a_result_with_one_thing_more_is_not_replaced() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("result");
        publish(&folder, &files("first")).unwrap();
        let more = |path: &str| folder.join(path);
        fs::write(more("sub/notes.txt"), b"mine").unwrap();
        assert!(is_foreign(&folder, "prone did not write sub/notes.txt"));
        fs::remove_file(more("sub/notes.txt")).unwrap();
        fs::create_dir(more("empty")).unwrap();
        assert!(is_foreign(&folder, "prone did not write empty"));
        fs::remove_dir(more("empty")).unwrap();
        fs::remove_file(more("sub/table.csv")).unwrap();
        symlink("/etc/hostname", more("sub/table.csv")).unwrap();
        assert!(is_foreign(&folder, "prone did not write sub/table.csv"));
        fs::remove_file(more("sub/table.csv")).unwrap();
        check(&folder).unwrap();
    }

    #[test]
    fn links_are_followed_and_mounts_refused() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        symlink("there", at("link")).unwrap();
        let dangling = |path: &str| matches!(check(&at(path)), Err(OutputError::Dangling { .. }));
        assert!(dangling("link") && dangling("link/below"));
        fs::create_dir(at("there")).unwrap();
        for content in ["first", "second"] {
            publish(&at("link"), &files(content)).unwrap();
            publish(&at("link/../there"), &files(content)).unwrap();
        }
        assert_eq!(entries(home.path()), ["link", "there"]);
        assert_eq!(entries(&at("there")), [RUN_FILE, "sub"]);
        symlink("/", at("root")).unwrap();
        let root = check(&at("root"));
        assert!(matches!(root, Err(OutputError::Nameless { .. })));
        let target = Target::resolve(Path::new("/proc")).unwrap();
        let mount = target.check_movable();
        assert!(matches!(mount, Err(OutputError::MountPoint { .. })));
        assert_eq!(entries(home.path()), ["link", "root", "there"]);
    }

    #[test]
    fn a_failure_leaves_no_folders_behind() {
        let home = tempfile::tempdir().unwrap();
        let mut broken = files("first");
        broken.insert("run.json/below".to_owned(), Vec::new());
        let failed = publish(&home.path().join("a/b/result"), &broken);
        let Err(OutputError::Write { path, .. }) = failed else {
            panic!("{failed:?}")
        };
        // Named as it would have been, not where it was made.
        assert!(path.ends_with("a/b/result/run.json/below"), "{path:?}");
        let failed = publish(&home.path().join("result"), &Artefacts::new());
        assert!(matches!(failed, Err(OutputError::Unrecorded(_))));
        let dotted = publish(&home.path().join("a/../result"), &files("first"));
        assert!(matches!(dotted, Err(OutputError::Nameless { .. })));
        assert_eq!(entries(home.path()), [""; 0]);
    }

    #[test]
    fn results_of_many_threads_are_each_whole() {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("new/result");
        std::thread::scope(|scope| {
            for content in ["a", "b", "c", "d"] {
                let folder = &folder;
                scope.spawn(move || {
                    for _ in 0..25 {
                        check(folder).unwrap();
                        publish(folder, &files(content)).unwrap();
                    }
                });
            }
        });
        assert_eq!(entries(&folder), [RUN_FILE, "sub"]);
        assert_eq!(entries(&home.path().join("new")), ["result"]);
    }
}
