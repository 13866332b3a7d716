//! Reading the result folders of searches of whole cycles: `prone optimize`, `prone crawl frontier`.

use super::pull_search::generation;
use super::{Content, Run};
use crate::figures::{GenerationRecord, Scores, SearchRecord, generations};
use crate::report::ReportError;
use crate::report::folder::Folder;
use prone_record::frontier::Frontier;
use prone_record::measure::{Heats, Measure};
use prone_record::search_plan::UnderPlan;

/// Reads a search, whose heats may be shares of another cycle's; the generations are drawn from their
/// table.
pub(super) fn read(folder: Folder, under: &UnderPlan) -> Result<Run, ReportError> {
    let result: Frontier = folder.json("result.json")?;
    let mut cuts = Vec::new();
    let drawing = match history(&folder, &result, under, &mut cuts)? {
        Some(history) => folder.drawn(generations(&history))?,
        None => None,
    };
    let recorded = folder.figures()?;
    let mut run = Run::new(folder, Content::Cycles(result));
    run.drawings.extend(drawing);
    run.recorded = recorded;
    run.shortfalls = cuts;
    Ok(run)
}

/// What the heats of a search are, by its plan.
fn heats(under: &UnderPlan) -> Heats {
    match under {
        UnderPlan::One(one) if one.worst_over.is_some() => Heats::OverAnother,
        _ => Heats::PerMetre,
    }
}

/// The search that found the best cycle.
fn history(
    folder: &Folder,
    result: &Frontier,
    under: &UnderPlan,
    cuts: &mut Vec<String>,
) -> Result<Option<SearchRecord>, ReportError> {
    let table = folder.table("history.csv")?;
    let [held, seed] = table.columns([result.held.column(), "seed"])?;
    let columns = [
        "generation",
        "best_violation",
        "best_value",
        "mean_violation",
    ];
    let columns = table.columns(columns)?;
    let rows = table.rows(cuts, |line| {
        let row = generation(line, columns)?;
        Some((line.optional(held).ok()?, line.whole(seed)?, row))
    });
    let Some(best) = result.best() else {
        return Ok(None);
    };
    let measure = Measure::of_cycles(result.objective, heats(under));
    // The table has so many decimals.
    let rounding = 0.6 * 10_f64.powf(-(result.held.decimals() as f64));
    let same = |value: Option<f64>| match value.zip(best.at) {
        Some((a, b)) => (a - b).abs() < rounding,
        None => value.is_none() && best.at.is_none(),
    };
    let own = rows
        .into_iter()
        .filter(|(value, of, _)| *of == best.seed && same(*value));
    let generations = own.map(|(_, _, row)| GenerationRecord {
        best_value: measure.read(row.best_value),
        ..row
    });
    Ok(Some(SearchRecord {
        seed: best.seed,
        objective: measure.what.to_owned(),
        unit: measure.unit.to_owned(),
        scores: Scores::Graded,
        generations: generations.collect(),
    }))
}
