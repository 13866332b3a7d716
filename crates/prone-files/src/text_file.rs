//! Reading a text file that a user names.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use sha2::{Digest, Sha256};

/// The largest file that is read: far beyond any robot or gait, far below the memory of any
/// machine.
pub const LARGEST_BYTES: u64 = 16 << 20;

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

/// Reads a regular file of at most [`LARGEST_BYTES`]; a pipe would be waited for, a device may
/// never end.
///
/// # Errors
/// [`io::Error`], whose message follows after `cannot read <file>: `.
pub fn read(path: &Path) -> io::Result<String> {
    read_at_most(path, LARGEST_BYTES)
}

/// The same with another limit, for tables.
///
/// # Errors
/// [`io::Error`], whose message follows after `cannot read <file>: `.
pub fn read_at_most(path: &Path, largest_bytes: u64) -> io::Result<String> {
    // Looked at before it is opened: opening a pipe waits for its writer.
    if !fs::metadata(path)?.is_file() {
        return Err(refused("it is not a regular file"));
    }
    let mut text = String::new();
    File::open(path)?
        .take(largest_bytes + 1)
        .read_to_string(&mut text)
        .map_err(|error| match error.kind() {
            io::ErrorKind::InvalidData => refused("it is not UTF-8 text"),
            _ => error,
        })?;
    if text.len() as u64 > largest_bytes {
        let most = largest_bytes >> 20;
        return Err(refused(&format!("it is larger than {most} MiB")));
    }
    Ok(text)
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
        assert_eq!(refusal("photo"), "it is not UTF-8 text");
        let large = File::create(at("large")).unwrap();
        large.set_len(LARGEST_BYTES).unwrap();
        assert_eq!(read(&at("large")).unwrap().len() as u64, LARGEST_BYTES);
        large.set_len(LARGEST_BYTES + 1).unwrap();
        assert_eq!(refusal("large"), "it is larger than 16 MiB");
        let zeros = read(Path::new("/dev/zero")).unwrap_err();
        assert_eq!(zeros.to_string(), "it is not a regular file");
    }
}
