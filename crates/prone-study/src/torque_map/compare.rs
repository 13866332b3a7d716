//! Two torque maps, joint by joint, and where they part.
//!
//! Compared are the nodes that both grids have, one of which must lie within the other, and of
//! those the rows that have torques in both. Beside the mean square, which a few rows in another
//! contact mode decide, stand the median and the ninth tenth of the |differences|.

mod nodes;

pub use nodes::GridsDiffer;

use serde::Serialize;

use prone::torque_map::{Mask, RecordedMap, Row};

use prone_record::pulls::JOINTS;
use prone_record::statistics::{correlation, rms};

/// What came out of a comparison of a first file, `a`, with a second, `b`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// Rows of each file.
    pub rows: Sides<usize>,
    /// Nodes that both grids have.
    pub common_nodes: usize,
    /// Nodes that have torques in both.
    pub compared: usize,
    /// Common nodes without torques, by reason, in each file; one without in both counts in both.
    pub masked: Sides<MaskCounts>,
    /// Contact modes; `None` where no compared row has them in both files.
    pub modes: Option<Modes>,
    /// Ankle, knee, hip, shoulder.
    pub joints: Vec<JointDifference>,
    /// Rows with the largest differences, the largest first.
    pub worst: Vec<WorstRow>,
}

/// One thing of each file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Sides<T> {
    /// Of the first.
    pub a: T,
    /// Of the second.
    pub b: T,
}

/// Rows by [`Mask`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct MaskCounts {
    /// [`Mask::Missing`].
    pub missing: usize,
    /// [`Mask::Mirrored`].
    pub mirrored: usize,
    /// [`Mask::Open`].
    pub open: usize,
    /// [`Mask::Failed`].
    pub failed: usize,
}

/// How often the same groups carry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Modes {
    /// Compared rows whose contact forces are known in both files.
    pub known: usize,
    /// Those of them in which the same groups carry.
    pub same: usize,
}

/// Difference of one joint's torque over all compared rows.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct JointDifference {
    /// One of [`JOINTS`].
    pub joint: &'static str,
    /// Pearson's correlation; `None` where one of the two does not vary.
    pub correlation: Option<f64>,
    /// Root of the mean squared difference, N·m.
    pub rms_nm: f64,
    /// Median of |difference|, N·m.
    pub median_nm: f64,
    /// Nine tenths of the |differences| are not larger, N·m.
    pub percentile_90_nm: f64,
}

/// One row that differs much.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorstRow {
    /// θ3, degrees.
    pub theta3_deg: f64,
    /// θ4, degrees.
    pub theta4_deg: f64,
    /// α, degrees.
    pub alpha_deg: f64,
    /// The joint that differs most.
    pub joint: &'static str,
    /// Torques of all four joints, N·m.
    pub torques_nm: Sides<[f64; 4]>,
    /// Torque of that joint in a minus that in b, N·m.
    pub difference_nm: f64,
    /// Which groups carry, such as `toe+elbow`; `None` where the file does not say.
    pub carrying: Sides<Option<String>>,
}

/// Why two maps cannot be compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CompareError {
    /// Neither grid lies within the other.
    #[error(transparent)]
    Grids(#[from] GridsDiffer),
    /// Every common row is masked in one file or the other.
    #[error("none of the {nodes} common rows has torques in both files")]
    NothingLeft {
        /// Nodes that both grids have.
        nodes: usize,
    },
}

/// Torques of both files at one node.
struct Pair {
    /// Row in the first and in the second map.
    at: (usize, usize),
    a: [f64; 4],
    b: [f64; 4],
}

/// Compares two maps; `worst` is how many of the worst rows are kept.
pub fn compare(a: &RecordedMap, b: &RecordedMap, worst: usize) -> Result<Comparison, CompareError> {
    let common = nodes::common(a.map().grid(), b.map().grid())?;
    let rows = |file: &RecordedMap, row: usize| file.map().rows()[row];
    let mut pairs = Vec::new();
    let mut masked = Sides {
        a: MaskCounts::default(),
        b: MaskCounts::default(),
    };
    for &at in &common {
        match (rows(a, at.0), rows(b, at.1)) {
            (Row::Torques(a), Row::Torques(b)) => pairs.push(Pair {
                at,
                a: a.to_array(),
                b: b.to_array(),
            }),
            (in_a, in_b) => {
                masked.a.count(&in_a);
                masked.b.count(&in_b);
            }
        }
    }
    if pairs.is_empty() {
        let nodes = common.len();
        return Err(CompareError::NothingLeft { nodes });
    }
    Ok(Comparison {
        rows: Sides {
            a: a.map().grid().len(),
            b: b.map().grid().len(),
        },
        common_nodes: common.len(),
        compared: pairs.len(),
        masked,
        modes: modes(a, b, &pairs),
        joints: (0..JOINTS.len())
            .map(|joint| difference(&pairs, joint))
            .collect(),
        worst: worst_rows(a, b, pairs, worst),
    })
}

