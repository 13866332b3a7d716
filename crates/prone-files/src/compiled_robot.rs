//! A compiled robot: all that [`prone::robot::Robot`] holds, as JSON, so that it can be had without
//! the engine.
//!
//! ```json
//! {
//!   "format": "prone-compiled-robot",
//!   "format_version": 3,
//!   "family": "nao",
//!   "version": "v4",
//!   "sources_sha256": "…",
//!   "engine": "MuJoCo 3.17.0",
//!   "robot": { "name": "NAO H25 V4", "standing_height_m": 0.574, "bodies": […], … }
//! }
//! ```
//!
//! Lengths are metres, angles radians, quaternions have their real part first; the keys say so.
//! Numbers have every digit. What is read keeps to the bounds of the text formats
//! ([`prone::robot::bounds`]) and has passed the checks of a robot that was compiled. The hash is
//! that of the two texts which the robot was compiled from: where they lie beside it, it tells
//! whether they still are those. A robot without a family has `null` for it and for its version.

mod bodies;
mod chain;
mod control;
mod coupled;
mod document;
mod layout;
mod names;
mod place;

pub use document::RobotDocument;
pub use place::Violation;

use std::path::Path;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use prone::robot::Robot;

use place::{LONGEST_NAME, Place};

use crate::error::FileError;
use crate::plain_name::is_plain;
use crate::robot_folder::{RobotFiles, Version};
use crate::shipped::RobotSource;
use crate::text_file::{ReadError, read_named};

/// Its name beside the robot's sources.
pub const FILE_NAME: &str = "robot.compiled.json";

/// What the key `format` says.
const FORMAT: &str = "prone-compiled-robot";
/// The version of the format that is written and read.
const FORMAT_VERSION: u64 = 3;
/// Digits of a SHA-256 hash.
const HASH_DIGITS: usize = 64;

/// A robot as the engine compiled it, and from what.
#[derive(Debug, Clone, PartialEq)]
pub struct CompiledRobot {
    robot: Robot,
    version: Option<Version>,
    sources_hash: String,
    engine: String,
}

/// Why a compiled robot cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum CompiledRobotError {
    /// The file cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// It is not JSON, or lacks or adds a key.
    #[error(transparent)]
    Json(#[from] FileError),
    /// It is JSON of another kind or version, or holds what no robot has.
    #[error("{file}{problem}")]
    Content {
        /// The file.
        file: String,
        /// What is wrong, and where; it continues the name of the file.
        problem: String,
    },
    /// Its sources have changed since.
    #[error(
        "{file} is stale: it was compiled from sources with the hash {compiled}, and those in {folder} have {sources}; `{}` renews it",
        renewal(folder, file)
    )]
    Stale {
        /// The file.
        file: String,
        /// SHA-256 of the sources that it was compiled from.
        compiled: String,
        /// Folder of the sources.
        folder: String,
        /// SHA-256 of what they are now.
        sources: String,
    },
}

/// The command that writes a compiled robot anew.
fn renewal(folder: &str, file: &str) -> String {
    if Path::new(folder).join(FILE_NAME) == Path::new(file) {
        format!("prone robot compile {folder}")
    } else {
        format!("prone robot compile {folder} --out {file}")
    }
}

/// Whether a text is a compiled robot by what it says of itself, whatever its version and its sources
/// are, and whatever else is in it.
pub fn is_compiled_robot(text: &str) -> bool {
    serde_json::from_str::<Head>(text).is_ok_and(|head| head.format == FORMAT)
}

/// The file as it is written.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Document {
    format: String,
    format_version: u64,
    #[serde(deserialize_with = "Option::deserialize")]
    family: Option<String>,
    #[serde(deserialize_with = "Option::deserialize")]
    version: Option<String>,
    sources_sha256: String,
    engine: String,
    robot: RobotDocument,
}

/// What says whether the rest can be read.
#[derive(Debug, Deserialize)]
struct Head {
    format: String,
    format_version: u64,
}

impl CompiledRobot {
    /// A robot that `engine` has compiled from its sources.
    ///
    /// # Errors
    /// [`Violation`] if the robot could not be read again from [`CompiledRobot::text`]: a name that
    /// is empty, say, or a number that is none.
    pub fn new(robot: &Robot, sources: &RobotFiles, engine: String) -> Result<Self, Violation> {
        let unchecked = Self {
            robot: robot.clone(),
            version: sources.version.clone(),
            sources_hash: sources.hash(),
            engine,
        };
        Self::from_document(unchecked.document())
    }

    /// Reads a compiled robot, wherever its sources are.
    ///
    /// # Errors
    /// All of [`CompiledRobotError`] but that it is stale.
    pub fn read(path: &Path) -> Result<Self, CompiledRobotError> {
        Self::parse(&path.display().to_string(), &read_named(path)?)
    }

    /// Reads the compiled robot that lies beside its sources, under the name [`FILE_NAME`], and
    /// refuses it if they are no longer those that it was compiled from.
    pub fn read_beside(sources: &RobotFiles) -> Result<Self, CompiledRobotError> {
        let path = Path::new(&sources.folder).join(FILE_NAME);
        let compiled = Self::read(&path)?;
        compiled.check_fresh(&path.display().to_string(), sources)?;
        Ok(compiled)
    }

