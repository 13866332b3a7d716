//! Robot and scene of a record.

use std::path::Path;

use anyhow::anyhow;

use prone::regime::Regime;
use prone::scene::Scene;
use prone_files::{scene_file, shipped};
use prone_record::recorded::{Recorded, RecordedRun};
use prone_sim::{LoadedRobot, RobotFiles, World};

use crate::Failure;
use crate::args::ExportArgs;

/// The files of the robot that crawled: of --robot, one that ships, or that of the folder in
/// the record. They must be those of the record.
pub(super) fn files(args: &ExportArgs, run: &RecordedRun) -> Result<RobotFiles, Failure> {
    let recorded = &run.robot;
    let mut shipped = shipped::families()
        .flat_map(|family| family.versions)
        .map(RobotFiles::shipped);
    let files = match &args.robot {
        Some(name) => RobotFiles::named(name).map_err(Failure::input)?,
        None => match shipped.find(|robot| robot.hash() == recorded.sha256) {
            Some(robot) => robot,
            None => RobotFiles::read(Path::new(&recorded.folder)).map_err(|error| {
                Failure::Input(anyhow!(
                    "{error}; --robot says where the robot of this run is"
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
pub(super) fn robot(args: &ExportArgs, run: &RecordedRun) -> Result<LoadedRobot, Failure> {
    LoadedRobot::load(files(args, run)?).map_err(Failure::input)
}

/// Robot and scene, to be looked at.
pub(super) fn world(robot: &LoadedRobot, record: &Recorded) -> Result<World, Failure> {
    let run = &record.run;
    let scene = match (&run.options.scene_text, record.plate) {
        (Some(text), _) => scene_file::parse(&run.scene.name, text).map_err(Failure::input)?,
        (None, Some((height, length))) => Scene::under_plate(height, length),
        (None, None) => Scene::level(),
    };
    // Pictures do not depend on the regime.
    World::in_scene(robot, Regime::LOCOMOTION, &scene).map_err(Failure::input)
}
