//! The tables of a record folder as CSV.

use prone::frames::{Ground, Root, Transform};
use prone::robot::{BodyPart, ContactGroup, JointAngles, Robot, Tops};
use prone::scene::{ContactForce, Obstacle, obstacle_name};
use prone::steering::Bearing;

use crate::crawl_summary::CrawlSummary;
use crate::record_info::{Channel, ChannelKind, Part};
use crate::tables::{finish, number};

/// `cycles.csv`.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn cycles(summary: &CrawlSummary) -> Result<Vec<u8>, csv::Error> {
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
pub struct Instant<'a> {
    /// Since the first pull began, s.
    pub time: f64,
    /// From 0.
    pub cycle: usize,
    /// Phase of the pull; nothing in a recovery.
    pub s: Option<f64>,
    /// Commanded joint angles, rad.
    pub command: &'a JointAngles,
    /// Measured joint angles, rad.
    pub angles: &'a JointAngles,
    /// **Actuator torque** of each joint about its axis, mean over the row, N·m.
    pub actuator_torque: &'a [f64],
    /// Normal force of the ground by [`ContactGroup::ALL`], mean over the row, N.
    pub contact: [f64; 4],
    /// What the world does to the robot now, contact by contact.
    pub forces: &'a [ContactForce],
    /// Pose of the root.
    pub ground_from_root: Transform<Ground, Root>,
    /// Highest points.
    pub tops: Tops,
}

/// The channels of [`rows`] and [`contacts`].
pub fn channels(robot: &Robot) -> Vec<Channel> {
    let channel = |table, is, unit: &str, columns: Vec<String>| Channel {
        table,
        columns,
        is,
        unit: unit.to_owned(),
    };
    let named = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    let of_joints = |end: &str| {
        let joints = robot.joints.iter();
        joints.map(|joint| format!("{}{end}", joint.name)).collect()
    };
    let grounds = ContactGroup::ALL.map(|group| format!("{}_n", group.name()));
    let (rows, places) = (Part::Rows, named(&["x_mm", "y_mm", "z_mm"]));
    vec![
        channel(rows, ChannelKind::Instant, "mm", places),
        channel(
            rows,
            ChannelKind::Instant,
            "1",
            named(&["qw", "qx", "qy", "qz"]),
        ),
        channel(rows, ChannelKind::Instant, "°", named(&["yaw_deg"])),
        channel(rows, ChannelKind::Instant, "mm", named(&["lateral_mm"])),
        channel(rows, ChannelKind::Command, "rad", of_joints("_cmd_rad")),
        channel(rows, ChannelKind::Instant, "rad", of_joints("_rad")),
        channel(rows, ChannelKind::Mean, "N·m", of_joints("_nm")),
        channel(rows, ChannelKind::Mean, "N", grounds.to_vec()),
        channel(rows, ChannelKind::Instant, "mm", tops().to_vec()),
        channel(rows, ChannelKind::Instant, "1", named(&["contacts"])),
        channel(
            Part::Contacts,
            ChannelKind::Instant,
            "mm",
            named(&["x_mm", "y_mm", "z_mm"]),
        ),
        channel(
            Part::Contacts,
            ChannelKind::Instant,
            "N",
            named(&["fx_n", "fy_n", "fz_n"]),
        ),
    ]
}

/// `rows.csv`; yaw and what is lateral are seen from `start`.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn rows(
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
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn contacts(
    robot: &Robot,
    obstacles: &[Obstacle],
    instants: &[Instant<'_>],
) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "time_s", "body", "with", "x_mm", "y_mm", "z_mm", "fx_n", "fy_n", "fz_n",
    ])?;
    for row in instants {
        for contact in row.forces {
            let with = contact.obstacle.map_or_else(
                || "floor".to_owned(),
                |index| obstacle_name(obstacles, index),
            );
            let mut cells = vec![
                number(row.time, 4),
                robot.bodies[contact.body.0].name.clone(),
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
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn plate_contacts(summary: &CrawlSummary) -> Result<Vec<u8>, csv::Error> {
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
