//! The objective of the published optimisation, to the digit.
//!
//! A gait is three cubics over the phase, their constant terms fixed by the start; 101 samples,
//! dt = 0.01, T = 1 s (Bell 2015, master's thesis, NYU Polytechnic, chapter IV):
//!
//! ```text
//! p(s) = ((c3 s + c2) s + c1) s + c0,     s_k = k/100, k = 0…100
//! cost = Σ_k [ τ2² + τ3² + τ4² + 5 τ5² ] dt + 10⁵ · dt · (violated samples)       (1)
//! ```
//!
//! Five rules are counted separately at each sample, so that one sample can count five times:
//! α increased since the sample before; the hip centre lies below a height; θ3, θ4, α lie
//! strictly outside the extreme values of the table's columns as printed. A chain that does not
//! close has no hip, which counts as a hip below the height.
//!
//! **The published rule of look-up** ([`PublishedObjective::torques`]), unlike that of
//! [`crate::torque_map`]: trilinear; outside the table each angle is clamped to its edge; no row
//! is masked; a row without torques takes those of its θ4 neighbour, the next smaller one first.
//!
//! The price keeps (1) in parts: counts, torque, and an *excess* that says by how much the rules
//! are broken. The published cost ignores the excess; a search may be guided by it.

mod coefficients;
mod kernel;
mod sin_cos;

pub use coefficients::{Coefficients, END, FREE, START};

use crate::chain::{ClosedChain, GaitParameters};

use crate::torque_map::{Grid, JointTorques, TorqueMap};

/// Samples of a phase.
pub const SAMPLES: usize = 101;
/// Time between samples, s; the phase takes 1 s.
pub const TIME_STEP: f64 = 0.01;
/// Cost of one violated sample: 10⁵ dt.
pub const VIOLATION_COST: f64 = 1e5 * TIME_STEP;
/// Weights of τ2², τ3², τ4², τ5²: the shoulder motor is 3 to 4 times weaker.
pub const WEIGHTS: [f64; 4] = [1.0, 1.0, 1.0, 5.0];

/// Where the problem may be varied.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PublishedRules {
    /// Least height of the hip centre, m.
    pub hip_threshold: f64,
    /// How far outside the table's limits an angle may lie, rad.
    pub limit_tolerance: f64,
}

impl PublishedRules {
    /// As published: 40 mm, no tolerance. Its fixed end points break both.
    pub const PUBLISHED: Self = Self {
        hip_threshold: 0.040,
        limit_tolerance: 0.0,
    };
}

/// Violated samples per rule.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ViolatedSamples {
    /// α increased since the sample before.
    pub arm_returns: u32,
    /// The hip centre is too low, or the chain does not close.
    pub hip_low: u32,
    /// θ3 outside the table.
    pub knee_range: u32,
    /// θ4 outside the table.
    pub hip_range: u32,
    /// α outside the table.
    pub arm_range: u32,
}

impl ViolatedSamples {
    /// All of them: one sample can count five times.
    pub const fn total(&self) -> u32 {
        self.arm_returns + self.hip_low + self.knee_range + self.hip_range + self.arm_range
    }
}

/// The price of a gait, in parts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PublishedPrice {
    /// Broken rules, counted.
    pub violated: ViolatedSamples,
    /// By how much the rules are broken, summed over rules and samples: radians for angles, and
    /// [`EXCESS_PER_METRE`] for the hip. Zero exactly when nothing is violated.
    pub excess: f64,
    /// Σ [τ2² + τ3² + τ4² + 5 τ5²] dt, N²·m²·s.
    pub torque: f64,
}

/// A hip 100 mm too low weighs as much as an angle 1 rad outside.
pub const EXCESS_PER_METRE: f64 = 10.0;

impl PublishedPrice {
    /// Equation (1).
    pub fn cost(&self) -> f64 {
        self.torque + VIOLATION_COST * f64::from(self.violated.total())
    }
}

/// Why a map cannot serve the published objective.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("row {row} of the map has no torques, and neither have its theta4 neighbours")]
pub struct PublishedError {
    /// Index of that row in the grid's order.
    pub row: usize,
}

/// The published objective on a table.
#[derive(Debug, Clone, PartialEq)]
pub struct PublishedObjective {
    chain: ClosedChain,
    rules: PublishedRules,
    grid: Grid,
    /// The grid's axes θ3, θ4, α, made ready for look-ups.
    ladders: [kernel::Ladder; 3],
    /// [τ2, τ3, τ4, τ5] per node, without gaps.
    table: Vec<[f64; 4]>,
    /// `s_k`.
    phases: [f64; SAMPLES],
}

impl PublishedObjective {
    /// The objective of a chain on a map.
    ///
    /// # Errors
    /// [`PublishedError`] where a row without torques has no neighbour to borrow from.
    pub fn new(
        chain: ClosedChain,
        map: &TorqueMap,
        rules: PublishedRules,
    ) -> Result<Self, PublishedError> {
        let grid = *map.grid();
        Ok(Self {
            chain,
            rules,
            grid,
            ladders: [grid.knee, grid.hip, grid.upper_arm].map(|axis| kernel::Ladder::new(&axis)),
            table: without_gaps(map)?,
            phases: std::array::from_fn(|k| k as f64 / (SAMPLES - 1) as f64),
        })
    }

    /// The rules.
    pub const fn rules(&self) -> PublishedRules {
        self.rules
    }

    /// Torques by the published rule of look-up; always an answer.
    pub fn torques(&self, at: GaitParameters) -> JointTorques {
        JointTorques::from_array(self.look_up(at.knee, at.hip, at.upper_arm))
    }

    /// Prices a gait of finite coefficients.
    pub fn price(&self, gait: &Coefficients) -> PublishedPrice {
        let path = kernel::Path::new(&self.phases, gait);
        let hip_height = path.hip_heights(&self.chain);
        let (violated, excess) = self.violations(&path, &hip_height);
        let squares = path.samples().map(|[knee, hip, arm]| {
            let torques = self.look_up(knee, hip, arm);
            (0..4)
                .map(|joint| WEIGHTS[joint] * torques[joint] * torques[joint])
                .sum::<f64>()
        });
        PublishedPrice {
            violated,
            excess,
            torque: squares.sum::<f64>() * TIME_STEP,
        }
    }
}

fn without_gaps(map: &TorqueMap) -> Result<Vec<[f64; 4]>, PublishedError> {
    let hips = map.grid().hip.len();
    let recorded = |row: usize| map.rows()[row].recorded();
    (0..map.rows().len())
        .map(|row| {
            let below = || (row % hips > 0).then(|| recorded(row - 1)).flatten();
            let above = || (row % hips + 1 < hips).then(|| recorded(row + 1)).flatten();
            recorded(row)
                .or_else(below)
                .or_else(above)
                .map(JointTorques::to_array)
                .ok_or(PublishedError { row })
        })
        .collect()
}

#[cfg(test)]
mod tests;
