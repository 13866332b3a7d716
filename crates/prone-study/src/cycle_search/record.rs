//! What a frontier leaves behind: `result.json`, `frontier.csv`, `history.csv`.

use prone::gait::cycle::Cycle;
use serde::Serialize;

use super::frontier::{Confirmed, ConfirmedSetting};
use super::price::{CycleObjective, CyclePrice};
use crate::optimize::search::Search;
use crate::tables::{finish, number};

/// All searches of a frontier.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Frontier {
    /// What was searched.
    pub objective: CycleObjective,
    /// Distance kept from the ceiling, mm.
    pub margin_mm: f64,
    /// By ceiling and seed.
    pub found: Vec<Found>,
    /// Other cycles in the same settings, for comparison.
    pub compared: Vec<Compared>,
}

/// Another cycle in the settings of a confirmation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// Its name.
    pub gait: String,
    /// What it does.
    pub confirmed: Confirmed,
}

/// What one search found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Found {
    /// The ceiling, mm, where there is one.
    pub ceiling_mm: Option<f64>,
    /// The seed.
    pub seed: u64,
    /// Evaluations.
    pub evaluations: u64,
    /// Name of the cycle.
    pub gait: String,
    /// The objective, as searched: minus metres per cycle, or s/m.
    pub value: Option<f64>,
    /// What it breaks of the rules of the search, in shares of their limits.
    pub violation: f64,
    /// Why it could not be crawled in the settings of the search, where it could not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
    /// Why the found cycle has lost the steering of the one that it was searched about, where it has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unsteered: Option<String>,
    /// What it does in other settings.
    pub confirmed: Confirmed,
}

impl Found {
    /// A run's best cycle.
    pub fn new(
        ceiling_mm: Option<f64>,
        seed: u64,
        evaluations: u64,
        cycle: &Cycle,
        price: &CyclePrice,
        confirmed: Confirmed,
    ) -> Self {
        Self {
            ceiling_mm,
            seed,
            evaluations,
            gait: cycle.pull.name.clone(),
            value: Some(price.value).filter(|value| value.is_finite()),
            violation: price.violation,
            refused: price.refusal.as_ref().map(ToString::to_string),
            unsteered: None,
            confirmed,
        }
    }

    /// What it does, for the head of its file.
    pub fn sentence(&self) -> String {
        let settings = self.confirmed.settings.iter().map(|row| match row {
            ConfirmedSetting {
                setting,
                mm_per_cycle: Some(advance),
                top_mm: Some(top),
                demanded_shoulder_nm: Some(shoulder),
                ..
            } => format!(
                "{setting}: {advance:.1} mm per cycle, {top:.1} mm high, {shoulder:.2} N·m asked of a shoulder."
            ),
            row => format!(
                "{}: {}.",
                row.setting,
                row.refused.as_deref().unwrap_or("not known")
            ),
        });
        settings.collect::<Vec<_>>().join("\n")
    }
}

/// `frontier.csv`: one row per ceiling, seed and setting.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn csv(frontier: &Frontier) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "ceiling_mm",
        "seed",
        "setting",
        "mm_per_cycle",
        "mm_per_s",
        "yaw_deg",
        "top_mm",
        "top_part",
        "heat_per_metre_s",
        "peak_torque_over_rated",
        "peak_joint",
        "demanded_shoulder_nm",
        "kept",
        "refused",
    ])?;
    let maybe = |value: Option<f64>, decimals| {
        value.map_or_else(String::new, |value| number(value, decimals))
    };
    for found in &frontier.found {
        for row in &found.confirmed.settings {
            table.write_record([
                maybe(found.ceiling_mm, 1),
                found.seed.to_string(),
                row.setting.to_string(),
                maybe(row.mm_per_cycle, 3),
                maybe(row.mm_per_s, 3),
                maybe(row.yaw_deg, 3),
                maybe(row.top_mm, 3),
                row.top_part.clone().unwrap_or_default(),
                maybe(row.heat_per_metre_s, 4),
                maybe(row.peak_torque_over_rated, 4),
                row.peak_joint.clone().unwrap_or_default(),
                maybe(row.demanded_shoulder_nm, 4),
                maybe(row.kept, 4),
                row.refused.clone().unwrap_or_default(),
            ])?;
        }
    }
    finish(table)
}

/// `history.csv`: one row per generation of each search, in the order of ceilings.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn history_csv(
    ceilings_mm: &[Option<f64>],
    searches: &[Search],
) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "ceiling_mm",
        "seed",
        "generation",
        "evaluations",
        "best_violation",
        "best_value",
        "mean_violation",
        "feasible",
    ])?;
    for (ceiling, search) in ceilings_mm.iter().zip(searches) {
        for run in search.runs() {
            for row in &run.history.0 {
                table.write_record([
                    ceiling.map_or_else(String::new, |ceiling| number(ceiling, 1)),
                    run.seed.to_string(),
                    row.generation.to_string(),
                    row.evaluations.to_string(),
                    number(row.best.violation(), 6),
                    number(row.best.value(), 6),
                    number(row.mean_violation, 6),
                    row.feasible.to_string(),
                ])?;
            }
        }
    }
    finish(table)
}
