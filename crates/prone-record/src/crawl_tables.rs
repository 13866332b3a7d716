//! The tables of a record folder as CSV.

use prone::crawl::Stage;
use prone::frames::{Ground, Root, Transform};
use prone::robot::{BodyPart, ContactGroup, JointAngles, Robot, Tops};
use prone::steering::Bearing;
use prone_sim::crawl::Row;
use prone_sim::{ContactForce, World, pull};

use super::obstacle_name;
use super::summary::CrawlSummary;
use crate::tables::{finish, number};

/// `cycles.csv`.
pub(super) fn cycles(summary: &CrawlSummary) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = [
        "cycle",
        "begin_s",
        "time_s",
        "turn_command_deg",
        "advance_mm",
        "left_mm",
        "yaw_deg",
        "x_mm",
        "y_mm",
    ]
    .map(String::from)
    .to_vec();
    header.extend(tops());
    let last = [
        "heat_s",
        "work_j",
        "body_share",
        "pull_advance_mm",
        "recovery_body_share",
    ];
    header.extend(last.map(String::from));
    table.write_record(&header)?;
    for row in &summary.per_cycle {
        let mut cells = vec![row.cycle.to_string()];
        let figures = [
            row.begin_s,
            row.time_s,
            row.turn_command_deg,
            row.advance_mm,
            row.left_mm,
            row.yaw_deg,
            row.x_mm,
            row.y_mm,
        ];
        let figures = figures.into_iter().chain(row.top_mm.to_array());
        cells.extend(figures.map(|figure| number(figure, 3)));
        let last = [
            row.heat_s,
            row.work_j,
            row.body_share,
            row.pull_advance_mm,
            row.recovery_body_share,
        ];
        cells.extend(last.map(|figure| number(figure, 5)));
        table.write_record(&cells)?;
    }
    finish(table)
}

/// One instant of a crawl or a pull.
pub(super) struct Instant<'a> {
    time: f64,
    cycle: usize,
    /// Phase of the pull; nothing in a recovery.
    s: Option<f64>,
    command: &'a JointAngles,
    angles: &'a JointAngles,
    actuator_torque: &'a [f64],
    contact: [f64; 4],
    forces: &'a [ContactForce],
    ground_from_root: Transform<Ground, Root>,
    tops: Tops,
}

impl<'a> Instant<'a> {
    /// Of a crawl.
    pub(super) fn of(row: &'a Row) -> Self {
        Self {
            time: row.time,
            cycle: row.cycle,
            s: match row.stage {
                Stage::Pull { s, .. } => Some(s),
                Stage::Recovery => None,
            },
            command: &row.command,
            angles: &row.angles,
            actuator_torque: &row.actuator_torque,
            contact: row.contact,
            forces: &row.forces,
            ground_from_root: row.ground_from_root,
            tops: row.tops,
        }
    }

    /// Of a pull, where what is shown was kept.
    pub(super) fn of_pull(row: &'a pull::Row) -> Option<Self> {
        let shown = row.shown.as_ref()?;
        Some(Self {
            time: row.time,
            cycle: 0,
            s: Some(shown.s),
            command: &row.command,
            angles: &row.angles,
            actuator_torque: &row.actuator_torque,
            contact: row.contact,
            forces: &shown.forces,
            ground_from_root: row.ground_from_root,
            tops: shown.tops,
        })
    }
}

/// `rows.csv`; yaw and what is lateral are seen from `start`.
pub(super) fn rows(
    robot: &Robot,
    start: Bearing,
    instants: &[Instant<'_>],
) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = [
        "time_s",
        "cycle",
        "stage",
        "s",
        "x_mm",
        "y_mm",
        "z_mm",
        "qw",
        "qx",
        "qy",
        "qz",
        "yaw_deg",
        "lateral_mm",
    ]
    .map(String::from)
    .to_vec();
    for joint in &robot.joints {
        let name = &joint.name;
        header.extend([
            format!("{name}_cmd_rad"),
            format!("{name}_rad"),
            format!("{name}_nm"),
        ]);
    }
    header.extend(ContactGroup::ALL.map(|group| format!("{}_n", group.name())));
    header.extend(tops());
    // By which a reader knows whether contacts.csv is whole.
    header.push("contacts".to_owned());
    table.write_record(&header)?;
    let (sin, cos) = start.yaw.sin_cos();
    for row in instants {
        let (stage, s) = match row.s {
            Some(s) => ("pull", number(s, 4)),
            None => ("recovery", String::new()),
        };
        let root = row.ground_from_root;
        let (at, turn) = (root.origin().metres(), root.rotation());
        let mut cells = vec![
            number(row.time, 4),
            (row.cycle + 1).to_string(),
            stage.to_owned(),
            s,
        ];
        cells.extend(at.to_array().map(|metres| number(metres * 1e3, 3)));
        cells.extend([turn.w, turn.x, turn.y, turn.z].map(|part| number(part, 7)));
        let (dx, dy) = (at.x - start.x, at.y - start.y);
        cells.push(number(Bearing::of_prone(&root).yaw.to_degrees(), 4));
        cells.push(number((cos * dy - sin * dx) * 1e3, 3));
        let angles = row.command.pairs(row.angles);
        for ((command, angle), torque) in angles.zip(row.actuator_torque) {
            cells.extend([number(command, 6), number(angle, 6), number(*torque, 5)]);
        }
        cells.extend(row.contact.map(|force| number(force, 4)));
        cells.extend(row.tops.0.map(|top| number(top * 1e3, 3)));
        cells.push(row.forces.len().to_string());
        table.write_record(&cells)?;
    }
    finish(table)
}

fn tops() -> [String; 5] {
    BodyPart::ALL.map(|part| format!("{}_top_mm", part.name()))
}

/// `contacts.csv`.
pub(super) fn contacts(world: &World, instants: &[Instant<'_>]) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "time_s", "body", "with", "x_mm", "y_mm", "z_mm", "fx_n", "fy_n", "fz_n",
    ])?;
    for row in instants {
        for contact in row.forces {
            let with = contact.obstacle.map_or_else(
                || "floor".to_owned(),
                |index| obstacle_name(world.obstacles(), index),
            );
            let mut cells = vec![
                number(row.time, 4),
                world.robot().bodies[contact.body.0].name.clone(),
                with,
            ];
            cells.extend(
                contact
                    .at
                    .metres()
                    .to_array()
                    .map(|metres| number(metres * 1e3, 3)),
            );
            cells.extend(contact.force.to_array().map(|force| number(force, 4)));
            table.write_record(&cells)?;
        }
    }
    finish(table)
}

/// `plate-contacts.csv`.
pub(super) fn plate_contacts(summary: &CrawlSummary) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(["body", "obstacle", "count", "first_s", "seconds", "peak_n"])?;
    for contact in &summary.contacts {
        table.write_record([
            contact.body.clone(),
            contact.obstacle.clone(),
            contact.count.to_string(),
            number(contact.first_s, 4),
            number(contact.seconds, 4),
            number(contact.peak_n, 3),
        ])?;
    }
    finish(table)
}
