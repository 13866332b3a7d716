//! Records as CSV.

use crate::pulls::{CHAIN_POINTS, ChainRecord, CostRecord, JOINTS, PullRecord};

/// Columns of commanded and measured angles after the four pitch joints.
pub const ARM_JOINTS: [&str; 3] = ["shoulder_roll", "forearm_upper", "forearm_lower"];

/// `torques/<gait>-<TT.T>s.csv`.
pub fn torque_file_name(pull: &PullRecord) -> String {
    format!("{}-{:04.1}s.csv", pull.gait, pull.duration_s)
}

/// One pull, one row per control step.
pub fn torques(pull: &PullRecord) -> Result<Vec<u8>, csv::Error> {
    let mut header = vec!["time_s".to_owned(), "cycle_percent".to_owned()];
    header.extend(JOINTS.map(|joint| format!("{joint}_nm")));
    for joint in JOINTS.iter().chain(&ARM_JOINTS) {
        header.extend([format!("{joint}_cmd_rad"), format!("{joint}_rad")]);
    }
    header.extend(["toe_n", "elbow_n", "torso_n", "leg_n"].map(String::from));
    header.extend(["top_mm", "head_top_mm", "squeeze_n"].map(String::from));
    let rows = pull.rows.iter().map(|row| {
        let mut cells = vec![number(row.time_s, 3), number(row.cycle_percent, 3)];
        cells.extend(row.torque_nm.map(|torque| number(torque, 6)));
        let angles = row.command_rad.iter().zip(&row.angle_rad);
        cells
            .extend(angles.flat_map(|(&command, &angle)| [command, angle].map(|it| number(it, 6))));
        cells.extend(row.contact_n.map(|force| number(force, 4)));
        cells.extend([row.top_mm, row.head_top_mm].map(|height| number(height, 3)));
        cells.push(number(row.squeeze_n, 5));
        cells
    });
    file(header, rows)
}

/// `chains.csv`: the planned chain of each gait, one row per instant.
pub fn chains(chains: &[ChainRecord]) -> Result<Vec<u8>, csv::Error> {
    let first = ["gait", "s", "theta3_deg", "theta4_deg", "alpha_deg"];
    let points = CHAIN_POINTS.map(|point| [format!("{point}_x_mm"), format!("{point}_z_mm")]);
    let header = first.map(String::from).into_iter();
    let samples = chains.iter().flat_map(|chain| {
        let samples = chain.samples.iter();
        samples.map(|sample| (&chain.gait, sample))
    });
    let rows = samples.map(|(gait, sample)| {
        let mut cells = vec![gait.clone(), number(sample.s, 4)];
        cells.extend(sample.parameters_deg.map(|angle| number(angle, 5)));
        let points = sample.points_mm.iter().flat_map(|&(x, z)| [x, z]);
        cells.extend(points.map(|length| number(length, 4)));
        cells
    });
    file(header.chain(points.into_iter().flatten()), rows)
}

/// `costs.csv`.
pub fn costs(costs: &[CostRecord]) -> Result<Vec<u8>, csv::Error> {
    columns(
        costs,
        [
            ("gait", &|it: &&CostRecord| it.gait.clone()),
            ("duration_s", &|it| it.duration_s.to_string()),
            ("cost_n2m2s", &|it| number(it.cost_n2m2s, 6)),
            ("published_n2m2s", &|it| maybe(it.published_n2m2s, 3)),
        ],
    )
}

/// A number with fixed decimals; a negative zero loses its sign.
pub fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    }
}

/// The same of a number that may be missing, and then leaves its cell empty.
pub fn maybe(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(String::new, |value| number(value, decimals))
}

/// A value as it is read again from a table that has it with so many decimals: what is drawn of it is
/// then the same before and after.
pub fn as_written(value: f64, decimals: usize) -> f64 {
    number(value, decimals).parse().unwrap_or(value)
}

/// What stands in a column of a row.
pub type Cell<'c, R> = &'c dyn Fn(&R) -> String;

/// A table of columns, each with its name and what stands in it, as a file.
pub fn columns<R, const N: usize>(
    rows: impl IntoIterator<Item = R>,
    columns: [(&str, Cell<'_, R>); N],
) -> Result<Vec<u8>, csv::Error> {
    let rows = rows.into_iter();
    let rows = rows.map(|row| columns.map(|(_, cell)| cell(&row)));
    file(columns.map(|(name, _)| name), rows)
}

/// A table of a header and rows as a file.
pub fn file<C: AsRef<[u8]>, R: IntoIterator<Item = C>>(
    header: impl IntoIterator<Item: AsRef<[u8]>>,
    rows: impl IntoIterator<Item = R>,
) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(header)?;
    for row in rows {
        table.write_record(row)?;
    }
    let bytes = table.into_inner();
    bytes.map_err(|error| error.into_error().into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_fixed_decimals_and_no_negative_zero() {
        assert_eq!(number(-0.000_000_1, 3), "0.000");
        assert_eq!(number(-0.5, 3), "-0.500");
        assert_eq!(number(0.150_000_000_000_000_02, 3), "0.150");
        assert!(as_written(-0.000_000_1, 3).total_cmp(&0.0).is_eq());
        assert!(as_written(f64::INFINITY, 3).is_infinite());
    }
}
