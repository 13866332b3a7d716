//! Reading the result folder of `prone optimize` over pulls.

use super::{Content, Run};
use crate::figures::GaitNumbers;
use crate::figures::{
    ConfirmedRecord, GenerationRecord, Scores, SearchRecord, confirmation, generations, parameters,
};
use crate::report::cut_table::{Column, Line};
use crate::report::folder::Folder;
use crate::report::{ReportError, chains};
use prone_record::gait_search::Outcome;
use prone_record::search_plan::{PullAimPlan, PullPlan, SourcePlan};

/// A search of pulls.
pub(in crate::report) struct PullSearch {
    /// What was minimised, as it was asked for.
    pub(in crate::report) aim: &'static str,
    /// Where torques came from.
    pub(in crate::report) source: String,
    /// What was found.
    pub(in crate::report) result: Outcome,
}

/// Reads a search; its figures are drawn from its tables.
pub(super) fn read(
    folder: Folder,
    plan: &PullPlan,
    gaits: &[GaitNumbers],
) -> Result<Run, ReportError> {
    let result: Outcome = folder.json("result.json")?;
    let (aim, scores, objective) = match &plan.pricing.aim {
        // The published cost is one of torque.
        PullAimPlan::Published { .. } => ("published", Scores::Published, "torque"),
        PullAimPlan::Torque(_) => ("torque", Scores::Graded, "torque"),
        PullAimPlan::Peak(_) => ("peak", Scores::Graded, "peak"),
        PullAimPlan::Heat(_) => ("heat", Scores::Graded, "heat"),
    };
    let (SourcePlan::Map { file: source, .. } | SourcePlan::Named(source)) = &plan.pricing.source;
    let mut cuts = Vec::new();
    let history = SearchRecord {
        seed: result.seed,
        objective: objective.to_owned(),
        unit: result.unit.to_string(),
        scores,
        generations: history(&folder, result.seed, &mut cuts)?,
    };
    let confirmed = confirmed(&folder, &mut cuts)?;
    let chains = chains::read(&folder, None, &mut cuts)?;
    let drawings = [
        folder.drawn(generations(&history))?,
        folder.drawn(confirmation(&confirmed, objective))?,
        folder.drawn(parameters(gaits, &chains))?,
    ];
    let search = PullSearch {
        aim,
        source: source.clone(),
        result,
    };
    let mut run = Run::new(folder, Content::Pulls(Box::new(search)));
    run.drawings = drawings.into_iter().flatten().collect();
    run.shortfalls = cuts;
    Ok(run)
}

/// The generations of the run with a seed.
fn history(
    folder: &Folder,
    seed: u64,
    cuts: &mut Vec<String>,
) -> Result<Vec<GenerationRecord>, ReportError> {
    let table = folder.table("history.csv")?;
    let [seeds] = table.columns(["seed"])?;
    let columns = [
        "generation",
        "best_violation",
        "best_torque",
        "mean_violation",
    ];
    let columns = table.columns(columns)?;
    let [mean, mean_feasible] = table.columns(["mean_torque", "mean_feasible_torque"])?;
    let rows = table.rows(cuts, |line| {
        let row = GenerationRecord {
            mean_value: line.optional(mean).ok()?,
            mean_feasible_value: line.optional(mean_feasible).ok()?,
            ..generation(line, columns)?
        };
        Some((line.whole(seeds)?, row))
    });
    let own = rows.into_iter().filter(|(of, _)| *of == seed);
    Ok(own.map(|(_, row)| row).collect())
}

/// A generation without the means of what is minimised: its number, violation and value of the best, and
/// mean violation.
pub(super) fn generation(line: &Line<'_>, columns: [Column; 4]) -> Option<GenerationRecord> {
    // A gait without a cost has no value; such a best is written as "inf".
    let [_, best_violation, best_value, mean_violation] =
        columns.map(|column| line.text(column).parse::<f64>().ok());
    Some(GenerationRecord {
        generation: line.whole(columns[0])?,
        best_violation: best_violation?,
        best_value: best_value?,
        mean_violation: mean_violation?,
        mean_value: None,
        mean_feasible_value: None,
    })
}

fn confirmed(folder: &Folder, cuts: &mut Vec<String>) -> Result<Vec<ConfirmedRecord>, ReportError> {
    let table = folder.table("confirmation.csv")?;
    let [regime, gait, duration, ratio] =
        table.columns(["regime", "gait", "duration_s", "ratio"])?;
    Ok(table.rows(cuts, |line| {
        Some(ConfirmedRecord {
            regime: line.text(regime).to_owned(),
            gait: line.text(gait).to_owned(),
            duration_s: line.number(duration)?,
            ratio: line.optional(ratio).ok()?,
        })
    }))
}
