//! Reading a file that a user, or a file by somebody else, names. All reading goes through here: only
//! regular files, and of a bounded size.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read as _};
use std::os::unix::fs::OpenOptionsExt as _;
use std::path::{Component, Path, PathBuf};

use rustix::fs::OFlags;
use sha2::{Digest, Sha256};

/// The largest file that is read: far beyond any robot or gait, far below the memory of any
/// machine.
pub const LARGEST_BYTES: u64 = 16 << 20;

/// The largest table of a record: a thousand cycles take half of it.
pub const LARGEST_TABLE_BYTES: u64 = 256 << 20;

/// A file that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("cannot read {}: {source}", path.display())]
pub struct ReadError {
    /// The file.
    pub path: PathBuf,
    /// Why.
    pub source: io::Error,
}

/// Reads as [`read`] does, with an error that names the file.
pub fn read_named(path: &Path) -> Result<String, ReadError> {
    read(path).map_err(|source| ReadError {
        path: path.to_owned(),
        source,
    })
}

/// Reads a regular file of at most [`LARGEST_BYTES`].
///
/// # Errors
/// [`io::Error`], whose message follows after `cannot read <file>: `.
pub fn read(path: &Path) -> io::Result<String> {
    read_at_most(path, LARGEST_BYTES)
}

/// The same with another limit, for tables.
///
/// # Errors
/// [`io::Error`], whose message follows after `cannot read <file>: `. Where it is not UTF-8, it says in
/// which line.
pub fn read_at_most(path: &Path, largest_bytes: u64) -> io::Result<String> {
    let bytes = read_bytes(path, largest_bytes)?;
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = before.split(|byte| *byte == b'\n').count();
        refused(&format!("it is not UTF-8 text in line {line}"))
    })
}

/// Reads the bytes of a regular file of at most `largest_bytes`.
///
/// # Errors
/// [`io::Error`], whose message follows after `cannot read <file>: `.
pub fn read_bytes(path: &Path, largest_bytes: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_regular(path)?
        .take(largest_bytes + 1)
        .read_to_end(&mut bytes)?;
    if bytes.len() as u64 > largest_bytes {
        let most = largest_bytes >> 20;
        return Err(refused(&format!("it is larger than {most} MiB")));
    }
    Ok(bytes)
}

/// Reads the bytes of a file that a folder holds, or that a text in the folder names. It has to lie in the
/// folder: a name with `..` in it, and a link that leads out of it, are refused.
///
/// # Errors
/// [`io::Error`], whose message follows after `cannot read <file>: `.
pub fn read_within(folder: &Path, file: &str, largest_bytes: u64) -> io::Result<Vec<u8>> {
    let is_plain = |part: Component<'_>| matches!(part, Component::Normal(_));
    if file.is_empty() || !Path::new(file).components().all(is_plain) {
        return Err(refused("it is not a name of a file below the folder"));
    }
    let path = fs::canonicalize(folder.join(file))?;
    if !path.starts_with(fs::canonicalize(folder)?) {
        return Err(refused("it is a link that leads out of the folder"));
    }
    read_bytes(&path, largest_bytes)
}

/// Opens a regular file. A pipe would be waited for, a device may never end: both are opened without
/// waiting, looked at, and refused.
fn open_regular(path: &Path) -> io::Result<File> {
    #[expect(
        clippy::cast_possible_wrap,
        reason = "a flag of the system, far below the sign"
    )]
    const WAITS_NOT: i32 = OFlags::NONBLOCK.bits() as i32;
    let opened = OpenOptions::new()
        .read(true)
        .custom_flags(WAITS_NOT)
        .open(path);
    // A socket cannot be opened at all.
    let is_regular = |found: &fs::Metadata| found.is_file();
    let file = match opened {
        Ok(file) => file,
        Err(_) if fs::metadata(path).is_ok_and(|found| !is_regular(&found)) => {
            return Err(refused("it is not a regular file"));
        }
        Err(error) => return Err(error),
    };
    if is_regular(&file.metadata()?) {
        Ok(file)
    } else {
        Err(refused("it is not a regular file"))
    }
}

