//! Bodies, joints and shapes of a document.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use prone::frames::{Frame, Transform};
use prone::motor::check_speed;
use prone::robot::{Body, BodyId, ContactGroup, Joint, Motor, Range, Robot, Shape, Solid, bounds};

use super::names::{Names, body_name, joint_name};
use super::place::{Place, Violation, optional};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyDocument {
    pub(super) name: String,
    #[serde(deserialize_with = "Option::deserialize")]
    parent: Option<String>,
    pub(super) parent_from_body: PoseDocument,
    #[serde(deserialize_with = "Option::deserialize")]
    joint: Option<String>,
    mass_kg: f64,
    pub(super) centre_of_mass_m: [f64; 3],
    #[serde(with = "ContactGroupName")]
    contact_group: ContactGroup,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "ContactGroup", rename_all = "lowercase")]
enum ContactGroupName {
    Toe,
    Elbow,
    Torso,
    Leg,
    Head,
    Hand,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointDocument {
    pub(super) name: String,
    body: String,
    axis: [f64; 3],
    pub(super) anchor_m: [f64; 3],
    range_rad: [f64; 2],
    effort_limit_nm: f64,
    speed_limit_rad_s: f64,
    servo_stiffness_nm_rad: f64,
    #[serde(deserialize_with = "Option::deserialize")]
    motor: Option<MotorDocument>,
}

/// A geared motor; torques and speed are those at the joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MotorDocument {
    ratio: f64,
    nominal_nm: f64,
    stall_nm: f64,
    #[serde(deserialize_with = "Option::deserialize")]
    no_load_speed_rad_s: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ShapeDocument {
    pub(super) name: String,
    body: String,
    pub(super) link_from_geom: PoseDocument,
    solid: SolidDocument,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
enum SolidDocument {
    Sphere { radius_m: f64 },
    Capsule { radius_m: f64, half_length_m: f64 },
    Ellipsoid { half_axes_m: [f64; 3] },
    Cylinder { radius_m: f64, half_length_m: f64 },
    Cuboid { half_edges_m: [f64; 3] },
}

/// A rigid motion: where the source's origin is, and its rotation with the real part first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoseDocument {
    pub(super) position_m: [f64; 3],
    quaternion_wxyz: [f64; 4],
}

impl BodyDocument {
    pub(super) fn new(robot: &Robot, body: &Body) -> Self {
        Self {
            name: body.name.clone(),
            parent: body.parent.map(|id| body_name(robot, id)),
            parent_from_body: PoseDocument::new(&body.parent_from_body),
            joint: body.joint.map(|id| joint_name(robot, id)),
            mass_kg: body.mass,
            centre_of_mass_m: body.centre_of_mass.metres().to_array(),
            contact_group: body.contact_group,
        }
    }

    pub(super) fn read(
        &self,
        at: Place<'_>,
        index: usize,
        names: &Names<'_>,
    ) -> Result<Body, Violation> {
        let parent = self.parent(at.key("parent"), index, names)?;
        let pose_at = at.key("parent_from_body");
        let parent_from_body = self.parent_from_body.read(pose_at)?;
        if parent.is_none() && parent_from_body != Transform::translation(DVec3::ZERO) {
            return Err(pose_at.violation("the root has no parent to be moved or turned in"));
        }
        let joint_at = at.key("joint");
        let joint = match &self.joint {
            Some(joint) if parent.is_none() => {
                let message = format!("the root floats and is not moved by {joint:?}");
                return Err(joint_at.violation(message));
            }
            joint => optional(joint.as_ref(), |joint| names.joint(joint_at, joint))?,
        };
        let mass = at.key("mass_kg");
        Ok(Body {
            name: at.key("name").name(&self.name)?,
            parent,
            parent_from_body,
            joint,
            mass: mass.within(self.mass_kg, 0.0..=bounds::MASS)?,
            centre_of_mass: at.key("centre_of_mass_m").point(self.centre_of_mass_m)?,
            contact_group: self.contact_group,
        })
    }

