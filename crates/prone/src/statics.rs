//! The joint torques of a robot at rest on the floor, without an engine.
//!
//! The robot is one rigid body in the commanded pose; the pose is mirrored left to right, so it
//! can only pitch. Convention: the root is turned by `R_y(φ)`; d = (sin φ, 0, −cos φ) points down
//! and e = (cos φ, 0, sin φ) forward, both in the root frame. c is the centre of mass, G the
//! weight.
//!
//! **Where it comes to rest.** Part i of a collision shape reaches down to the support function
//! `h_i(d)` = max p·d. With that part on the floor the centre of mass is at the height `f_i`, and the
//! floor keeps it above all of them:
//!
//! ```text
//! f_i(φ) = h_i(d) − c·d,    H(φ) = max_i f_i(φ)                                (1)
//! f_i'(φ) = (p_i − c)·e = x_i                                                  (2)
//! ```
//!
//! where `x_i` is how far the touching point `p_i` lies ahead of the centre of mass. A robot let go
//! tilts downhill in H until it is level on two parts with `x_r` ≤ 0 ≤ `x_f` — the lower edge of the
//! shapes' hull under the centre of mass — or, seldom, rocks on a single round part with x = 0.
//!
//! **Reactions** are vertical and push only. Balance of force and moment:
//!
//! ```text
//! N_r + N_f = G,    x_r N_r + x_f N_f = 0                                      (3)
//! ```
//!
//! Both are ≥ 0 by the choice of the supports. What (3) leaves open is the horizontal **squeeze**
//! S: the floor pushes the rear support forward and the front support back with S each. It is a
//! parameter; zero is a floor without friction. Left and right share every reaction evenly.
//!
//! **Torques.** With everything beyond joint j — on its side away from the root — carrying the
//! forces `F_k` at `r_k`, weights and reactions, and `a_j` the axis through `c_j`:
//!
//! ```text
//! load_j = a_j · Σ_k (r_k − c_j) × F_k,    motor_j = −load_j                   (4)
//! ```
//!
//! `load` is the sign of the published recordings, `motor` that of the engine's actuators.
//!
//! **The second route** (`virtual_work`, of the tests) knows neither supports' hull nor moments: the
//! motors' work is what lifts the weight and stretches the squeezed span,
//! `motor_j = ½ ∂(G H + S L)/∂q_j` for a mirrored pair.

mod balance;
mod half;
mod moments;
mod outline;
mod source;

pub use half::{ASYMMETRY_TOLERANCE, HalfRobot, SymmetryError};
pub use source::{StaticTorques, StaticsError};

use glam::{DQuat, DVec3};

use crate::frames::{Ground, Point, Root, Transform};
use crate::robot::{BodyId, ContactGroup, JointAngles, JointId, Robot};
use balance::Equilibrium;
use half::HalfPose;
use outline::Part;

/// Acceleration of gravity, m/s²: the engine's default, so that both weigh alike.
pub const GRAVITY: f64 = 9.81;

/// Which shapes may carry the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SupportRule {
    /// All of them.
    AnyShape,
    /// All but forearms and hands. A flat forearm touches along its whole length; the give of
    /// the elbow's servos, which a rigid body does not have, leaves the load at the elbow.
    ElbowNotHand,
}

/// How a robot stands on the floor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stance {
    /// Which shapes may carry.
    pub supports: SupportRule,
    /// S of the module's header, N: the floor presses front and rear support together.
    pub squeeze: f64,
}

impl Stance {
    /// A stance on a floor without friction.
    pub const fn unsqueezed(supports: SupportRule) -> Self {
        Self {
            supports,
            squeeze: 0.0,
        }
    }
}

/// A robot at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Rest {
    /// Pose of the root; x = 0 is the rear support, z = 0 the floor.
    pub ground_from_root: Transform<Ground, Root>,
    /// What carries it.
    pub footing: Footing,
    load: Vec<f64>,
}

/// What carries a robot at rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Footing {
    /// Level on two supports.
    Two {
        /// Behind the centre of mass.
        rear: Support,
        /// Ahead of it.
        front: Support,
    },
    /// Rocking on one round shape; there is nothing to squeeze.
    One(Support),
}

