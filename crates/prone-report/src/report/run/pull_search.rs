//! Reading the result folder of `prone optimize` over pulls.

use serde::Deserialize;

use super::{Content, Run};
use crate::figures::GaitNumbers;
use crate::figures::{
    ConfirmedRecord, GenerationRecord, Scores, SearchRecord, confirmation, generations, parameters,
};
use crate::report::cut_table::{Column, Line};
use crate::report::folder::Folder;
use crate::report::{ReportError, chains};
use prone_record::curves_info::CurvesInfo;
use prone_record::search_plan::{PullAimPlan, PullPlan};

/// What is needed of `result.json`, and of the plan.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(in crate::report) struct SearchResult {
    /// What was minimised, as it was asked for.
    #[serde(skip)]
    pub(in crate::report) aim: String,
    /// Where torques came from.
    #[serde(skip)]
    pub(in crate::report) source: String,
    pub(in crate::report) gait: String,
    pub(in crate::report) curves: CurvesInfo,
    pub(in crate::report) cost: Option<f64>,
    pub(in crate::report) torque: Option<f64>,
    pub(in crate::report) violations: f64,
    pub(in crate::report) unit: String,
    pub(in crate::report) seed: u64,
    pub(in crate::report) evaluations: u64,
    pub(in crate::report) complete: bool,
    pub(in crate::report) compared: Vec<ComparedGait>,
    pub(in crate::report) verdicts: Vec<VerdictRow>,
}

/// Another gait's cost.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(in crate::report) struct ComparedGait {
    pub(in crate::report) gait: String,
    pub(in crate::report) torque_ratio: Option<f64>,
}

/// The found gait against another in simulation.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(in crate::report) struct VerdictRow {
    pub(in crate::report) regime: String,
    pub(in crate::report) against: String,
    pub(in crate::report) cheaper_at: usize,
    pub(in crate::report) of: usize,
    pub(in crate::report) best_ratio: Option<f64>,
    pub(in crate::report) worst_ratio: Option<f64>,
}

/// Reads a search; its figures are drawn from its tables.
pub(super) fn read(
    folder: Folder,
    plan: &PullPlan,
    gaits: &[GaitNumbers],
) -> Result<Run, ReportError> {
    let aim = plan.pricing.aim.name();
    let result = SearchResult {
        aim: aim.to_owned(),
        source: plan.pricing.source.name().to_owned(),
        ..folder.json("result.json")?
    };
    let (scores, objective) = match &plan.pricing.aim {
        // The published cost is one of torque.
        PullAimPlan::Published { .. } => (Scores::Published, "torque"),
        _ => (Scores::Graded, aim),
    };
    let mut cuts = Vec::new();
    let history = SearchRecord {
        seed: result.seed,
        objective: objective.to_owned(),
        unit: result.unit.clone(),
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
    let mut run = Run::new(folder, Content::Pulls(Box::new(result)));
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
