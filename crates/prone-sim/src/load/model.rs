//! Reads bodies, hinges, shapes and sites out of the engine's compiled model.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use mujoco_rs::prelude::*;

use prone::frames::{Link, Point, Transform};
use prone::robot::{Body, BodyId, ContactGroup, Joint, JointId, Range, Shape, Solid};
use prone_files::model_file::ModelFile;

use super::{LoadError, bounds, foreign, label};
use crate::engine_numbers::{WORLD_BODY, collides, robot_body, rotation};

/// What the model says; drives and contact groups are still to be filled in.
pub(super) struct Parts {
    pub(super) bodies: Vec<Body>,
    pub(super) joints: Vec<Joint>,
    pub(super) shapes: Vec<Shape>,
    pub(super) sites: BTreeMap<String, Site>,
    /// Pairs of hinges that an equality keeps at the same angle.
    pub(super) tied: Vec<[JointId; 2]>,
}

/// A named place of the robot, and what is measured there.
pub(super) struct Site {
    pub(super) at: (BodyId, Point<Link>),
    pub(super) link_from_axes: DQuat,
    pub(super) accelerometer: bool,
    pub(super) gyroscope: bool,
}

/// Reads a compiled model. The engine's body 0 is the world and its joint 0 the free one: ours start
/// after them.
pub(super) fn read(model: &MjModel, file: &ModelFile) -> Result<Parts, LoadError> {
    let refused = |message| LoadError::Model {
        file: file.file().to_owned(),
        message,
    };
    let parts = parts(model).map_err(refused)?;
    bounds::check(model, file)?;
    Ok(parts)
}

fn parts(model: &MjModel) -> Result<Parts, String> {
    check_root(model)?;
    let mut joints = Vec::new();
    let mut bodies = Vec::new();
    for index in 1..model.body_parentid().len() {
        let joint = read_joint(model, index, &mut joints)?;
        bodies.push(read_body(model, index, joint)?);
    }
    foreign::check(model)?;
    Ok(Parts {
        bodies,
        joints,
        shapes: read_shapes(model)?,
        sites: read_sites(model),
        tied: read_ties(model),
    })
}

fn check_root(model: &MjModel) -> Result<(), String> {
    let parents = model.body_parentid().iter().skip(1);
    let count = parents.filter(|&&parent| parent == WORLD_BODY).count();
    let floats = model.jnt_type().first() == Some(&MjtJoint::mjJNT_FREE);
    if count == 1 && floats {
        return Ok(());
    }
    let found = if count == 1 {
        "its body has none".to_owned()
    } else {
        format!("it holds {count} bodies")
    };
    Err(format!(
        "the world must hold exactly one body, with a free joint; {found}"
    ))
}

fn read_body(model: &MjModel, index: usize, joint: Option<JointId>) -> Result<Body, String> {
    let parent = robot_body(model.body_parentid()[index]);
    let parent_from_body = match parent {
        // Where the model's file puts the root in the world is of no interest.
        None => Transform::translation(DVec3::ZERO),
        Some(_) => Transform::new(
            rotation(model.body_quat()[index]).normalize(),
            DVec3::from_array(model.body_pos()[index]),
        ),
    };
    Ok(Body {
        name: name(model, MjtObjBase::mjOBJ_BODY, index, "body")?,
        parent,
        parent_from_body,
        joint,
        mass: model.body_mass()[index],
        centre_of_mass: Point::new(DVec3::from_array(model.body_ipos()[index])),
        contact_group: ContactGroup::Torso,
    })
}

fn read_joint(
    model: &MjModel,
    body: usize,
    joints: &mut Vec<Joint>,
) -> Result<Option<JointId>, String> {
    let count = model.body_jntnum()[body];
    let Ok(index) = usize::try_from(model.body_jntadr()[body]) else {
        return Ok(None);
    };
    let kind = model.jnt_type()[index];
    if body == 1 && count == 1 && kind == MjtJoint::mjJNT_FREE {
        return Ok(None);
    }
    if count != 1 || kind != MjtJoint::mjJNT_HINGE {
        let body = name(model, MjtObjBase::mjOBJ_BODY, body, "body")?;
        return Err(format!("body {body} must be fixed or move by one hinge"));
    }
    let name = name(model, MjtObjBase::mjOBJ_JOINT, index, "joint")?;
    if !model.jnt_limited()[index] {
        return Err(format!("joint {name} has no range"));
    }
    let [lower, upper] = model.jnt_range()[index];
    let id = JointId(joints.len());
    joints.push(Joint {
        name,
        body: BodyId(body - 1),
        axis: DVec3::from_array(model.jnt_axis()[index]),
        anchor: Point::new(DVec3::from_array(model.jnt_pos()[index])),
        range: Range { lower, upper },
        effort_limit: 0.0,
        speed_limit: 0.0,
        servo_stiffness: 0.0,
        motor: None,
    });
    Ok(Some(id))
}

