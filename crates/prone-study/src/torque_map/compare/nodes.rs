//! The nodes that two grids have in common.

use prone::torque_map::{Axis, EDGE_TOLERANCE, Grid};

/// Neither grid lies within the other, node on node.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "neither grid lies within the other, node on node: the first has {first}, the second {second}"
)]
pub struct GridsDiffer {
    /// The first grid, in words.
    first: String,
    /// The second.
    second: String,
}

/// Indices in both grids of every node that they share, in the order of the smaller one. One must
/// lie within the other; nodes closer than [`EDGE_TOLERANCE`] are the same.
pub(super) fn common(first: &Grid, second: &Grid) -> Result<Vec<(usize, usize)>, GridsDiffer> {
    if let Some(places) = within(first, second) {
        return Ok(places.into_iter().enumerate().collect());
    }
    let places = within(second, first).ok_or_else(|| GridsDiffer {
        first: words(first),
        second: words(second),
    })?;
    let pairs = places.into_iter().enumerate();
    Ok(pairs.map(|(second, first)| (first, second)).collect())
}

/// For every node of the inner grid its index in the outer one; `None` where one has none.
fn within(inner: &Grid, outer: &Grid) -> Option<Vec<usize>> {
    let knees = places(&inner.knee, &outer.knee)?;
    let hips = places(&inner.hip, &outer.hip)?;
    let arms = places(&inner.upper_arm, &outer.upper_arm)?;
    let mut indices = Vec::with_capacity(inner.len());
    for &arm in &arms {
        for &knee in &knees {
            indices.extend(hips.iter().map(|&hip| outer.index(knee, hip, arm)));
        }
    }
    Some(indices)
}

fn places(inner: &Axis, outer: &Axis) -> Option<Vec<usize>> {
    let place = |value: f64| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates, and the node is checked"
        )]
        let node = ((value - outer.low()) / outer.step()).round() as usize;
        let found = node < outer.len() && (outer.value(node) - value).abs() <= EDGE_TOLERANCE;
        found.then_some(node)
    };
    (0..inner.len())
        .map(|node| place(inner.value(node)))
        .collect()
}

fn words(grid: &Grid) -> String {
    let axes = [
        ("theta3", &grid.knee),
        ("theta4", &grid.hip),
        ("alpha", &grid.upper_arm),
    ];
    let axes = axes.map(|(name, axis)| {
        let [low, high, step] = [axis.low(), axis.high(), axis.step()].map(super::degrees);
        format!("{name} {low}..{high}° by {step}°")
    });
    axes.join(", ")
}
