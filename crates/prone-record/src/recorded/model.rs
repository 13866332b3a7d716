//! `model.json`: the bodies of the robot, and what stands about it.

use std::path::Path;

use glam::{DQuat, DVec3};
use serde::Deserialize;
use serde_json::Value;

use prone::frames::{Link, Point, Transform};

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
    // The page draws them; here they only have to be there.
    #[serde(rename = "shapes")]
    _shapes: Vec<Value>,
    #[serde(rename = "chain")]
    _chain: Value,
}

#[derive(Deserialize)]
struct BodyEntry {
    name: String,
    parent: Option<usize>,
    position: [f64; 3],
    quaternion: [f64; 4],
    joint: Option<JointEntry>,
}

#[derive(Deserialize)]
struct JointEntry {
    name: String,
    axis: [f64; 3],
    anchor: [f64; 3],
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
        let json = |source| ReadError::Json {
            file: file.clone(),
            source,
        };
        let content = text(folder, MODEL_FILE)?;
        let parts: Parts = serde_json::from_str(&content).map_err(json)?;
        let text = serde_json::from_str(&content).map_err(json)?;
        Ok(Self { text, file, parts })
    }

    /// The bodies, for the joints of the rows.
    pub(super) fn bodies(&self, joints: &[String]) -> Result<Vec<RecordedBody>, ReadError> {
        if self.parts.bodies.len() > MOST_BODIES {
            return Err(ReadError::Model {
                file: self.file.clone(),
                problem: format!("more than {MOST_BODIES} bodies"),
            });
        }
        let bodies = self.parts.bodies.iter().enumerate();
        let bodies = bodies.map(|(index, body)| {
            body.read(index, joints)
                .map_err(|problem| ReadError::Model {
                    file: self.file.clone(),
                    problem,
                })
        });
        bodies.collect()
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
        let [w, x, y, z] = self.quaternion;
        let turn = DQuat::from_xyzw(x, y, z, w);
        if (turn.length() - 1.0).abs() > UNIT {
            return Err(format!(
                "the quaternion of body {name} has not the length 1"
            ));
        }
        let hinge = match &self.joint {
            None => None,
            Some(joint) => {
                let place = joints.iter().position(|known| *known == joint.name);
                let axis = DVec3::from_array(joint.axis);
                if (axis.length() - 1.0).abs() > UNIT {
                    return Err(format!("the axis of {} has not the length 1", joint.name));
                }
                Some(Hinge {
                    joint: place
                        .ok_or_else(|| format!("{ROWS_FILE} has no joint {}", joint.name))?,
                    axis,
                    anchor: Point::new(DVec3::from_array(joint.anchor)),
                })
            }
        };
        Ok(RecordedBody {
            name: name.clone(),
            parent: self.parent,
            parent_from_body: Transform::new(turn, DVec3::from_array(self.position)),
            hinge,
        })
    }
}
