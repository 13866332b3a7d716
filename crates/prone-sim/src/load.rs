//! Loading a robot: MJCF and `robot.toml` into [`prone::robot::Robot`].
//!
//! The engine compiles the MJCF, so a model means here what it means there. Bodies, hinges,
//! inertias, shapes and sites come from the model; the chain, drives, contact groups and postures
//! from the TOML file, whose every name must be in the model.

mod model;
mod tables;

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use mujoco_rs::prelude::*;
use sha2::{Digest, Sha256};

use prone::robot::Robot;
use prone_files::FileError;
use prone_files::robot_file::RobotFile;
use prone_files::shipped::RobotSource;

use crate::engine_log::{self, one_line};

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

/// A robot, checked, with the model text that worlds are built from.
#[derive(Debug, Clone)]
pub struct LoadedRobot {
    robot: Arc<Robot>,
    files: RobotFiles,
}

/// Why a robot cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// `robot.toml` is malformed, or names what the model lacks.
    #[error(transparent)]
    Toml(#[from] FileError),
    /// The engine refuses the model; its message carries the line.
    #[error("{file}: {message}")]
    Mjcf {
        /// The model file.
        file: String,
        /// The engine's message.
        message: String,
    },
    /// The model is valid, but not a robot that can crawl here.
    #[error("{file}: {problem}")]
    Model {
        /// The model file.
        file: String,
        /// What is missing or not understood.
        problem: ModelProblem,
    },
}

/// What a valid model lacks to be a crawling robot.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ModelProblem {
    /// There is not exactly one body in the world, or it does not float.
    #[error("the world must hold exactly one body, with a free joint; {found}")]
    Root {
        /// What was found instead.
        found: String,
    },
    /// A body moves by more than one joint, or by one that is no hinge.
    #[error("body {body} must be fixed or move by one hinge")]
    NotHinged {
        /// The body's name.
        body: String,
    },
    /// A hinge without limits.
    #[error("joint {joint} has no range")]
    Unlimited {
        /// The joint's name.
        joint: String,
    },
    /// A body or joint without a name.
    #[error("{kind} number {index} has no name")]
    Nameless {
        /// `body` or `joint`.
        kind: &'static str,
        /// Its index in the model.
        index: usize,
    },
    /// A colliding shape of a kind whose extent is not known.
    #[error("geom {geom}: only spheres, capsules, ellipsoids, cylinders and boxes may collide")]
    Shape {
        /// The geom's name.
        geom: String,
    },
    /// Servos belong to the program.
    #[error("the model has {count} actuators; servos are added by the program, from robot.toml")]
    Actuators {
        /// How many.
        count: i64,
    },
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
        let read = |path: PathBuf| {
            std::fs::read_to_string(&path).map_err(|source| LoadError::Read { path, source })
        };
        let toml_path = folder.join("robot.toml");
        let toml = read(toml_path.clone())?;
        let table = RobotFile::parse(&toml_path.display().to_string(), &toml)?;
        let mjcf = read(folder.join(table.model.get_ref()))?;
        Ok(Self {
            folder: folder.display().to_string(),
            toml,
            mjcf,
        })
    }

    /// SHA-256 of both texts, hexadecimal.
    pub fn hash(&self) -> String {
        let mut hasher = Sha256::new();
        hasher.update(self.toml.as_bytes());
        hasher.update([0]);
        hasher.update(self.mjcf.as_bytes());
        hasher
            .finalize()
            .iter()
            .fold(String::new(), |mut hex, byte| {
                use fmt::Write as _;
                write!(hex, "{byte:02x}").expect("writing to a string does not fail");
                hex
            })
    }

    fn toml_name(&self) -> String {
        format!("{}/robot.toml", self.folder)
    }
}

impl LoadedRobot {
    /// Compiles and checks a robot.
    ///
    /// # Errors
    /// [`LoadError`], naming file, line and the missing or malformed thing.
    pub fn load(files: RobotFiles) -> Result<Self, LoadError> {
        engine_log::silence();
        let toml_name = files.toml_name();
        let table = RobotFile::parse(&toml_name, &files.toml)?;
        let mjcf_name = format!("{}/{}", files.folder, table.model.get_ref());

        let refused = |error: MjEditError| LoadError::Mjcf {
            file: mjcf_name.clone(),
            message: one_line(&error.to_string()),
        };
        let model = MjSpec::from_xml_string(&files.mjcf)
            .and_then(|mut spec| spec.compile())
            .map_err(refused)?;
        let parts = model::read(&model).map_err(|problem| LoadError::Model {
            file: mjcf_name.clone(),
            problem,
        })?;
        let robot = tables::Tables {
            file: &toml_name,
            text: &files.toml,
            mjcf: &mjcf_name,
        }
        .assemble(table, parts)?;
        Ok(Self {
            robot: Arc::new(robot),
            files,
        })
    }

    /// The robot.
    pub const fn robot(&self) -> &Arc<Robot> {
        &self.robot
    }

    /// Where it came from.
    pub const fn files(&self) -> &RobotFiles {
        &self.files
    }

    pub(crate) fn mjcf(&self) -> &str {
        &self.files.mjcf
    }
}
