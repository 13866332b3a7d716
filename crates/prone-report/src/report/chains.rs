//! Reading `chains.csv`: planned chains.

use super::ReportError;
use super::cut_table::Cut;
use super::folder::Folder;
use prone_record::pulls::{CHAIN_POINTS, ChainRecord, ChainSample};

/// Planned chains in the order of the file; `expected` are the gaits that must be there, if it is
/// known which.
///
/// # Errors
/// [`ReportError`] where the table is missing or lacks a column.
pub fn read(
    folder: &Folder,
    expected: Option<&[&str]>,
    cuts: &mut Vec<Cut>,
) -> Result<Vec<ChainRecord>, ReportError> {
    let mut table = folder.table("chains.csv")?;
    let [gait, s, knee, hip, arm] =
        table.columns(["gait", "s", "theta3_deg", "theta4_deg", "alpha_deg"])?;
    let mut points = [[s; 2]; 6];
    for (columns, point) in points.iter_mut().zip(CHAIN_POINTS) {
        let [x, z] = [format!("{point}_x_mm"), format!("{point}_z_mm")];
        *columns = table.columns([x.as_str(), z.as_str()])?;
    }
    let samples = table.rows(|line| {
        let mut points_mm = [(0.0, 0.0); 6];
        for (point, columns) in points_mm.iter_mut().zip(points) {
            *point = line.numbers(columns)?.into();
        }
        let sample = ChainSample {
            s: line.number(s)?,
            parameters_deg: line.numbers([knee, hip, arm])?,
            points_mm,
        };
        Some((line.text(gait).to_owned(), sample))
    });
    let mut chains: Vec<ChainRecord> = Vec::new();
    for (gait, sample) in samples {
        match chains.last_mut() {
            Some(chain) if chain.gait == gait => chain.samples.push(sample),
            _ => chains.push(ChainRecord {
                gait,
                samples: vec![sample],
            }),
        }
    }
    let whole = chains
        .iter()
        .all(|chain| chain.samples.last().is_some_and(|last| last.s >= 1.0));
    let all = expected.is_none_or(|gaits| {
        let known = |gait: &&str| chains.iter().any(|chain| chain.gait == *gait);
        gaits.iter().all(known)
    });
    if !whole || !all {
        table.end_early();
    }
    cuts.extend(table.cut());
    Ok(chains)
}
