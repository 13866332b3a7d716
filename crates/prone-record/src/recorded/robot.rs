//! The robot of a record: what an export reads without the tables and without an engine.

use std::path::Path;

use prone_files::compiled_robot::CompiledRobot;

use super::error::text;
use super::model::Model;
use super::{ROBOT_FILE, ReadError, RecordedBody, RecordedShape};
use crate::record_info::RecordInfo;

/// Bodies and shapes of a record's robot.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedModel {
    /// Parents before children; the first one is the root.
    pub bodies: Vec<RecordedBody>,
    /// Shapes, in the order of the engine's model.
    pub shapes: Vec<RecordedShape>,
}

impl RecordedModel {
    /// Reads `model.json` of a record folder.
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let model = Model::read(folder)?;
        Ok(Self {
            bodies: model.bodies(&model.joints())?,
            shapes: model.shapes()?,
        })
    }
}

/// Reads the compiled robot of a record folder, which must be the one that `run` names.
pub fn compiled_robot(folder: &Path, run: &RecordInfo) -> Result<CompiledRobot, ReadError> {
    let file = folder.join(ROBOT_FILE).display().to_string();
    let compiled = CompiledRobot::parse(&file, &text(folder, ROBOT_FILE)?)?;
    if compiled.sources_hash() != run.robot.sha256 {
        return Err(ReadError::Content {
            file,
            problem: format!(
                "it was compiled from files with the hash {}, those of {} have {}",
                compiled.sources_hash(),
                run.robot.name,
                run.robot.sha256
            ),
        });
    }
    Ok(compiled)
}
