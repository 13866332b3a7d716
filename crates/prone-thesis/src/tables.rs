//! Tables of the study as CSV.

use prone_record::tables::{finish, number};

use crate::agreement::Agreement;

/// `agreement.csv`.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub(crate) fn agreement(agreement: &[Agreement]) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(["gait", "duration_s", "joint", "rms_nm", "correlation"])?;
    for row in agreement {
        table.write_record([
            row.gait.clone(),
            row.duration_s.to_string(),
            row.joint.to_string(),
            number(row.rms_nm, 6),
            row.correlation
                .map_or_else(String::new, |value| number(value, 6)),
        ])?;
    }
    finish(table)
}
