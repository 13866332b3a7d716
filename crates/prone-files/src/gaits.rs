//! Gaits by name: a robot's own go before those that ship with the program.
//!
//! The gaits of a robot are files `<name>.toml` in the folder `gaits` of its family, or of a robot
//! without one. A file is looked at when its name is asked for, so that one which is broken is in
//! nobody's way.

use std::fs;
use std::path::{Path, PathBuf};

use crate::gait_text::GaitText;
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
