//! The columns of `rows.csv` and `contacts.csv`: their names, their units, and what a value is.
//!
//! Whoever writes a record and whoever reads it take them from here. A column that is not described
//! here may be recorded too; it is shown as it is.

use prone::robot::{BodyPart, ContactGroup, Robot};

use crate::record_info::{Channel, ChannelKind, Part};

/// Time of a row or a contact since the first pull began, s.
pub(crate) const TIME: &str = "time_s";
/// Number of the cycle, from 1.
pub(crate) const CYCLE: &str = "cycle";
/// `pull` or `recovery`: the only column of rows that holds no numbers.
pub(crate) const STAGE: &str = "stage";
/// Phase of the pull, 0 to 1.
pub(crate) const PHASE: &str = "s";
/// Name of the body that touches.
pub(crate) const BODY: &str = "body";
/// Name of what it touches.
pub(crate) const WITH: &str = "with";

/// Where the root, or a contact, is in the ground frame.
pub(crate) const PLACE: [&str; 3] = ["x_mm", "y_mm", "z_mm"];
/// How the root is turned, as a quaternion.
pub(crate) const TURN: [&str; 4] = ["qw", "qx", "qy", "qz"];
/// Heading of the root.
pub(crate) const YAW: &str = "yaw_deg";
/// How far the root is to the left of the line of the start.
pub(crate) const LATERAL: &str = "lateral_mm";
/// How many contacts a row has, by which a reader knows whether `contacts.csv` is whole.
pub(crate) const CONTACTS: &str = "contacts";
/// Force of a contact on the robot.
pub(crate) const FORCE: [&str; 3] = ["fx_n", "fy_n", "fz_n"];

/// End of the column of a joint's command; the joint's name is before it.
pub(crate) const COMMAND_END: &str = "_cmd_rad";
/// End of the column of a joint's angle.
pub(crate) const ANGLE_END: &str = "_rad";
/// End of the column of a joint's torque.
pub(crate) const TORQUE_END: &str = "_nm";
/// End of the column of the heat of a joint's motor.
pub(crate) const HEAT_END: &str = "_heat_s";
/// End of the column of the positive work of a joint's motor.
pub(crate) const WORK_END: &str = "_work_j";

/// Names of the stages of a crawl.
pub(crate) const STAGES: [&str; 2] = ["pull", "recovery"];

/// What the values of a column are.
pub(crate) struct Meaning {
    pub(crate) unit: &'static str,
    /// What a value may be; first what a simulation records.
    pub(crate) is: &'static [ChannelKind],
}

/// Columns that say which line it is: they are no channels.
pub(crate) const fn labels(table: Part) -> &'static [&'static str] {
    match table {
        Part::Rows => &[TIME, CYCLE, STAGE, PHASE],
        Part::Contacts => &[TIME, BODY, WITH],
    }
}

/// Normal force of the ground on each group of bodies.
pub(crate) fn grounds() -> [String; ContactGroup::COUNT] {
    ContactGroup::ALL.map(|group| format!("{}_n", group.name()))
}

/// Highest point of each part of the body.
pub(crate) fn tops() -> [String; 5] {
    BodyPart::ALL.map(|part| format!("{}_top_mm", part.name()))
}

/// What the values of a column are, `None` of one that is not described here.
pub(crate) fn meaning(table: Part, column: &str) -> Option<Meaning> {
    let is_among = |names: &[String]| names.iter().any(|name| name == column);
    let instant: &[ChannelKind] = &[ChannelKind::Instant];
    // A simulation averages what a robot samples.
    let mean: &[ChannelKind] = &[ChannelKind::Mean, ChannelKind::Instant];
    let (unit, is) = match table {
        Part::Contacts if PLACE.contains(&column) => ("mm", mean),
        Part::Contacts if FORCE.contains(&column) => ("N", mean),
        Part::Rows if PLACE.contains(&column) => ("mm", instant),
        Part::Rows if TURN.contains(&column) || column == CONTACTS => ("1", instant),
        Part::Rows if column.ends_with(HEAT_END) => ("s", &[ChannelKind::Sum][..]),
        Part::Rows if column.ends_with(WORK_END) => ("J", &[ChannelKind::Sum][..]),
        Part::Rows if column == YAW => ("°", instant),
        Part::Rows if column == LATERAL || is_among(&tops()) => ("mm", instant),
        Part::Rows if is_among(&grounds()) => ("N", mean),
        Part::Rows if column.ends_with(COMMAND_END) => ("rad", &[ChannelKind::Command][..]),
        Part::Rows if column.ends_with(ANGLE_END) => ("rad", instant),
        Part::Rows if column.ends_with(TORQUE_END) => ("N·m", mean),
        _ => return None,
    };
    Some(Meaning { unit, is })
}

/// The channels of a simulation of a robot.
pub fn channels(robot: &Robot) -> Vec<Channel> {
    let named = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
    let of_joints = |end: &str| {
        let joints = robot.joints.iter();
        joints.map(|joint| format!("{}{end}", joint.name)).collect()
    };
    let groups: [(Part, Vec<String>); 14] = [
        (Part::Rows, named(&PLACE)),
        (Part::Rows, named(&TURN)),
        (Part::Rows, named(&[YAW])),
        (Part::Rows, named(&[LATERAL])),
        (Part::Rows, of_joints(COMMAND_END)),
        (Part::Rows, of_joints(ANGLE_END)),
        (Part::Rows, of_joints(TORQUE_END)),
        (Part::Rows, of_joints(HEAT_END)),
        (Part::Rows, of_joints(WORK_END)),
        (Part::Rows, grounds().to_vec()),
        (Part::Rows, tops().to_vec()),
        (Part::Rows, named(&[CONTACTS])),
        (Part::Contacts, named(&PLACE)),
        (Part::Contacts, named(&FORCE)),
    ];
    let channels = groups.into_iter().filter_map(|(table, columns)| {
        let Meaning { unit, is } = meaning(table, columns.first()?)?;
        Some(Channel {
            table,
            columns,
            is: is[0],
            unit: unit.to_owned(),
        })
    });
    channels.collect()
}
