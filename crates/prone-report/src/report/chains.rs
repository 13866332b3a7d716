//! Reading `chains.csv`: planned chains.

use super::ReportError;
use super::cut_table::Line;
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
    cuts: &mut Vec<String>,
) -> Result<Vec<ChainRecord>, ReportError> {
    let table = folder.table("chains.csv")?;
    let [gait, s, knee, hip, arm] =
        table.columns(["gait", "s", "theta3_deg", "theta4_deg", "alpha_deg"])?;
    let mut points = [[s; 2]; 6];
    for (columns, point) in points.iter_mut().zip(CHAIN_POINTS) {
        let [x, z] = [format!("{point}_x_mm"), format!("{point}_z_mm")];
        *columns = table.columns([x, z])?;
    }
    let read = |line: &Line<'_>| {
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
    };
    let samples = table.all_rows(cuts, read, |samples| {
        // The last sample of each gait is at the end of the phase.
        let mut gaits = samples.chunk_by(|(a, _), (b, _)| a == b);
        let known = |gait: &&str| samples.iter().any(|(known, _)| known == gait);
        gaits.all(|own| own.last().is_some_and(|(_, last)| last.s >= 1.0))
            && expected.is_none_or(|gaits| gaits.iter().all(known))
    });
    let gaits = samples.chunk_by(|(a, _), (b, _)| a == b);
    let chains = gaits.map(|own| ChainRecord {
        gait: own[0].0.clone(),
        samples: own.iter().map(|(_, sample)| *sample).collect(),
    });
    Ok(chains.collect())
}
