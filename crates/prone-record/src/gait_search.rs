//! What a search of pulls leaves behind: `result.json`, `history.csv`, `confirmation.csv`.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::curves_info::CurvesInfo;
use crate::search::Search;
use crate::tables::{finish, number};

/// What a search found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outcome {
    /// Name of the gait.
    pub gait: String,
    /// What it is made of.
    pub curves: CurvesInfo,
    /// Its cost.
    #[serde(flatten)]
    pub cost: PullCost,
    /// Unit of the torque part.
    pub unit: &'static str,
    /// Seed of the run that found it.
    pub seed: u64,
    /// Evaluations of all runs.
    pub evaluations: u64,
    /// Whether every run came to its own end, or the search was stopped by its time budget.
    pub complete: bool,
    /// Variables.
    pub variables: usize,
    /// Each run's best.
    pub runs: Vec<RunOutcome>,
    /// The gaits that it is compared with, by the same costs.
    pub compared: Vec<Compared>,
    /// What simulation says at other durations and in the other regime.
    pub verdicts: Vec<Verdict>,
    /// Gaits that could not be simulated there.
    pub refused: Vec<Refusal>,
}

/// One run's best.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunOutcome {
    /// Its seed.
    pub seed: u64,
    /// The cost of its best gait, `None` where nothing was evaluated.
    #[serde(flatten)]
    pub cost: Option<PullCost>,
    /// Evaluations.
    pub evaluations: u64,
    /// Generations.
    pub generations: u64,
    /// How often the population began anew.
    pub restarts: u64,
}

/// The cost of another gait, and the found one's over it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// Name of the gait.
    pub gait: String,
    /// Its cost.
    #[serde(flatten)]
    pub cost: PullCost,
    /// The found gait's torque part over this one's, where both are known.
    pub torque_ratio: Option<f64>,
}

/// The cost of a pull, in parts.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PullCost {
    /// What is minimised among gaits with the same violations; for `published` its cost, in which
    /// violations weigh 1000 each. `None` where it is not known, as violations forbid to simulate.
    pub cost: Option<f64>,
    /// The torque part.
    pub torque: Option<f64>,
    /// Published: violated samples. Graded: the sum of excesses, 0 for a gait that keeps the rules.
    pub violations: f64,
    /// The rules that are broken.
    pub broken: Vec<Broken>,
}

/// A broken rule.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Broken {
    /// Its name.
    pub rule: Cow<'static, str>,
    /// How often.
    pub count: u32,
    /// By how much in all, shares of the limit; for `published` the count once more.
    pub sum: f64,
}

/// Every gait in every regime at every duration.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Confirmation {
    /// What came out.
    pub rows: Vec<Row>,
    /// Gaits that could not be simulated, and why.
    pub refused: Vec<Refusal>,
    /// The found gait against each of the others.
    pub verdicts: Vec<Verdict>,
}

/// One simulated pull.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Row {
    /// Contact regime.
    pub regime: &'static str,
    /// Name of the gait.
    pub gait: String,
    /// Duration of the pull, s.
    pub duration_s: f64,
    /// What the search minimised, here per phase.
    pub objective: f64,
    /// The same over that of the first gait in the same regime at the same duration.
    pub ratio: f64,
    /// ∫ Σ τ² dt, N²·m²·s.
    pub torque_n2m2s: f64,
    /// ∫ Σ (τ/`τ_nominal`)² dt, s; `None` where a motor's figures are missing.
    pub heat_s: Option<f64>,
    /// Largest |τ| over the effort limit.
    pub peak_of_effort: f64,
    /// The joint that has it.
    pub peak_joint: &'static str,
    /// Share of the normal force on trunk and legs, percent.
    pub body_share_percent: f64,
    /// From where on toes and elbows carry most of the weight to the end, percent of the phase;
    /// `None` where they do not.
    pub carried_from_percent: Option<f64>,
    /// How far the trunk moved forward, mm.
    pub advance_mm: f64,
    /// Highest point of any shape, mm.
    pub top_mm: f64,
}

/// A pull that could not be simulated.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Refusal {
    /// Contact regime.
    pub regime: &'static str,
    /// Name of the gait.
    pub gait: String,
    /// Why.
    pub reason: String,
}

