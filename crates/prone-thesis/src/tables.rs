//! Tables of the study as CSV.

use prone_record::tables::{columns, maybe, number};

use crate::agreement::Agreement;

/// `agreement.csv`.
pub(crate) fn agreement(agreement: &[Agreement]) -> Result<Vec<u8>, csv::Error> {
    columns(
        agreement,
        [
            ("gait", &|it: &&Agreement| it.gait.clone()),
            ("duration_s", &|it| it.duration_s.to_string()),
            ("joint", &|it| it.joint.to_string()),
            ("rms_nm", &|it| number(it.rms_nm, 6)),
            ("correlation", &|it| maybe(it.correlation, 6)),
        ],
    )
}
