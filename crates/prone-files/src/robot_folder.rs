//! A robot's folder: the two texts that define the robot, its family and its gaits.
//!
//! A folder with a `robot.toml` is a robot. A folder with a `family.toml` is a family: its robots
//! are the versions in the folders within, and it stands for the one that it calls the default.
//! A version's `robot.toml` names its family, and what versions share lies beside `family.toml`.
//!
//! ```text
//! robots/nao/family.toml       name = "nao", default = "v4", [defaults]
//! robots/nao/gaits/*.toml
//! robots/nao/v4/robot.toml     family = "nao", model = "robot.xml", …
//! robots/nao/v4/robot.xml
//! ```

use std::fs;
use std::path::{Path, PathBuf};

use crate::defaults::{Defaults, DefaultsTable};
use crate::error::Source;
use crate::family_file::FamilyFile;
use crate::gait_text::GaitKind;
use crate::gaits::Gaits;
use crate::names::{NameKind, UnknownName};
use crate::plain_name::is_plain;
use crate::robot_file::{Name, RobotFile};
use crate::shipped::{self, RobotSource};
use crate::text_file::{ReadError, read_named};
use crate::{FileError, text_file};

const ROBOT_FILE: &str = "robot.toml";
const FAMILY_FILE: &str = "family.toml";

/// The texts of a robot, and where they came from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RobotFiles {
    /// The robot's own folder, as shown to a user.
    pub folder: String,
    /// `robot.toml`.
    pub toml: String,
    /// The MJCF model that it names.
    pub mjcf: String,
    /// Which version of which family it is, where it is one.
    pub version: Option<Version>,
    /// The `family.toml` of that family.
    pub family_toml: Option<FamilyText>,
    /// Where its own gaits are.
    pub gaits: Gaits,
    /// The files that were read; of a robot that ships there are none.
    pub read: Vec<PathBuf>,
}

/// Which version of which family a robot is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Version {
    /// The family's name.
    pub family: String,
    /// The version's name, which is that of its folder.
    pub version: String,
}

/// A `family.toml`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FamilyText {
    /// Name of the file, as shown to a user.
    file: String,
    text: String,
    /// The folder that it was read from; `None` of a family that ships.
    folder: Option<PathBuf>,
}

/// Why a robot's folder cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum RobotFolderError {
    /// A file cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// A text is malformed, or names what is not there.
    #[error(transparent)]
    Text(#[from] FileError),
    /// Which robot is meant cannot be said.
    #[error(
        "{folder} has both a {FAMILY_FILE} and a {ROBOT_FILE}: the robots of a family are in folders of their own within it"
    )]
    FamilyAndRobot {
        /// The folder.
        folder: String,
    },
    /// A file was named.
    #[error(
        "{file} is a file, and a robot is a folder with a {ROBOT_FILE} and the MJCF model that it names: {hint}"
    )]
    NotAFolder {
        /// The file.
        file: String,
        /// What to do.
        hint: String,
    },
    /// There is no such robot.
    #[error(transparent)]
    Unknown(#[from] UnknownName),
    /// The folder of a robot that ships was named, and it is not there.
    #[error(
        "there is no folder {folder:?}; that robot is built in, and needs none: its name is {name:?}"
    )]
    BuiltIn {
        /// The folder.
        folder: String,
        /// The robot's name.
        name: String,
    },
}

impl RobotFiles {
    /// A robot that ships with the program.
    pub fn shipped(source: &RobotSource) -> Self {
        let family = shipped::family_of(source);
        Self {
            folder: source.folder.to_owned(),
            toml: source.toml.to_owned(),
            mjcf: source.mjcf.to_owned(),
            version: family.map(|family| Version {
                family: family.name.to_owned(),
                version: source.version.to_owned(),
            }),
            family_toml: family.map(|family| FamilyText {
                file: family.toml_name(),
                text: family.toml.to_owned(),
                folder: None,
            }),
            gaits: family.map_or(Gaits::None, Gaits::Shipped),
            read: Vec::new(),
        }
    }

    /// The robot that a user names: by a folder, as [`RobotFiles::read`] takes it, or by the name of
    /// one that ships, as [`shipped::robot`] takes it. A folder goes first.
    pub fn named(name: &Path) -> Result<Self, RobotFolderError> {
        if name.is_dir() {
            return Self::read(name);
        }
        if name.exists() {
            return Self::of_file(name);
        }
        match name.to_str().and_then(shipped::robot) {
            Some(shipped) => Ok(Self::shipped(shipped?)),
            None => Err(Self::unknown(name)),
        }
    }

