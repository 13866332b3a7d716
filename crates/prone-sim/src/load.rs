//! Loading a robot: MJCF and `robot.toml` into [`prone::robot::Robot`].
//!
//! The engine compiles the MJCF, so a model means here what it means there. Bodies, hinges,
//! inertias, shapes and sites come from the model; the chain, drives, contact groups and postures
//! from the TOML file, whose every name must be in the model. What the two say is checked, numbers
//! and the robot's own kinematics included, so that a robot that loads can crawl.

mod bounds;
mod control;
mod foreign;
mod imu;
mod limbs;
mod lookup;
mod model;
mod physics;
mod tables;

pub use prone_files::robot_folder::RobotFiles;

use std::sync::Arc;

use mujoco_rs::prelude::*;

use prone::plausible;
use prone::plausible::symmetry::Asymmetry;
use prone::robot::Robot;
use prone_files::FileError;
use prone_files::model_file::ModelFile;
use prone_files::robot_file::RobotFile;
use prone_files::robot_folder;

use crate::engine_log::{self, one_line};

/// A robot, checked, with the model text that worlds are built from.
#[derive(Debug, Clone)]
pub struct LoadedRobot {
    robot: Arc<Robot>,
    files: RobotFiles,
    model: Arc<ModelFile>,
    asymmetries: Vec<Asymmetry>,
}

/// Why a robot cannot be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// `robot.toml` is malformed, or names what the model lacks, or the model's text holds what is not
    /// read here.
    #[error(transparent)]
    File(#[from] FileError),
    /// The engine refuses the model, or it is valid, but not a robot that can crawl here.
    #[error("{file}: {message}")]
    Model {
        /// The model file.
        file: String,
        /// The engine's message, which carries the line, or what is missing or not understood.
        message: String,
    },
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
        robot_folder::check_model_name(&toml_name, &files.toml, &table.model)?;
        let mjcf_name = format!("{}/{}", files.folder, table.model.get_ref());
        let model = ModelFile::parse(&mjcf_name, &files.mjcf)?;

        let refused = |message| LoadError::Model {
            file: mjcf_name.clone(),
            message,
        };
        let compiled = spec(&model)
            .and_then(|mut spec| spec.compile())
            .map_err(|error| refused(one_line(&error.to_string())))?;
        let parts = model::read(&compiled, &model)?;
        let lookup = lookup::Lookup {
            file: &toml_name,
            text: &files.toml,
            mjcf: &mjcf_name,
        };
        let places = physics::Places::of(&table);
        let robot = lookup.assemble(table, parts)?;
        let asymmetries = plausible::check(&robot)
            .map_err(|error| places.error(&lookup, &model, &robot, &error))?;
        physics::check_engine(&compiled, &model, &robot)?;
        Ok(Self {
            robot: Arc::new(robot),
            files,
            model: Arc::new(model),
            asymmetries,
        })
    }

    /// In what its sides differ, as those of real models do.
    pub fn asymmetries(&self) -> &[Asymmetry] {
        &self.asymmetries
    }

    /// The model, checked, for the engine.
    pub(crate) fn model(&self) -> &ModelFile {
        &self.model
    }

    /// The robot.
    pub const fn robot(&self) -> &Arc<Robot> {
        &self.robot
    }

    /// Where it came from.
    pub const fn files(&self) -> &RobotFiles {
        &self.files
    }
}

/// What the engine makes worlds of. It is given nothing else: of a model, what was checked.
pub(crate) fn spec(model: &ModelFile) -> Result<MjSpec, MjEditError> {
    engine_log::silence();
    MjSpec::from_xml_string(model.text())
}

/// How a refusal calls something of the model: by its name, or by its number where it has none.
fn label(model: &MjModel, kind: MjtObjBase, index: usize) -> String {
    model
        .id_to_name(kind, index)
        .map_or_else(|| format!("number {index}"), str::to_owned)
}
