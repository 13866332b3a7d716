//! Names that become parts of file names.

/// Whether a name is made of letters, digits, `-` and `_`: never empty, never a path.
pub fn is_plain(name: &str) -> bool {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    !name.is_empty() && name.chars().all(plain)
}
