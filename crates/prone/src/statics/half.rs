//! One half of a mirrored robot: what is on its middle plane, and one of each pair of limbs.
//!
//! The mirror is that of [`crate::robot::mirror`]. A joint about a, mirrored by a joint about a', holds
//!
//! ```text
//! q' = s q,   s = (−a_x, a_y, −a_z)·a' = ±1                                    (1)
//! ```
//!
//! in a symmetric pose, and carries the torque s τ. A joint on the middle plane mirrors itself:
//! with s = −1 (a neck that turns sideways) it must be at zero. Everything is read from the
//! robot's zero pose; names mean nothing here.

use glam::{DQuat, DVec3};

use super::outline::Part;
use super::{RestError, SupportRule};
use crate::frames::{Link, Point, Root, Transform};
use crate::robot::mirror::{mirrored_axis, mirrored_point};
use crate::robot::{BodyId, BodyPoses, JointAngles, JointId, Robot, Shape};

/// How far two joints may be from mirroring each other, rad; their mean is used. The published
/// gaits press both ankles of a NAO against their stops, which are 0.003 rad apart.
pub const ASYMMETRY_TOLERANCE: f64 = 0.01;

/// Masses (kg) and lengths (m) closer than this are the same: the last digits of a model file.
const SAME: f64 = 1e-6;

/// Directions in which mirrored shapes must reach equally far: enough to tell any two apart.
const PROBES: [DVec3; 6] = [
    DVec3::X,
    DVec3::Y,
    DVec3::Z,
    DVec3::new(0.48, 0.6, 0.64),
    DVec3::new(-0.6, 0.64, 0.48),
    DVec3::new(0.64, -0.48, 0.6),
];

/// Half a robot, in the robot's order of bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct HalfRobot {
    pub(super) bodies: Vec<HalfBody>,
    parts: Vec<Part>,
    /// Place in `bodies` of each of the robot's, on either side.
    place: Vec<usize>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct HalfBody {
    pub(super) id: BodyId,
    /// Place in the half; `None` for the root.
    pub(super) parent: Option<usize>,
    pub(super) joint: Option<JointPair>,
    /// 2 for one of a pair, 1 on the middle plane.
    pub(super) copies: f64,
    /// Whether it hangs on the forearm's hinges.
    beyond_elbow: bool,
}

/// A joint of the half and the one that mirrors it: itself on the middle plane.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct JointPair {
    pub(super) this: JointId,
    pub(super) mirror: JointId,
    /// s of equation (1).
    pub(super) sign: f64,
}

/// Poses of the half's bodies in the root.
pub(super) struct HalfPose(pub(super) Vec<Transform<Root, Link>>);

/// A robot is no mirrored one: a body has no counterpart of the same mass, place, joint and shapes.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("body {body} has no mirror image among the robot's bodies; statics needs one")]
pub struct SymmetryError {
    /// Its name.
    pub body: String,
}

impl HalfRobot {
    /// Pairs the robot's bodies.
    ///
    /// # Errors
    /// [`SymmetryError`] where a body has no mirror image.
    pub fn from_robot(robot: &Robot) -> Result<Self, SymmetryError> {
        let zero = robot.zero_pose();
        let mut half = Self {
            bodies: Vec::new(),
            parts: Vec::new(),
            place: vec![usize::MAX; robot.bodies.len()],
        };
        let mut mirror: Vec<BodyId> = Vec::with_capacity(robot.bodies.len());
        for index in 0..robot.bodies.len() {
            let id = BodyId(index);
            let image = mirror_image(robot, &zero, id, &mirror).ok_or_else(|| SymmetryError {
                body: robot.bodies[index].name.clone(),
            })?;
            mirror.push(image);
            if index <= image.0 {
                half.keep(robot, &zero, id, image);
            } else {
                half.place[index] = half.place[image.0];
            }
        }
        Ok(half)
    }

    fn keep(&mut self, robot: &Robot, zero: &BodyPoses<Root>, id: BodyId, image: BodyId) {
        let body = &robot.bodies[id.0];
        self.place[id.0] = self.bodies.len();
        let joints = body.joint.zip(robot.bodies[image.0].joint);
        self.bodies.push(HalfBody {
            id,
            parent: body.parent.map(|parent| self.place[parent.0]),
            joint: joints.map(|(this, mirror)| JointPair {
                this,
                mirror,
                sign: mirror_sign(robot, zero, this, mirror),
            }),
            copies: if id == image { 1.0 } else { 2.0 },
            beyond_elbow: is_beyond_elbow(robot, id),
        });
        for (index, shape) in shapes_of(robot, id) {
            self.parts.extend(Part::from_shape(shape, index));
        }
    }

    /// Place in `bodies` of one of the robot's, on either side.
    pub(super) fn place(&self, body: BodyId) -> usize {
        self.place[body.0]
    }

    pub(super) fn may_carry(&self, robot: &Robot, part: &Part, rule: SupportRule) -> bool {
        let place = self.place(robot.shapes[part.shape].body);
        rule == SupportRule::AnyShape || !self.bodies[place].beyond_elbow
    }