fn refused(reason: &str) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, reason)
}

/// SHA-256 of texts, one after the other with a zero byte between two, hexadecimal.
pub fn sha256(texts: &[&str]) -> String {
    let mut hasher = Sha256::new();
    for (index, text) in texts.iter().enumerate() {
        if index > 0 {
            hasher.update([0]);
        }
        hasher.update(text.as_bytes());
    }
    let digits = |byte: &u8| {
        [byte >> 4, byte & 0xf].map(|d| char::from(b"0123456789abcdef"[usize::from(d)]))
    };
    hasher.finalize().iter().flat_map(digits).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_files_of_a_sane_size_are_read() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        let refusal = |name: &str| read(&at(name)).unwrap_err().to_string();
        fs::write(at("gait.toml"), "name = \"a\"\n").unwrap();
        assert_eq!(read(&at("gait.toml")).unwrap(), "name = \"a\"\n");
        assert_eq!(refusal("."), "it is not a regular file");
        fs::write(at("photo"), [0xff; 9]).unwrap();
        assert_eq!(refusal("photo"), "it is not UTF-8 text in line 1");
        fs::write(at("latin"), b"a\nb\nTisch h\xf6her\n").unwrap();
        assert_eq!(refusal("latin"), "it is not UTF-8 text in line 3");
        let large = File::create(at("large")).unwrap();
        large.set_len(LARGEST_BYTES).unwrap();
        assert_eq!(read(&at("large")).unwrap().len() as u64, LARGEST_BYTES);
        large.set_len(LARGEST_BYTES + 1).unwrap();
        assert_eq!(refusal("large"), "it is larger than 16 MiB");
        let zeros = read(Path::new("/dev/zero")).unwrap_err();
        assert_eq!(zeros.to_string(), "it is not a regular file");
    }
    /// Whatever stands in a file's place, the reader does not wait, and says so.
    #[test]
    fn limit_pipes_devices_and_sockets_are_not_waited_for() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        let made = std::process::Command::new("mkfifo")
            .arg(at("pipe"))
            .status();
        assert!(made.unwrap().success());
        let _socket = std::os::unix::net::UnixListener::bind(at("socket")).unwrap();
        std::os::unix::fs::symlink("pipe", at("link")).unwrap();
        std::os::unix::fs::symlink("loop", at("loop")).unwrap();
        for name in [
            "pipe",
            "socket",
            "link",
            "/dev/tty",
            "/dev/null",
            "/dev/zero",
        ] {
            let refused = read_bytes(&at(name), 10).unwrap_err().to_string();
            // A terminal that is none of the process's cannot be opened at all.
            assert!(
                refused == "it is not a regular file" || name == "/dev/tty",
                "{name}: {refused}"
            );
        }
        assert!(read_bytes(&at("loop"), 10).is_err());
        assert!(read_bytes(&at("none"), 10).is_err());
    }

    #[test]
    fn what_a_folder_names_lies_in_it() {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name);
        fs::create_dir_all(at("record/figures")).unwrap();
        fs::write(at("secret"), b"secret").unwrap();
        fs::write(at("record/figures/a.png"), b"a").unwrap();
        std::os::unix::fs::symlink(at("secret"), at("record/figures/b.png")).unwrap();
        std::os::unix::fs::symlink("figures/a.png", at("record/c.png")).unwrap();
        let read = |file: &str| read_within(&at("record"), file, 10).map_err(|it| it.to_string());
        assert_eq!(read("figures/a.png").unwrap(), b"a");
        assert_eq!(read("c.png").unwrap(), b"a");
        let secret = at("secret").display().to_string();
        for file in [
            "../secret",
            "figures/../../secret",
            &secret,
            "",
            ".",
            "figures/b.png",
        ] {
            assert!(read(file).is_err(), "{file}");
        }
    }
}
