//! Reading the result folders of searches of whole cycles: `prone optimize`, `prone crawl frontier`.

use super::pull_search::generation;
use super::{Content, Run};
use crate::figures::{GenerationRecord, Scores, SearchRecord, generations};
use crate::report::ReportError;
use crate::report::folder::Folder;
use prone_record::frontier::{CycleObjective, Found, Frontier};
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

/// What the values of a search are, in which unit, and that unit in theirs; searches minimise, so that
/// what is to be large is negative.
fn quantity(objective: CycleObjective, under: &UnderPlan) -> (&'static str, &'static str, f64) {
    let over = matches!(under, UnderPlan::One(one) if one.worst_over.is_some());
    match objective {
        CycleObjective::Heat if over => ("heat over another cycle's", "–", 1.0),
        CycleObjective::Heat => ("heat per metre", "s/m", 1.0),
        CycleObjective::HeatRate => ("heat per second", "", 1.0),
        CycleObjective::Advance => ("advance per cycle", "mm", -1e3),
        CycleObjective::Speed => ("speed", "mm/s", -1e3),
        CycleObjective::Peak => ("torque demanded of a shoulder", "N·m", 1.0),
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
    let [ceiling, seed] = table.columns(["ceiling_mm", "seed"])?;
    let columns = [
        "generation",
        "best_violation",
        "best_value",
        "mean_violation",
    ];
    let columns = table.columns(columns)?;
    let rows = table.rows(cuts, |line| {
        let row = generation(line, columns)?;
        Some((line.optional(ceiling).ok()?, line.whole(seed)?, row))
    });
    let order = |found: &Found| (found.violation, found.value.unwrap_or(f64::INFINITY));
    let best = result.found.iter().min_by(|a, b| {
        let (a, b) = (order(a), order(b));
        a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    let Some(best) = best else {
        return Ok(None);
    };
    let (objective, unit, factor) = quantity(result.objective, under);
    // The table has a tenth of a millimetre.
    let same = |height: Option<f64>| match height.zip(best.ceiling_mm) {
        Some((a, b)) => (a - b).abs() < 0.06,
        None => height.is_none() && best.ceiling_mm.is_none(),
    };
    let own = rows
        .into_iter()
        .filter(|(height, of, _)| *of == best.seed && same(*height));
    let generations = own.map(|(_, _, row)| GenerationRecord {
        best_value: row.best_value * factor,
        ..row
    });
    Ok(Some(SearchRecord {
        seed: best.seed,
        objective: objective.to_owned(),
        unit: unit.to_owned(),
        scores: Scores::Graded,
        generations: generations.collect(),
    }))
}
