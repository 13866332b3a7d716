//! Gaits by name: a robot's own go before those that ship with the program.
//!
//! The gaits of a robot are files `<name>.toml` in the folder `gaits` of its family, or of a robot
//! without one. A file is looked at when its name is asked for, so that one which is broken is in
//! nobody's way.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::gait_text::{GaitKind, GaitText};
use crate::names::{NameKind, UnknownName};
use crate::plain_name::is_plain;
use crate::shipped::{self, FamilySource};
use crate::text_file::ReadError;

/// Name of the folder of gaits.
pub(crate) const FOLDER: &str = "gaits";

/// Most gaits of a folder.
const MOST_GAITS: usize = 10_000;

/// Where a robot's own gaits are.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum Gaits {
    /// It has none.
    #[default]
    None,
    /// Inside the program.
    Shipped(&'static FamilySource),
    /// In a folder.
    Folder(PathBuf),
}

/// Why there is no gait for what a user typed.
#[derive(Debug, thiserror::Error)]
pub enum GaitLookupError {
    /// There is a file that cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Nothing is named so, and no file lies there.
    #[error(transparent)]
    Unknown(#[from] UnknownName),
    /// A pull was named where a cycle is needed.
    #[error("{asked} is a pull alone; a crawl needs a cycle with its way back")]
    PullAlone {
        /// The name or the path.
        asked: String,
    },
    /// A cycle was named where a pull is needed.
    #[error(
        "{asked} is a whole cycle; a pull alone is needed here (`prone crawl run` tells what a cycle costs)"
    )]
    WholeCycle {
        /// The name or the path.
        asked: String,
    },
}

impl Gaits {
    /// The gaits beside a `family.toml` or `robot.toml`.
    pub(crate) fn beside(folder: &Path) -> Self {
        let gaits = folder.join(FOLDER);
        if gaits.is_dir() {
            Self::Folder(gaits)
        } else {
            Self::None
        }
    }

    /// The gait of a name: the robot's own, or else one that ships; `None` where there is neither.
    ///
    /// # Errors
    /// [`ReadError`] where there is a file that cannot be read.
    pub fn find(&self, name: &str) -> Result<Option<GaitText>, ReadError> {
        if !is_plain(name) {
            return Ok(None);
        }
        match self {
            Self::None => Ok(shipped::gait_file(name)),
            Self::Shipped(family) => {
                Ok(family.gait_file(name).or_else(|| shipped::gait_file(name)))
            }
            Self::Folder(folder) => {
                let path = folder.join(format!("{name}.toml"));
                if !path.exists() {
                    return Ok(shipped::gait_file(name));
                }
                GaitText::read(&path).map(Some)
            }
        }
    }

    /// The gait that a user names: by its name, as [`Gaits::find`] takes it, or else by its file.
    ///
    /// # Errors
    /// [`GaitLookupError`] where there is neither.
    pub fn named(&self, asked: &str) -> Result<GaitText, GaitLookupError> {
        self.named_as(NameKind::Gait, asked)
    }

    /// The gait that a user names where one kind of gait is needed. What holds no gait of either
    /// kind is left to whoever parses it, and says what is missing.
    ///
    /// # Errors
    /// [`GaitLookupError`] where there is none, or it is of the other kind.
    pub fn of_kind(&self, kind: GaitKind, asked: &str) -> Result<GaitText, GaitLookupError> {
        let gait = self.named_as(kind.name_kind(), asked)?;
        let asked = || asked.to_owned();
        match (kind, gait.kind()) {
            (GaitKind::Cycle, Some(GaitKind::Pull)) => {
                Err(GaitLookupError::PullAlone { asked: asked() })
            }
            (GaitKind::Pull, Some(GaitKind::Cycle)) => {
                Err(GaitLookupError::WholeCycle { asked: asked() })
            }
            _ => Ok(gait),
        }
    }

