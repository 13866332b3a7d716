//! What a model may not say, because it belongs to the program: the floor, what holds on to it,
//! and the servos.

use mujoco_rs::prelude::*;

use super::label;
use crate::engine_numbers::WORLD_BODY as WORLD;

/// Checks a compiled model for anything beside the robot; a refusal is a message.
pub(super) fn check(model: &MjModel) -> Result<(), String> {
    if let Some(geom) = model.geom_bodyid().iter().position(|&body| body == WORLD) {
        let geom = label(model, MjtObjBase::mjOBJ_GEOM, geom);
        return Err(format!(
            "geom {geom} belongs to the world; the floor is added by the program"
        ));
    }
    let floor_touches = |(&contype, &conaffinity): (&i32, &i32)| (contype | conaffinity) & 1 == 1;
    let mut geoms = model.geom_contype().iter().zip(model.geom_conaffinity());
    if !geoms.any(floor_touches) {
        return Err("no geom can touch the floor: none has conaffinity 1 or contype 1".to_owned());
    }
    check_equalities(model)?;
    // Two body numbers of 16 bits each.
    let of_world = |&pair: &i32| pair >> 16 == WORLD || pair & 0xffff == WORLD;
    if let Some(exclude) = model.exclude_signature().iter().position(of_world) {
        let exclude = label(model, MjtObjBase::mjOBJ_EXCLUDE, exclude);
        return Err(format!(
            "exclude {exclude} keeps a body from touching the world"
        ));
    }
    check_joints(model)
}

fn check_equalities(model: &MjModel) -> Result<(), String> {
    for (index, &kind) in model.eq_objtype().iter().enumerate() {
        let ends = [model.eq_obj1id()[index], model.eq_obj2id()[index]];
        let tied = ends.into_iter().any(|id| match kind {
            MjtObjBase::mjOBJ_BODY => id == WORLD,
            MjtObjBase::mjOBJ_SITE => {
                usize::try_from(id).is_ok_and(|site| model.site_bodyid()[site] == WORLD)
            }
            _ => false,
        });
        if tied {
            let equality = label(model, MjtObjBase::mjOBJ_EQUALITY, index);
            return Err(format!("equality {equality} ties the robot to the world"));
        }
    }
    Ok(())
}

fn check_joints(model: &MjModel) -> Result<(), String> {
    // Joint 0 is the free one.
    for index in 1..model.jnt_type().len() {
        let joint = || label(model, MjtObjBase::mjOBJ_JOINT, index);
        let settings = [
            (model.jnt_actfrclimited()[index], "actuatorfrcrange"),
            (model.jnt_actgravcomp()[index], "actuatorgravcomp"),
        ];
        if let Some((_, setting)) = settings.into_iter().find(|(set, _)| *set) {
            return Err(format!(
                "joint {} has {setting}; what servos do is set by the program, from robot.toml",
                joint()
            ));
        }
        let address = usize::try_from(model.jnt_qposadr()[index]).ok();
        let reference = address.map_or(f64::NAN, |address| model.qpos0()[address]);
        if reference.is_nan() || reference.abs() > 0.0 {
            return Err(format!(
                "joint {} has ref {reference} rad; it must be 0: the zero pose is the standing one",
                joint()
            ));
        }
    }
    Ok(())
}
