//! Reading the result folder of `prone optimize` over pulls.

use serde::Deserialize;

use super::cut_table::Cut;
use super::folder::Folder;
use super::{ReportError, chains};
use crate::figures::{
    ConfirmedRecord, Figure, GenerationRecord, Scores, SearchRecord, confirmation, generations,
};
use prone_record::curves_info::CurvesInfo;
use prone_record::pulls::ChainRecord;
use prone_record::search_plan::{PullAimPlan, PullPlan};

/// What a search of pulls left behind.
pub(super) struct SearchRun {
    pub(super) folder: Folder,
    pub(super) result: SearchResult,
    /// What was minimised, as it was asked for.
    pub(super) aim: String,
    pub(super) source: String,
    pub(super) history: SearchRecord,
    pub(super) confirmed: Vec<ConfirmedRecord>,
    pub(super) chains: Vec<ChainRecord>,
    pub(super) cuts: Vec<Cut>,
}

/// What is needed of `result.json`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct SearchResult {
    pub(super) gait: String,
    pub(super) curves: CurvesInfo,
    pub(super) cost: Option<f64>,
    pub(super) torque: Option<f64>,
    pub(super) violations: f64,
    pub(super) unit: String,
    pub(super) seed: u64,
    pub(super) evaluations: u64,
    pub(super) complete: bool,
    pub(super) compared: Vec<ComparedGait>,
    pub(super) verdicts: Vec<VerdictRow>,
}

/// Another gait's cost.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct ComparedGait {
    pub(super) gait: String,
    pub(super) torque_ratio: Option<f64>,
}

/// The found gait against another in simulation.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct VerdictRow {
    pub(super) regime: String,
    pub(super) against: String,
    pub(super) cheaper_at: usize,
    pub(super) of: usize,
    pub(super) best_ratio: Option<f64>,
    pub(super) worst_ratio: Option<f64>,
}

impl SearchRun {
    pub(super) fn read(folder: Folder, plan: &PullPlan) -> Result<Self, ReportError> {
        let result: SearchResult = folder.json("result.json")?;
        let mut cuts = Vec::new();
        let aim = plan.pricing.aim.name();
        let (scores, objective) = match &plan.pricing.aim {
            // The published cost is one of torque.
            PullAimPlan::Published { .. } => (Scores::Published, "torque"),
            graded => (Scores::Graded, graded.name()),
        };
        let mut history = SearchRecord {
            seed: result.seed,
            objective: objective.to_owned(),
            unit: result.unit.clone(),
            scores,
            generations: Vec::new(),
        };
        history.generations = history_rows(&folder, result.seed, &mut cuts)?;
        Ok(Self {
            confirmed: confirmed(&folder, &mut cuts)?,
            chains: chains::read(&folder, None, &mut cuts)?,
            source: plan.pricing.source.name().to_owned(),
            aim: aim.to_owned(),
            result,
            history,
            cuts,
            folder,
        })
    }

    /// Figure 24 and the confirmation, drawn from the tables.
    pub(super) fn drawings(&self) -> Result<Vec<Figure>, ReportError> {
        let drawn = [
            generations(&self.history),
            confirmation(&self.confirmed, &self.history.objective),
        ];
        let mut figures = Vec::new();
        for figure in drawn {
            figures.extend(figure.map_err(|source| ReportError::Figure {
                run: self.folder.name.clone(),
                source,
            })?);
        }
        Ok(figures)
    }
}

fn history_rows(
    folder: &Folder,
    seed: u64,
    cuts: &mut Vec<Cut>,
) -> Result<Vec<GenerationRecord>, ReportError> {
    let mut table = folder.table("history.csv")?;
    let [of, generation] = table.columns(["seed", "generation"])?;
    let bests = table.columns(["best_violation", "best_torque", "mean_violation"])?;
    let [mean, mean_feasible] = table.columns(["mean_torque", "mean_feasible_torque"])?;
    let rows = table.rows(|line| {
        // A gait that cannot be priced has no torque; such a best is written as "inf".
        let [violation, torque, mean_violation] =
            bests.map(|column| line.text(column).parse::<f64>().ok());
        let row = GenerationRecord {
            generation: line.whole(generation)?,
            best_violation: violation?,
            best_value: torque?,
            mean_violation: mean_violation?,
            mean_value: line.optional(mean).ok()?,
            mean_feasible_value: line.optional(mean_feasible).ok()?,
        };
        Some((line.whole(of)?, row))
    });
    cuts.extend(table.cut());
    let own = rows.into_iter().filter(|(of, _)| *of == seed);
    Ok(own.map(|(_, row)| row).collect())
}

fn confirmed(folder: &Folder, cuts: &mut Vec<Cut>) -> Result<Vec<ConfirmedRecord>, ReportError> {
    let mut table = folder.table("confirmation.csv")?;
    let [regime, gait, duration, ratio] =
        table.columns(["regime", "gait", "duration_s", "ratio"])?;
    let rows = table.rows(|line| {
        Some(ConfirmedRecord {
            regime: line.text(regime).to_owned(),
            gait: line.text(gait).to_owned(),
            duration_s: line.number(duration)?,
            ratio: line.optional(ratio).ok()?,
        })
    });
    cuts.extend(table.cut());
    Ok(rows)
}
