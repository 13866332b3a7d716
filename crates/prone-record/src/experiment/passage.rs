//! Whether a robot gets under a ceiling.

use serde::{Deserialize, Serialize};

use super::{GaitText, RobotText};

/// Cycles crawled under a ceiling, and a search where none of them fits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassageExperiment {
    /// Which robot.
    pub robot: RobotText,
    /// The cycles that are tried, in order.
    pub cycles: Vec<PassageCycle>,
    /// Height of the ceiling above the floor, mm.
    pub ceiling_mm: f64,
    /// How long the plate is, m, within [`PassageExperiment::LENGTHS_M`].
    pub length_m: f64,
    /// Distance that has to stay between robot and ceiling where everything is as in the model, mm.
    pub margin_mm: f64,
    /// Whether one is searched where none fits.
    pub search: Option<PassageSearch>,
}

/// A cycle, and where it comes from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassageCycle {
    /// Its file.
    pub gait: GaitText,
    /// As it was called: a name or a path.
    pub called: String,
    /// `shipped` or `file`.
    pub origin: String,
}

impl PassageExperiment {
    /// Shortest and longest plate, m.
    pub const LENGTHS_M: (f64, f64) = (0.1, 20.0);
}

/// A search of a lower cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PassageSearch {
    /// Its seed.
    pub seed: u64,
    /// Most evaluations.
    pub budget: u64,
}