/// A place where the floor carries the robot, on both sides of it alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Support {
    /// The body, or the one of a mirrored pair that the model lists first.
    pub body: BodyId,
    /// Its row in records.
    pub group: ContactGroup,
    /// Where it touches; mirrored on the other side unless y = 0.
    pub point: Point<Ground>,
    /// Vertical force of the floor, both sides together, N; never negative.
    pub reaction: f64,
    /// Forward force of the floor, both sides together, N: ± the squeeze.
    pub forward: f64,
}

/// Why a pose has no rest.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RestError {
    /// The two sides differ.
    #[error(
        "{joint} and {mirror} are {by_deg:.2}° from mirroring each other; statics needs a symmetric pose"
    )]
    Asymmetric {
        /// A joint.
        joint: String,
        /// The joint that mirrors it.
        mirror: String,
        /// How far, degrees.
        by_deg: f64,
    },
    /// Angles that are not numbers.
    #[error("joint angles must be finite numbers")]
    NotFinite,
    /// No shape may carry.
    #[error("the robot has no shape to rest on")]
    NothingCarries,
}

/// Lays the robot on the floor in a pose and computes (1) to (4).
///
/// The tilt starts where toe and elbow are level, so the robot comes to rest as it would from its
/// crawling pose.
pub fn rest(
    robot: &Robot,
    half: &HalfRobot,
    angles: &JointAngles,
    stance: Stance,
) -> Result<Rest, RestError> {
    let pose = half.pose(robot, angles)?;
    let parts = half.parts(robot, &pose);
    let centre = half.centre_of_mass(robot, &pose);
    let carries = |part: &Part| half.may_carry(robot, part, stance.supports);
    let found = balance::settle(&parts, carries, centre, start_pitch(robot, half, &pose))?;

    let ground_from_root = ground_from_root(&found, centre);
    let footing = footing(robot, &found, ground_from_root, stance.squeeze);
    let wrenches = moments::wrenches(robot, half, &pose, &found, &footing);
    Ok(Rest {
        ground_from_root,
        footing,
        load: moments::loads(robot, half, &pose, &wrenches),
    })
}

/// Pitch that brings toe and elbow level, toe behind, rad.
fn start_pitch(robot: &Robot, half: &HalfRobot, pose: &HalfPose) -> f64 {
    let layout = &robot.chain.left;
    let forward = pose.point(half, layout.elbow) - pose.point(half, layout.toe);
    // R_y(φ) turns a sagittal angle by −φ.
    forward.z.atan2(forward.x)
}

/// The floor is as far below the centre of mass as H says, and x = 0 is the rear contact.
fn ground_from_root(found: &Equilibrium, centre: Point<Root>) -> Transform<Ground, Root> {
    let floor = centre.metres().dot(balance::down(found.pitch)) + found.height;
    let rear = found.contacts[0].point.dot(balance::forward(found.pitch));
    let turn = DQuat::from_rotation_y(found.pitch);
    Transform::new(turn, DVec3::new(-rear, 0.0, floor))
}

/// Equation (3).
fn footing(
    robot: &Robot,
    found: &Equilibrium,
    ground_from_root: Transform<Ground, Root>,
    squeeze: f64,
) -> Footing {
    let support = |contact: &balance::Contact, reaction: f64, forward: f64| {
        let body = robot.shapes[contact.shape].body;
        Support {
            body,
            group: robot.bodies[body.0].contact_group,
            point: ground_from_root * Point::<Root>::new(contact.point),
            reaction,
            forward,
        }
    };
    let weight = robot.mass() * GRAVITY;
    let [rear, front] = &found.contacts;
    let apart = front.ahead - rear.ahead;
    if apart > 0.0 {
        Footing::Two {
            rear: support(rear, weight * front.ahead / apart, squeeze),
            front: support(front, -weight * rear.ahead / apart, -squeeze),
        }
    } else {
        Footing::One(support(rear, weight, 0.0))
    }
}

impl Rest {
    /// Moment of weights and reactions beyond a joint about its axis, N·m: the sign of the
    /// published recordings, opposite to that of the engine's actuators.
    pub fn load(&self, joint: JointId) -> f64 {
        self.load[joint.0]
    }
}

impl Footing {
    /// The supports, rear first.
    pub fn supports(&self) -> impl Iterator<Item = &Support> {
        let (first, second) = match self {
            Self::Two { rear, front } => (rear, Some(front)),
            Self::One(support) => (support, None),
        };
        std::iter::once(first).chain(second)
    }
}

#[cfg(test)]
mod tests;
