//! Joint torques over the gait parameters: where they come from, and a table of them.
//!
//! A [`TorqueSource`] answers the question "what do ankle, knee, hip and shoulder of one side
//! hold in this posture?" or says why it cannot. The statics, the engine and a [`TorqueMap`] are
//! such sources.
//!
//! A map is a regular [`Grid`] over (θ3, θ4, α) with one row of torques, or the reason why there
//! is none, per node. Between nodes it interpolates linearly along each axis (trilinear): with
//! u, v, w ∈ [0, 1] the place inside the cell and `τ_abc` the torques of its corners,
//!
//! ```text
//! τ = Σ_{a,b,c ∈ {0,1}} u_a v_b w_c τ_abc,   u_0 = 1 − u, u_1 = u, and so on
//! ```
//!
//! A corner of weight zero is not asked: on a node, edge or face only the corners that count
//! matter. Outside the grid by more than [`EDGE_TOLERANCE`], or next to a masked row, the answer
//! is a [`TorqueGap`], never a neighbour's value; only [`crate::cost::published`] looks up by
//! another rule, and names it.

mod csv;
mod grid;
mod recorded;

pub use csv::{COLUMNS, ParseError, comments, parse, parse_recorded, write};
pub use grid::{Axis, Grid, GridError};
pub use recorded::{CARRYING_SHARE, ContactForces, RecordedMap};

use crate::chain::{ClosureError, GaitParameters};

/// How far outside the grid a question may lie and still be answered by its edge, rad.
///
/// The tables print five digits, so their α = −90° reads −1.5708, 4·10⁻⁶ off.
pub const EDGE_TOLERANCE: f64 = 1e-4;

/// Torques of one side's four loaded joints, N·m, in the source's sign.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointTorques {
    /// τ2.
    pub ankle: f64,
    /// τ3.
    pub knee: f64,
    /// τ4.
    pub hip: f64,
    /// τ5.
    pub shoulder: f64,
}

impl JointTorques {
    /// [τ2, τ3, τ4, τ5].
    pub const fn to_array(self) -> [f64; 4] {
        [self.ankle, self.knee, self.hip, self.shoulder]
    }

    /// From [τ2, τ3, τ4, τ5].
    pub const fn from_array([ankle, knee, hip, shoulder]: [f64; 4]) -> Self {
        Self {
            ankle,
            knee,
            hip,
            shoulder,
        }
    }
}

/// Anything that knows the torques of a posture.
pub trait TorqueSource: Sync {
    /// Torques of one side in the posture that closes the chain with these parameters.
    ///
    /// # Errors
    /// [`TorqueGap`] where the source has no answer; the posture is then infeasible, not free.
    fn torques(&self, at: GaitParameters) -> Result<JointTorques, TorqueGap>;
}

impl<Source: TorqueSource + ?Sized> TorqueSource for &Source {
    fn torques(&self, at: GaitParameters) -> Result<JointTorques, TorqueGap> {
        (**self).torques(at)
    }
}

