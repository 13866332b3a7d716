//! One half of a mirrored robot: what is on its middle plane, and one of each pair of limbs.
//!
//! The mirror M in the sagittal plane negates y of points and directions; of a rotation's axis it
//! negates x and z instead. A joint about a, mirrored by a joint about a', holds
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
use crate::robot::{BodyId, BodyPoses, ContactGroup, JointAngles, JointId, Robot, Shape};

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
    pub(super) joints: Vec<JointPair>,
    shapes: Vec<HalfShape>,
    parts: Vec<Part>,
    /// Place in `bodies` of each of the robot's, on either side.
    place: Vec<usize>,
    /// Joints of the whole robot.
    joint_count: usize,
    mass: f64,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct HalfBody {
    id: BodyId,
    /// Place in the half; `None` for the root.
    pub(super) parent: Option<usize>,
    parent_from_body: Transform<Link, Link>,
    /// Place in [`HalfRobot::joints`].
    pub(super) joint: Option<usize>,
    /// Of this one body, kg.
    pub(super) mass: f64,
    pub(super) centre_of_mass: Point<Link>,
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
    pub(super) axis: DVec3,
    pub(super) anchor: Point<Link>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct HalfShape {
    pub(super) index: usize,
    pub(super) body: BodyId,
    /// Place in [`HalfRobot::bodies`].
    pub(super) place: usize,
    pub(super) group: ContactGroup,
    pub(super) group_column: usize,
    pub(super) is_head: bool,
}

/// Poses of the half's bodies in the root.
pub(super) struct HalfPose(pub(super) Vec<Transform<Root, Link>>);

/// Why a robot is no mirrored one.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SymmetryError {
    /// A body without a counterpart of the same mass, place, joint and shapes.
    #[error("body {body} has no mirror image among the robot's bodies; statics needs one")]
    NoMirror {
        /// Its name.
        body: String,
    },
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
            joints: Vec::new(),
            shapes: Vec::new(),
            parts: Vec::new(),
            place: vec![usize::MAX; robot.bodies.len()],
            joint_count: robot.joints.len(),
            mass: robot.mass(),
        };
        let mut mirror: Vec<BodyId> = Vec::with_capacity(robot.bodies.len());
        for index in 0..robot.bodies.len() {
            let id = BodyId(index);
            let image =
                mirror_image(robot, &zero, id, &mirror).ok_or_else(|| SymmetryError::NoMirror {
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
        let place = self.bodies.len();
        self.place[id.0] = place;
        let joint = body
            .joint
            .zip(robot.bodies[image.0].joint)
            .map(|(this, mirror)| {
                let joint = &robot.joints[this.0];
                self.joints.push(JointPair {
                    this,
                    mirror,
                    sign: mirror_sign(robot, zero, this, mirror),
                    axis: joint.axis,
                    anchor: joint.anchor,
                });
                self.joints.len() - 1
            });
        self.bodies.push(HalfBody {
            id,
            parent: body.parent.map(|parent| self.place[parent.0]),
            parent_from_body: body.parent_from_body,
            joint,
            mass: body.mass,
            centre_of_mass: body.centre_of_mass,
            copies: if id == image { 1.0 } else { 2.0 },
            beyond_elbow: is_beyond_elbow(robot, id),
        });
        for (index, shape) in shapes_of(robot, id) {
            let kept = self.shapes.len();
            self.parts.extend(Part::of(shape, kept));
            self.shapes.push(HalfShape {
                index,
                body: id,
                place,
                group: body.contact_group,
                group_column: body.contact_group as usize,
                is_head: body.is_head,
            });
        }
    }

    /// Mass of the whole robot, kg.
    pub(super) const fn mass(&self) -> f64 {
        self.mass
    }

    pub(super) const fn joint_count(&self) -> usize {
        self.joint_count
    }

    pub(super) fn shape(&self, place: usize) -> &HalfShape {
        &self.shapes[place]
    }

    /// Whether a body of either side hangs on the forearm's hinges.
    pub(super) fn is_beyond_elbow(&self, body: BodyId) -> bool {
        self.bodies[self.place[body.0]].beyond_elbow
    }

    pub(super) fn may_carry(&self, part: &Part, rule: SupportRule) -> bool {
        match rule {
            SupportRule::AnyShape => true,
            SupportRule::ElbowNotHand => !self.bodies[self.shapes[part.shape].place].beyond_elbow,
        }
    }

    /// Forward kinematics of the half, the root at the origin.
    pub(super) fn pose(&self, robot: &Robot, angles: &JointAngles) -> Result<HalfPose, RestError> {
        let mut poses: Vec<Transform<Root, Link>> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let parent = match body.parent {
                None => Transform::translation(DVec3::ZERO),
                Some(parent) => poses[parent] * body.parent_from_body,
            };
            poses.push(match body.joint {
                None => parent,
                Some(joint) => {
                    let pair = &self.joints[joint];
                    let turn = DQuat::from_axis_angle(pair.axis, pair.angle(robot, angles)?);
                    let anchor = pair.anchor.metres();
                    parent * Transform::<Link, Link>::new(turn, anchor - turn * anchor)
                }
            });
        }
        Ok(HalfPose(poses))
    }

    /// All parts in the root frame.
    pub(super) fn parts(&self, pose: &HalfPose) -> Vec<Part> {
        let placed = |part: &Part| part.placed(&pose.0[self.shapes[part.shape].place]);
        self.parts.iter().map(placed).collect()
    }

    /// Centre of mass of the whole robot.
    pub(super) fn centre_of_mass(&self, pose: &HalfPose) -> Point<Root> {
        let moment: DVec3 = self
            .bodies
            .iter()
            .zip(&pose.0)
            .map(|(body, pose)| body.copies * body.mass * (*pose * body.centre_of_mass).metres())
            .sum();
        Point::new(DVec3::new(moment.x, 0.0, moment.z) / self.mass)
    }
}

