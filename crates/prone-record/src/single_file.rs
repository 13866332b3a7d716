//! Writing one file where the user says: whole or not at all.

use std::fs::{self, OpenOptions, Permissions};
use std::io::{self, Write as _};
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use crate::output;

/// Mode of a new file, before the user's mask.
const NEW_FILE: u32 = 0o666;

/// A file that is not there as it should be; an earlier one is as it was.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", path.display())]
pub struct WriteError {
    /// The file, as it was named.
    pub path: PathBuf,
    /// Why.
    pub source: io::Error,
}

/// Writes to `path`: a regular file whole or not at all, a device or a pipe directly.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), WriteError> {
    put(path, bytes).map_err(named(path))
}

/// Whether a file that takes long to make can be put at `path`, whole: only a regular file, which may
/// be written, or nothing may stand there.
pub fn check_place(path: &Path) -> Result<(), WriteError> {
    look(path).map_err(named(path))
}

fn named(path: &Path) -> impl FnOnce(io::Error) -> WriteError {
    let path = path.to_owned();
    |source| WriteError { path, source }
}

fn put(path: &Path, bytes: &[u8]) -> io::Result<()> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() => {
            // A file that may not be written is not replaced either.
            OpenOptions::new().write(true).open(path)?;
            replace(&fs::canonicalize(path)?, bytes, found.mode())
        }
        Err(error)
            if error.kind() == io::ErrorKind::NotFound && fs::symlink_metadata(path).is_err() =>
        {
            replace(path, bytes, NEW_FILE)
        }
        // What else there is: a device, a pipe, a link to a file that is still to be made.
        _ => fs::write(path, bytes),
    }
}

fn look(path: &Path) -> io::Result<()> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() => OpenOptions::new().write(true).open(path).map(drop),
        Ok(_) => Err(io::Error::other("it is not a regular file")),
        Err(error)
            if error.kind() == io::ErrorKind::NotFound && fs::symlink_metadata(path).is_ok() =>
        {
            Err(io::Error::other(
                "it is a link to something that does not exist",
            ))
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

fn replace(path: &Path, bytes: &[u8], mode: u32) -> io::Result<()> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut file = tempfile::Builder::new()
        .permissions(Permissions::from_mode(NEW_FILE))
        .tempfile_in(folder)
        .map_err(|error| output::without_hidden_name(&error))?;
    // Past `tempfile`, whose errors name the hidden file.
    file.as_file_mut().write_all(bytes)?;
    if mode != NEW_FILE {
        fs::set_permissions(file.path(), Permissions::from_mode(mode & 0o7777))?;
    }
    // On disk before it has the name: whoever made it may now remove what it was made from.
    file.as_file().sync_all()?;
    file.persist(path)?;
    Ok(())
}

/// The one of `inputs` that is the same file as `path`, by whatever name or link.
pub fn same_file<'a>(path: &Path, inputs: &'a [PathBuf]) -> Option<&'a Path> {
    let identity = |path: &Path| fs::metadata(path).map(|found| (found.dev(), found.ino()));
    let written = identity(path).ok()?;
    let mut inputs = inputs.iter().map(PathBuf::as_path);
    inputs.find(|input| identity(input).is_ok_and(|read| read == written))
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    #[test]
    fn files_are_replaced_whole_and_keep_their_mode() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        fs::write(at("plain"), b"").unwrap();
        write(&at("new"), b"one").unwrap();
        let mode = |name: &str| fs::metadata(at(name)).unwrap().mode();
        assert_eq!(mode("new"), mode("plain"), "the user's mask counts");
        fs::set_permissions(at("new"), Permissions::from_mode(0o640)).unwrap();
        symlink("new", at("link")).unwrap();
        symlink("later", at("dangling")).unwrap();
        let held = fs::File::open(at("new")).unwrap();
        write(&at("link"), b"two").unwrap();
        write(&at("dangling"), b"three").unwrap();
        assert_eq!(fs::read(at("new")).unwrap(), b"two");
        assert_eq!(mode("new") & 0o777, 0o640);
        assert_eq!(fs::read(at("later")).unwrap(), b"three");
        assert!(fs::symlink_metadata(at("link")).unwrap().is_symlink());
        assert_eq!(io::read_to_string(held).unwrap(), "one", "not overwritten");
        for (name, place) in [
            ("link", Ok(())),
            ("newer", Ok(())),
            ("dangling", Ok(())),
            (".", Err(())),
        ] {
            assert_eq!(check_place(&at(name)).map_err(drop), place, "{name}");
        }
        symlink("nowhere", at("lost")).unwrap();
        assert!(check_place(&at("lost")).is_err());
        fs::remove_file(at("lost")).unwrap();
        assert!(check_place(Path::new("/dev/null")).is_err());
        write(Path::new("/dev/null"), b"four").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        assert!(write(Path::new("/dev/full"), b"five").is_err());
        assert!(write(home.path(), b"six").is_err());
        assert_eq!(fs::read_dir(home.path()).unwrap().count(), 5);
    }

    #[test]
    fn a_file_is_known_under_another_name() {
        let home = tempfile::tempdir().unwrap();
        let inputs = ["a", "b"].map(|name| home.path().join(name));
        for input in &inputs {
            fs::write(input, b"").unwrap();
        }
        symlink("b", home.path().join("c")).unwrap();
        assert_eq!(
            same_file(&home.path().join("c"), &inputs),
            Some(&*inputs[1])
        );
        assert_eq!(same_file(&home.path().join("d"), &inputs), None);
    }
}
