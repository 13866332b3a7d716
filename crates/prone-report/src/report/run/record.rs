//! Reading the records of crawls and pulls.

use std::collections::BTreeMap;

use maud::Markup;

use super::{Content, Fact, Run, entries, robot_facts};
use crate::figures::{AngleRecord, AngleRow, PublishedRange, crawl_angles};
use crate::report::ReportError;
use crate::report::folder::{Folder, Given};
use crate::view;
use prone_record::crawl_summary::CrawlSummary;
use prone_record::figure_entry::FIGURES_FILE;
use prone_record::origin::Origin;
use prone_record::record_info::{Kind, RecordInfo};
use prone_record::recorded::{Command, Recorded, compiled_robot};

/// Figures of a crawl, in its record folder.
const SUMMARY_FILE: &str = "summary.json";

/// What a crawl or a pull left behind.
pub(in crate::report) struct Record {
    pub(in crate::report) info: RecordInfo,
    /// Figures of a crawl; only simulations are sure to have them.
    pub(in crate::report) summary: Option<CrawlSummary>,
    /// For the page's replay.
    pub(in crate::report) replay: view::record::Run,
}

impl Record {
    /// Its place among the replays: those that the user named come first, then pulls, which are one
    /// gait beside the other.
    pub(in crate::report) fn replay_place(&self, given: Given) -> u8 {
        match (given, self.info.kind()) {
            (Given::Named, _) => 0,
            (Given::Within, Kind::Pull) => 1,
            (Given::Within, Kind::Crawl | Kind::Driven) => 2,
        }
    }
}

/// Reads a record. Whatever drove a robot may not know its chain, nor have summed anything up; a
/// simulation has. `joint_range` is the published range of a joint.
pub(in crate::report) fn read(
    folder: Folder,
    joint_range: &dyn Fn(&str) -> Option<PublishedRange>,
) -> Result<Run, ReportError> {
    let record = Recorded::read(&folder.path)?;
    let replay = view::record::from_record(&record);
    let named = |sentences: &[String]| -> Vec<String> {
        let named = sentences.iter();
        named
            .map(|sentence| format!("{}/{sentence}", folder.name))
            .collect()
    };
    let shortfalls = named(replay.shortfalls());
    let mut unrecorded = named(replay.gaps());
    let simulated = matches!(record.run.origin, Origin::Simulated(_));
    let has = |file: &str| simulated || folder.path.join(file).exists();
    let command = record.run.head.command;
    let (mut summary, mut drawing) = (None, None);
    if record.run.kind() != Kind::Pull {
        if has(SUMMARY_FILE) {
            summary = Some(folder.json(SUMMARY_FILE)?);
        } else {
            let none = format!("no {SUMMARY_FILE}: there is no report card");
            unrecorded.extend(named(&[none]));
        }
        let angles = angles(&record, &chain(&folder, &record.run)?);
        let figure = crawl_angles(&angles, joint_range);
        drawing = folder.drawn(figure)?;
    }
    // The crawl of a reproduction has its pictures beside those of the pulls.
    let recorded = if command == Command::Crawl && has(FIGURES_FILE) {
        folder.figures()?
    } else {
        Vec::new()
    };
    let (robot, facts) = (record.run.robot.name.clone(), facts(&record.run));
    let record = Record {
        info: record.run,
        summary,
        replay,
    };
    let mut run = Run::new(folder, Content::Record(Box::new(record)));
    run.drawings.extend(drawing);
    run.recorded = recorded;
    run.shortfalls = shortfalls;
    run.unrecorded = unrecorded;
    run.robot = Some(robot);
    run.facts = facts;
    Ok(run)
}

/// The joints of the left chain, from toe to elbow, then those that point the arm.
fn chain(folder: &Folder, info: &RecordInfo) -> Result<Vec<String>, ReportError> {
    match compiled_robot(&folder.path, info) {
        Ok(compiled) => {
            let robot = compiled.robot();
            let joints = robot.chain.left.commanded_joints();
            Ok(joints
                .map(|joint| robot.joints[joint.0].name.clone())
                .to_vec())
        }
        Err(error) if matches!(info.origin, Origin::Simulated(_)) => Err(error.into()),
        Err(_) => Ok(Vec::new()),
    }
}

