//! What is drawn of a search, a confirmation and a crawl: figures are drawn from these, and checked
//! before.

use prone::cost::objective::Objective;
use prone_record::gait_search::Confirmation;
use prone_record::search::Search;
use prone_record::tables::as_written;

/// What is drawn of a search: the run that found the best, generation by generation.
#[derive(Debug, Clone, PartialEq)]
pub struct SearchRecord {
    /// Of that run.
    pub seed: u64,
    /// Name of the torque part.
    pub objective: String,
    /// Its unit.
    pub unit: String,
    /// What the scores mean.
    pub scores: Scores,
    /// One by one.
    pub generations: Vec<GenerationRecord>,
}

/// One generation of a search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GenerationRecord {
    /// Its number, from 1.
    pub generation: u64,
    /// Of the best gait so far.
    pub best_violation: f64,
    /// The torque part of the best gait so far.
    pub best_value: f64,
    /// Mean of all gaits.
    pub mean_violation: f64,
    /// Mean torque part of all gaits, where it is known.
    pub mean_value: Option<f64>,
    /// The same of those that break no rule; nothing without any.
    pub mean_feasible_value: Option<f64>,
}

/// What is drawn of one simulated pull of a confirmation.
#[derive(Debug, Clone, PartialEq)]
pub struct ConfirmedRecord {
    /// Contact regime.
    pub regime: String,
    /// Name of the gait.
    pub gait: String,
    /// Duration of the pull, s.
    pub duration_s: f64,
    /// What the search minimised, over that of the first gait; nothing where that is not known.
    pub ratio: Option<f64>,
}

/// The range that a joint swept on a crawling robot, as it was published.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PublishedRange {
    /// Smallest and largest angle, rad.
    pub angles: (f64, f64),
    /// How it was obtained: a sentence of a caption.
    pub obtained: &'static str,
}

/// What the scores of a search mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scores {
    /// Violated samples, and a torque part.
    Published,
    /// Excesses, and a torque part that only feasible gaits are compared by.
    Graded,
}

impl SearchRecord {
    /// The best run of a search, to the digits of `history.csv`; nothing where none has a gait.
    pub fn from_search(search: &Search, objective: &Objective, scores: Scores) -> Option<Self> {
        let (run, _) = search.best()?;
        let written = |value: f64| as_written(value, 6);
        let finite = |value: f64| Some(written(value)).filter(|value| value.is_finite());
        let generations = run.history.0.iter().map(|row| GenerationRecord {
            generation: row.generation,
            best_violation: written(row.best.violation()),
            best_value: written(row.best.value()),
            mean_violation: written(row.mean_violation),
            mean_value: finite(row.mean_value),
            mean_feasible_value: (row.feasible > 0).then(|| written(row.mean_feasible_value)),
        });
        Some(Self {
            seed: run.seed,
            objective: objective.name().to_owned(),
            unit: objective.unit().to_owned(),
            scores,
            generations: generations.collect(),
        })
    }
}

impl ConfirmedRecord {
    /// What is drawn of every row of a confirmation.
    pub fn from_confirmation(confirmation: &Confirmation) -> Vec<Self> {
        let rows = confirmation.rows.iter().map(|row| Self {
            regime: row.regime.to_owned(),
            gait: row.gait.clone(),
            duration_s: row.duration_s,
            ratio: Some(row.ratio).filter(|ratio| ratio.is_finite()),
        });
        rows.collect()
    }
}

/// What is drawn of a crawl: the first cycles of some joints.
#[derive(Debug, Clone, PartialEq)]
pub struct AngleRecord {
    /// Name of the cycle.
    pub gait: String,
    /// Names of the joints, in the order of the rows.
    pub joints: Vec<String>,
    /// Of the first cycles.
    pub rows: Vec<AngleRow>,
    /// How many cycles these are.
    pub cycles: usize,
    /// Where they were recorded, if they were not simulated.
    pub not_simulated: Option<String>,
}

/// One instant.
#[derive(Debug, Clone, PartialEq)]
pub struct AngleRow {
    /// Since the first pull began, s.
    pub time_s: f64,
    /// What was commanded, rad.
    pub command_rad: Vec<f64>,
    /// What was reached, rad.
    pub angle_rad: Vec<f64>,
}

impl AngleRecord {
    /// How many cycles are shown.
    pub const CYCLES: usize = 4;
}
