//! Whether the engine's compiled model keeps to the bounds on a robot's numbers.

use mujoco_rs::prelude::*;

use prone::robot::bounds::{INERTIA, LENGTH, MASS};
use prone_files::FileError;
use prone_files::model_file::{ModelFile, ModelPart};

use super::label;

/// Checks lengths, masses and inertias of a compiled model.
pub(super) fn check(model: &MjModel, file: &ModelFile) -> Result<(), FileError> {
    let within = |(kind, part): (MjtObjBase, ModelPart),
                  (what, attribute),
                  values: &[f64],
                  width: usize,
                  (largest, unit): (f64, &str)| {
        // A NaN is in no range.
        let bound = -largest..=largest;
        let Some(place) = values.iter().position(|value| !bound.contains(value)) else {
            return Ok(());
        };
        let (name, value) = (label(model, kind, place / width), values[place]);
        let word = match part {
            ModelPart::Inertial => "body",
            part => part.element(),
        };
        let message =
            format!("{word} {name}: {what} {value} {unit} is outside -{largest}..{largest} {unit}");
        Err(file.error_at(part, &name, attribute, message))
    };
    let body = (MjtObjBase::mjOBJ_BODY, ModelPart::Body);
    let inertial = (MjtObjBase::mjOBJ_BODY, ModelPart::Inertial);
    let joint = (MjtObjBase::mjOBJ_JOINT, ModelPart::Joint);
    let geom = (MjtObjBase::mjOBJ_GEOM, ModelPart::Geom);
    let site = (MjtObjBase::mjOBJ_SITE, ModelPart::Site);
    let (length, mass, inertia) = ((LENGTH, "m"), (MASS, "kg"), (INERTIA, "kg·m²"));
    let pos = ("pos", "pos");
    // The world is body 0, and where the root is in it does not matter.
    let mut positions = model.body_pos().to_vec();
    positions[..2].fill([0.0; 3]);
    within(body, pos, positions.as_flattened(), 3, length)?;
    let centres = model.body_ipos().as_flattened();
    within(inertial, ("centre of mass", "pos"), centres, 3, length)?;
    let inertias = model.body_inertia().as_flattened();
    within(inertial, ("inertia", "fullinertia"), inertias, 3, inertia)?;
    within(inertial, ("mass", "mass"), model.body_mass(), 1, mass)?;
    within(joint, pos, model.jnt_pos().as_flattened(), 3, length)?;
    within(geom, pos, model.geom_pos().as_flattened(), 3, length)?;
    within(
        geom,
        ("size", "size"),
        model.geom_size().as_flattened(),
        3,
        length,
    )?;
    within(site, pos, model.site_pos().as_flattened(), 3, length)
}
