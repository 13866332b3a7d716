//! A robot as URDF: links, hinges, inertias, primitive shapes.
//!
//! A link's frame lies where its hinge's axis passes; where a body of the model is hinged at its own
//! origin, as all of the NAO's are, that is the body's frame, and the frames of a log's `/tf` are
//! the links of this file. URDF has no capsule and no ellipsoid: a capsule is written as a cylinder
//! and two spheres, which is the same solid, an ellipsoid as spheres inside it, whose hull is
//! nearly the ellipsoid's.
//!
//! A joint that shares its motor with others mimics the first of them. `<mujoco>` is read by
//! `MuJoCo` alone, which otherwise welds the root to its world and drops the root's mass.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use glam::{DMat3, DQuat, DVec3, EulerRot};

use prone::robot::{Body, Joint, Robot};
use prone_record::recorded::{Inertia, RecordedModel, RecordedShape};

use crate::markup::escaped;

pub mod ellipsoid;

/// Groups of the engine that are drawn: 0 to 2.
const DRAWN: std::ops::RangeInclusive<i32> = 0..=2;

/// Inertia of a link without mass.
const WEIGHTLESS: &str = "    <inertial><mass value=\"0\"/><inertia ixx=\"0\" ixy=\"0\" ixz=\"0\" \
    iyy=\"0\" iyz=\"0\" izz=\"0\"/></inertial>\n";

/// Why a record's robot has no URDF.
#[derive(Debug, thiserror::Error)]
pub enum UrdfError {
    /// The model of the record has other bodies than the compiled robot.
    #[error("the bodies of the record's model are not those of {robot}")]
    OtherBodies {
        /// Name of the compiled robot.
        robot: String,
    },
    /// The model of the record lacks the inertia of a body that has mass.
    #[error("the record does not say how hard body {body} is to turn")]
    NoInertia {
        /// Name of the body.
        body: String,
    },
    /// Links and joints are known by their names.
    #[error("two {things} of the robot are called {name:?}: URDF needs one name for each")]
    SameName {
        /// `links` or `joints`.
        things: &'static str,
        /// The name.
        name: String,
    },
    /// A link or a joint without a name.
    #[error("one of the {things} of the robot has no name: URDF needs one")]
    Nameless {
        /// `links` or `joints`.
        things: &'static str,
    },
}

/// Writes the robot of a record.
pub fn from_record(robot: &Robot, model: &RecordedModel) -> Result<String, UrdfError> {
    let names = robot.bodies.iter().map(|body| &body.name);
    if !names.eq(model.bodies.iter().map(|body| &body.name)) {
        return Err(UrdfError::OtherBodies {
            robot: robot.name.clone(),
        });
    }
    check_names("links", robot.bodies.iter().map(|body| &body.name))?;
    let hinges = check_names("joints", robot.joints.iter().map(|joint| &joint.name))?;
    let mut text = format!(
        "<?xml version=\"1.0\"?>\n<!-- Made by prone {} from its MJCF model. Ellipsoids are written \
         as spheres inside them: URDF has none. -->\n<robot name=\"{}\">\n",
        env!("CARGO_PKG_VERSION"),
        escaped(&robot.name)
    );
    text += "  <mujoco><compiler fusestatic=\"false\"/></mujoco>\n";
    materials(&mut text, model);
    for (index, (body, recorded)) in robot.bodies.iter().zip(&model.bodies).enumerate() {
        let shapes = model.shapes.iter().filter(|shape| shape.body == index);
        let shift = link_in_body(robot, body);
        let inertial = match recorded.inertia {
            // Said, as Bullet takes a link that is silent for one of 1 kg.
            _ if body.mass <= 0.0 => WEIGHTLESS.to_owned(),
            Some(inertia) => inertial(body, shift, &inertia),
            None => {
                return Err(UrdfError::NoInertia {
                    body: body.name.clone(),
                });
            }
        };
        link(&mut text, body, shift, &inertial, shapes);
    }
    for body in &robot.bodies {
        joint(&mut text, robot, body, &hinges);
    }
    Ok(text + "</robot>\n")
}

