//! `model.json`: the bodies of the robot, and what stands about it.

use std::path::Path;

use glam::{DQuat, DVec3};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

use prone::frames::{Link, Point, Transform};

use crate::unique_json;

use super::error::text;
use super::{ROWS_FILE, ReadError};

/// Its file in the record folder.
pub const MODEL_FILE: &str = "model.json";

/// How far the length of a quaternion or an axis may be from one.
const UNIT: f64 = 1e-6;

/// More than any robot has.
const MOST_BODIES: usize = 10_000;

/// A body of the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedBody {
    /// Its name in the model.
    pub name: String,
    /// Its place among the bodies; `None` for the root.
    pub parent: Option<usize>,
    /// Pose in the parent with all joints at zero.
    pub parent_from_body: Transform<Link, Link>,
    /// What moves it in its parent.
    pub hinge: Option<Hinge>,
    /// How hard it is to turn, where the record says.
    pub inertia: Option<Inertia>,
}

/// How hard a body is to turn.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct Inertia {
    /// Moments about the principal axes, through the centre of mass, kg·m².
    #[serde(deserialize_with = "vector")]
    pub principal: DVec3,
    /// From the principal axes to the body's own.
    #[serde(rename = "quaternion", deserialize_with = "real_first")]
    pub rotation: DQuat,
}

/// A shape of the robot, whether it collides or is only seen.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct RecordedShape {
    /// The body that it is fixed to, by its place among the bodies.
    pub body: usize,
    /// `sphere`, `capsule`, `cylinder`, `ellipsoid` or `box`; long axis along z.
    #[serde(rename = "type")]
    pub kind: String,
    /// Radius and half-length along z, half-axes, or half-edges, as many as the kind has, m.
    pub size: Vec<f64>,
    /// Its middle in the body, m.
    #[serde(deserialize_with = "vector")]
    pub position: DVec3,
    /// Its turn in the body.
    #[serde(rename = "quaternion", deserialize_with = "real_first")]
    pub rotation: DQuat,
    /// Red, green, blue, opacity, 0 to 1.
    #[serde(rename = "rgba")]
    pub colour: [f64; 4],
    /// The engine's group: 0 to 2 are drawn.
    pub group: i32,
    /// Whether it collides.
    pub collides: bool,
}

/// A hinge of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge {
    /// Its place in [`super::Recorded::joints`].
    pub joint: usize,
    /// Unit axis in the body's frame.
    pub axis: DVec3,
    /// A point of the axis in the body's frame.
    pub anchor: Point<Link>,
}

/// The file, and what of it is looked at.
pub(super) struct Model {
    pub(super) text: Value,
    file: String,
    parts: Parts,
}

#[derive(Deserialize)]
struct Parts {
    bodies: Vec<BodyEntry>,
    obstacles: Vec<ObstacleEntry>,
    shapes: Vec<RecordedShape>,
    // The page draws it; here it only has to be there.
    #[serde(rename = "chain")]
    _chain: Value,
}

#[derive(Deserialize)]
struct BodyEntry {
    name: String,
    parent: Option<usize>,
    #[serde(deserialize_with = "vector")]
    position: DVec3,
    #[serde(deserialize_with = "real_first")]
    quaternion: DQuat,
    joint: Option<JointEntry>,
    inertia: Option<Inertia>,
}

#[derive(Deserialize)]
struct JointEntry {
    name: String,
    #[serde(deserialize_with = "vector")]
    axis: DVec3,
    #[serde(deserialize_with = "vector")]
    anchor: DVec3,
}

#[derive(Deserialize)]
struct ObstacleEntry {
    kind: String,
    half_edges: [f64; 3],
    position: [f64; 3],
}

impl Model {
    pub(super) fn read(folder: &Path) -> Result<Self, ReadError> {
        let file = folder.join(MODEL_FILE).display().to_string();
        let json = |error: serde_json::Error| wrong(&file, error.to_string());
        let content = text(folder, MODEL_FILE)?;
        let parts: Parts = serde_json::from_str(&content).map_err(json)?;
        let text = unique_json::parse(content.as_bytes()).map_err(json)?;
        Ok(Self { text, file, parts })
    }

    /// The bodies, for the joints of the rows.
    pub(super) fn bodies(&self, joints: &[String]) -> Result<Vec<RecordedBody>, ReadError> {
        if self.parts.bodies.len() > MOST_BODIES {
            return Err(wrong(&self.file, format!("more than {MOST_BODIES} bodies")));
        }
        let bodies = self.parts.bodies.iter().enumerate();
        let bodies = bodies.map(|(index, body)| body.read(index, joints));
        bodies
            .collect::<Result<_, _>>()
            .map_err(|problem| wrong(&self.file, problem))
    }

    /// Names of the joints of the bodies, in the order of the bodies.
    pub(super) fn joints(&self) -> Vec<String> {
        let joints = self.parts.bodies.iter();
        let joints = joints.filter_map(|body| Some(body.joint.as_ref()?.name.clone()));
        joints.collect()
    }

    /// The robot's shapes, each fixed to one of the bodies.
    pub(super) fn shapes(self) -> Result<Vec<RecordedShape>, ReadError> {
        let (bodies, shapes) = (self.parts.bodies.len(), self.parts.shapes);
        match shapes.iter().find(|shape| shape.body >= bodies) {
            None => Ok(shapes),
            Some(shape) => {
                let problem = format!("a shape is fixed to body {} of {bodies}", shape.body);
                Err(wrong(&self.file, problem))
            }
        }
    }

    pub(super) fn plate(&self) -> Option<(f64, f64)> {
        let obstacles = self.parts.obstacles.iter();
        let plate = obstacles.into_iter().find(|it| it.kind == "plate")?;
        let underside = plate.position[2] - plate.half_edges[2];
        Some((underside, 2.0 * plate.half_edges[0]))
    }
}

impl BodyEntry {
    fn read(&self, index: usize, joints: &[String]) -> Result<RecordedBody, String> {
        let name = &self.name;
        // Parents come first, and only the first body has none.
        if self.parent.is_none() != (index == 0) || self.parent.is_some_and(|it| it >= index) {
            return Err(format!("body {name} does not follow its parent"));
        }
        if (self.quaternion.length() - 1.0).abs() > UNIT {
            return Err(format!(
                "the quaternion of body {name} has not the length 1"
            ));
        }
        let hinge = match &self.joint {
            None => None,
            Some(joint) => {
                let place = joints.iter().position(|known| *known == joint.name);
                if (joint.axis.length() - 1.0).abs() > UNIT {
                    return Err(format!("the axis of {} has not the length 1", joint.name));
                }
                Some(Hinge {
                    joint: place
                        .ok_or_else(|| format!("{ROWS_FILE} has no joint {}", joint.name))?,
                    axis: joint.axis,
                    anchor: Point::new(joint.anchor),
                })
            }
        };
        Ok(RecordedBody {
            name: name.clone(),
            parent: self.parent,
            parent_from_body: Transform::new(self.quaternion, self.position),
            hinge,
            inertia: self.inertia,
        })
    }
}

fn wrong(file: &str, problem: String) -> ReadError {
    let file = file.to_owned();
    ReadError::Content { file, problem }
}

fn vector<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DVec3, D::Error> {
    <[f64; 3]>::deserialize(deserializer).map(DVec3::from_array)
}

/// A quaternion whose real part stands first.
fn real_first<'de, D: Deserializer<'de>>(deserializer: D) -> Result<DQuat, D::Error> {
    let [w, x, y, z] = Deserialize::deserialize(deserializer)?;
    Ok(DQuat::from_xyzw(x, y, z, w))
}
