//! A record as one tidy CSV table: a line per instant and joint.

use prone_record::recorded::Recorded;
use prone_record::tables::{finish, number};

/// Makes the table: instants in their order, in each the joints in the robot's order;
/// the cell of what was not recorded is empty.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn csv(record: &Recorded) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let columns = "time_s,joint,command_rad,position_rad,velocity_rad_s,effort_nm";
    table.write_record(columns.split(','))?;
    for (row, speeds) in record.rows.iter().zip(record.joint_speeds()) {
        let time = number(row.time_s, 4);
        for (index, joint) in record.joints.iter().enumerate() {
            table.write_record([
                &time,
                joint,
                &recorded(row.command.as_slice()[index], 6),
                &recorded(row.angles.as_slice()[index], 6),
                &recorded(speeds[index], 4),
                &recorded(row.actuator_torque_nm[index], 5),
            ])?;
        }
    }
    finish(table)
}

/// A number with fixed decimals; nothing where it was not recorded.
fn recorded(value: f64, decimals: usize) -> String {
    if value.is_nan() {
        String::new()
    } else {
        number(value, decimals)
    }
}