    /// The robot that a file belongs to: its `robot.toml` stands for the folder.
    fn of_file(file: &Path) -> Result<Self, RobotFolderError> {
        let folder = match file.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if file.file_name().is_some_and(|name| name == ROBOT_FILE) {
            return Self::read(folder);
        }
        let is_beside = folder.join(ROBOT_FILE).is_file();
        let hint = if is_beside {
            format!("give its folder, {}", folder.display())
        } else if file.extension().is_some_and(|ending| ending == "urdf") {
            "a URDF is not read: MuJoCo's `compile robot.urdf robot.xml` makes the MJCF model of it, and docs/robot.md says what its robot.toml holds".to_owned()
        } else {
            format!("docs/robot.md says what its {ROBOT_FILE} holds")
        };
        let file = file.display().to_string();
        Err(RobotFolderError::NotAFolder { file, hint })
    }

    /// Why nothing is named so.
    fn unknown(named: &Path) -> RobotFolderError {
        let asked = named.display().to_string();
        match shipped::robot_of_folder(named) {
            Some(name) => RobotFolderError::BuiltIn {
                folder: asked,
                name,
            },
            None => UnknownName::new(NameKind::Robot, &asked, shipped::robot_names()).into(),
        }
    }

    /// Reads the robot of a folder, or the default version of a family's folder.
    pub fn read(folder: &Path) -> Result<Self, RobotFolderError> {
        let family_file = folder.join(FAMILY_FILE);
        if !family_file.exists() {
            return Self::read_robot(folder, None);
        }
        if folder.join(ROBOT_FILE).exists() {
            let folder = folder.display().to_string();
            return Err(RobotFolderError::FamilyAndRobot { folder });
        }
        let family = Family::read(folder)?;
        let default = family.table.default.clone();
        Self::read_version(family, &default)
    }

    /// Reads the version that a key of a family's file names.
    fn read_version(family: Family, named: &Name) -> Result<Self, RobotFolderError> {
        let version = family.folder.join(named.get_ref());
        if !version.join(ROBOT_FILE).exists() {
            let message = format!("there is no {}", version.join(ROBOT_FILE).display());
            return Err(family.error(named, &message));
        }
        Self::read_robot(&version, Some(family))
    }

    /// The version of its family whose torques were recorded and published; `None` where the family
    /// names none, and for that version itself.
    ///
    /// # Errors
    /// [`RobotFolderError`] where the family names a version that is not there, or that is malformed.
    pub fn recorded(&self) -> Result<Option<Self>, RobotFolderError> {
        let Some((text, version)) = self.family_toml.as_ref().zip(self.version.as_ref()) else {
            return Ok(None);
        };
        let Some(recorded) = FamilyFile::parse(&text.file, &text.text)?.recorded else {
            return Ok(None);
        };
        if *recorded.get_ref() == version.version {
            return Ok(None);
        }
        if let Some(folder) = &text.folder {
            return Self::read_version(Family::read(folder)?, &recorded).map(Some);
        }
        let name = format!("{}/{}", version.family, recorded.get_ref());
        if let Some(source) = shipped::robot(&name) {
            return Ok(Some(Self::shipped(source?)));
        }
        let source = Source {
            file: &text.file,
            text: &text.text,
        };
        let message = format!("no version {} ships", recorded.get_ref());
        Err(source.error(recorded.span(), message).into())
    }

    /// Reads the robot of a folder; its family, where it is not known, is in the folder around it.
    fn read_robot(folder: &Path, family: Option<Family>) -> Result<Self, RobotFolderError> {
        let toml_path = folder.join(ROBOT_FILE);
        let toml = read_named(&toml_path)?;
        let toml_name = toml_path.display().to_string();
        let table = RobotFile::parse(&toml_name, &toml)?;
        check_model_name(&toml_name, &toml, &table.model)?;
        let mjcf_path = folder.join(table.model.get_ref());
        let mjcf = read_named(&mjcf_path)?;
        let source = Source {
            file: &toml_name,
            text: &toml,
        };
        let mut read = vec![toml_path, mjcf_path];
        let (version, family_toml, gaits) = match table.family {
            Some(name) => {
                let family = match family {
                    Some(family) => family,
                    None => Family::around(folder, &name, source)?,
                };
                read.push(family.folder.join(FAMILY_FILE));
                let gaits = Gaits::beside(&family.folder);
                check_names(&family.table.defaults, family.source(), &gaits)?;
                let version = family.version(folder, &name, source)?;
                (Some(version), Some(family.file), gaits)
            }
            None if family.is_some() => {
                let message = "a version names its family: the key family is missing";
                return Err(source.error(0..0, message).into());
            }
            None => (None, None, Gaits::beside(folder)),
        };
        check_names(&table.defaults, source, &gaits)?;
        Ok(Self {
            folder: folder.display().to_string(),
            toml,
            mjcf,
            version,
            family_toml,
            gaits,
            read,
        })
    }

    /// SHA-256 of the two texts that define the robot, hexadecimal.
    pub fn hash(&self) -> String {
        text_file::sha256(&[&self.toml, &self.mjcf])
    }