    /// Parents come before their children, so there is no circle.
    fn parent(
        &self,
        at: Place<'_>,
        child: usize,
        names: &Names<'_>,
    ) -> Result<Option<BodyId>, Violation> {
        match &self.parent {
            None if child == 0 => Ok(None),
            None => Err(at.violation("only the first body is the root")),
            Some(name) => match names.body(at, name)? {
                parent if parent.0 < child => Ok(Some(parent)),
                _ => Err(at.violation(format!("{name:?} does not come before its child"))),
            },
        }
    }
}

/// Checks that bodies and joints name one another.
pub(super) fn check_moved(at: Place<'_>, robot: &Robot) -> Result<(), Violation> {
    let (bodies, joints) = (at.key("bodies"), at.key("joints"));
    bodies.each(&robot.bodies, |at, index, body| {
        let Some(joint) = body.joint.map(|id| &robot.joints[id.0]) else {
            return Ok(());
        };
        if joint.body == BodyId(index) {
            return Ok(());
        }
        let moved = &robot.bodies[joint.body.0].name;
        let message = format!("{:?} moves {moved:?}, not {:?}", joint.name, body.name);
        Err(at.key("joint").violation(message))
    })?;
    joints.each(&robot.joints, |at, index, joint| {
        let body = &robot.bodies[joint.body.0];
        let mover = match body.joint {
            Some(id) if id.0 == index => return Ok(()),
            Some(id) => format!("{:?}", robot.joints[id.0].name),
            None => "no joint".to_owned(),
        };
        let message = format!("{:?} is moved by {mover}, not {:?}", body.name, joint.name);
        Err(at.key("body").violation(message))
    })?;
    Ok(())
}

impl JointDocument {
    pub(super) fn new(robot: &Robot, joint: &Joint) -> Self {
        Self {
            name: joint.name.clone(),
            body: body_name(robot, joint.body),
            axis: joint.axis.to_array(),
            anchor_m: joint.anchor.metres().to_array(),
            range_rad: ends(joint.range),
            effort_limit_nm: joint.effort_limit,
            speed_limit_rad_s: joint.speed_limit,
            servo_stiffness_nm_rad: joint.servo_stiffness,
            motor: joint.motor.as_ref().map(MotorDocument::new),
        }
    }

    pub(super) fn read(&self, at: Place<'_>, names: &Names<'_>) -> Result<Joint, Violation> {
        let positive = |key, value, largest| at.key(key).positive(value, largest);
        let range = at.key("range_rad");
        let joint = Joint {
            motor: optional(self.motor.as_ref(), |motor| motor.read(at.key("motor")))?,
            name: at.key("name").name(&self.name)?,
            body: names.body(at.key("body"), &self.body)?,
            axis: at.key("axis").direction(self.axis)?,
            anchor: at.key("anchor_m").point(self.anchor_m)?,
            range: range.range(self.range_rad, bounds::STOP)?,
            effort_limit: positive("effort_limit_nm", self.effort_limit_nm, bounds::EFFORT)?,
            speed_limit: positive("speed_limit_rad_s", self.speed_limit_rad_s, bounds::SPEED)?,
            servo_stiffness: positive(
                "servo_stiffness_nm_rad",
                self.servo_stiffness_nm_rad,
                bounds::STIFFNESS,
            )?,
        };
        let speed = at.key("speed_limit_rad_s");
        check_speed(&joint).map_err(|too_fast| speed.violation(too_fast))?;
        Ok(joint)
    }
}

impl MotorDocument {
    const fn new(motor: &Motor) -> Self {
        Self {
            ratio: motor.ratio,
            nominal_nm: motor.nominal,
            stall_nm: motor.stall,
            no_load_speed_rad_s: motor.no_load_speed,
        }
    }

