//! Whether the engine's compiled model keeps to the bounds on a robot's numbers.

use mujoco_rs::prelude::*;

use prone::robot::bounds::{INERTIA, LENGTH, MASS};

use super::label;

/// Checks lengths, masses and inertias of a compiled model; a refusal is a message.
pub(super) fn check(model: &MjModel) -> Result<(), String> {
    let within =
        |(kind, word), what, values: &[f64], width: usize, (largest, unit): (f64, &str)| {
            // A NaN is in no range.
            let bound = -largest..=largest;
            let Some(place) = values.iter().position(|value| !bound.contains(value)) else {
                return Ok(());
            };
            let (name, value) = (label(model, kind, place / width), values[place]);
            Err(format!(
                "{word} {name}: {what} {value} {unit} is outside -{largest}..{largest} {unit}"
            ))
        };
    let body = (MjtObjBase::mjOBJ_BODY, "body");
    let joint = (MjtObjBase::mjOBJ_JOINT, "joint");
    let geom = (MjtObjBase::mjOBJ_GEOM, "geom");
    let site = (MjtObjBase::mjOBJ_SITE, "site");
    let (length, mass, inertia) = ((LENGTH, "m"), (MASS, "kg"), (INERTIA, "kg·m²"));
    // The world is body 0, and where the root is in it does not matter.
    let mut positions = model.body_pos().to_vec();
    positions[..2].fill([0.0; 3]);
    within(body, "pos", positions.as_flattened(), 3, length)?;
    let centres = model.body_ipos().as_flattened();
    within(body, "centre of mass", centres, 3, length)?;
    let inertias = model.body_inertia().as_flattened();
    within(body, "inertia", inertias, 3, inertia)?;
    within(body, "mass", model.body_mass(), 1, mass)?;
    within(joint, "pos", model.jnt_pos().as_flattened(), 3, length)?;
    within(geom, "pos", model.geom_pos().as_flattened(), 3, length)?;
    within(geom, "size", model.geom_size().as_flattened(), 3, length)?;
    within(site, "pos", model.site_pos().as_flattened(), 3, length)
}