/// The found gait against another in one regime.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Verdict {
    /// Contact regime.
    pub regime: &'static str,
    /// The other gait.
    pub against: String,
    /// Durations at which the found gait costs less.
    pub cheaper_at: usize,
    /// Durations at which both were simulated.
    pub of: usize,
    /// Lowest ratio of found to other.
    pub best_ratio: f64,
    /// Highest ratio of found to other.
    pub worst_ratio: f64,
}

impl Outcome {
    /// Whether the found gait costs less than another everywhere in a regime.
    pub fn holds(&self, regime: &str, base: &str) -> bool {
        let mut verdicts = self.verdicts.iter();
        verdicts
            .any(|v| v.regime == regime && v.against == base && v.of > 0 && v.cheaper_at == v.of)
    }
}

impl Verdict {
    /// In words, for the screen and for the gait's file.
    pub fn sentence(&self) -> String {
        let Self {
            regime,
            against,
            cheaper_at,
            of,
            best_ratio,
            worst_ratio,
        } = self;
        if *of == 0 {
            return format!("{regime}: not compared with {against}.");
        }
        format!(
            "{regime}: {best_ratio:.3} to {worst_ratio:.3} of {against}, cheaper at {cheaper_at} of {of} durations."
        )
    }
}

impl Refusal {
    /// Whether it is about the same gait in the same regime.
    pub fn is_about(&self, other: &Self) -> bool {
        self.regime == other.regime && self.gait == other.gait
    }
}

impl Row {
    /// Whether two rows are of the same regime and duration.
    pub fn is_beside(&self, other: &Self) -> bool {
        self.regime == other.regime && (self.duration_s - other.duration_s).abs() < 1e-9
    }
}

/// `history.csv`: one row per generation of each run.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn history_csv(search: &Search) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "seed",
        "generation",
        "evaluations",
        "best_violation",
        "best_torque",
        "generation_best_violation",
        "generation_best_torque",
        "mean_violation",
        "feasible",
        "mean_feasible_torque",
        "restarts",
        "mean_torque",
    ])?;
    for run in search.runs() {
        for row in &run.history.0 {
            let mean_torque = (row.mean_value.is_finite()).then(|| number(row.mean_value, 6));
            let mean = (row.feasible > 0).then(|| number(row.mean_feasible_value, 6));
            table.write_record([
                run.seed.to_string(),
                row.generation.to_string(),
                row.evaluations.to_string(),
                number(row.best.violation(), 6),
                number(row.best.value(), 6),
                number(row.generation_best.violation(), 6),
                number(row.generation_best.value(), 6),
                number(row.mean_violation, 6),
                row.feasible.to_string(),
                mean.unwrap_or_default(),
                row.restarts.to_string(),
                mean_torque.unwrap_or_default(),
            ])?;
        }
    }
    finish(table)
}

/// `confirmation.csv`: one row per simulated pull.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn confirmation_csv(confirmation: &Confirmation) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "regime",
        "gait",
        "duration_s",
        "objective",
        "ratio",
        "torque_n2m2s",
        "heat_s",
        "peak_of_effort",
        "peak_joint",
        "body_share_percent",
        "carried_from_percent",
        "advance_mm",
        "top_mm",
    ])?;
    for row in &confirmation.rows {
        table.write_record(cells(row))?;
    }
    finish(table)
}

fn cells(row: &Row) -> [String; 13] {
    let maybe = |value: Option<f64>, decimals| {
        let value = value.filter(|value| value.is_finite());
        value.map_or_else(String::new, |value| number(value, decimals))
    };
    [
        row.regime.to_owned(),
        row.gait.clone(),
        row.duration_s.to_string(),
        number(row.objective, 6),
        maybe(Some(row.ratio), 6),
        number(row.torque_n2m2s, 6),
        maybe(row.heat_s, 6),
        number(row.peak_of_effort, 6),
        row.peak_joint.to_owned(),
        number(row.body_share_percent, 3),
        maybe(row.carried_from_percent, 3),
        number(row.advance_mm, 3),
        number(row.top_mm, 3),
    ]
}
