//! The record of one pull in the form of a crawl's, so that it can be replayed and exported.

use prone::gait::Gait;
use prone::regime::CONTROL_STEP;
use prone::steering::Bearing;
use prone_sim::pull::{Pull, Row};
use prone_sim::{LoadedRobot, World};

use super::record::{RecordError, shown};
use super::run::{Subject, record_info};
use prone_record::crawl_tables::Instant;
use prone_record::output::Artefacts;
use prone_record::program::Program;
use prone_record::record_info::{Options, PullOptions};
use prone_record::recorded::Command;

/// A pull that was simulated, and under which conditions.
pub struct PullRecording<'a> {
    /// What made it: a pull by itself, or one of the published study.
    pub command: Command,
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
    /// In which posture it began, in words or by its name among the robot's postures.
    pub start_posture: &'a str,
    /// With what is shown of its rows.
    pub pull: &'a Pull,
}

/// Makes `run.json`, `model.json`, `rows.csv`, `contacts.csv` and `robot.compiled.json`.
pub fn files(recording: &PullRecording<'_>, program: &Program) -> Result<Artefacts, RecordError> {
    let (robot, world, pull) = (recording.robot, recording.world, recording.pull);
    let options = PullOptions {
        time_scale: Some(1.0),
        scene_text: None,
        duration_s: recording.duration_s,
        start_posture: Some(recording.start_posture.to_owned()),
    };
    let instants: Vec<Instant<'_>> = pull.rows.iter().filter_map(instant).collect();
    let subject = Subject {
        command: recording.command,
        gait: (&recording.gait.name, &recording.gait.description),
        chain: Some((recording.gait.mapping, recording.gait.arm)),
        file: recording.file,
        command_step_s: CONTROL_STEP,
        rows: instants.len(),
        row_step_s: CONTROL_STEP,
        options: Options::Pull(options),
    };
    let info = record_info(robot, world, subject, program);
    let start = Bearing::of_prone(&pull.start);
    shown(robot, world, &info, start, &instants)
}

/// A row as an instant of a record, where what is shown was kept.
fn instant(row: &Row) -> Option<Instant<'_>> {
    let shown = row.shown.as_ref()?;
    Some(Instant {
        time: row.time,
        cycle: 0,
        s: Some(shown.s),
        command: &row.command,
        angles: &row.angles,
        applied_torque: &row.applied_torque,
        effort: Some(&row.effort),
        contact: row.contact,
        forces: &row.forces,
        ground_from_root: row.ground_from_root,
        tops: shown.tops,
    })
}