    fn named_as(&self, kind: NameKind, asked: &str) -> Result<GaitText, GaitLookupError> {
        if let Some(gait) = self.find(asked)? {
            return Ok(gait);
        }
        let path = Path::new(asked);
        if !path.exists() {
            return Err(self.unknown(kind, asked)?.into());
        }
        Ok(GaitText::read(path)?)
    }

    /// The error for a name that no gait of a kind has.
    ///
    /// # Errors
    /// [`ReadError`] where the folder or one of its files cannot be read.
    fn unknown(&self, kind: NameKind, asked: &str) -> Result<UnknownName, ReadError> {
        let unknown = UnknownName::new(kind, asked, self.names(kind)?);
        let home = match self {
            Self::Folder(folder) => folder.parent(),
            Self::None | Self::Shipped(_) => None,
        };
        Ok(match home {
            Some(home) => unknown.with_those_of(home),
            None => unknown,
        })
    }

    /// Names by which gaits of a kind are found, the robot's own first; none of what is no gait.
    ///
    /// # Errors
    /// [`ReadError`] where the folder or one of its files cannot be read.
    pub fn names(&self, kind: NameKind) -> Result<Vec<String>, ReadError> {
        let (pulls, cycles) = match kind {
            NameKind::Gait => (true, true),
            NameKind::Pull => (true, false),
            NameKind::Cycle => (false, true),
            _ => (false, false),
        };
        let mut names = Vec::new();
        if pulls {
            names.extend(self.own_pulls()?);
            names.extend(shipped::gait_names().map(str::to_owned));
        }
        if cycles {
            names.extend(self.own_cycles()?);
            names.extend(shipped::cycle_names().map(str::to_owned));
        }
        let mut seen = BTreeSet::new();
        names.retain(|name| seen.insert(name.clone()));
        Ok(names)
    }

    /// Names of the robot's own pulls: as they ship, or in the order of their names.
    ///
    /// # Errors
    /// [`ReadError`] where the folder or one of its files cannot be read.
    pub fn own_pulls(&self) -> Result<Vec<String>, ReadError> {
        self.own(
            |family| family.pull_names().map(str::to_owned).collect(),
            |gait| !gait.is_cycle(),
        )
    }

    /// Names of the robot's own cycles: as they ship, or in the order of their names.
    ///
    /// # Errors
    /// [`ReadError`] where the folder or one of its files cannot be read.
    pub fn own_cycles(&self) -> Result<Vec<String>, ReadError> {
        self.own(
            |family| family.cycle_names().map(str::to_owned).collect(),
            GaitText::is_cycle,
        )
    }

