//! A record as one tidy CSV table: a line per instant and joint.

use prone::foreign_text;
use prone_record::recorded::Recorded;
use prone_record::tables::{file, maybe, number};

/// Makes the table: instants in their order, in each the joints in the robot's order;
/// the cell of what was not recorded is empty.
pub fn csv(record: &Recorded) -> Result<Vec<u8>, csv::Error> {
    let columns = "time_s,joint,command_rad,position_rad,velocity_rad_s,effort_nm";
    let rows = record.rows.iter().zip(record.joint_speeds());
    let rows = rows.flat_map(|(row, speeds)| {
        let joints = record.joints.iter().enumerate();
        joints.map(move |(index, joint)| {
            [
                number(row.time_s, 4),
                foreign_text::escaped(joint).into_owned(),
                recorded(row.command.as_slice()[index], 6),
                recorded(row.angles.as_slice()[index], 6),
                recorded(speeds[index], 4),
                recorded(row.motor_torque_nm[index], 5),
            ]
        })
    });
    file(columns.split(','), rows)
}

/// A number with fixed decimals; nothing where it was not recorded.
fn recorded(value: f64, decimals: usize) -> String {
    maybe(Some(value).filter(|value| !value.is_nan()), decimals)
}