    /// The bounds are those of the motor's shaft, behind the gear.
    fn read(&self, at: Place<'_>) -> Result<Motor, Violation> {
        let ratio = at.key("ratio").positive(self.ratio, bounds::RATIO)?;
        let torque = bounds::SHAFT_TORQUE * ratio;
        let speed = bounds::SHAFT_SPEED * TAU / 60.0 / ratio;
        let no_load = at.key("no_load_speed_rad_s");
        Ok(Motor {
            ratio,
            nominal: at.key("nominal_nm").positive(self.nominal_nm, torque)?,
            stall: at.key("stall_nm").positive(self.stall_nm, torque)?,
            no_load_speed: optional(self.no_load_speed_rad_s, |it| no_load.positive(it, speed))?,
        })
    }
}

impl ShapeDocument {
    pub(super) fn new(robot: &Robot, shape: &Shape) -> Self {
        Self {
            name: shape.name.clone(),
            body: body_name(robot, shape.body),
            link_from_geom: PoseDocument::new(&shape.link_from_geom),
            solid: SolidDocument::new(shape.solid),
        }
    }

    pub(super) fn read(&self, at: Place<'_>, names: &Names<'_>) -> Result<Shape, Violation> {
        Ok(Shape {
            name: at.key("name").name(&self.name)?,
            body: names.body(at.key("body"), &self.body)?,
            link_from_geom: self.link_from_geom.read(at.key("link_from_geom"))?,
            solid: self.solid.read(at.key("solid"))?,
        })
    }
}

impl SolidDocument {
    const fn new(solid: Solid) -> Self {
        match solid {
            Solid::Sphere { radius } => Self::Sphere { radius_m: radius },
            Solid::Capsule {
                radius,
                half_length,
            } => Self::Capsule {
                radius_m: radius,
                half_length_m: half_length,
            },
            Solid::Ellipsoid { half_axes } => Self::Ellipsoid {
                half_axes_m: half_axes.to_array(),
            },
            Solid::Cylinder {
                radius,
                half_length,
            } => Self::Cylinder {
                radius_m: radius,
                half_length_m: half_length,
            },
            Solid::Cuboid { half_edges } => Self::Cuboid {
                half_edges_m: half_edges.to_array(),
            },
        }
    }

    fn read(&self, at: Place<'_>) -> Result<Solid, Violation> {
        let length = |kind, key, metres| at.key(kind).key(key).length(metres);
        let lengths = |kind, key, metres| at.key(kind).key(key).lengths(metres);
        Ok(match *self {
            Self::Sphere { radius_m } => Solid::Sphere {
                radius: length("sphere", "radius_m", radius_m)?,
            },
            Self::Capsule {
                radius_m,
                half_length_m,
            } => Solid::Capsule {
                radius: length("capsule", "radius_m", radius_m)?,
                half_length: length("capsule", "half_length_m", half_length_m)?,
            },
            Self::Ellipsoid { half_axes_m } => Solid::Ellipsoid {
                half_axes: lengths("ellipsoid", "half_axes_m", half_axes_m)?,
            },
            Self::Cylinder {
                radius_m,
                half_length_m,
            } => Solid::Cylinder {
                radius: length("cylinder", "radius_m", radius_m)?,
                half_length: length("cylinder", "half_length_m", half_length_m)?,
            },
            Self::Cuboid { half_edges_m } => Solid::Cuboid {
                half_edges: lengths("cuboid", "half_edges_m", half_edges_m)?,
            },
        })
    }
}

impl PoseDocument {
    pub(super) fn new<A: Frame, B: Frame>(pose: &Transform<A, B>) -> Self {
        let DQuat { x, y, z, w } = pose.rotation();
        Self {
            position_m: pose.origin().metres().to_array(),
            quaternion_wxyz: [w, x, y, z],
        }
    }

    pub(super) fn read<A: Frame, B: Frame>(
        &self,
        at: Place<'_>,
    ) -> Result<Transform<A, B>, Violation> {
        let position = at.key("position_m").point::<A>(self.position_m)?;
        let [w, x, y, z] = self.quaternion_wxyz;
        let turn = DQuat::from_xyzw(x, y, z, w);
        at.key("quaternion_wxyz")
            .unit("quaternion", turn.length())?;
        Ok(Transform::new(turn, position.metres()))
    }
}

/// Both ends of a range.
pub(super) const fn ends(range: Range) -> [f64; 2] {
    [range.lower, range.upper]
}
