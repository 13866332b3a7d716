//! Whether the engine's compiled model keeps to the bounds on a robot's numbers.

use mujoco_rs::prelude::*;

use prone::robot::bounds::{INERTIA, LENGTH, MASS};

use super::problem::{ModelProblem, label};

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
