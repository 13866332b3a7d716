//! Names that become parts of file names.

/// Longest name, bytes: with what is put before and behind it, a file's name has 255 at most.
const LONGEST: usize = 200;

/// Whether a name is made of letters, digits, `-` and `_`: never empty, never a path, not too long for
/// a file.
pub fn is_plain(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    (1..=LONGEST).contains(&name.len()) && name.chars().all(plain)
}

/// A gait's name of which no file can be named.
#[derive(Debug, thiserror::Error)]
#[error("a gait's name is made of letters, digits, - and _, not {name:?}")]
pub struct GaitNameError {
    name: String,
}

/// Refuses a gait's name of which no file can be named.
///
/// # Errors
/// [`GaitNameError`].
pub fn check_gait(name: &str) -> Result<(), GaitNameError> {
    if is_plain(name) {
        return Ok(());
    }
    let name = name.to_owned();
    Err(GaitNameError { name })
}
