//! Bounds on a robot's numbers: far from any robot, near enough to find a wrong unit.

use mujoco_rs::prelude::*;

use super::model::label;
use super::problem::ModelProblem;

/// Largest length and coordinate, m.
pub(super) const LENGTH: f64 = 10.0;
/// Largest mass of a body, kg.
const MASS: f64 = 1e3;
/// Largest moment of inertia of a body, kg·m²: the largest mass at the largest length.
const INERTIA: f64 = MASS * LENGTH * LENGTH;
/// Largest angle of a posture, an offset or a moved stop, rad: a turn.
pub(super) const ANGLE: f64 = std::f64::consts::TAU;
/// Largest effort limit of a joint, N·m.
pub(super) const EFFORT: f64 = 1e3;
/// Largest speed limit of a joint, rad/s.
pub(super) const SPEED: f64 = 1e3;
/// Largest velocity gain of a servo, N·m·s/rad.
pub(super) const GAIN: f64 = 1e4;
/// Largest gear ratio.
pub(super) const RATIO: f64 = 1e5;
/// Largest noise and bias of an accelerometer, m/s²: what a saturated part reads, 10 g.
pub(super) const ACCELERATION: f64 = 100.0;
/// Largest noise and bias of a gyroscope, rad/s.
pub(super) const TURN_RATE: f64 = 10.0;
/// Largest torque of a motor at its shaft, N·m.
pub(super) const SHAFT_TORQUE: f64 = 1e3;
/// Largest speed of a motor's shaft, turns per minute.
pub(super) const SHAFT_SPEED: f64 = 1e6;

/// Checks lengths, masses and inertias of a compiled model.
pub(super) fn check(model: &MjModel) -> Result<(), ModelProblem> {
    let bodies = Items {
        model,
        kind: MjtObjBase::mjOBJ_BODY,
        word: "body",
    };
    // The world is body 0, and where the root is in it does not matter.
    bodies.within(
        "pos",
        model.body_pos().iter().enumerate().skip(2),
        LENGTH,
        "m",
    )?;
    bodies.within(
        "centre of mass",
        model.body_ipos().iter().enumerate(),
        LENGTH,
        "m",
    )?;
    bodies.within(
        "inertia",
        model.body_inertia().iter().enumerate(),
        INERTIA,
        "kg·m²",
    )?;
    let masses: Vec<[f64; 1]> = model.body_mass().iter().map(|&mass| [mass]).collect();
    bodies.within("mass", masses.iter().enumerate(), MASS, "kg")?;
    let joints = Items {
        model,
        kind: MjtObjBase::mjOBJ_JOINT,
        word: "joint",
    };
    joints.within("pos", model.jnt_pos().iter().enumerate(), LENGTH, "m")?;
    let geoms = Items {
        model,
        kind: MjtObjBase::mjOBJ_GEOM,
        word: "geom",
    };
    geoms.within("pos", model.geom_pos().iter().enumerate(), LENGTH, "m")?;
    geoms.within("size", model.geom_size().iter().enumerate(), LENGTH, "m")?;
    let sites = Items {
        model,
        kind: MjtObjBase::mjOBJ_SITE,
        word: "site",
    };
    sites.within("pos", model.site_pos().iter().enumerate(), LENGTH, "m")
}

/// Things of one kind, by index.
struct Items<'a> {
    model: &'a MjModel,
    kind: MjtObjBase,
    word: &'static str,
}

impl Items<'_> {
    fn within<'v, const N: usize>(
        &self,
        what: &'static str,
        values: impl Iterator<Item = (usize, &'v [f64; N])>,
        largest: f64,
        unit: &'static str,
    ) -> Result<(), ModelProblem> {
        for (index, vector) in values {
            // A NaN is in no range.
            let bound = -largest..=largest;
            if let Some(&value) = vector.iter().find(|value| !bound.contains(value)) {
                return Err(ModelProblem::OutOfBounds {
                    kind: self.word,
                    name: label(self.model, self.kind, index),
                    what,
                    value,
                    largest,
                    unit,
                });
            }
        }
        Ok(())
    }
}
