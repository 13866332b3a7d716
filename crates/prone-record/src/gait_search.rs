//! What a search of pulls leaves behind: `result.json`, `history.csv`, `confirmation.csv`.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use crate::curves_info::CurvesInfo;
use crate::search::{Search, SeededRun};
use crate::tables::{columns, maybe, number};

/// What a search found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Name of the gait.
    pub gait: String,
    /// What it is made of.
    pub curves: CurvesInfo,
    /// Its cost.
    #[serde(flatten)]
    pub cost: PullCost,
    /// Unit of the torque part.
    pub unit: Cow<'static, str>,
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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
    /// Share of the normal force on trunk, head and legs, percent.
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
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refusal {
    /// Contact regime.
    pub regime: Cow<'static, str>,
    /// Name of the gait.
    pub gait: String,
    /// Why.
    pub reason: String,
}

/// The found gait against another in one regime.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// Contact regime.
    pub regime: Cow<'static, str>,
    /// The other gait.
    pub against: String,
    /// Durations at which the found gait costs less.
    pub cheaper_at: usize,
    /// Durations at which both were simulated.
    pub of: usize,
    /// Lowest ratio of found to other, where there is one.
    pub best_ratio: Option<f64>,
    /// Highest ratio of found to other, where there is one.
    pub worst_ratio: Option<f64>,
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
        let (Some(best), Some(worst)) = (best_ratio, worst_ratio) else {
            return format!("{regime}: not compared with {against}.");
        };
        format!(
            "{regime}: {best:.3} to {worst:.3} of {against}, cheaper at {cheaper_at} of {of} durations."
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
pub fn history_csv<'s>(search: &'s Search) -> Result<Vec<u8>, csv::Error> {
    let generations = |run: &'s SeededRun| run.history.0.iter().map(move |it| (run.seed, it));
    columns(
        search.runs().iter().flat_map(generations),
        [
            ("seed", &|(seed, _)| seed.to_string()),
            ("generation", &|(_, it)| it.generation.to_string()),
            ("evaluations", &|(_, it)| it.evaluations.to_string()),
            ("best_violation", &|(_, it)| number(it.best.violation(), 6)),
            ("best_torque", &|(_, it)| number(it.best.value(), 6)),
            ("generation_best_violation", &|(_, it)| {
                number(it.generation_best.violation(), 6)
            }),
            ("generation_best_torque", &|(_, it)| {
                number(it.generation_best.value(), 6)
            }),
            ("mean_violation", &|(_, it)| number(it.mean_violation, 6)),
            ("feasible", &|(_, it)| it.feasible.to_string()),
            ("mean_feasible_torque", &|(_, it)| {
                maybe(Some(it.mean_feasible_value).filter(|_| it.feasible > 0), 6)
            }),
            ("restarts", &|(_, it)| it.restarts.to_string()),
            ("mean_torque", &|(_, it)| maybe(finite(it.mean_value), 6)),
        ],
    )
}

/// `confirmation.csv`: one row per simulated pull.
pub fn confirmation_csv(confirmation: &Confirmation) -> Result<Vec<u8>, csv::Error> {
    columns(
        &confirmation.rows,
        [
            ("regime", &|it: &&Row| it.regime.to_owned()),
            ("gait", &|it| it.gait.clone()),
            ("duration_s", &|it| it.duration_s.to_string()),
            ("objective", &|it| number(it.objective, 6)),
            ("ratio", &|it| maybe(finite(it.ratio), 6)),
            ("torque_n2m2s", &|it| number(it.torque_n2m2s, 6)),
            ("heat_s", &|it| maybe(it.heat_s.and_then(finite), 6)),
            ("peak_of_effort", &|it| number(it.peak_of_effort, 6)),
            ("peak_joint", &|it| it.peak_joint.to_owned()),
            ("body_share_percent", &|it| number(it.body_share_percent, 3)),
            ("carried_from_percent", &|it| {
                maybe(it.carried_from_percent.and_then(finite), 3)
            }),
            ("advance_mm", &|it| number(it.advance_mm, 3)),
            ("top_mm", &|it| number(it.top_mm, 3)),
        ],
    )
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}
