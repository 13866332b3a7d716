//! The record of one pull in the form of a crawl's, so that it can be replayed and exported.

use serde::Serialize;

use prone::gait::Gait;
use prone::regime::CONTROL_STEP;
use prone::steering::Bearing;
use prone_sim::pull::Pull;
use prone_sim::{LoadedRobot, World};

use super::instants;
use super::record::{RecordError, shown};
use super::run::{RecordInfo, Subject};
use prone_record::crawl_tables::Instant;
use prone_record::output::Artefacts;
use prone_record::program::Program;
use prone_record::recorded::{Command, Extent};

/// A pull of the published study.
pub struct PullRecording<'a> {
    /// With which robot.
    pub robot: &'a LoadedRobot,
    /// Where.
    pub world: &'a World,
    /// Of which gait.
    pub gait: &'a Gait,
    /// The gait's file and its text.
    pub file: (&'a str, &'a str),
    /// How long it lasted, s.
    pub duration_s: f64,
    /// With what is shown of its rows.
    pub pull: &'a Pull,
}

/// What was asked for. The first two are those of a crawl.
#[derive(Debug, Clone, Serialize)]
struct Options<'a> {
    time_scale: f64,
    scene_text: Option<&'a str>,
    duration_s: f64,
    start_posture: &'a str,
}

/// Makes `run.json`, `model.json`, `rows.csv` and `contacts.csv`.
///
/// # Errors
/// [`RecordError`].
pub fn files(recording: &PullRecording<'_>, program: &Program) -> Result<Artefacts, RecordError> {
    let PullRecording {
        robot,
        world,
        gait,
        file,
        duration_s,
        pull,
    } = *recording;
    let options = Options {
        time_scale: 1.0,
        scene_text: None,
        duration_s,
        start_posture: &world.robot().study.start_posture,
    };
    let instants: Vec<Instant<'_>> = pull.rows.iter().filter_map(instants::of_pull).collect();
    let subject = Subject {
        command: Command::ReproducePull,
        gait,
        file,
        command_step_s: CONTROL_STEP,
        extent: Extent {
            rows: instants.len(),
            row_step_s: CONTROL_STEP,
        },
        options: &options,
    };
    let info = RecordInfo::of(robot, world, &subject, program);
    shown(world, &info, Bearing::of_prone(&pull.start), &instants)
}