    /// Name of `robot.toml`, as shown to a user.
    pub fn toml_name(&self) -> String {
        format!("{}/{ROBOT_FILE}", self.folder)
    }

    /// Which gaits the program uses where a user names none: those of the robot's `robot.toml`, its
    /// family's, and for the rest those of the robot that ships.
    ///
    /// # Errors
    /// [`RobotFolderError`] for texts that are malformed, and gaits that cannot be read.
    pub fn defaults(&self) -> Result<Defaults, RobotFolderError> {
        let own = RobotFile::parse(&self.toml_name(), &self.toml)?.defaults;
        let family = match &self.family_toml {
            Some(family) => FamilyFile::parse(&family.file, &family.text)?.defaults,
            None => DefaultsTable::default(),
        };
        let mut stated = own.over(family);
        if !stated.has_under() {
            stated.try_under(self.gaits.own_cycles()?);
        }
        Ok(shipped::defaults(stated)?)
    }
}

/// A `family.toml` that was read.
struct Family {
    folder: PathBuf,
    file: FamilyText,
    table: FamilyFile,
}

impl Family {
    fn read(folder: &Path) -> Result<Self, RobotFolderError> {
        let path = folder.join(FAMILY_FILE);
        let text = read_named(&path)?;
        let file = path.display().to_string();
        let table = FamilyFile::parse(&file, &text)?;
        let folder = folder.to_owned();
        let file = FamilyText {
            file,
            text,
            folder: Some(folder.clone()),
        };
        Ok(Self {
            folder,
            file,
            table,
        })
    }

    /// The family in the folder around a version's.
    fn around(version: &Path, name: &Name, source: Source<'_>) -> Result<Self, RobotFolderError> {
        let folder = match version.parent() {
            // What ends in a name has its parent in its text; `.` and `..` have not.
            Some(parent) if version.file_name().is_some() => match parent.as_os_str().len() {
                0 => PathBuf::from("."),
                _ => parent.to_owned(),
            },
            _ => version.join(".."),
        };
        let file = folder.join(FAMILY_FILE);
        if !file.exists() {
            let message = format!(
                "there is no {}: a version lies in its family's folder; a robot without a family has no key family",
                file.display()
            );
            return Err(source.error(name.span(), message).into());
        }
        Self::read(&folder)
    }

    fn source(&self) -> Source<'_> {
        Source {
            file: &self.file.file,
            text: &self.file.text,
        }
    }

    fn error(&self, place: &Name, message: &str) -> RobotFolderError {
        self.source().error(place.span(), message).into()
    }

    /// The robot of a folder as a version of this family, which it has to name.
    fn version(
        &self,
        folder: &Path,
        named: &Name,
        source: Source<'_>,
    ) -> Result<Version, RobotFolderError> {
        let family = self.table.name.get_ref();
        if family != named.get_ref() {
            let message = format!(
                "the family of {} is called {family:?}, not {:?}",
                self.file.file,
                named.get_ref()
            );
            return Err(source.error(named.span(), message).into());
        }
        let real = fs::canonicalize(folder).map_err(|source| ReadError {
            path: folder.to_owned(),
            source,
        })?;
        let version = real.file_name().and_then(|name| name.to_str());
        let Some(version) = version.filter(|version| is_plain(version)) else {
            let message = format!(
                "the folder of a version is named by letters, digits, - and _, not {}",
                real.display()
            );
            return Err(source.error(named.span(), message).into());
        };
        Ok(Version {
            family: family.clone(),
            version: version.to_owned(),
        })
    }
}

/// Every gait that a `[defaults]` names is there, and is what it is used as.
fn check_names(
    table: &DefaultsTable,
    source: Source<'_>,
    gaits: &Gaits,
) -> Result<(), RobotFolderError> {
    for (kind, name) in table.names() {
        let is = gaits.find(name.get_ref())?.map(|gait| {
            if gait.is_cycle() {
                GaitKind::Cycle
            } else {
                GaitKind::Pull
            }
        });
        let message = match is {
            Some(is) if is == kind => continue,
            Some(is) => format!(
                "{} is a {}, not a {}",
                name.get_ref(),
                is.name_kind().noun(),
                kind.name_kind().noun()
            ),
            None => {
                // Without its folder: a robot whose file is wrong cannot be listed.
                let known = gaits.names(kind.name_kind())?;
                UnknownName::new(kind.name_kind(), name.get_ref(), known).to_string()
            }
        };
        return Err(source.error(name.span(), message).into());
    }
    Ok(())
}

/// The model lies beside `robot.toml`: a robot is one folder.
///
/// # Errors
/// [`FileError`] for a path.
pub fn check_model_name(file: &str, toml: &str, model: &Name) -> Result<(), FileError> {
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

#[cfg(test)]
mod tests;