    fn own(
        &self,
        shipped: fn(&FamilySource) -> Vec<String>,
        wanted: impl Fn(&GaitText) -> bool,
    ) -> Result<Vec<String>, ReadError> {
        let folder = match self {
            Self::None => return Ok(Vec::new()),
            Self::Shipped(family) => return Ok(shipped(family)),
            Self::Folder(folder) => folder,
        };
        let unread = |source| ReadError {
            path: folder.to_owned(),
            source,
        };
        let mut names = Vec::new();
        for entry in fs::read_dir(folder).map_err(unread)? {
            let file = entry.map_err(unread)?.file_name();
            let name = file.to_str().and_then(|file| file.strip_suffix(".toml"));
            names.extend(name.filter(|name| is_plain(name)).map(str::to_owned));
            if names.len() > MOST_GAITS {
                let many = format!("it holds more than {MOST_GAITS} gaits");
                return Err(unread(std::io::Error::other(many)));
            }
        }
        names.sort_unstable();
        let mut found = Vec::new();
        for name in names {
            if self.find(&name)?.is_some_and(|gait| wanted(&gait)) {
                found.push(name);
            }
        }
        Ok(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder() -> (tempfile::TempDir, Gaits) {
        let home = tempfile::tempdir().unwrap();
        let gaits = home.path().join(FOLDER);
        fs::create_dir(&gaits).unwrap();
        for (name, like) in [("ours", "nominal"), ("low-175", "hip-10"), ("a", "hip-10")] {
            let text = shipped::gait_file(like).unwrap().text;
            fs::write(gaits.join(format!("{name}.toml")), text.as_bytes()).unwrap();
        }
        fs::write(gaits.join("notes.txt"), "none").unwrap();
        fs::write(home.path().join("outside.toml"), "none").unwrap();
        let found = Gaits::beside(home.path());
        assert_eq!(found, Gaits::Folder(gaits));
        (home, found)
    }

    #[test]
    fn a_robot_s_own_gaits_go_before_those_that_ship() {
        let (_home, gaits) = folder();
        let own = gaits.find("low-175").unwrap().unwrap();
        assert_eq!(own.text, shipped::gait_file("hip-10").unwrap().text);
        assert!(own.file.ends_with("/gaits/low-175.toml"));
        let shipped = shipped::gait_file("low-165").unwrap();
        assert_eq!(gaits.find("low-165").unwrap().unwrap(), shipped);
        assert_eq!(Gaits::None.find("low-165").unwrap().unwrap(), shipped);
        assert_eq!(gaits.find("gallop").unwrap(), None);
    }

    #[test]
    fn own_gaits_are_listed_by_what_they_are() {
        let (_home, gaits) = folder();
        assert_eq!(gaits.own_pulls().unwrap(), ["ours"]);
        assert_eq!(gaits.own_cycles().unwrap(), ["a", "low-175"]);
        assert!(Gaits::None.own_pulls().unwrap().is_empty());
    }

    #[test]
    fn what_a_user_names_is_found_by_name_or_file() {
        let (home, gaits) = folder();
        let file = home.path().join("gaits/a.toml");
        let file = file.to_str().unwrap();
        let cycle = gaits.of_kind(GaitKind::Cycle, file).unwrap();
        assert_eq!(cycle.text, gaits.named("a").unwrap().text);
        assert_eq!(cycle.kind(), Some(GaitKind::Cycle));
        assert_eq!(gaits.named("ours").unwrap().kind(), Some(GaitKind::Pull));
        // What holds no gait is for the parser to refuse.
        let outside = home.path().join("outside.toml");
        let outside = gaits.of_kind(GaitKind::Pull, outside.to_str().unwrap());
        assert_eq!(outside.unwrap().kind(), None);
    }

    #[test]
    fn a_gait_of_the_other_kind_is_called_so() {
        let (home, gaits) = folder();
        let said = |kind, asked: &str| gaits.of_kind(kind, asked).unwrap_err().to_string();
        assert_eq!(
            said(GaitKind::Cycle, "ours"),
            "ours is a pull alone; a crawl needs a cycle with its way back"
        );
        assert!(said(GaitKind::Pull, "low-175").starts_with("low-175 is a whole cycle; "));
        let pull = home.path().join("gaits/ours.toml");
        let pull = pull.to_str().unwrap();
        assert!(said(GaitKind::Cycle, pull).starts_with(&format!("{pull} is a pull alone; ")));
        // Only names of the kind that is needed are offered.
        let offered = format!(
            "there is no cycle \"low-174\"; did you mean \"low-175\"? `prone list --robot {}` shows all",
            home.path().display()
        );
        assert_eq!(said(GaitKind::Cycle, "low-174"), offered);
        assert!(!said(GaitKind::Pull, "low-174").contains("low-175"));
        // A robot's own are offered too.
        assert!(said(GaitKind::Pull, "our").contains("\"ours\""));
        let names = gaits.names(NameKind::Cycle).unwrap();
        assert_eq!(names.iter().filter(|name| *name == "low-175").count(), 1);
    }

    #[test]
    fn a_name_is_never_a_path() {
        let (home, gaits) = folder();
        for name in ["../outside", "./ours", "", "gaits/../ours", "/etc/passwd"] {
            assert_eq!(gaits.find(name).unwrap(), None, "{name}");
        }
        fs::create_dir(home.path().join("gaits/odd.toml")).unwrap();
        let message = gaits.find("odd").unwrap_err().to_string();
        assert!(
            message.ends_with("odd.toml: it is not a regular file"),
            "{message}"
        );
    }
}
