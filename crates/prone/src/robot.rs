//! A robot as data: bodies, joints, shapes, and which of them form the crawling chain.
//!
//! Nothing here knows a particular robot. `prone-sim` fills [`Robot`] from an MJCF model and a
//! `robot.toml`. The value is immutable once loaded; algorithms are functions over `&Robot`.

pub mod bounds;
mod contact_group;
mod control;
mod coupled_limit;
mod drive;
mod imu;
mod joint_angles;
mod kinematics;
mod level;
mod limbs;
pub(crate) mod mirror;
mod shape;
#[cfg(test)]
pub(crate) mod testing;
mod tops;
mod tree;

pub use contact_group::ContactGroup;
pub use control::{Control, SearchSetup, SteeringGains};
pub use coupled_limit::{BeyondCoupled, CoupledLimit, CoupledLimitError};
pub use drive::Drive;
pub use imu::{Imu, SensorNoise};
pub use joint_angles::JointAngles;
pub use kinematics::BodyPoses;
pub use limbs::{ChainPart, ChainSide, LimbError, check_limbs};
pub use mirror::{Mirror, Twin};
pub use shape::{Shape, Solid};
pub use tops::{BodyPart, Tops};

use std::collections::BTreeMap;

use glam::DVec3;

use crate::frames::{Link, Point, Root, Transform};

/// Index of a body in [`Robot::bodies`]; parents come before their children, 0 is the root.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct BodyId(pub usize);

/// Index of a joint in [`Robot::joints`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JointId(pub usize);

/// A humanoid as the crawl needs it.
#[derive(Debug, Clone, PartialEq)]
pub struct Robot {
    /// The manufacturer's name of the model.
    pub name: String,
    /// How high it stands, m, where the manufacturer says so: heights and speeds are compared by it.
    pub standing_height: Option<f64>,
    /// Parents before children; the first one floats freely.
    pub bodies: Vec<Body>,
    /// Hinges in the model's order.
    pub joints: Vec<Joint>,
    /// Joints that one motor turns together, which the model ties by an equality; every other joint
    /// has a motor of its own ([`Self::drives`]).
    pub shared_motors: Vec<Vec<JointId>>,
    /// Limits of joints that depend on the angle of another joint, beside those of [`Joint::range`].
    pub coupled_limits: Vec<CoupledLimit>,
    /// Primitives that collide.
    pub shapes: Vec<Shape>,
    /// What makes the sagittal chain.
    pub chain: ChainLayout,
    /// Named postures, every joint listed (0 where the file is silent).
    pub postures: BTreeMap<String, JointAngles>,
    /// How the torque study treats this robot.
    pub study: StudySetup,
    /// Its inertial measurement unit, where it has one.
    pub imu: Option<Imu>,
    /// How it is driven and steered.
    pub control: Control,
    /// Within what searches look for its cycles.
    pub search: SearchSetup,
    /// How long it lies, stretched out, m: what pictures are framed by.
    pub lying_length: f64,
}

/// One rigid body.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name in the model.
    pub name: String,
    /// `None` for the root.
    pub parent: Option<BodyId>,
    /// Pose in the parent with all joints at zero; the identity for the root.
    pub parent_from_body: Transform<Link, Link>,
    /// The hinge that moves the body in its parent.
    pub joint: Option<JointId>,
    /// kg.
    pub mass: f64,
    /// Centre of mass in the body's own frame.
    pub centre_of_mass: Point<Link>,
    /// Which column of a record its contacts count for.
    pub contact_group: ContactGroup,
}

/// One hinge.
#[derive(Debug, Clone, PartialEq)]
pub struct Joint {
    /// The manufacturer's name.
    pub name: String,
    /// The body it moves.
    pub body: BodyId,
    /// Unit axis in the moved body's frame.
    pub axis: DVec3,
    /// A point of the axis in the moved body's frame.
    pub anchor: Point<Link>,
    /// The manufacturer's limits, rad.
    pub range: Range,
    /// The manufacturer's effort limit, N·m: what the current limit of its motor leaves at the joint.
    pub effort_limit: f64,
    /// The manufacturer's speed limit, rad/s.
    pub speed_limit: f64,
    /// Torque that its servo asks for per position error, N·m/rad.
    pub servo_stiffness: f64,
    /// The motor behind the joint, where its figures are known.
    pub motor: Option<Motor>,
}

/// A geared motor, at the joint, before gear losses.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Motor turns per joint turn.
    pub ratio: f64,
    /// Continuous torque, N·m.
    pub nominal: f64,
    /// Stall torque, N·m.
    pub stall: f64,
    /// Speed without load, rad/s, where it is known.
    pub no_load_speed: Option<f64>,
}

impl Motor {
    /// What the winding turns into heat per squared torque, W/(N·m)², where the speed without load
    /// is known.
    ///
    /// A direct-current motor with constant k, resistance R and supply U has
    ///
    /// 1. no-load speed ω₀ = U / k
    /// 2. stall torque τₛ = k U / R
    /// 3. loss R I² = R (τ / k)² = τ² ω₀ / τₛ
    ///
    /// whatever the supply. Friction in motor and gear, and what iron and drive lose, are left out.
    pub fn winding_loss(&self) -> Option<f64> {
        self.no_load_speed.map(|speed| speed / self.stall)
    }
}

/// A closed interval of joint angles, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Smallest allowed angle.
    pub lower: f64,
    /// Largest allowed angle.
    pub upper: f64,
}

impl Body {
    /// Whether it belongs to the head.
    pub const fn is_head(&self) -> bool {
        matches!(self.contact_group, ContactGroup::Head)
    }
}