impl MaskCounts {
    fn count(&mut self, row: &Row) {
        let Row::Masked { mask, .. } = row else {
            return;
        };
        let count = match mask {
            Mask::Missing => &mut self.missing,
            Mask::Mirrored => &mut self.mirrored,
            Mask::Open => &mut self.open,
            Mask::Failed => &mut self.failed,
        };
        *count += 1;
    }

    /// Every mask with its count.
    pub const fn by_mask(&self) -> [(Mask, usize); 4] {
        [
            (Mask::Missing, self.missing),
            (Mask::Mirrored, self.mirrored),
            (Mask::Open, self.open),
            (Mask::Failed, self.failed),
        ]
    }
}

impl Pair {
    /// a − b of one joint, N·m.
    fn difference(&self, joint: usize) -> f64 {
        self.a[joint] - self.b[joint]
    }

    /// The joint that differs most; the first of equals.
    fn worst_joint(&self) -> usize {
        let size = |joint: &usize| self.difference(*joint).abs();
        (1..JOINTS.len()).fold(0, |worst, joint| {
            if size(&joint) > size(&worst) {
                joint
            } else {
                worst
            }
        })
    }
}

fn difference(pairs: &[Pair], joint: usize) -> JointDifference {
    let torques: Vec<(f64, f64)> = pairs
        .iter()
        .map(|pair| (pair.a[joint], pair.b[joint]))
        .collect();
    let mut errors: Vec<f64> = torques.iter().map(|(a, b)| (a - b).abs()).collect();
    errors.sort_by(f64::total_cmp);
    JointDifference {
        joint: JOINTS[joint],
        correlation: correlation(&torques),
        rms_nm: rms(&torques),
        median_nm: quantile(&errors, 0.5),
        percentile_90_nm: quantile(&errors, 0.9),
    }
}

/// The value below which a share of the sorted values lies, linear between neighbours; NaN of none.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = share * last as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to last"
    )]
    let below = (place as usize).min(last);
    let part = place - below as f64;
    sorted[below] * (1.0 - part) + sorted[(below + 1).min(last)] * part
}

fn modes(a: &RecordedMap, b: &RecordedMap, pairs: &[Pair]) -> Option<Modes> {
    let mut modes = Modes { known: 0, same: 0 };
    for pair in pairs {
        if let (Some(a), Some(b)) = (a.contacts()[pair.at.0], b.contacts()[pair.at.1]) {
            modes.known += 1;
            modes.same += usize::from(a.carrying().eq(b.carrying()));
        }
    }
    (modes.known > 0).then_some(modes)
}

fn worst_rows(
    a: &RecordedMap,
    b: &RecordedMap,
    mut pairs: Vec<Pair>,
    count: usize,
) -> Vec<WorstRow> {
    let size = |pair: &Pair| pair.difference(pair.worst_joint()).abs();
    // Stable: rows that differ as much stay in the grid's order.
    pairs.sort_by(|one, other| size(other).total_cmp(&size(one)));
    let carrying = |file: &RecordedMap, row: usize| file.contacts()[row].map(|at| at.to_string());
    let rows = pairs.iter().take(count).map(|pair| {
        let node = a.map().grid().node(pair.at.0);
        let joint = pair.worst_joint();
        WorstRow {
            theta3_deg: degrees(node.knee),
            theta4_deg: degrees(node.hip),
            alpha_deg: degrees(node.upper_arm),
            joint: JOINTS[joint],
            torques_nm: Sides {
                a: pair.a,
                b: pair.b,
            },
            difference_nm: pair.difference(joint),
            carrying: Sides {
                a: carrying(a, pair.at.0),
                b: carrying(b, pair.at.1),
            },
        }
    });
    rows.collect()
}

/// Degrees to a hundredth: files of five digits are no nearer to their nodes.
fn degrees(radians: f64) -> f64 {
    // Adding zero takes the sign from a negative one.
    (radians.to_degrees() * 100.0).round() / 100.0 + 0.0
}

#[cfg(test)]
mod tests;
