//! What made a record, and of which robot.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use prone::robot::Robot;
use prone_files::robot_folder::RobotFiles;

/// Which program made a result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Program {
    /// Its version.
    pub version: Cow<'static, str>,
    /// The commit it was built from, `unknown` outside a checkout.
    pub commit: Cow<'static, str>,
}

/// Which robot it was.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobotInfo {
    /// The manufacturer's name.
    pub name: String,
    /// Of which family it is a version; records of earlier builds do not say.
    #[serde(default)]
    pub family: Option<String>,
    /// Which version of it.
    #[serde(default)]
    pub version: Option<String>,
    /// Its folder, as the user named it.
    pub folder: String,
    /// Of the texts that define it.
    pub sha256: String,
    /// How high it stands, mm, where its manufacturer says so.
    pub standing_height_mm: Option<f64>,
}

impl RobotInfo {
    /// Words for its version, `unknown` where a record does not say.
    pub fn version_name(&self) -> String {
        match (&self.family, &self.version) {
            (Some(family), Some(version)) => format!("{version} of {family}"),
            _ => "unknown".to_owned(),
        }
    }

    /// Of a robot and the files that it was made of.
    pub fn of(robot: &Robot, files: &RobotFiles) -> Self {
        let version = files.version.as_ref();
        Self {
            name: robot.name.clone(),
            family: version.map(|version| version.family.clone()),
            version: version.map(|version| version.version.clone()),
            folder: files.folder.clone(),
            sha256: files.hash(),
            // The digits of robot.toml, which metres do not keep.
            standing_height_mm: robot
                .standing_height
                .map(|metres| (metres * 1e9).round() / 1e6),
        }
    }
}