/// What makes the sagittal chain of a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct ChainLayout {
    /// The left limbs.
    pub left: SideLayout,
    /// The right limbs.
    pub right: SideLayout,
    /// `d_e` of the chain derived from the model, metres.
    pub span: f64,
    /// l5 that the derived chain asks for; the shoulder roll is solved for it, metres.
    pub projected_upper_arm: f64,
    /// A chain printed in a publication, where there is one.
    pub published: Option<PublishedChain>,
    /// Arm joints of the fixed-arm mode, left side, rad (the right side mirrors).
    pub fixed_arm: Option<FixedArm>,
}

/// The joints and points of one side's chain, toe to elbow.
#[derive(Debug, Clone, PartialEq)]
pub struct SideLayout {
    /// Where the foot touches the ground on its toes: a body and a point in it.
    pub toe: (BodyId, Point<Link>),
    /// Ankle pitch.
    pub ankle: JointId,
    /// Knee pitch.
    pub knee: JointId,
    /// Hip pitch.
    pub hip: JointId,
    /// Shoulder pitch.
    pub shoulder: JointId,
    /// Spreads the upper arm outwards.
    pub shoulder_roll: JointId,
    /// The elbow's centre: a body and a point in it.
    pub elbow: (BodyId, Point<Link>),
    /// Two hinges that point the forearm, upper one first.
    pub forearm: [JointId; 2],
    /// Unit vector along the forearm, in the frame of the body that the second one moves.
    pub forearm_direction: DVec3,
}

/// A chain as a publication prints it, with the offsets that its mapping used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PublishedChain {
    /// Link lengths and span.
    pub chain: crate::chain::ClosedChain,
    /// Ankle joint angle minus θ2, rad.
    pub ankle_offset: f64,
    /// Outward shoulder roll, rad.
    pub shoulder_roll: f64,
}

/// Arm joints that stay where they are during the pull, left side, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FixedArm {
    /// Shoulder roll.
    pub shoulder_roll: f64,
    /// The two forearm hinges.
    pub forearm: [f64; 2],
}

/// How the torque study treats a robot.
#[derive(Debug, Clone, PartialEq)]
pub struct StudySetup {
    /// Name in [`Robot::postures`] of the pose before the first command.
    pub start_posture: String,
    /// Stops moved for the study, so that sag does not press a joint into them.
    pub stops: Vec<(JointId, Range)>,
}

impl Range {
    /// How far `angle` lies outside, rad: positive above, negative below, 0 inside, NaN for NaN.
    pub fn excess(&self, angle: f64) -> f64 {
        if angle > self.upper {
            angle - self.upper
        } else if angle < self.lower {
            angle - self.lower
        } else {
            // NaN stays NaN.
            angle * 0.0
        }
    }

    /// The nearest angle inside.
    pub const fn clamp(&self, angle: f64) -> f64 {
        angle.clamp(self.lower, self.upper)
    }

    /// Whether `angle` lies inside; NaN does not.
    pub fn contains(&self, angle: f64) -> bool {
        (self.lower..=self.upper).contains(&angle)
    }
}

impl Robot {
    /// The joint of that name.
    pub fn joint(&self, name: &str) -> Option<JointId> {
        self.joints.iter().position(|j| j.name == name).map(JointId)
    }

    /// The body of that name.
    pub fn body(&self, name: &str) -> Option<BodyId> {
        self.bodies.iter().position(|b| b.name == name).map(BodyId)
    }

    /// Total mass, kg.
    pub fn mass(&self) -> f64 {
        self.bodies.iter().map(|body| body.mass).sum()
    }

    /// The joints' limits as the manufacturer gives them.
    pub fn stops(&self) -> Vec<Range> {
        self.joints.iter().map(|joint| joint.range).collect()
    }

    /// The joints' limits with the study's stops moved.
    pub fn study_stops(&self) -> Vec<Range> {
        let mut stops = self.stops();
        for (joint, range) in &self.study.stops {
            stops[joint.0] = *range;
        }
        stops
    }

    /// Poses of the bodies in the root with all joints at zero.
    pub(crate) fn zero_pose(&self) -> BodyPoses<Root> {
        self.forward_kinematics(
            Transform::translation(DVec3::ZERO),
            &JointAngles::zero(self),
        )
    }
}

impl ChainLayout {
    /// Left, then right.
    pub const fn sides(&self) -> [&SideLayout; 2] {
        [&self.left, &self.right]
    }
}

impl SideLayout {
    /// Ankle, knee, hip and shoulder pitch: the joints whose torque the study records.
    pub const fn pitch_joints(&self) -> [JointId; 4] {
        [self.ankle, self.knee, self.hip, self.shoulder]
    }

    /// The joints that a gait commands, the pitch joints first.
    pub const fn commanded_joints(&self) -> [JointId; 7] {
        [
            self.ankle,
            self.knee,
            self.hip,
            self.shoulder,
            self.shoulder_roll,
            self.forearm[0],
            self.forearm[1],
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn excess_has_the_sign_of_the_side_and_keeps_nan() {
        let range = Range {
            lower: -1.0,
            upper: 2.0,
        };
        assert!(range.excess(0.5).abs() < f64::EPSILON);
        assert!((range.excess(2.5) - 0.5).abs() < 1e-15);
        assert!((range.excess(-1.25) + 0.25).abs() < 1e-15);
        assert!(range.excess(f64::NAN).is_nan());
        assert!(!range.contains(f64::NAN));
    }
}
