//! Reads bodies, hinges, shapes and sites out of the engine's compiled model.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use mujoco_rs::prelude::*;

use prone::frames::{Geom, Link, Point, Transform};
use prone::robot::{Body, BodyId, ContactGroup, Joint, JointId, Range, Shape, Solid};

use super::problem::{ModelProblem, label};
use super::{bounds, foreign};

/// What the model says; drives and contact groups are still to be filled in.
pub(super) struct Parts {
    pub(super) bodies: Vec<Body>,
    pub(super) joints: Vec<Joint>,
    pub(super) shapes: Vec<Shape>,
    pub(super) sites: BTreeMap<String, (BodyId, Point<Link>)>,
    /// What is measured at each site that has a sensor.
    pub(super) sensors: BTreeMap<String, SiteSensors>,
}

/// The sensors at one site.
pub(super) struct SiteSensors {
    /// The sensors' axes in the site's body.
    pub(super) link_from_sensor: DQuat,
    pub(super) accelerometer: bool,
    pub(super) gyroscope: bool,
}

/// The engine's body 0 is the world and its joint 0 the free one: ours start after them.
pub(super) fn read(model: &MjModel) -> Result<Parts, ModelProblem> {
    check_root(model)?;
    let mut joints = Vec::new();
    let mut bodies = Vec::new();
    for index in 1..model.body_parentid().len() {
        let joint = read_joint(model, index, &mut joints)?;
        bodies.push(read_body(model, index, joint)?);
    }
    foreign::check(model)?;
    bounds::check(model)?;
    Ok(Parts {
        bodies,
        joints,
        shapes: read_shapes(model)?,
        sites: read_sites(model),
        sensors: read_sensors(model),
    })
}

fn check_root(model: &MjModel) -> Result<(), ModelProblem> {
    let in_world = model
        .body_parentid()
        .iter()
        .skip(1)
        .filter(|&&parent| parent == 0);
    let count = in_world.count();
    let floats = model.jnt_type().first() == Some(&MjtJoint::mjJNT_FREE);
    if count == 1 && floats {
        return Ok(());
    }
    let found = if count == 1 {
        "its body has none".to_owned()
    } else {
        format!("it holds {count} bodies")
    };
    Err(ModelProblem::Root { found })
}

fn read_body(model: &MjModel, index: usize, joint: Option<JointId>) -> Result<Body, ModelProblem> {
    let parent = usize::try_from(model.body_parentid()[index]).ok();
    let parent = parent.and_then(|parent| parent.checked_sub(1)).map(BodyId);
    let parent_from_body = match parent {
        // Where the model's file puts the root in the world is of no interest.
        None => Transform::translation(DVec3::ZERO),
        Some(_) => pose(model.body_quat()[index], model.body_pos()[index]),
    };
    Ok(Body {
        name: name(model, MjtObjBase::mjOBJ_BODY, index, "body")?,
        parent,
        parent_from_body,
        joint,
        mass: model.body_mass()[index],
        centre_of_mass: Point::new(DVec3::from_array(model.body_ipos()[index])),
        contact_group: ContactGroup::Torso,
        is_head: false,
    })
}

fn read_joint(
    model: &MjModel,
    body: usize,
    joints: &mut Vec<Joint>,
) -> Result<Option<JointId>, ModelProblem> {
    let count = model.body_jntnum()[body];
    let Ok(index) = usize::try_from(model.body_jntadr()[body]) else {
        return Ok(None);
    };
    let kind = model.jnt_type()[index];
    if body == 1 && count == 1 && kind == MjtJoint::mjJNT_FREE {
        return Ok(None);
    }
    if count != 1 || kind != MjtJoint::mjJNT_HINGE {
        return Err(ModelProblem::NotHinged {
            body: name(model, MjtObjBase::mjOBJ_BODY, body, "body")?,
        });
    }
    let name = name(model, MjtObjBase::mjOBJ_JOINT, index, "joint")?;
    if !model.jnt_limited()[index] {
        return Err(ModelProblem::Unlimited { joint: name });
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
        servo_gain: 0.0,
        motor: None,
    });
    Ok(Some(id))
}

fn read_shapes(model: &MjModel) -> Result<Vec<Shape>, ModelProblem> {
    let mut shapes = Vec::new();
    for (index, &kind) in model.geom_type().iter().enumerate() {
        let body = usize::try_from(model.geom_bodyid()[index]).ok();
        let Some(body) = body.and_then(|body| body.checked_sub(1)) else {
            continue;
        };
        if model.geom_contype()[index] == 0 && model.geom_conaffinity()[index] == 0 {
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
            _ => return Err(ModelProblem::Shape { geom }),
        };
        shapes.push(Shape {
            name: geom,
            body: BodyId(body),
            link_from_geom: geom_pose(model, index),
            solid,
        });
    }
    Ok(shapes)
}

fn geom_pose(model: &MjModel, index: usize) -> Transform<Link, Geom> {
    let pose = pose(model.geom_quat()[index], model.geom_pos()[index]);
    Transform::new(pose.rotation(), pose.origin().metres())
}

fn read_sites(model: &MjModel) -> BTreeMap<String, (BodyId, Point<Link>)> {
    let mut sites = BTreeMap::new();
    for (index, &body) in model.site_bodyid().iter().enumerate() {
        let body = usize::try_from(body)
            .ok()
            .and_then(|body| body.checked_sub(1));
        let name = model.id_to_name(MjtObjBase::mjOBJ_SITE, index);
        if let (Some(body), Some(name)) = (body, name) {
            let point = Point::new(DVec3::from_array(model.site_pos()[index]));
            sites.insert(name.to_owned(), (BodyId(body), point));
        }
    }
    sites
}

fn read_sensors(model: &MjModel) -> BTreeMap<String, SiteSensors> {
    let mut sites = BTreeMap::<String, SiteSensors>::new();
    for (kind, &site) in model.sensor_type().iter().zip(model.sensor_objid()) {
        let Ok(site) = usize::try_from(site) else {
            continue;
        };
        let Some(name) = model.id_to_name(MjtObjBase::mjOBJ_SITE, site) else {
            continue;
        };
        let sensors = sites.entry(name.to_owned()).or_insert_with(|| {
            let [w, x, y, z] = model.site_quat()[site];
            SiteSensors {
                link_from_sensor: DQuat::from_xyzw(x, y, z, w).normalize(),
                accelerometer: false,
                gyroscope: false,
            }
        });
        match kind {
            MjtSensor::mjSENS_ACCELEROMETER => sensors.accelerometer = true,
            MjtSensor::mjSENS_GYRO => sensors.gyroscope = true,
            _ => {}
        }
    }
    sites
}

fn name(
    model: &MjModel,
    kind: MjtObjBase,
    index: usize,
    word: &'static str,
) -> Result<String, ModelProblem> {
    model
        .id_to_name(kind, index)
        .map(str::to_owned)
        .ok_or(ModelProblem::Nameless { kind: word, index })
}

fn pose([w, x, y, z]: [f64; 4], position: [f64; 3]) -> Transform<Link, Link> {
    Transform::new(
        DQuat::from_xyzw(x, y, z, w).normalize(),
        DVec3::from_array(position),
    )
}
