//! Rows of a simulation as the instants of a record.

use prone::crawl::Stage;
use prone_record::crawl_tables::Instant;
use prone_sim::crawl::Row;
use prone_sim::pull;

/// Of a crawl.
pub(super) fn of_crawl(row: &Row) -> Instant<'_> {
    Instant {
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
pub(super) fn of_pull(row: &pull::Row) -> Option<Instant<'_>> {
    let shown = row.shown.as_ref()?;
    Some(Instant {
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
