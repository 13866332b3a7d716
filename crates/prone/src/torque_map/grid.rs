//! A regular grid over (θ3, θ4, α).
//!
//! Order of the nodes: α outermost, θ3, θ4 innermost, each ascending,
//!
//! ```text
//! index = (i_α n_θ3 + i_θ3) n_θ4 + i_θ4
//! ```

use crate::chain::GaitParameters;

use super::{EDGE_TOLERANCE, TorqueGap};

/// Equally spaced values, ascending, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    low: f64,
    high: f64,
    nodes: usize,
}

/// Why numbers make no grid.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum GridError {
    /// Fewer than two nodes, or limits that do not ascend.
    #[error("{nodes} nodes from {low} to {high} rad make no axis: it takes two or more, ascending")]
    Axis {
        /// First value, rad.
        low: f64,
        /// Last value, rad.
        high: f64,
        /// Number of values.
        nodes: usize,
    },
    /// Number of rows and nodes differ.
    #[error("{rows} rows for a grid of {nodes} nodes")]
    Rows {
        /// Rows given.
        rows: usize,
        /// Nodes of the grid.
        nodes: usize,
    },
}

impl Axis {
    /// `nodes` values from `low` to `high`, rad.
    ///
    /// # Errors
    /// [`GridError::Axis`].
    pub fn new(low: f64, high: f64, nodes: usize) -> Result<Self, GridError> {
        if nodes >= 2 && low < high && (high - low).is_finite() {
            Ok(Self { low, high, nodes })
        } else {
            Err(GridError::Axis { low, high, nodes })
        }
    }

    /// Smallest value, rad.
    pub const fn low(&self) -> f64 {
        self.low
    }

    /// Largest value, rad.
    pub const fn high(&self) -> f64 {
        self.high
    }

    /// Number of values.
    #[expect(
        clippy::len_without_is_empty,
        reason = "an axis has at least two nodes"
    )]
    pub const fn len(&self) -> usize {
        self.nodes
    }

    /// Distance of neighbours, rad.
    pub fn step(&self) -> f64 {
        (self.high - self.low) / (self.nodes - 1) as f64
    }

    /// The value at a node, rad; exact at both ends.
    pub fn value(&self, node: usize) -> f64 {
        let share = node as f64 / (self.nodes - 1) as f64;
        self.low * (1.0 - share) + self.high * share
    }

    /// Node below and place between it and the next, 0 to 1; `None` outside the tolerance.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the place is in 0..=nodes-1, and truncating is the floor"
    )]
    fn locate(&self, value: f64) -> Option<(usize, f64)> {
        if !(self.low - EDGE_TOLERANCE..=self.high + EDGE_TOLERANCE).contains(&value) {
            return None;
        }
        let last = (self.nodes - 1) as f64;
        let place = ((value - self.low) / self.step()).clamp(0.0, last);
        let node = (place as usize).min(self.nodes - 2);
        Some((node, place - node as f64))
    }
}

/// A regular grid over the gait parameters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// θ3.
    pub knee: Axis,
    /// θ4.
    pub hip: Axis,
    /// α.
    pub upper_arm: Axis,
}

impl Grid {
    /// Number of nodes.
    #[expect(
        clippy::len_without_is_empty,
        reason = "a grid has at least eight nodes"
    )]
    pub const fn len(&self) -> usize {
        self.knee.nodes * self.hip.nodes * self.upper_arm.nodes
    }

    /// Index of a node, given its places along θ3, θ4 and α.
    pub const fn index(&self, knee: usize, hip: usize, upper_arm: usize) -> usize {
        (upper_arm * self.knee.nodes + knee) * self.hip.nodes + hip
    }

    /// Gait parameters of a node.
    pub fn node(&self, index: usize) -> GaitParameters {
        let (rest, hip) = (index / self.hip.nodes, index % self.hip.nodes);
        GaitParameters {
            knee: self.knee.value(rest % self.knee.nodes),
            hip: self.hip.value(hip),
            upper_arm: self.upper_arm.value(rest / self.knee.nodes),
        }
    }

    /// Indices in the order of the original's files: α, θ3, θ4 nested as here, with α and θ4
    /// descending.
    pub fn recorded_order(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.upper_arm.nodes).rev().flat_map(move |arm| {
            (0..self.knee.nodes).flat_map(move |knee| {
                (0..self.hip.nodes)
                    .rev()
                    .map(move |hip| self.index(knee, hip, arm))
            })
        })
    }

    /// The eight corners of the cell around a posture and their weights, which sum to 1.
    ///
    /// # Errors
    /// [`TorqueGap::Outside`] beyond [`EDGE_TOLERANCE`]; NaN is outside.
    pub fn corners(&self, at: GaitParameters) -> Result<[(usize, f64); 8], TorqueGap> {
        let along = |name, axis: &Axis, value| {
            axis.locate(value).ok_or(TorqueGap::Outside {
                axis: name,
                value,
                low: axis.low,
                high: axis.high,
            })
        };
        let (knee, u) = along("theta3", &self.knee, at.knee)?;
        let (hip, v) = along("theta4", &self.hip, at.hip)?;
        let (arm, w) = along("alpha", &self.upper_arm, at.upper_arm)?;
        let place = [u, v, w];
        Ok(std::array::from_fn(|corner| {
            let upper = [corner & 1, (corner >> 1) & 1, (corner >> 2) & 1];
            let weight = (0..3)
                .map(|axis| match upper[axis] {
                    1 => place[axis],
                    _ => 1.0 - place[axis],
                })
                .product();
            (
                self.index(knee + upper[0], hip + upper[1], arm + upper[2]),
                weight,
            )
        }))
    }
}