    /// Forward kinematics of the half, the root at the origin.
    pub(super) fn pose(&self, robot: &Robot, angles: &JointAngles) -> Result<HalfPose, RestError> {
        let mut poses: Vec<Transform<Root, Link>> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let parent = match body.parent {
                None => Transform::translation(DVec3::ZERO),
                Some(parent) => poses[parent] * robot.bodies[body.id.0].parent_from_body,
            };
            poses.push(match &body.joint {
                None => parent,
                Some(pair) => {
                    let joint = &robot.joints[pair.this.0];
                    let turn = DQuat::from_axis_angle(joint.axis, pair.angle(robot, angles)?);
                    let anchor = joint.anchor.metres();
                    parent * Transform::<Link, Link>::new(turn, anchor - turn * anchor)
                }
            });
        }
        Ok(HalfPose(poses))
    }

    /// All parts in the root frame.
    pub(super) fn parts(&self, robot: &Robot, pose: &HalfPose) -> Vec<Part> {
        let placed = |part: &Part| part.placed(&pose.0[self.place(robot.shapes[part.shape].body)]);
        self.parts.iter().map(placed).collect()
    }

    /// Centre of mass of the whole robot.
    pub(super) fn centre_of_mass(&self, robot: &Robot, pose: &HalfPose) -> Point<Root> {
        let moment: DVec3 = self
            .bodies
            .iter()
            .zip(&pose.0)
            .map(|(half, pose)| {
                let body = &robot.bodies[half.id.0];
                half.copies * body.mass * (*pose * body.centre_of_mass).metres()
            })
            .sum();
        Point::new(DVec3::new(moment.x, 0.0, moment.z) / robot.mass())
    }
}

impl HalfPose {
    /// A point of a body of either side, in the half.
    pub(super) fn point(&self, half: &HalfRobot, (body, point): (BodyId, Point<Link>)) -> DVec3 {
        (self.0[half.place(body)] * point).metres()
    }
}

impl JointPair {
    /// The angle of this side, mean of both.
    fn angle(&self, robot: &Robot, angles: &JointAngles) -> Result<f64, RestError> {
        let (this, mirrored) = (angles[self.this], self.sign * angles[self.mirror]);
        if !(this + mirrored).is_finite() {
            return Err(RestError::NotFinite);
        }
        if (this - mirrored).abs() > ASYMMETRY_TOLERANCE {
            return Err(RestError::Asymmetric {
                joint: robot.joints[self.this.0].name.clone(),
                mirror: robot.joints[self.mirror.0].name.clone(),
                by_deg: (this - mirrored).to_degrees(),
            });
        }
        Ok(f64::midpoint(this, mirrored))
    }
}

/// The body that mirrors `id`, given the images of those before it.
fn mirror_image(
    robot: &Robot,
    zero: &BodyPoses<Root>,
    id: BodyId,
    known: &[BodyId],
) -> Option<BodyId> {
    let parent_image = robot.bodies[id.0].parent.map(|parent| known[parent.0]);
    (0..robot.bodies.len()).map(BodyId).find(|&other| {
        robot.bodies[other.0].parent == parent_image && mirrors(robot, zero, id, other)
    })
}

fn mirrors(robot: &Robot, zero: &BodyPoses<Root>, id: BodyId, other: BodyId) -> bool {
    let [this, that] = [id, other].map(|id| &robot.bodies[id.0]);
    let centre = |id: BodyId| zero.point((id, robot.bodies[id.0].centre_of_mass)).metres();
    let same_mass = (this.mass - that.mass).abs() < SAME
        && (mirrored_point(centre(id)) - centre(other)).length() < SAME;
    let same_joint = match (this.joint, that.joint) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            let anchor = |id: JointId| zero.anchor(&robot.joints[id.0]).metres();
            let parallel = mirror_sign(robot, zero, a, b).abs() > 1.0 - SAME;
            parallel && (mirrored_point(anchor(a)) - anchor(b)).length() < SAME
        }
        _ => false,
    };
    let alike = |shape: &Shape, candidate: &Shape| {
        PROBES.iter().all(|&probe| {
            let reach = shape.reach_along(zero.of(id), probe);
            (reach - candidate.reach_along(zero.of(other), mirrored_point(probe))).abs() < SAME
        })
    };
    let same_shapes = shapes_of(robot, id).count() == shapes_of(robot, other).count()
        && shapes_of(robot, id)
            .all(|(_, shape)| shapes_of(robot, other).any(|(_, image)| alike(shape, image)));
    same_mass && same_joint && same_shapes
}

/// Equation (1), rounded to ±1 where the axes mirror each other.
fn mirror_sign(robot: &Robot, zero: &BodyPoses<Root>, this: JointId, that: JointId) -> f64 {
    let [a, b] = [this, that].map(|id| zero.axis(&robot.joints[id.0]));
    let cosine = mirrored_axis(a).dot(b);
    if cosine.abs() > 1.0 - SAME {
        cosine.signum()
    } else {
        cosine
    }
}

fn shapes_of(robot: &Robot, body: BodyId) -> impl Iterator<Item = (usize, &Shape)> {
    let shapes = robot.shapes.iter().enumerate();
    shapes.filter(move |(_, shape)| shape.body == body)
}

/// Whether a body hangs on the forearm's hinges.
fn is_beyond_elbow(robot: &Robot, body: BodyId) -> bool {
    let hinges = robot.chain.sides().map(|side| side.forearm[0]);
    hinges
        .iter()
        .any(|hinge| robot.moves_with(body, robot.joints[hinge.0].body))
}
