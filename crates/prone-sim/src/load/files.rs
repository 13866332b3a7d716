//! The two texts of a robot.

use std::fs::File;
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

use prone_files::robot_file::{Name, RobotFile};
use prone_files::shipped::RobotSource;
use prone_files::{FileError, text_file};

use super::LoadError;

/// Largest text that is read, bytes: a thousand times the shipped robot's.
const LARGEST_FILE: u64 = 16 << 20;

/// The two texts of a robot and where they came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RobotFiles {
    /// The folder, as shown to a user.
    pub folder: String,
    /// `robot.toml`.
    pub toml: String,
    /// The MJCF model that it names.
    pub mjcf: String,
}

impl RobotFiles {
    /// A robot that ships with the program.
    pub fn shipped(source: &RobotSource) -> Self {
        Self {
            folder: source.folder.to_owned(),
            toml: source.toml.to_owned(),
            mjcf: source.mjcf.to_owned(),
        }
    }

    /// Reads `robot.toml` and the model that it names from a folder.
    ///
    /// # Errors
    /// [`LoadError::Read`], [`LoadError::Toml`].
    pub fn read(folder: &Path) -> Result<Self, LoadError> {
        let toml_path = folder.join("robot.toml");
        let toml = read(toml_path.clone())?;
        let toml_name = toml_path.display().to_string();
        let table = RobotFile::parse(&toml_name, &toml)?;
        check_model_name(&toml_name, &toml, &table.model)?;
        let mjcf = read(folder.join(table.model.get_ref()))?;
        Ok(Self {
            folder: folder.display().to_string(),
            toml,
            mjcf,
        })
    }

    /// SHA-256 of both texts, hexadecimal.
    pub fn hash(&self) -> String {
        text_file::sha256(&[&self.toml, &self.mjcf])
    }

    pub(super) fn toml_name(&self) -> String {
        format!("{}/robot.toml", self.folder)
    }
}

/// The model lies beside `robot.toml`: a robot is one folder.
pub(super) fn check_model_name(file: &str, toml: &str, model: &Name) -> Result<(), FileError> {
    let name = model.get_ref();
    let is_plain = Path::new(name)
        .file_name()
        .is_some_and(|last| last == name.as_str())
        && !name.contains(['\\', '\0']);
    if is_plain {
        return Ok(());
    }
    let message = format!("model must be the name of a file beside this one, not {name:?}");
    Err(RobotFile::error_at(file, toml, model, &message))
}

/// Reads a regular file, and no more of it than a model can need.
fn read(path: PathBuf) -> Result<String, LoadError> {
    match read_text(&path) {
        Ok(text) => Ok(text),
        Err(source) => Err(LoadError::Read { path, source }),
    }
}

fn read_text(path: &Path) -> io::Result<String> {
    // Asked before opening, which would wait for the writer of a pipe.
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    let mut text = String::new();
    File::open(path)?
        .take(LARGEST_FILE + 1)
        .read_to_string(&mut text)?;
    if text.len() as u64 > LARGEST_FILE {
        let message = format!("it is larger than {} MiB", LARGEST_FILE >> 20);
        return Err(io::Error::other(message));
    }
    Ok(text)
}
