//! Texts of robots, gaits and scenes, each with its hash.

use serde::{Deserialize, Serialize};

use prone_files::gaits::Gaits;
use prone_files::robot_folder::{RobotFiles, Version};
use prone_files::{FileError, text_file};

/// A robot's two texts.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotText {
    /// Its folder, as shown to a user.
    pub folder: String,
    /// Of which family it is a version.
    pub family: Option<String>,
    /// Which version of it.
    pub version: Option<String>,
    /// `robot.toml`.
    pub toml: String,
    /// The MJCF model that it names.
    pub mjcf: String,
    /// SHA-256 of both, hexadecimal.
    pub sha256: String,
}

/// The text of a file.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TextFile {
    /// Its path, as the user named it, or the name of one that ships.
    pub file: String,
    /// What stands in it.
    pub text: String,
    /// SHA-256 of that, hexadecimal.
    pub sha256: String,
}

/// The text of a gait's file: a pull or a cycle.
pub type GaitText = TextFile;

/// The text of a scene's file.
pub type SceneText = TextFile;

/// A text is not the one that its hash is of.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("the text of {file} has the SHA-256 {found}, and the experiment says {expected}")]
pub struct ChangedText {
    /// Its file or folder.
    pub file: String,
    /// What the experiment says.
    pub expected: String,
    /// What the text has.
    pub found: String,
}

/// Why a text does not hold what it should.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum TextError {
    /// It is not the one that was asked for.
    #[error(transparent)]
    Changed(#[from] ChangedText),
    /// It is malformed.
    #[error(transparent)]
    Malformed(#[from] FileError),
}

impl RobotText {
    /// The texts of a robot that was read.
    pub fn from_files(files: &RobotFiles) -> Self {
        let version = files.version.as_ref();
        Self {
            folder: files.folder.clone(),
            family: version.map(|version| version.family.clone()),
            version: version.map(|version| version.version.clone()),
            toml: files.toml.clone(),
            mjcf: files.mjcf.clone(),
            sha256: files.hash(),
        }
    }

    /// The robot's files, to be loaded. Its family's gaits are not among them: an experiment names all
    /// gaits that it needs.
    pub fn files(&self) -> Result<RobotFiles, ChangedText> {
        let files = RobotFiles {
            folder: self.folder.clone(),
            toml: self.toml.clone(),
            mjcf: self.mjcf.clone(),
            version: self
                .family
                .clone()
                .zip(self.version.clone())
                .map(|(family, version)| Version { family, version }),
            family_toml: None,
            gaits: Gaits::None,
            read: Vec::new(),
        };
        same(&self.folder, &self.sha256, files.hash())?;
        Ok(files)
    }
}

impl TextFile {
    /// A text and its hash.
    pub fn new(file: &str, text: &str) -> Self {
        Self {
            file: file.to_owned(),
            text: text.to_owned(),
            sha256: text_file::sha256(&[text]),
        }
    }

    /// The text, if it is the one that the hash is of.
    pub fn checked(&self) -> Result<&str, ChangedText> {
        same(&self.file, &self.sha256, text_file::sha256(&[&self.text]))?;
        Ok(&self.text)
    }

    /// What stands in the text, by a parser of its format, which takes file and text.
    pub fn parse<T>(
        &self,
        parser: impl FnOnce(&str, &str) -> Result<T, FileError>,
    ) -> Result<T, TextError> {
        Ok(parser(&self.file, self.checked()?)?)
    }
}

fn same(file: &str, expected: &str, found: String) -> Result<(), ChangedText> {
    if expected == found {
        return Ok(());
    }
    Err(ChangedText {
        file: file.to_owned(),
        expected: expected.to_owned(),
        found,
    })
}
