//! The file of a gait, before it is known what it holds.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use crate::cycle_file;
use crate::text_file::{self, ReadError};

/// A gait's file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GaitText {
    /// Its name, as shown to a user.
    pub file: String,
    /// Its text.
    pub text: Cow<'static, str>,
    /// Where it was read; nowhere if it ships.
    pub read: Option<PathBuf>,
}

impl GaitText {
    /// Reads a gait's file.
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        Ok(Self {
            file: path.display().to_string(),
            text: text_file::read_named(path)?.into(),
            read: Some(path.to_owned()),
        })
    }

    /// Whether it holds a whole cycle, and not a pull alone.
    pub fn is_cycle(&self) -> bool {
        cycle_file::is_cycle(&self.text)
    }
}