    /// Reads a compiled robot from its text; `file` is the name that errors carry.
    ///
    /// # Errors
    /// As [`CompiledRobot::read`].
    pub fn parse(file: &str, text: &str) -> Result<Self, CompiledRobotError> {
        let wrong = |problem| CompiledRobotError::Content {
            file: file.to_owned(),
            problem,
        };
        let Head {
            format: kind,
            format_version: found,
        } = from_json(file, text)?;
        if kind != FORMAT {
            return Err(wrong(format!(
                " is no compiled robot: its format is {kind:?}, not {FORMAT:?}"
            )));
        }
        if found != FORMAT_VERSION {
            return Err(wrong(format!(
                " has version {found} of its format and this program reads version {FORMAT_VERSION}"
            )));
        }
        let compiled = Self::from_document(from_json(file, text)?);
        compiled.map_err(|violation| wrong(format!(": {violation}")))
    }

    /// A robot that ships with the program.
    ///
    /// # Errors
    /// [`CompiledRobotError`] if the embedded text does not read, which a test excludes.
    pub fn shipped(source: &RobotSource) -> Result<Self, CompiledRobotError> {
        Self::parse(&format!("{}/{FILE_NAME}", source.folder), source.compiled)
    }

    fn from_document(document: Document) -> Result<Self, Violation> {
        let hash = &document.sources_sha256;
        let is_digit = |digit: u8| matches!(digit, b'0'..=b'9' | b'a'..=b'f');
        if hash.len() != HASH_DIGITS || !hash.bytes().all(is_digit) {
            let message = format!("a hash has {HASH_DIGITS} digits, 0 to 9 and a to f");
            return Err(Place::Root("sources_sha256").violation(message));
        }
        if document.engine.len() > LONGEST_NAME {
            let message = format!("more than {LONGEST_NAME} bytes");
            return Err(Place::Root("engine").violation(message));
        }
        Ok(Self {
            robot: document.robot.robot("robot")?,
            version: read_version(document.family, document.version)?,
            sources_hash: document.sources_sha256,
            engine: document.engine,
        })
    }

    /// The text of its file: the same robot gives the same bytes.
    pub fn text(&self) -> String {
        layout::text(&self.document())
    }

    fn document(&self) -> Document {
        Document {
            format: FORMAT.to_owned(),
            format_version: FORMAT_VERSION,
            family: self.version.as_ref().map(|it| it.family.clone()),
            version: self.version.as_ref().map(|it| it.version.clone()),
            sources_sha256: self.sources_hash.clone(),
            engine: self.engine.clone(),
            robot: RobotDocument::from_robot(&self.robot),
        }
    }

    /// The robot.
    pub const fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The robot, without where it comes from.
    pub fn into_robot(self) -> Robot {
        self.robot
    }

    /// Which version of which family it is, where it is one.
    pub const fn version(&self) -> Option<&Version> {
        self.version.as_ref()
    }

    /// SHA-256 of the sources that it was compiled from, hexadecimal.
    pub fn sources_hash(&self) -> &str {
        &self.sources_hash
    }

    /// The engine that compiled it, with its version.
    pub fn engine(&self) -> &str {
        &self.engine
    }

    /// Whether its sources still are those that it was compiled from; `file` is the name that the
    /// error carries.
    ///
    /// # Errors
    /// [`CompiledRobotError::Stale`].
    pub fn check_fresh(&self, file: &str, sources: &RobotFiles) -> Result<(), CompiledRobotError> {
        let hash = sources.hash();
        if self.sources_hash == hash {
            return Ok(());
        }
        Err(CompiledRobotError::Stale {
            file: file.to_owned(),
            compiled: self.sources_hash.clone(),
            folder: sources.folder.clone(),
            sources: hash,
        })
    }
}

/// Both names or none; they name folders.
fn read_version(
    family: Option<String>,
    version: Option<String>,
) -> Result<Option<Version>, Violation> {
    let refused = |place, message: &str| Err(Place::Root(place).violation(message));
    let (family, version) = match (family, version) {
        (None, None) => return Ok(None),
        (Some(family), Some(version)) => (family, version),
        (None, Some(_)) => return refused("family", "a version has a family"),
        (Some(_), None) => return refused("version", "a robot of a family is a version"),
    };
    for (place, name) in [("family", &family), ("version", &version)] {
        if !is_plain(name) || name.len() > LONGEST_NAME {
            let message =
                format!("{name:?} is not made of 1 to {LONGEST_NAME} letters, digits, - and _");
            return refused(place, &message);
        }
    }
    Ok(Some(Version { family, version }))
}

fn from_json<T: DeserializeOwned>(file: &str, text: &str) -> Result<T, FileError> {
    serde_json::from_str(text).map_err(|error| {
        let (line, column) = (error.line().max(1), error.column().max(1));
        let message = error.to_string();
        // The reader ends its messages with the place, which is said before them here.
        let place = format!(" at line {} column {}", error.line(), error.column());
        FileError {
            file: file.to_owned(),
            line,
            column,
            message: message.strip_suffix(&place).unwrap_or(&message).to_owned(),
        }
    })
}

#[cfg(test)]
mod tests;