/// Why a source has no torques for a posture.
#[derive(Debug, thiserror::Error)]
pub enum TorqueGap {
    /// Beyond the edge of the map.
    #[error("{axis} = {value:.4} rad is outside the map's {low:.4}..{high:.4}")]
    Outside {
        /// The axis that is left, as the tables call it.
        axis: &'static str,
        /// The value asked for, rad.
        value: f64,
        /// Smallest value of the map, rad.
        low: f64,
        /// Largest value of the map, rad.
        high: f64,
    },
    /// A corner of the cell has no usable torques.
    #[error("row {row} of the map, a corner of this cell, is masked: {mask}")]
    Masked {
        /// Its index in the grid's order.
        row: usize,
        /// Why it is masked.
        mask: Mask,
    },
    /// The chain does not close there.
    #[error(transparent)]
    Closure(#[from] ClosureError),
    /// The source itself failed.
    #[error("the torque source failed: {0}")]
    Source(#[source] Box<dyn std::error::Error + Send + Sync>),
}

/// Why a row of a map is not to be used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
pub enum Mask {
    /// No torques were recorded.
    #[error("no torques were recorded")]
    Missing,
    /// Recorded with the leg mirrored below the floor (θ1 < 0 < θ2).
    #[error("it was recorded with the leg mirrored below the floor")]
    Mirrored,
    /// The chain does not close there.
    #[error("the chain does not close there")]
    Open,
    /// The source failed there.
    #[error("the source had no torques there")]
    Failed,
}

/// What a map holds at one node of its grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Row {
    /// Torques to use.
    Torques(JointTorques),
    /// Torques that were recorded and are wrong, or none.
    Masked {
        /// Why.
        mask: Mask,
        /// What the record says nevertheless; the published objective used it.
        recorded: Option<JointTorques>,
    },
}

impl Mask {
    /// All masks, in the order of summaries.
    pub const ALL: [Self; 4] = [Self::Missing, Self::Mirrored, Self::Open, Self::Failed];

    /// One word for tables and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Missing => "missing",
            Self::Mirrored => "mirrored",
            Self::Open => "open",
            Self::Failed => "failed",
        }
    }
}

impl Row {
    /// What was recorded, masked or not.
    pub const fn recorded(&self) -> Option<JointTorques> {
        match self {
            Self::Torques(torques) => Some(*torques),
            Self::Masked { recorded, .. } => *recorded,
        }
    }
}

/// Torques on a regular grid over (θ3, θ4, α).
#[derive(Debug, Clone, PartialEq)]
pub struct TorqueMap {
    grid: Grid,
    rows: Vec<Row>,
}

impl TorqueMap {
    /// A map of rows in the grid's order.
    ///
    /// # Errors
    /// [`GridError::Rows`] where their number is not the grid's.
    pub fn new(grid: Grid, rows: Vec<Row>) -> Result<Self, GridError> {
        if rows.len() == grid.len() {
            Ok(Self { grid, rows })
        } else {
            Err(GridError::Rows {
                rows: rows.len(),
                nodes: grid.len(),
            })
        }
    }

    /// Asks a source at every node, one after the other.
    pub fn measure(grid: Grid, source: &impl TorqueSource) -> Self {
        let rows = (0..grid.len())
            .map(|index| row_of(source, grid.node(index)))
            .collect();
        Self { grid, rows }
    }

    /// The grid.
    pub const fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Rows in the grid's order.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Number of rows per mask.
    pub fn masked(&self, mask: Mask) -> usize {
        let is = |row: &&Row| matches!(row, Row::Masked { mask: m, .. } if *m == mask);
        self.rows.iter().filter(is).count()
    }
}

/// One row of a map: a source's answer, or the reason why there is none.
pub fn row_of(source: &impl TorqueSource, at: GaitParameters) -> Row {
    let mask = match source.torques(at) {
        Ok(torques) => return Row::Torques(torques),
        Err(TorqueGap::Closure(_)) => Mask::Open,
        Err(TorqueGap::Masked { mask, .. }) => mask,
        Err(TorqueGap::Outside { .. } | TorqueGap::Source(_)) => Mask::Failed,
    };
    Row::Masked {
        mask,
        recorded: None,
    }
}

impl TorqueSource for TorqueMap {
    fn torques(&self, at: GaitParameters) -> Result<JointTorques, TorqueGap> {
        let mut sum = [0.0; 4];
        for (row, weight) in self.grid.corners(at)? {
            if weight == 0.0 {
                continue;
            }
            match self.rows[row] {
                Row::Torques(torques) => {
                    for (total, torque) in sum.iter_mut().zip(torques.to_array()) {
                        *total += weight * torque;
                    }
                }
                Row::Masked { mask, .. } => return Err(TorqueGap::Masked { row, mask }),
            }
        }
        Ok(JointTorques::from_array(sum))
    }
}

#[cfg(test)]
mod tests;
