//! Torque maps to text.

use std::fmt::Write as _;

use crate::mapping::Mapping;
use crate::robot::Robot;

use super::super::{ContactForces, RecordedMap, Row};
use super::{ANKLE_JOINT, COLUMNS, COMMENT, FIRST_FORCE, FIRST_TORQUE, HIP, KNEE, UPPER_ARM};

/// Decimals of every number: angles and torques come back to within 5·10⁻¹¹.
const DECIMALS: usize = 10;

/// Writes a map with its contact forces: `comments` first, one line each, then the rows.
///
/// Chain and joint angles are those of the mapping, right side, limits not looked at. A masked row
/// keeps the angles that it has, and no torques; where no chain closes there are neither.
pub fn write(
    comments: &[String],
    robot: &Robot,
    mapping: &Mapping,
    recorded: &RecordedMap,
) -> String {
    let grid = recorded.map().grid();
    let mut text = String::new();
    for comment in comments {
        line(&mut text, format_args!("{COMMENT} {comment}"));
    }
    for index in grid.recorded_order() {
        let node = grid.node(index);
        let mut numbers = [f64::NAN; COLUMNS.len()];
        if let Ok(chain) = mapping.chain().close(node) {
            numbers[..UPPER_ARM].copy_from_slice(&chain.to_array());
            if let Ok(joints) = mapping.joint_angles(robot, &chain) {
                let angles = robot.chain.right.pitch_joints().map(|joint| joints[joint]);
                numbers[ANKLE_JOINT..FIRST_TORQUE].copy_from_slice(&angles);
            }
            if let Row::Torques(torques) = recorded.map().rows()[index] {
                numbers[FIRST_TORQUE..FIRST_FORCE].copy_from_slice(&torques.to_array());
                let forces = recorded.contacts()[index].map(ContactForces::to_array);
                numbers[FIRST_FORCE..].copy_from_slice(&forces.unwrap_or([f64::NAN; 4]));
            }
        }
        // The node itself, also where no chain closes.
        (numbers[KNEE], numbers[HIP]) = (node.knee, node.hip);
        numbers[UPPER_ARM] = node.upper_arm;
        line(&mut text, format_args!("{}", numbers.map(number).join(",")));
    }
    text
}

fn line(text: &mut String, content: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "{content}");
}

/// A number with fixed decimals; a negative zero loses its sign.
fn number(value: f64) -> String {
    let text = format!("{value:.DECIMALS$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    }
}