/// The first cycles of the joints of a chain whose angles and commands are known all along.
fn angles(record: &Recorded, chain: &[String]) -> AngleRecord {
    let rows = || {
        let rows = record.rows.iter();
        rows.filter(|row| row.cycle <= AngleRecord::CYCLES)
    };
    let known = |place: &usize| {
        rows().all(|row| {
            let pair = [&row.command, &row.angles].map(|angles| angles.as_slice()[*place]);
            pair.iter().all(|angle| !angle.is_nan())
        })
    };
    let place = |joint: &String| record.joints.iter().position(|known| known == joint);
    let places: Vec<usize> = chain.iter().filter_map(place).filter(known).collect();
    let pick = |angles: &[f64]| places.iter().map(|&place| angles[place]).collect();
    let rows = rows().map(|row| AngleRow {
        time_s: row.time_s,
        command_rad: pick(row.command.as_slice()),
        angle_rad: pick(row.angles.as_slice()),
    });
    let joints = places.iter().map(|&place| &record.joints[place]);
    let last = record.rows.last().map_or(0, |row| row.cycle);
    AngleRecord {
        gait: record.run.gait.name.clone(),
        joints: joints.cloned().collect(),
        // A figure without a panel is none.
        rows: if places.is_empty() {
            Vec::new()
        } else {
            rows.collect()
        },
        cycles: AngleRecord::CYCLES.min(last),
        not_simulated: view::record::not_simulated(&record.run.origin),
    }
}

/// The conditions of a record that are worth reading; what it does not say is `unknown`.
fn facts(info: &RecordInfo) -> Markup {
    let unknown = || "unknown".to_owned();
    let word = |word: &Option<String>| word.clone().unwrap_or_else(unknown);
    let figure = |number: Option<f64>| number.map_or_else(unknown, |number| format!("{number:?}"));
    let RecordInfo { gait, scene, .. } = info;
    let mut facts = vec![
        ("gait", gait.name.clone()),
        ("about it", word(&gait.description)),
        ("its file", word(&gait.file)),
        ("mapping", word(&gait.mapping)),
        ("arms", word(&gait.arm)),
        ("scene", scene.name.clone()),
        ("friction, left", figure(scene.friction_left)),
        ("friction, right", figure(scene.friction_right)),
        ("slope, °", figure(scene.slope_deg)),
    ];
    facts.extend(origin_facts(&info.origin));
    if let Some(options) = info.options.crawl() {
        facts.extend([
            ("steering", word(&options.steering)),
            ("joints off by up to, °", figure(options.joint_offset_deg)),
        ]);
        let imperfect = [
            ("masses times", options.mass_factor),
            ("stiffness of servos times", options.stiffness_factor),
            ("play of gears, °", options.backlash_deg),
            ("commands late by up to, ms", options.late_commands_ms),
        ];
        let imperfect = imperfect.into_iter();
        facts.extend(imperfect.filter_map(|(name, it)| Some((name, format!("{:?}", it?)))));
    }
    facts.push(("time scale", figure(info.options.time_scale())));
    let seed = info.options.crawl().and_then(|options| options.seed);
    facts.extend(seed.map(|seed| ("seed of joint errors", seed.to_string())));
    facts.extend(robot_facts(&info.robot));
    entries(&facts)
}

fn origin_facts(origin: &Origin) -> Vec<Fact> {
    let list = |entries: &BTreeMap<String, String>| {
        let entries = entries.iter();
        let entries = entries.map(|(name, value)| format!("{name} {value}"));
        entries.collect::<Vec<_>>().join(", ")
    };
    match origin {
        Origin::Simulated(simulated) => vec![
            ("contact regime", simulated.regime.name.clone()),
            ("torque limit", simulated.regime.effort_limit.clone()),
            (
                "time step, s",
                format!("{:?}", simulated.regime.time_step_s),
            ),
            (
                "integrator, solver, cone",
                [&*simulated.integrator, &simulated.solver, &simulated.cone].join(", "),
            ),
        ],
        Origin::Robot(robot) => vec![
            ("recorded on the robot", robot.host.clone()),
            ("its software", list(&robot.versions)),
            ("settings", list(&robot.settings)),
        ],
        Origin::Imported(imported) => vec![("imported from", imported.from.clone())],
    }
}