/// The first body whose link has another frame than the body itself, as it is not hinged at its own
/// origin.
pub fn shifted_link(robot: &Robot) -> Option<&Body> {
    let mut bodies = robot.bodies.iter();
    bodies.find(|body| link_in_body(robot, body) != DVec3::ZERO)
}

/// Checks that each has a name of its own, and gives the names.
fn check_names<'a>(
    things: &'static str,
    names: impl Iterator<Item = &'a String>,
) -> Result<BTreeSet<&'a str>, UrdfError> {
    let mut found = BTreeSet::new();
    for name in names {
        if name.is_empty() {
            return Err(UrdfError::Nameless { things });
        }
        if !found.insert(name.as_str()) {
            let name = name.clone();
            return Err(UrdfError::SameName { things, name });
        }
    }
    Ok(found)
}

/// Each colour that is seen, once; shapes name it.
fn materials(text: &mut String, model: &RecordedModel) {
    let drawn = model.shapes.iter();
    let drawn = drawn.filter(|shape| DRAWN.contains(&shape.group));
    let colours = drawn.map(|shape| (material(shape.colour), shape.colour));
    let colours: BTreeMap<String, [f64; 4]> = colours.collect();
    for (name, [r, g, b, a]) in colours {
        // Writing to a text does not fail.
        let _ = writeln!(
            text,
            "  <material name=\"{name}\"><color rgba=\"{r:.3} {g:.3} {b:.3} {a:.3}\"/></material>"
        );
    }
}

fn inertial(body: &Body, shift: DVec3, inertia: &Inertia) -> String {
    let turn = DMat3::from_quat(inertia.rotation);
    let tensor = turn * DMat3::from_diagonal(inertia.principal) * turn.transpose();
    let [[xx, xy, xz], [_, yy, yz], [.., zz]] = tensor.to_cols_array_2d();
    format!(
        "    <inertial>{}<mass value=\"{:.6}\"/><inertia ixx=\"{xx:.9e}\" ixy=\"{xy:.9e}\" \
         ixz=\"{xz:.9e}\" iyy=\"{yy:.9e}\" iyz=\"{yz:.9e}\" izz=\"{zz:.9e}\"/></inertial>\n",
        origin(body.centre_of_mass.metres() - shift, DQuat::IDENTITY),
        body.mass
    )
}

fn link<'a>(
    text: &mut String,
    body: &Body,
    shift: DVec3,
    inertial: &str,
    shapes: impl Iterator<Item = &'a RecordedShape>,
) {
    // Writing to a text does not fail.
    let _ = writeln!(text, "  <link name=\"{}\">", escaped(&body.name));
    *text += inertial;
    for shape in shapes {
        for (place, geometry) in solids(shape) {
            let at = shape.position + shape.rotation * place - shift;
            let place = origin(at, shape.rotation);
            if DRAWN.contains(&shape.group) {
                let _ = writeln!(
                    text,
                    "    <visual>{place}<geometry>{geometry}</geometry><material name=\"{}\"/></visual>",
                    material(shape.colour)
                );
            }
            if shape.collides {
                let _ = writeln!(
                    text,
                    "    <collision>{place}<geometry>{geometry}</geometry></collision>"
                );
            }
        }
    }
    *text += "  </link>\n";
}

fn joint(text: &mut String, robot: &Robot, body: &Body, hinges: &BTreeSet<&str>) {
    let Some(parent) = body.parent.map(|parent| &robot.bodies[parent.0]) else {
        return;
    };
    let shift = link_in_body(robot, body);
    let pose = &body.parent_from_body;
    let at = pose.origin().metres() + pose.rotation() * shift - link_in_body(robot, parent);
    let hinge = body.joint.map(|joint| &robot.joints[joint.0]);
    let (name, kind) = match hinge {
        Some(joint) => (joint.name.clone(), "revolute"),
        None => (fixed_name(&body.name, hinges), "fixed"),
    };
    let _ = writeln!(
        text,
        "  <joint name=\"{}\" type=\"{kind}\">\n    {}<parent link=\"{}\"/><child link=\"{}\"/>",
        escaped(&name),
        origin(at, pose.rotation()),
        escaped(&parent.name),
        escaped(&body.name)
    );
    if let Some(joint) = hinge {
        let _ = writeln!(
            text,
            "    <axis xyz=\"{}\"/><limit lower=\"{}\" upper=\"{}\" effort=\"{}\" velocity=\"{}\"/>",
            triple(joint.axis),
            joint.range.lower,
            joint.range.upper,
            joint.effort_limit,
            joint.speed_limit
        );
        if let Some(leader) = leader(robot, joint) {
            let _ = writeln!(
                text,
                "    <mimic joint=\"{}\" multiplier=\"1\" offset=\"0\"/>",
                escaped(&leader.name)
            );
        }
    }
    *text += "  </joint>\n";
}