impl HalfPose {
    /// A point of a body of either side, in the half.
    pub(super) fn point(&self, half: &HalfRobot, (body, point): (BodyId, Point<Link>)) -> DVec3 {
        (self.0[half.place[body.0]] * point).metres()
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

fn mirrored(point: DVec3) -> DVec3 {
    DVec3::new(point.x, -point.y, point.z)
}

fn mirrors(robot: &Robot, zero: &BodyPoses<Root>, id: BodyId, other: BodyId) -> bool {
    let [this, that] = [id, other].map(|id| &robot.bodies[id.0]);
    let centre = |id: BodyId| zero.point((id, robot.bodies[id.0].centre_of_mass)).metres();
    let same_mass = (this.mass - that.mass).abs() < SAME
        && (mirrored(centre(id)) - centre(other)).length() < SAME;
    let same_joint = match (this.joint, that.joint) {
        (None, None) => true,
        (Some(a), Some(b)) => {
            let anchor = |id: JointId| {
                let joint = &robot.joints[id.0];
                zero.point((joint.body, joint.anchor)).metres()
            };
            let parallel = mirror_sign(robot, zero, a, b).abs() > 1.0 - SAME;
            parallel && (mirrored(anchor(a)) - anchor(b)).length() < SAME
        }
        _ => false,
    };
    let alike = |shape: &Shape, candidate: &Shape| {
        PROBES.iter().all(|&probe| {
            let reach = shape.reach_along(zero.of(id), probe);
            (reach - candidate.reach_along(zero.of(other), mirrored(probe))).abs() < SAME
        })
    };
    let same_shapes = shapes_of(robot, id).count() == shapes_of(robot, other).count()
        && shapes_of(robot, id)
            .all(|(_, shape)| shapes_of(robot, other).any(|(_, image)| alike(shape, image)));
    same_mass && same_joint && same_shapes
}

/// Equation (1), rounded to ±1 where the axes mirror each other.
fn mirror_sign(robot: &Robot, zero: &BodyPoses<Root>, this: JointId, that: JointId) -> f64 {
    let [a, b] = [this, that].map(|id| {
        let joint = &robot.joints[id.0];
        zero.of(joint.body).rotate(joint.axis)
    });
    let cosine = DVec3::new(-a.x, a.y, -a.z).dot(b);
    if cosine.abs() > 1.0 - SAME {
        cosine.signum()
    } else {
        cosine
    }
}

fn shapes_of(robot: &Robot, body: BodyId) -> impl Iterator<Item = (usize, &Shape)> {
    robot
        .shapes
        .iter()
        .enumerate()
        .filter(move |(_, shape)| shape.body == body)
}

/// Whether a body hangs on the forearm's hinges.
fn is_beyond_elbow(robot: &Robot, body: BodyId) -> bool {
    let hinges = robot.chain.sides().map(|side| side.forearm[0]);
    hinges
        .iter()
        .any(|hinge| robot.moves_with(body, robot.joints[hinge.0].body))
}