fn read_shapes(model: &MjModel) -> Result<Vec<Shape>, String> {
    let mut shapes = Vec::new();
    for (index, &kind) in model.geom_type().iter().enumerate() {
        let Some(body) = robot_body(model.geom_bodyid()[index]) else {
            continue;
        };
        if !collides(model, index) {
            continue;
        }
        let geom = label(model, MjtObjBase::mjOBJ_GEOM, index);
        let [x, y, z] = model.geom_size()[index];
        let solid = match kind {
            MjtGeomBase::mjGEOM_SPHERE => Solid::Sphere { radius: x },
            MjtGeomBase::mjGEOM_CAPSULE => Solid::Capsule {
                radius: x,
                half_length: y,
            },
            MjtGeomBase::mjGEOM_CYLINDER => Solid::Cylinder {
                radius: x,
                half_length: y,
            },
            MjtGeomBase::mjGEOM_ELLIPSOID => Solid::Ellipsoid {
                half_axes: DVec3::new(x, y, z),
            },
            MjtGeomBase::mjGEOM_BOX => Solid::Cuboid {
                half_edges: DVec3::new(x, y, z),
            },
            _ => {
                return Err(format!(
                    "geom {geom}: only spheres, capsules, ellipsoids, cylinders and boxes may collide"
                ));
            }
        };
        shapes.push(Shape {
            name: geom,
            body,
            link_from_geom: Transform::new(
                rotation(model.geom_quat()[index]).normalize(),
                DVec3::from_array(model.geom_pos()[index]),
            ),
            solid,
        });
    }
    Ok(shapes)
}

fn read_sites(model: &MjModel) -> BTreeMap<String, Site> {
    let mut sites = BTreeMap::new();
    for (index, &body) in model.site_bodyid().iter().enumerate() {
        let name = model.id_to_name(MjtObjBase::mjOBJ_SITE, index);
        let (Some(body), Some(name)) = (robot_body(body), name) else {
            continue;
        };
        let has = |wanted| {
            let mut sensors = model.sensor_type().iter().zip(model.sensor_objid());
            sensors.any(|(&kind, &site)| kind == wanted && usize::try_from(site) == Ok(index))
        };
        let point = Point::new(DVec3::from_array(model.site_pos()[index]));
        let site = Site {
            at: (body, point),
            link_from_axes: rotation(model.site_quat()[index]).normalize(),
            accelerometer: has(MjtSensor::mjSENS_ACCELEROMETER),
            gyroscope: has(MjtSensor::mjSENS_GYRO),
        };
        sites.insert(name.to_owned(), site);
    }
    sites
}

/// Equalities that are on and say that one hinge has the angle of another.
fn read_ties(model: &MjModel) -> Vec<[JointId; 2]> {
    // The engine's joint 0 is the free one.
    let hinge = |id: i32| Some(JointId(usize::try_from(id).ok()?.checked_sub(1)?));
    let same_angle = [0.0, 1.0, 0.0, 0.0, 0.0];
    let mut ties = Vec::new();
    for (index, kind) in model.eq_type().iter().enumerate() {
        let polynomial = &model.eq_data()[index][..same_angle.len()];
        let is_tie = *kind == MjtEq::mjEQ_JOINT
            && model.eq_active0()[index]
            && polynomial == same_angle.as_slice();
        let pair = hinge(model.eq_obj1id()[index]).zip(hinge(model.eq_obj2id()[index]));
        if let (true, Some((one, other))) = (is_tie, pair) {
            ties.push([one, other]);
        }
    }
    ties
}

fn name(model: &MjModel, kind: MjtObjBase, index: usize, word: &str) -> Result<String, String> {
    let name = model.id_to_name(kind, index).map(str::to_owned);
    name.ok_or_else(|| format!("{word} number {index} has no name"))
}
