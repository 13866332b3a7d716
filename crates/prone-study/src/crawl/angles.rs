//! Joint angles of a simulated crawl, to be drawn.

use prone::robot::Robot;
use prone_record::tables::as_written;
use prone_report::figures::{AngleRecord, AngleRow};
use prone_sim::crawl::Crawl;

/// The left chain of a crawl that was simulated with rows, to the digits of `rows.csv`.
pub(super) fn of_crawl(robot: &Robot, gait: &str, crawl: &Crawl) -> AngleRecord {
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
