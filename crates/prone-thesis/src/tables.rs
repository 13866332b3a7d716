//! Tables of the study as CSV.

use prone_record::pulls::JOINTS;
use prone_record::tables::{columns, file, maybe, number};

use crate::agreement::Agreement;
use crate::squeeze::{Squeeze, Squeezed};

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

/// `squeeze.csv`.
pub(crate) fn squeeze(squeezes: &[Squeeze]) -> Result<Vec<u8>, csv::Error> {
    let mut header = ["gait", "duration_s", "from_percent"]
        .map(String::from)
        .to_vec();
    header.extend(JOINTS.map(|joint| format!("{joint}_nm_per_n")));
    header.push("cost_percent_per_n".to_owned());
    for whose in ["ours", "published"] {
        header.extend(
            ["squeeze_n", "rate_n2m2", "rate_without_n2m2"].map(|it| format!("{whose}_{it}")),
        );
    }
    header.extend(["rms_nm", "rms_with_its_squeeze_nm"].map(String::from));
    let rows = squeezes.iter().map(|it| {
        let mut cells = vec![
            it.gait.clone(),
            it.duration_s.to_string(),
            number(it.from_percent, 0),
        ];
        cells.extend(it.effect_nm.map(|effect| number(effect, 5)));
        cells.push(number(it.effect_percent, 3));
        for squeezed in [Some(it.ours), it.published] {
            let values: [fn(Squeezed) -> f64; 3] = [
                |it| it.squeeze_n,
                |it| it.rate_n2m2,
                |it| it.rate_without_n2m2,
            ];
            cells.extend(values.map(|value| maybe(squeezed.map(value), 5)));
        }
        cells.extend([it.rms_nm, it.rms_with_its_squeeze_nm].map(|rms| maybe(rms, 5)));
        cells
    });
    file(header, rows)
}
