//! Searches: of pulls, and of whole cycles.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{CycleRulesChoice, GaitText, Limit, NamedGait, PullCostChoice, RobotText};
use crate::frontier::{CycleObjective, Quantity};
use crate::search::Solver;

/// Runs of a search with seeds that follow one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Runs {
    /// Seed of the first run.
    pub seed: u64,
    /// Independent runs.
    pub runs: u64,
    /// Most evaluations of each run.
    pub budget: u64,
}

impl Runs {
    /// Checks that a search of so many runs and evaluations can be carried out.
    pub fn check(&self) -> Result<(), Limit> {
        Limit::check("a search", " runs", self.runs as f64, (1.0, 1e3))?;
        Limit::check("a budget", " evaluations", self.budget as f64, (1.0, 1e9))
    }
}

/// A search of pulls: `prone optimize`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PullSearchExperiment {
    /// The robot that would pull.
    pub robot: RobotText,
    /// What pulls cost.
    pub terms: PullCostChoice,
    /// Which curves are searched.
    pub form: GaitForm,
    /// Whether θ3 and θ4 keep the base gait's ends.
    pub ends: Ends,
    /// The optimiser.
    pub solver: Solver,
    /// Its runs.
    pub runs: Runs,
    /// Most seconds of searching in all, up to [`PullSearchExperiment::LONGEST_S`].
    pub time_budget_s: Option<f64>,
    /// Name of the found gait.
    pub name: String,
    /// Gaits that the found one is compared with beside the base gait, as far as the robot can follow
    /// them.
    pub compared: Vec<GaitText>,
    /// Durations at which the found gait is simulated, s.
    pub confirm_durations_s: Vec<f64>,
}

impl PullSearchExperiment {
    /// A time budget that is none, s: thirty years.
    pub const LONGEST_S: f64 = 1e9;
    /// Most evaluations of a run where none are asked for, on statics or a map.
    pub const BUDGET: u64 = 100_000;
    /// The same where each is a simulation.
    pub const DYNAMIC_BUDGET: u64 = 3_000;
}

/// Which curves are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GaitForm {
    /// The thesis': one cubic per parameter.
    Cubic,
    /// Cubic B-splines.
    BSpline {
        /// Control points per parameter, 4 or more.
        points: usize,
    },
}

impl fmt::Display for GaitForm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cubic => f.write_str("cubic"),
            Self::BSpline { points } => write!(f, "bspline:{points}"),
        }
    }
}

/// Whether θ3 and θ4 keep the base gait's values at the ends of the phase.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Ends {
    /// They do.
    Fixed,
    /// They do not.
    Free,
}

/// A search of whole cycles: `prone optimize --source cycle`, and `prone crawl frontier`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CycleSearchExperiment {
    /// The robot that would crawl.
    pub robot: RobotText,
    /// What is minimised.
    pub objective: CycleObjective,
    /// Whether only cycles that can be steered count.
    pub steerable: bool,
    /// Whether the corners are left out: what is found is for good ground.
    pub ideal: bool,
    /// How large the box about the base is, as a share of the largest, up to
    /// [`CycleSearchExperiment::REACH`].
    pub reach: f64,
    /// Under which ceilings.
    pub under: Under,
    /// Cycles of which one is searched about under each ceiling.
    pub from: Vec<NamedGait>,
    /// Cycles that the found ones are compared with.
    pub compared: Vec<GaitText>,
    /// The runs of the optimiser.
    pub runs: Runs,
    /// Most seconds of searching in all, up to [`PullSearchExperiment::LONGEST_S`].
    pub time_budget_s: Option<f64>,
}

impl CycleSearchExperiment {
    /// Most evaluations of a run where none are asked for.
    pub const BUDGET: u64 = 1600;
}

impl CycleSearchExperiment {
    /// Least and largest share of the reach.
    pub const REACH: (f64, f64) = (0.01, 1.0);
}

/// Under which ceilings cycles are searched, and by which rules.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Under {
    /// By the usual rules, and a quantity that is held at several values: `prone crawl frontier`.
    Across {
        /// What is held.
        held: Quantity,
        /// At which values, in its unit.
        at: Vec<f64>,
        /// Distance that has to stay between robot and ceiling, mm, where ceilings are held.
        margin_mm: f64,
    },
    /// One ceiling or none, by rules that may be asked for: `prone optimize --source cycle`.
    One {
        /// The rules.
        rules: Box<CycleRulesChoice>,
        /// The cycle over whose heats those found are.
        worst_over: Option<NamedGait>,
        /// Name of the found cycle; without one it is called after the objective.
        name: Option<String>,
    },
}

/// Checks a ceiling and a margin, mm.
pub fn check_heights(ceiling_mm: f64, margin_mm: f64) -> Result<(), Limit> {
    let (_, highest) = CycleRulesChoice::LENGTHS_MM;
    let bounds = (prone::scene::LOWEST_CEILING * 1e3, highest);
    Limit::check("a ceiling", " mm", ceiling_mm, bounds)?;
    Limit::check("a margin", " mm", margin_mm, (0.0, 1e3))
}