/// Name of the joint that fixes a body, which no hinge has.
fn fixed_name(body: &str, hinges: &BTreeSet<&str>) -> String {
    let mut name = format!("{body}_fixed");
    while hinges.contains(name.as_str()) {
        name.push('_');
    }
    name
}

/// The joint at whose angle this one is kept, as one motor turns both; none of the first of them.
fn leader<'a>(robot: &'a Robot, joint: &Joint) -> Option<&'a Joint> {
    let mut groups = robot.shared_motors.iter();
    let place = robot.joint(&joint.name)?;
    let group = groups.find(|group| group.contains(&place))?;
    let first = *group.first()?;
    (first != place).then(|| &robot.joints[first.0])
}

/// Origin of a body's link in the body's frame: its hinge, or its own origin.
fn link_in_body(robot: &Robot, body: &Body) -> DVec3 {
    body.joint
        .map_or(DVec3::ZERO, |joint| robot.joints[joint.0].anchor.metres())
}

/// A shape as URDF's solids, each with its place along the shape's axes.
fn solids(shape: &RecordedShape) -> Vec<(DVec3, String)> {
    let sphere = |radius: f64| format!("<sphere radius=\"{radius}\"/>");
    let cylinder = |radius: f64, half: f64| {
        format!("<cylinder radius=\"{radius}\" length=\"{}\"/>", 2.0 * half)
    };
    match (shape.kind.as_str(), shape.size.as_slice()) {
        ("sphere", &[radius]) => vec![(DVec3::ZERO, sphere(radius))],
        ("cylinder", &[radius, half]) => vec![(DVec3::ZERO, cylinder(radius, half))],
        ("capsule", &[radius, half]) => vec![
            (DVec3::ZERO, cylinder(radius, half)),
            (half * DVec3::Z, sphere(radius)),
            (half * DVec3::NEG_Z, sphere(radius)),
        ],
        ("box", &[x, y, z]) => {
            let edges = triple(2.0 * DVec3::new(x, y, z));
            vec![(DVec3::ZERO, format!("<box size=\"{edges}\"/>"))]
        }
        ("ellipsoid", &[x, y, z]) => ellipsoid::balls(DVec3::new(x, y, z))
            .iter()
            .map(|ball| (ball.centre, sphere(ball.radius)))
            .collect(),
        _ => Vec::new(),
    }
}

/// A name per colour, as a name that stands for two colours is an error.
fn material(colour: [f64; 4]) -> String {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "shares of 0 to 1 as bytes"
    )]
    let bytes = colour.map(|share| format!("{:02x}", (share * 255.0).round() as u8));
    format!("rgba_{}", bytes.concat())
}

/// URDF's angles turn about fixed x, y, z, in that order.
fn origin(metres: DVec3, turn: DQuat) -> String {
    let (yaw, pitch, roll) = turn.to_euler(EulerRot::ZYX);
    let angles = triple(DVec3::new(roll, pitch, yaw));
    format!("<origin xyz=\"{}\" rpy=\"{angles}\"/>", triple(metres))
}

/// Nanometres and nanoradians; 0 without a sign.
fn triple(vector: DVec3) -> String {
    let parts = vector
        .to_array()
        .map(|part| (part * 1e9).round() / 1e9 + 0.0);
    parts.map(|part| part.to_string()).join(" ")
}
