//! The file of a gait, before it is known what it holds.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use crate::names::NameKind;
use crate::text_file::{self, ReadError};
use crate::{cycle_file, gait_file};

/// What a gait is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum GaitKind {
    /// A pull alone.
    Pull,
    /// A whole cycle.
    Cycle,
}

impl GaitKind {
    /// What names of this kind are names of.
    pub const fn name_kind(self) -> NameKind {
        match self {
            Self::Pull => NameKind::Pull,
            Self::Cycle => NameKind::Cycle,
        }
    }
}

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

    /// What it holds, by the tables that only one of the two has; nothing of a text that has none of
    /// them, or that is no TOML.
    pub fn kind(&self) -> Option<GaitKind> {
        if self.is_cycle() {
            return Some(GaitKind::Cycle);
        }
        gait_file::is_pull(&self.text).then_some(GaitKind::Pull)
    }

    /// Whether it holds a whole cycle, and not a pull alone.
    pub fn is_cycle(&self) -> bool {
        cycle_file::is_cycle(&self.text)
    }
}
