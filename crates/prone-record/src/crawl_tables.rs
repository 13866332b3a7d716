//! The tables of a record folder as CSV.

use prone::frames::{Ground, Root, Transform};
use prone::motor::Effort;
use prone::robot::{ContactGroup, JointAngles, Robot, Tops};
use prone::scene::{ContactForce, Obstacle, obstacle_name};
use prone::steering::Bearing;

use crate::crawl_summary::{CrawlSummary, CycleSummary, MotorSummary};
use crate::record_columns::{
    ANGLE_END, COMMAND_END, CONTACTS, FORCE, HEAT_END, LATERAL, PLACE, STAGES, TIME, TORQUE_END,
    TURN, WORK_END, YAW, grounds, labels, tops,
};
use crate::record_info::Part;
use crate::tables::{file, maybe, number};

/// A figure of a cycle: its column, and where it stands.
type Figure = (&'static str, fn(&CycleSummary) -> f64);

/// A figure of a cycle that may not be known.
type KnownFigure = (&'static str, fn(&CycleSummary) -> Option<f64>);

/// A figure of a motor that may not be known.
type MotorFigure = (&'static str, fn(&MotorSummary) -> Option<f64>);

/// Figures of a cycle before its highest points, with three decimals.
const FIRST: [Figure; 9] = [
    ("begin_s", |cycle| cycle.begin_s),
    ("time_s", |cycle| cycle.time_s),
    ("turn_command_deg", |cycle| cycle.turn_command_deg),
    ("shift_command_deg", |cycle| cycle.shift_command_deg),
    ("advance_mm", |cycle| cycle.advance_mm),
    ("left_mm", |cycle| cycle.left_mm),
    ("yaw_deg", |cycle| cycle.yaw_deg),
    ("x_mm", |cycle| cycle.x_mm),
    ("y_mm", |cycle| cycle.y_mm),
];

/// Figures of a cycle after its highest points, with five decimals.
const LAST: [KnownFigure; 7] = [
    ("heat_s", |cycle| cycle.heat_s),
    ("work_j", |cycle| Some(cycle.work_j)),
    ("body_share", |cycle| Some(cycle.body_share)),
    ("pull_advance_mm", |cycle| Some(cycle.pull_advance_mm)),
    ("recovery_body_share", |cycle| {
        Some(cycle.recovery_body_share)
    }),
    ("head_peak_n", |cycle| Some(cycle.ground.head.peak_n)),
    ("hand_peak_n", |cycle| Some(cycle.ground.hand.peak_n)),
];

/// Figures of a motor over a cycle.
const MOTOR: [MotorFigure; 12] = [
    ("heat_s", |it| it.heat_s),
    ("heat_per_second", |it| it.heat_per_second),
    ("heat_per_metre_s", |it| it.heat_per_metre_s),
    ("rms_nm", |it| Some(it.rms_nm)),
    ("rms_over_nominal", |it| it.rms_over_nominal),
    ("peak_nm", |it| Some(it.peak_nm)),
    ("voltage_clipped_share", |it| it.voltage_clipped_share),
    ("saturated_share", |it| Some(it.saturated_share)),
    ("planned_speed_over_no_load", |it| {
        it.planned_speed_over_no_load
    }),
    ("largest_lag_deg", |it| Some(it.largest_lag_deg)),
    ("work_j", |it| Some(it.work_j)),
    ("winding_loss_j", |it| it.winding_loss_j),
];

/// `cycles.csv`.
pub fn cycles(summary: &CrawlSummary) -> Result<Vec<u8>, csv::Error> {
    let mut header = vec!["cycle".to_owned()];
    header.extend(FIRST.map(|(name, _)| name.to_owned()));
    header.extend(tops());
    header.extend(LAST.map(|(name, _)| name.to_owned()));
    let rows = summary.per_cycle.iter().map(|cycle| {
        let mut cells = vec![cycle.cycle.to_string()];
        cells.extend(FIRST.map(|(_, figure)| number(figure(cycle), 3)));
        cells.extend(cycle.top_mm.to_array().map(|top| number(top, 3)));
        cells.extend(LAST.map(|(_, figure)| maybe(figure(cycle), 5)));
        cells
    });
    file(header, rows)
}

/// `motors.csv`: what each motor did in each cycle.
pub fn motors(summary: &CrawlSummary) -> Result<Vec<u8>, csv::Error> {
    let mut header = vec!["cycle".to_owned(), "joint".to_owned()];
    header.extend(MOTOR.map(|(name, _)| name.to_owned()));
    let rows = summary.per_cycle.iter().flat_map(|cycle| {
        cycle.joints.iter().map(|motor| {
            let mut cells = vec![cycle.cycle.to_string(), motor.joint.clone()];
            cells.extend(MOTOR.map(|(_, figure)| maybe(figure(motor), 6)));
            cells
        })
    });
    file(header, rows)
}

/// A row of a crawl or a pull.
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
    /// **Applied torque** of each joint's motor about the joint's axis, mean over the row, N·m.
    pub applied_torque: &'a [f64],
    /// What the motors did over the row, where that is known.
    pub effort: Option<&'a Effort>,
    /// Normal force of the ground by [`ContactGroup::ALL`], mean over the row, N.
    pub contact: [f64; ContactGroup::COUNT],
    /// What the world does to each body that it touches, mean over the row.
    pub forces: &'a [ContactForce],
    /// Pose of the root.
    pub ground_from_root: Transform<Ground, Root>,
    /// Highest points.
    pub tops: Tops,
}

/// `rows.csv`; yaw and what is lateral are seen from `start`.
pub fn rows(
    robot: &Robot,
    start: Bearing,
    instants: &[Instant<'_>],
) -> Result<Vec<u8>, csv::Error> {
    let first = labels(Part::Rows).iter().chain(&PLACE).chain(&TURN);
    let first = first.chain(&[YAW, LATERAL]);
    let mut header: Vec<String> = first.map(|&name| name.to_owned()).collect();
    for joint in &robot.joints {
        header
            .extend([COMMAND_END, ANGLE_END, TORQUE_END].map(|end| format!("{}{end}", joint.name)));
    }
    for end in [HEAT_END, WORK_END] {
        header.extend(
            robot
                .joints
                .iter()
                .map(|joint| format!("{}{end}", joint.name)),
        );
    }
    header.extend(grounds());
    header.extend(tops());
    header.push(CONTACTS.to_owned());
    let (sin, cos) = start.yaw.sin_cos();
    let rows = instants.iter().map(|row| {
        let [pull, recovery] = STAGES;
        let root = row.ground_from_root;
        let (at, turn) = (root.origin().metres(), root.rotation());
        let mut cells = vec![
            number(row.time, 4),
            (row.cycle + 1).to_string(),
            row.s.map_or(recovery, |_| pull).to_owned(),
            row.s.map_or_else(String::new, |s| number(s, 4)),
        ];
        cells.extend(at.to_array().map(|metres| number(metres * 1e3, 3)));
        cells.extend([turn.w, turn.x, turn.y, turn.z].map(|part| number(part, 7)));
        let (dx, dy) = (at.x - start.x, at.y - start.y);
        cells.push(number(Bearing::of_prone(&root).yaw.to_degrees(), 4));
        cells.push(number((cos * dy - sin * dx) * 1e3, 3));
        let angles = row.command.pairs(row.angles);
        for ((command, angle), torque) in angles.zip(row.applied_torque) {
            cells.extend([number(command, 6), number(angle, 6), number(*torque, 5)]);
        }
        let (heat, work) = heat_and_work(robot, row.effort);
        cells.extend(heat.into_iter().map(|it| maybe(it, 8)));
        cells.extend(work.into_iter().map(|it| maybe(it, 8)));
        cells.extend(row.contact.map(|force| number(force, 4)));
        cells.extend(row.tops.0.map(|top| number(top * 1e3, 3)));
        cells.push(row.forces.len().to_string());
        cells
    });
    file(header, rows)
}

/// Heat, s, and positive work, J, by joint; joints that share a motor have even shares. Nothing of
/// what is not known.
fn heat_and_work(robot: &Robot, effort: Option<&Effort>) -> (Vec<Option<f64>>, Vec<Option<f64>>) {
    let mut heat = vec![None; robot.joints.len()];
    let mut work = heat.clone();
    let Some(effort) = effort else {
        return (heat, work);
    };
    for (drive, motor) in robot.drives().iter().zip(&effort.motors) {
        let used = motor.motor_use(robot, drive, effort.seconds, 1.0);
        for joint in &drive.joints {
            heat[joint.0] = used.as_ref().ok().map(|it| it.heat / drive.sharers());
            work[joint.0] = Some(motor.work / drive.sharers());
        }
    }
    (heat, work)
}

/// `commands.csv`: what the joints were sent, offsets apart, and when it reached them, s.
pub fn commands(robot: &Robot, commands: &[(f64, JointAngles)]) -> Result<Vec<u8>, csv::Error> {
    let names = robot.joints.iter();
    let columns = names.map(|joint| format!("{}{COMMAND_END}", joint.name));
    let header = std::iter::once(TIME.to_owned()).chain(columns);
    let rows = commands.iter().map(|(time, command)| {
        let angles = command.as_slice().iter().map(|angle| number(*angle, 6));
        let mut cells = vec![number(*time, 5)];
        cells.extend(angles);
        cells
    });
    file(header, rows)
}

/// `contacts.csv`.
pub fn contacts(
    robot: &Robot,
    obstacles: &[Obstacle],
    instants: &[Instant<'_>],
) -> Result<Vec<u8>, csv::Error> {
    let header = labels(Part::Contacts).iter().chain(&PLACE).chain(&FORCE);
    let contacts = instants.iter().flat_map(|row| {
        let contacts = row.forces.iter();
        contacts.map(|contact| (row.time, contact))
    });
    let rows = contacts.map(|(time, contact)| {
        let floor = || "floor".to_owned();
        let obstacle = |index| obstacle_name(obstacles, index);
        let mut cells = vec![
            number(time, 4),
            robot.bodies[contact.body.0].name.clone(),
            contact.obstacle.map_or_else(floor, obstacle),
        ];
        let at = contact.at.metres().to_array();
        cells.extend(at.map(|metres| number(metres * 1e3, 3)));
        cells.extend(contact.force.to_array().map(|force| number(force, 4)));
        cells
    });
    file(header, rows)
}

/// `plate-contacts.csv`.
pub fn plate_contacts(summary: &CrawlSummary) -> Result<Vec<u8>, csv::Error> {
    let rows = summary.contacts.iter().map(|contact| {
        [
            contact.body.clone(),
            contact.obstacle.clone(),
            contact.count.to_string(),
            number(contact.first_s, 4),
            number(contact.seconds, 4),
            number(contact.peak_n, 3),
        ]
    });
    file(
        ["body", "obstacle", "count", "first_s", "seconds", "peak_n"],
        rows,
    )
}
