//! Whether parts of the robot would go through one another in a cycle's plan.

use prone::gait::cycle::{CheckedCycle, CycleError};
use prone::robot::JointAngles;

use crate::self_collision::{SelfCollision, SelfCollisionError};
use crate::world::World;

/// Time between two postures that are looked at for parts in one another, s.
const LIMB_STEP: f64 = 0.02;
/// How deep parts may be in one another, m.
const DEEP: f64 = 1e-3;

/// Why the parts of the robot do not keep clear of one another in a cycle.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum LimbsError {
    /// The way back cannot be planned.
    #[error(transparent)]
    Cycle(#[from] CycleError),
    /// Two parts would go through one another, which the simulation does not keep them from.
    #[error(
        "cycle {cycle}: {} and {} would be {depth_mm:.1} mm in one another, {place}",
        shapes.0, shapes.1
    )]
    Through {
        /// The cycle's name.
        cycle: String,
        /// Names of the two shapes.
        shapes: (String, String),
        /// How deep, mm.
        depth_mm: f64,
        /// In the pull or the recovery, and when.
        place: String,
    },
    /// The parts cannot be compared.
    #[error(transparent)]
    SelfCollision(#[from] SelfCollisionError),
}

/// Looks whether parts of the robot go through one another in a cycle's plan.
///
/// # Errors
/// [`LimbsError::Through`] with the deepest place; a millimetre is not deep, as a model's shapes are
/// rounder than its robot.
pub fn check_limbs(world: &World, checked: &CheckedCycle) -> Result<(), LimbsError> {
    let times = |seconds: f64| {
        let count = (seconds / LIMB_STEP).ceil().max(1.0);
        (0..)
            .map(f64::from)
            .take_while(move |k| *k <= count)
            .map(move |k| seconds * k / count)
    };
    let pull = checked.pull_seconds();
    let path = checked.recovery_after(checked)?;
    let forth: Vec<f64> = times(pull).collect();
    let back: Vec<f64> = times(checked.recovery_seconds()).collect();
    let pulled = forth.iter().map(|&time| checked.pull_at(time));
    let recovered = back.iter().map(|&time| path.at(time));
    let postures: Vec<JointAngles> = pulled.chain(recovered).collect();
    let nearest = SelfCollision::new(world)?.scan(&postures)?;
    if nearest.distance_m >= -DEEP {
        return Ok(());
    }
    let place = match nearest.index.checked_sub(forth.len()) {
        None => format!("{:.2} s into the pull", forth[nearest.index]),
        Some(index) => format!("{:.2} s into the recovery", back[index]),
    };
    Err(LimbsError::Through {
        cycle: checked.name().to_owned(),
        shapes: nearest.shapes,
        depth_mm: -nearest.distance_m * 1e3,
        place,
    })
}
