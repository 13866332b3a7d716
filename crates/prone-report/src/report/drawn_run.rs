//! Reading result folders whose drawings are shown as they are: searches of whole cycles, frontiers,
//! torque maps.

use super::ReportError;
use super::cut_table::Cut;
use super::folder::Folder;
use crate::figures::{Figure, GenerationRecord, Scores, SearchRecord, generations};
use prone_record::figure_entry::FigureEntry;
use prone_record::frontier::{CycleObjective, Found, Frontier};
use prone_record::search_plan::UnderPlan;

/// What such a command left behind.
pub(super) struct DrawnRun {
    pub(super) folder: Folder,
    pub(super) recorded: Vec<FigureEntry>,
    /// Of a search of whole cycles.
    pub(super) cycles: Option<Frontier>,
    /// Generation by generation, the search of cycles that found the best.
    pub(super) history: Option<SearchRecord>,
    pub(super) cuts: Vec<Cut>,
}

impl DrawnRun {
    /// A search of whole cycles, whose heats may be shares of another cycle's.
    pub(super) fn cycles(folder: Folder, under: &UnderPlan) -> Result<Self, ReportError> {
        let result: Frontier = folder.json("result.json")?;
        let mut cuts = Vec::new();
        Ok(Self {
            recorded: folder.figures()?,
            history: history(&folder, &result, under, &mut cuts)?,
            cycles: Some(result),
            cuts,
            folder,
        })
    }

    /// Slices of a torque map.
    pub(super) fn map(folder: Folder) -> Result<Self, ReportError> {
        Ok(Self {
            recorded: folder.figures()?,
            cycles: None,
            history: None,
            cuts: Vec::new(),
            folder,
        })
    }

    /// Figure 24, drawn from the table.
    pub(super) fn drawing(&self) -> Result<Option<Figure>, ReportError> {
        let drawn = self.history.as_ref().map(generations).transpose();
        let drawn = drawn.map_err(|source| ReportError::Figure {
            run: self.folder.name.clone(),
            source,
        })?;
        Ok(drawn.flatten())
    }
}

/// What the values of a search are, in which unit, and that unit in theirs; searches minimise, so that
/// what is to be large is negative.
fn quantity(objective: CycleObjective, under: &UnderPlan) -> (&'static str, &'static str, f64) {
    let over = matches!(under, UnderPlan::One(one) if one.worst_over.is_some());
    match objective {
        CycleObjective::Heat if over => ("heat over another cycle's", "–", 1.0),
        CycleObjective::Heat => ("heat per metre", "s/m", 1.0),
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
    cuts: &mut Vec<Cut>,
) -> Result<Option<SearchRecord>, ReportError> {
    let mut table = folder.table("history.csv")?;
    let [ceiling, seed, generation] = table.columns(["ceiling_mm", "seed", "generation"])?;
    let columns = table.columns(["best_violation", "best_value", "mean_violation"])?;
    let rows = table.rows(|line| {
        // A cycle that cannot be crawled has no value.
        let [best_violation, best_value, mean_violation] =
            columns.map(|column| line.text(column).parse::<f64>().ok());
        let row = GenerationRecord {
            generation: line.whole(generation)?,
            best_violation: best_violation?,
            best_value: best_value?,
            mean_violation: mean_violation?,
            mean_value: None,
            mean_feasible_value: None,
        };
        Some((line.optional(ceiling).ok()?, line.whole(seed)?, row))
    });
    cuts.extend(table.cut());
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
