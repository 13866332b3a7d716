//! The files of a record folder.

use std::collections::BTreeMap;

use serde_json::json;

use prone::crawl::Stage;
use prone::robot::Robot;
use prone::steering::Bearing;
use prone_sim::crawl::{Crawl, ROW_STEP, Row};
use prone_sim::{LoadedRobot, World};

use super::run::{GaitSource, Subject, record_info};
use super::{frames, model};
use crate::frames::FramesError;
use crate::watch::{Progress, Watch};
use prone_files::compiled_robot::{CompiledRobot, Violation};
use prone_record::crawl_summary::CrawlSummary;
use prone_record::crawl_tables as tables;
use prone_record::crawl_tables::Instant;
use prone_record::output::{Artefacts, RUN_FILE, json as written};
use prone_record::program::Program;
use prone_record::record_info::{CrawlOptions, Options, RecordInfo};
use prone_record::recorded::{CONTACTS_FILE, Command, MODEL_FILE, ROBOT_FILE, ROWS_FILE};
use prone_record::tables::as_written;
use prone_report::figure_list::FigureList;
use prone_report::figures::{self, AngleRecord, AngleRow, FigureError, PNG_SCALE, PublishedRange};

/// Why a record has no files.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// A figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// The frames cannot be made.
    #[error(transparent)]
    Frames(#[from] FramesError),
    /// A table cannot be written.
    #[error("table: {0}")]
    Csv(#[from] csv::Error),
    /// A JSON file cannot be written.
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The compiled robot cannot be written.
    #[error("compiled robot: {0}")]
    Robot(#[from] Violation),
}

/// Everything that was simulated, and under which conditions.
#[derive(Debug, Clone, Copy)]
pub struct Recording<'a> {
    /// The robot.
    pub robot: &'a LoadedRobot,
    /// Where it crawled.
    pub world: &'a World,
    /// With which cycle.
    pub gait: &'a GaitSource,
    /// Under which conditions.
    pub conditions: &'a CrawlOptions,
    /// What was measured, with rows.
    pub crawl: &'a Crawl,
    /// The same in figures.
    pub summary: &'a CrawlSummary,
}

/// Makes every file but `timing.json`; all the same for the same input. Pictures are taken on the
/// current rayon pool. `published` is the range that a joint swept on a robot, rad, where one is
/// published, for the figure of angles.
pub fn files(
    recording: &Recording<'_>,
    program: &Program,
    published: &dyn Fn(&str) -> Option<PublishedRange>,
    watch: &dyn Watch,
) -> Result<Artefacts, RecordError> {
    let Recording {
        world,
        crawl,
        summary,
        ..
    } = *recording;
    let mut artefacts = numbers(recording, Command::Crawl, program)?;
    watch.progress(&Progress::Drawing);
    let mut list = FigureList::default();
    for frames in frames::all(world, &summary.gait, crawl, watch)? {
        list.picture(&mut artefacts, frames.figure, frames.png);
    }
    let drawn = angles(world.robot(), &summary.gait, crawl);
    if let Some(figure) = figures::crawl_angles(&drawn, published)? {
        let png = figure.png(PNG_SCALE)?;
        list.drawing(&mut artefacts, "figures/", figure, png);
    }
    list.finish(&mut artefacts)?;
    Ok(artefacts)
}

/// All files but the figures.
pub fn numbers(
    recording: &Recording<'_>,
    command: Command,
    program: &Program,
) -> Result<Artefacts, RecordError> {
    let Recording {
        robot,
        world,
        gait,
        conditions,
        crawl,
        summary,
    } = *recording;
    let subject = Subject {
        command,
        gait: (&gait.cycle.name, &gait.cycle.description),
        chain: gait
            .cycle
            .pull
            .as_ref()
            .map(|pull| (pull.mapping, pull.arm)),
        file: (&gait.file, &gait.text),
        command_step_s: world.robot().control.command_step,
        rows: crawl.rows.len(),
        row_step_s: ROW_STEP,
        options: Options::Crawl(Box::new(conditions.clone())),
    };
    let start = crawl
        .cycles
        .first()
        .map_or_else(Default::default, |cycle| cycle.from);
    let info = record_info(robot, world, subject, program);
    let instants: Vec<Instant<'_>> = crawl.rows.iter().map(instant).collect();
    let mut artefacts = shown(robot, world, &info, start, &instants)?;
    artefacts.insert("start.json".into(), written(&start_state(world, crawl))?);
    let commands = tables::commands(world.robot(), &crawl.commands)?;
    artefacts.insert("commands.csv".into(), commands);
    artefacts.insert("summary.json".into(), written(summary)?);
    artefacts.insert("cycles.csv".into(), tables::cycles(summary)?);
    artefacts.insert("motors.csv".into(), tables::motors(summary)?);
    artefacts.insert(
        "plate-contacts.csv".into(),
        tables::plate_contacts(summary)?,
    );
    Ok(artefacts)
}

/// State of the robot when the first pull begins, from which a crawl can be simulated again.
fn start_state(world: &World, crawl: &Crawl) -> serde_json::Value {
    let root = crawl.start.ground_from_root();
    let turn = root.rotation();
    let names = || world.robot().joints.iter().map(|joint| &joint.name);
    let by_joint = |values: &[f64]| -> BTreeMap<String, f64> {
        names().cloned().zip(values.iter().copied()).collect()
    };
    let (of_root, of_joints) = crawl.start_speeds.split_at(ROOT_SPEEDS);
    let (linear, angular) = of_root.split_at(ROOT_SPEEDS / 2);
    json!({
        "position_m": root.origin().metres().to_array(),
        "quaternion_wxyz": [turn.w, turn.x, turn.y, turn.z],
        "velocity_m_s": linear,
        "angular_velocity_rad_s": angular,
        "angles_rad": by_joint(crawl.start.joint_angles()),
        "speeds_rad_s": by_joint(of_joints),
    })
}

/// Speeds of the root: three of its place, three of its turn.
const ROOT_SPEEDS: usize = 6;

/// The files that replay and exports need.
pub(super) fn shown(
    robot: &LoadedRobot,
    world: &World,
    info: &RecordInfo,
    start: Bearing,
    instants: &[Instant<'_>],
) -> Result<Artefacts, RecordError> {
    let mut artefacts = Artefacts::new();
    artefacts.insert(RUN_FILE.into(), written(info)?);
    artefacts.insert(MODEL_FILE.into(), written(&model::describe(world))?);
    let rows = tables::rows(world.robot(), start, instants)?;
    artefacts.insert(ROWS_FILE.into(), rows);
    let contacts = tables::contacts(world.robot(), world.obstacles(), instants)?;
    artefacts.insert(CONTACTS_FILE.into(), contacts);
    let compiled = CompiledRobot::new(robot.robot(), robot.files(), prone_sim::engine_version())?;
    artefacts.insert(ROBOT_FILE.into(), compiled.text().into_bytes());
    Ok(artefacts)
}

/// A row as an instant of a record.
fn instant(row: &Row) -> Instant<'_> {
    Instant {
        time: row.time,
        cycle: row.cycle,
        s: match row.stage {
            Stage::Pull { s, .. } => Some(s),
            Stage::Recovery => None,
        },
        command: &row.command,
        angles: &row.angles,
        applied_torque: &row.applied_torque,
        effort: Some(&row.effort),
        contact: row.contact,
        forces: &row.forces,
        ground_from_root: row.ground_from_root,
        tops: row.tops,
    }
}

/// The left chain of a crawl that was simulated with rows, to the digits of `rows.csv`.
fn angles(robot: &Robot, gait: &str, crawl: &Crawl) -> AngleRecord {
    let joints = robot.chain.left.commanded_joints();
    let rows = crawl
        .rows
        .iter()
        .filter(|row| row.cycle < AngleRecord::CYCLES);
    let rows = rows.map(|row| AngleRow {
        time_s: as_written(row.time, 4),
        command_rad: joints
            .map(|joint| as_written(row.command[joint], 6))
            .to_vec(),
        angle_rad: joints
            .map(|joint| as_written(row.angles[joint], 6))
            .to_vec(),
    });
    AngleRecord {
        gait: gait.to_owned(),
        joints: joints
            .map(|joint| robot.joints[joint.0].name.clone())
            .to_vec(),
        rows: rows.collect(),
        cycles: AngleRecord::CYCLES.min(crawl.cycles.len()),
        not_simulated: None,
    }
}
