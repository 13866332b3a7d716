//! Writing one file where the user says: whole or not at all.

use std::fs::{self, OpenOptions, Permissions};
use std::io::{self, Write as _};
use std::os::unix::fs::{MetadataExt as _, PermissionsExt as _};
use std::path::{Path, PathBuf};

use rustix::fs::Access;
use tempfile::NamedTempFile;

use crate::leftovers::{self, Leftover};
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
/// be written, or nothing may stand there, in a folder that takes a file.
pub fn check_place(path: &Path) -> Result<(), WriteError> {
    match fs::metadata(path) {
        Ok(found) if !found.is_file() && !found.is_dir() => {
            Err(io::Error::other("it is not a regular file"))
        }
        _ => look(path),
    }
    .map_err(named(path))
}

/// The same of a file that is made in one go: a device or a pipe may stand there too.
pub fn check_output(path: &Path) -> Result<(), WriteError> {
    look(path).map_err(named(path))
}

fn named(path: &Path) -> impl FnOnce(io::Error) -> WriteError {
    let path = path.to_owned();
    |source| WriteError { path, source }
}

fn put(path: &Path, bytes: &[u8]) -> io::Result<()> {
    match fs::metadata(path) {
        // What else there is: a device, a pipe.
        Ok(found) if !found.is_file() => fs::write(path, bytes),
        _ => {
            let mut file = make(path, "")?;
            // Past `tempfile`, whose errors name the hidden file.
            file.hidden.as_file_mut().write_all(bytes)?;
            file.place()
        }
    }
}

fn look(path: &Path) -> io::Result<()> {
    let place = match fs::metadata(path) {
        Ok(found) if found.is_dir() => return Err(io::Error::other("it is a folder")),
        // Not opened: a pipe waits for its reader.
        Ok(found) if !found.is_file() => return Ok(()),
        Ok(_) => {
            OpenOptions::new().write(true).open(path)?;
            fs::canonicalize(path)?
        }
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        Err(_) if fs::symlink_metadata(path).is_ok() => return Err(dangling()),
        Err(_) => path.to_owned(),
    };
    let above = folder_of(&place);
    if !fs::metadata(above)?.is_dir() {
        return Err(io::Error::from(io::ErrorKind::NotADirectory));
    }
    Ok(rustix::fs::access(
        above,
        Access::WRITE_OK | Access::EXEC_OK,
    )?)
}

fn dangling() -> io::Error {
    io::Error::other("it is a link to something that does not exist")
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// A hidden file beside the place that it is made for. It is removed on every way out, also where the
/// program is ended at once ([`leftovers`]), unless it is put in its place.
#[derive(Debug)]
pub struct HiddenFile {
    // Removed before it is struck off the list.
    hidden: NamedTempFile,
    leftover: Leftover,
    /// Its place, without links.
    place: PathBuf,
    /// As it was named.
    given: PathBuf,
    /// Mode of the file that it replaces.
    mode: Option<u32>,
}

impl HiddenFile {
    /// Makes an empty one, for whoever writes by name; its name ends in `suffix`.
    ///
    /// # Errors
    /// [`WriteError`] with the place that the file is for.
    pub fn beside(path: &Path, suffix: &str) -> Result<Self, WriteError> {
        make(path, suffix).map_err(named(path))
    }

    /// Where it is meanwhile.
    pub fn path(&self) -> &Path {
        self.hidden.path()
    }

    /// Puts it in its place: whole, and in one step.
    ///
    /// # Errors
    /// [`WriteError`]; what stands in its place is then as it was.
    pub fn put(self) -> Result<(), WriteError> {
        let given = self.given.clone();
        self.place().map_err(named(&given))
    }

    fn place(self) -> io::Result<()> {
        if let Some(mode) = self.mode {
            let mode = Permissions::from_mode(mode & 0o7777);
            fs::set_permissions(self.hidden.path(), mode)?;
        }
        // On disk before it has the name: whoever made it may now remove what it was made from.
        self.hidden.as_file().sync_all()?;
        let Self {
            hidden,
            leftover,
            place,
            ..
        } = self;
        let put = leftover.settle(|| hidden.persist(place));
        put.map(drop).map_err(|error| error.error)
    }
}

fn make(path: &Path, suffix: &str) -> io::Result<HiddenFile> {
    let (place, mode) = match fs::metadata(path) {
        Ok(found) => {
            // A file that may not be written is not replaced either.
            OpenOptions::new().write(true).open(path)?;
            (fs::canonicalize(path)?, Some(found.mode()))
        }
        Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
        Err(_) if fs::symlink_metadata(path).is_ok() => return Err(dangling()),
        Err(_) => (path.to_owned(), None),
    };
    let make = || {
        tempfile::Builder::new()
            .prefix(".prone-")
            .suffix(suffix)
            .permissions(Permissions::from_mode(NEW_FILE))
            .tempfile_in(folder_of(&place))
            .map_err(|error| output::without_hidden_name(&error))
    };
    let (hidden, leftover) = leftovers::make(make, |made| {
        let path = made.path().to_owned();
        // One that is gone already is no matter.
        move || drop(fs::remove_file(path))
    })?;
    Ok(HiddenFile {
        hidden,
        leftover,
        place,
        given: path.to_owned(),
        mode,
    })
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
        assert!(write(&at("dangling"), b"three").is_err());
        assert_eq!(fs::read(at("new")).unwrap(), b"two");
        assert_eq!(mode("new") & 0o777, 0o640);
        assert!(!at("later").exists(), "nothing is made through a link");
        assert!(fs::symlink_metadata(at("link")).unwrap().is_symlink());
        assert_eq!(io::read_to_string(held).unwrap(), "one", "not overwritten");
        for (name, place) in [
            ("link", Ok(())),
            ("newer", Ok(())),
            ("dangling", Err(())),
            ("none/file", Err(())),
            ("plain/file", Err(())),
            (".", Err(())),
        ] {
            assert_eq!(check_place(&at(name)).map_err(drop), place, "{name}");
        }
        assert!(check_place(Path::new("/dev/null")).is_err());
        assert!(check_output(Path::new("/dev/null")).is_ok());
        write(Path::new("/dev/null"), b"four").unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
        assert!(write(Path::new("/dev/full"), b"five").is_err());
        assert!(write(home.path(), b"six").is_err());
        assert_eq!(fs::read_dir(home.path()).unwrap().count(), 4);
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
