//! What an experiment leaves behind: the numbers that tables, figures and report read.
//!
//! Torque here is **joint torque in the sign of the recordings**: minus the torque that the motor applies about the joint's axis, of the
//! right side, averaged over one control step. That is the sign and the averaging of the
//! published recordings.

use serde::{Deserialize, Serialize};

/// The four joints of one side whose torque is recorded, in the order of every array of four.
pub const JOINTS: [&str; 4] = ["ankle", "knee", "hip", "shoulder"];

/// The points of a planned chain, in the order of [`ChainSample::points_mm`].
pub const CHAIN_POINTS: [&str; 6] = ["toe", "ankle", "knee", "hip", "shoulder", "elbow"];

/// One closed-chain phase of one gait in simulation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PullRecord {
    /// Name of the gait.
    pub gait: String,
    /// How long the phase lasts, s.
    pub duration_s: f64,
    /// One row per control step.
    pub rows: Vec<PullRow>,
}

/// One control step of a pull.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PullRow {
    /// End of the step, s since the phase began.
    pub time_s: f64,
    /// The same in percent of the phase.
    pub cycle_percent: f64,
    /// Joint torque in that sign, N·m, in the order of [`JOINTS`].
    pub torque_nm: [f64; 4],
    /// Commanded angles, rad: [`JOINTS`], then shoulder roll and the two forearm hinges.
    pub command_rad: [f64; 7],
    /// Measured angles at the end of the step, rad, same order.
    pub angle_rad: [f64; 7],
    /// Normal contact force by [`prone::robot::ContactGroup::OF_THE_STUDY`], N, both sides, averaged.
    pub contact_n: [f64; 4],
    /// Internal squeeze of the chain, N a side: the horizontal force with which the ground pushes toes
    /// and elbows towards one another, averaged.
    pub squeeze_n: f64,
    /// Highest point of any shape at the end of the step, mm above the floor.
    pub top_mm: f64,
    /// Highest point of the head, mm above the floor.
    pub head_top_mm: f64,
}

/// The planned closed chain of one gait, sampled over the phase.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainRecord {
    /// Name of the gait.
    pub gait: String,
    /// Equally spaced from s = 0 to s = 1.
    pub samples: Vec<ChainSample>,
}

/// One instant of a planned chain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ChainSample {
    /// Phase, 0 to 1.
    pub s: f64,
    /// θ3, θ4, α, degrees.
    pub parameters_deg: [f64; 3],
    /// Toe, ankle, knee, hip, shoulder, elbow as (x, z), mm.
    pub points_mm: [(f64, f64); 6],
}

/// Cost of one gait at one duration, ours beside the published one.
#[derive(Debug, Clone, PartialEq)]
pub struct CostRecord {
    /// Name of the gait.
    pub gait: String,
    /// Duration of the phase, s.
    pub duration_s: f64,
    /// ∫ Σ τ² dt of one side, N²·m²·s, in our simulation.
    pub cost_n2m2s: f64,
    /// The published value at that duration, where there is one.
    pub published_n2m2s: Option<f64>,
}

/// What else was measured in a pull.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Name of the gait.
    pub gait: String,
    /// Duration of the phase, s.
    pub duration_s: f64,
    /// How far the trunk moved forward in the phase, mm.
    pub advance_mm: f64,
    /// How far it moved to the left, mm.
    pub lateral_mm: f64,
    /// Highest point of any shape in the phase, mm.
    pub top_mm: f64,
    /// Highest point of the head in the phase, mm.
    pub head_top_mm: f64,
}

/// A joint that a gait asked for more than its limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ClampRecord {
    /// Name of the gait.
    pub gait: String,
    /// The manufacturer's name of the joint.
    pub joint: String,
    /// In how many samples it was stopped at the limit.
    pub samples: usize,
    /// Of how many.
    pub of_samples: usize,
    /// First of them, percent of the phase.
    pub from_percent: f64,
    /// Last of them, percent of the phase.
    pub to_percent: f64,
    /// The largest amount cut off, degrees, negative at the lower limit.
    pub largest_deg: f64,
}
