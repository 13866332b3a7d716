//! Robot and scene of a record.

use std::path::Path;

use anyhow::anyhow;

use prone::regime::Regime;
use prone::robot::Robot;
use prone::scene::Scene;
use prone_files::{scene_file, shipped};
use prone_record::record_info::RecordInfo;
use prone_record::recorded::{Recorded, compiled_robot};
use prone_sim::{LoadedRobot, RobotFiles, World};

use crate::Failure;
use crate::args::ExportArgs;

/// The files of the robot that crawled: of --robot, one that ships, or that of the folder in
/// the record. They must be those of the record.
pub(super) fn files(args: &ExportArgs, run: &RecordInfo) -> Result<RobotFiles, Failure> {
    let recorded = &run.robot;
    let mut shipped = shipped::families()
        .flat_map(|family| family.versions)
        .map(RobotFiles::shipped);
    let files = match &args.robot {
        Some(name) => RobotFiles::named(name).map_err(Failure::input)?,
        None => match shipped.find(|robot| robot.hash() == recorded.sha256) {
            Some(robot) => robot,
            // What a record names may be anybody's folder: nothing is said of what is in it, and nothing is
            // done with it but to compare its hash, unless it is the robot of the record.
            None => RobotFiles::read(Path::new(&recorded.folder))
                .ok()
                .filter(|files| files.hash() == recorded.sha256)
                .ok_or_else(|| {
                    Failure::Input(anyhow!(
                        "the robot of this run ({}) is not in {}, or was changed since; --robot says where it is",
                        recorded.name,
                        recorded.folder
                    ))
                })?,
        },
    };
    if files.hash() != recorded.sha256 {
        return Err(Failure::Input(anyhow!(
            "the files of {} are not those of the run's robot ({}): it was changed since, or --robot \
             names another one",
            files.folder,
            recorded.name
        )));
    }
    Ok(files)
}

/// The robot of these files.
pub(super) fn robot(args: &ExportArgs, run: &RecordInfo) -> Result<LoadedRobot, Failure> {
    LoadedRobot::load(files(args, run)?).map_err(Failure::input)
}

/// The robot as it was compiled: of the record, or of --robot, whose files must be those of the
/// record.
pub(super) fn recorded_robot(args: &ExportArgs, run: &RecordInfo) -> Result<Robot, Failure> {
    if args.robot.is_some() {
        return Ok(robot(args, run)?.robot().as_ref().clone());
    }
    let compiled = compiled_robot(&args.run, run).map_err(Failure::input)?;
    Ok(compiled.into_robot())
}

/// Robot and scene, to be looked at.
pub(super) fn world(robot: &LoadedRobot, record: &Recorded) -> Result<World, Failure> {
    let run = &record.run;
    let scene = match (run.options.scene_text(), record.plate) {
        (Some(text), _) => scene_file::parse(&run.scene.name, text).map_err(Failure::input)?,
        (None, Some((height, length))) => Scene::under_plate(height, length),
        (None, None) => Scene::level(),
    };
    // Pictures do not depend on the regime.
    World::in_scene(robot, Regime::LOCOMOTION, &scene).map_err(Failure::input)
}
