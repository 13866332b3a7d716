//! Records as CSV.

use crate::pulls::{CHAIN_POINTS, ChainRecord, CostRecord, JOINTS, PullRecord};

/// Columns of commanded and measured angles after the four pitch joints.
pub const ARM_JOINTS: [&str; 3] = ["shoulder_roll", "forearm_upper", "forearm_lower"];

/// `torques/<gait>-<TT.T>s.csv`.
pub fn torque_file_name(pull: &PullRecord) -> String {
    format!("{}-{:04.1}s.csv", pull.gait, pull.duration_s)
}

/// One pull, one row per control step.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn torques(pull: &PullRecord) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = vec!["time_s".into(), "cycle_percent".into()];
    header.extend(JOINTS.map(|joint| format!("{joint}_nm")));
    for joint in JOINTS.iter().chain(&ARM_JOINTS) {
        header.push(format!("{joint}_cmd_rad"));
        header.push(format!("{joint}_rad"));
    }
    header.extend(
        [
            "toe_n",
            "elbow_n",
            "torso_n",
            "leg_n",
            "top_mm",
            "head_top_mm",
        ]
        .map(Into::into),
    );
    table.write_record(&header)?;
    for row in &pull.rows {
        let mut cells = vec![number(row.time_s, 3), number(row.cycle_percent, 3)];
        cells.extend(row.torque_nm.map(|torque| number(torque, 6)));
        for (command, angle) in row.command_rad.iter().zip(row.angle_rad) {
            cells.push(number(*command, 6));
            cells.push(number(angle, 6));
        }
        cells.extend(row.contact_n.map(|force| number(force, 4)));
        cells.extend([row.top_mm, row.head_top_mm].map(|height| number(height, 3)));
        table.write_record(&cells)?;
    }
    finish(table)
}

/// `chains.csv`: the planned chain of each gait, one row per instant.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn chains(chains: &[ChainRecord]) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    let mut header: Vec<String> = ["gait", "s", "theta3_deg", "theta4_deg", "alpha_deg"]
        .map(Into::into)
        .to_vec();
    for point in CHAIN_POINTS {
        header.extend([format!("{point}_x_mm"), format!("{point}_z_mm")]);
    }
    table.write_record(&header)?;
    for chain in chains {
        for sample in &chain.samples {
            let mut cells = vec![chain.gait.clone(), number(sample.s, 4)];
            cells.extend(sample.parameters_deg.map(|angle| number(angle, 5)));
            let points = sample.points_mm.iter().flat_map(|&(x, z)| [x, z]);
            cells.extend(points.map(|length| number(length, 4)));
            table.write_record(&cells)?;
        }
    }
    finish(table)
}

/// `costs.csv`.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn costs(costs: &[CostRecord]) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record(["gait", "duration_s", "cost_n2m2s", "published_n2m2s"])?;
    for cost in costs {
        table.write_record([
            cost.gait.clone(),
            cost.duration_s.to_string(),
            number(cost.cost_n2m2s, 6),
            cost.published_n2m2s
                .map_or_else(String::new, |cost| number(cost, 3)),
        ])?;
    }
    finish(table)
}

/// A number with fixed decimals; a negative zero loses its sign.
pub fn number(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        _ => text,
    }
}

/// A value as it is read again from a table that has it with so many decimals: what is drawn of it is
/// then the same before and after.
pub fn as_written(value: f64, decimals: usize) -> f64 {
    number(value, decimals).parse().unwrap_or(value)
}

/// The table as a file.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn finish(table: csv::Writer<Vec<u8>>) -> Result<Vec<u8>, csv::Error> {
    table
        .into_inner()
        .map_err(|error| error.into_error().into())
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
