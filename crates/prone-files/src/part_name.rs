//! Names of a robot's parts: bodies, joints, sites, shapes, motors.
//!
//! They become columns of tables, frames and topics of ROS, links of a URDF and parts of messages, in
//! programs that each forbid something else. So they are plain, short, and unlike each other even where
//! a program has only one character for `-`, `.` and `_`.

use std::collections::BTreeMap;

use prone::foreign_text;

/// Longest name of a part, bytes.
pub const LONGEST: usize = 64;

/// The frame of the ground in logs.
const WORLD: &str = "world";

/// A joint's commands stand in a column with this after its name, beside that of its angle.
const COMMAND_COLUMN: &str = "_cmd";

/// A name that no part may have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum PartNameError {
    /// Nothing, or too much.
    #[error("the name of a {kind} has 1 to {LONGEST} bytes, not {bytes}")]
    Length {
        /// What it names.
        kind: &'static str,
        /// Length of the name.
        bytes: usize,
    },
    /// A character that some format forbids, or no letter at all.
    #[error(
        "the name of a {kind} is made of letters, digits, _, - and ., with a letter or a digit among them, not \"{name}\""
    )]
    Characters {
        /// What it names.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// Another part is called so.
    #[error("{kind} {name} is there twice")]
    Twice {
        /// What it names.
        kind: &'static str,
        /// The name.
        name: String,
    },
    /// Another part is called alike.
    #[error(
        "{kind} {name} is called like {kind} {other}: names differ in more than _, - and ., which are one in topics of ROS"
    )]
    Alike {
        /// What it names.
        kind: &'static str,
        /// The name.
        name: String,
        /// That of an earlier one.
        other: String,
    },
    /// A name that means something else.
    #[error("{name} is not the name of a {kind}: it is {taken_for}")]
    Taken {
        /// What it names.
        kind: &'static str,
        /// The name.
        name: String,
        /// What it stands for.
        taken_for: &'static str,
    },
}

/// Refuses a name that no part may have; `kind` is what errors call the part.
///
/// # Errors
/// [`PartNameError`].
pub fn check(kind: &'static str, name: &str) -> Result<(), PartNameError> {
    if !(1..=LONGEST).contains(&name.len()) {
        let bytes = name.len();
        return Err(PartNameError::Length { kind, bytes });
    }
    let plain = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
    if !name.chars().all(plain) || key(name).is_empty() {
        let name = foreign_text::cut(name).into_owned();
        return Err(PartNameError::Characters { kind, name });
    }
    Ok(())
}

/// Refuses a name that a body may not have.
///
/// # Errors
/// [`PartNameError`].
pub fn check_body(name: &str) -> Result<(), PartNameError> {
    check("body", name)?;
    refuse_taken("body", name, name == WORLD, "the frame of the ground")
}

/// Refuses a name that a joint may not have.
///
/// # Errors
/// [`PartNameError`].
pub fn check_joint(name: &str) -> Result<(), PartNameError> {
    check("joint", name)?;
    let is_column = name.ends_with(COMMAND_COLUMN);
    refuse_taken("joint", name, is_column, "the column of a joint's command")
}

fn refuse_taken(
    kind: &'static str,
    name: &str,
    taken: bool,
    taken_for: &'static str,
) -> Result<(), PartNameError> {
    if !taken {
        return Ok(());
    }
    Err(PartNameError::Taken {
        kind,
        name: name.to_owned(),
        taken_for,
    })
}

/// Refuses names of which two are the same, or alike; with the place of the second one.
///
/// # Errors
/// The index of the name that an earlier one is like, and [`PartNameError`].
pub fn check_distinct<'a>(
    kind: &'static str,
    names: impl IntoIterator<Item = &'a str>,
) -> Result<(), (usize, PartNameError)> {
    let mut seen = BTreeMap::new();
    for (index, name) in names.into_iter().enumerate() {
        if let Some(other) = seen.insert(key(name), name) {
            let (name, other) = (name.to_owned(), other.to_owned());
            let error = if name == other {
                PartNameError::Twice { kind, name }
            } else {
                PartNameError::Alike { kind, name, other }
            };
            return Err((index, error));
        }
    }
    Ok(())
}

/// What is left of a name where `_`, `-` and `.` are one, and count once.
fn key(name: &str) -> String {
    let parts = name.split(['_', '-', '.']).filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join("_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain_and_short() {
        let longest = "a".repeat(LONGEST);
        for name in ["LKneePitch", "left_knee-joint.1", "7", &longest] {
            assert_eq!(check("site", name), Ok(()), "{name}");
        }
        let over = "a".repeat(LONGEST + 1);
        for name in [
            "", &over, "L,Knee", "L Knee", "L\"K", "K\n", "%s", "_-.", "Knöchel", "a/b",
        ] {
            assert!(check("site", name).is_err(), "{name}");
        }
        assert!(
            check("site", &"é".repeat(2_000_000))
                .unwrap_err()
                .to_string()
                .len()
                < 500
        );
        assert!(check_body("world").is_err());
        assert!(check_joint("LKneePitch_cmd").is_err());
        assert!(check_joint("cmd").is_ok());
    }

    #[test]
    fn names_differ_in_more_than_punctuation() {
        let refused =
            |names: &[&str]| check_distinct("body", names.iter().copied()).map_err(|it| it.0);
        assert_eq!(refused(&["L.Foot", "R.Foot", "LFoot"]), Ok(()));
        assert_eq!(refused(&["L.Foot", "R.Foot", "L-Foot"]), Err(2));
        assert_eq!(refused(&["a", "a"]), Err(1));
        assert_eq!(refused(&["a_b", "a__b"]), Err(1));
    }
}
