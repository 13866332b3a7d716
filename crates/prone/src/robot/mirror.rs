//! Which joint is which other one's mirror image.
//!
//! A mirror in the sagittal plane takes a point (x, y, z) to (x, −y, z) and an axis of rotation
//! (x, y, z) to (−x, y, −z). On the way from the root to toe and forearm the hinges of the right limb
//! are the twins of the left limb's in their order ([`limb_pairs`]), however exactly they mirror them,
//! which [`crate::plausible`] bounds. Of the others, two are twins where, at zero angles, one's axis is
//! the other's mirrored and one's anchor is the other's mirrored. A hinge in the plane is its own twin.
//! (Lines are not enough: the pitch axes of both sides are one line.)

use glam::DVec3;

use super::{BodyId, JointAngles, JointId, Robot, SideLayout};

/// How far a mirrored hinge may miss its twin, m and as a sine: rounding in a model file.
const TOLERANCE: f64 = 1e-6;

/// The twin of every joint that has one.
#[derive(Debug, Clone, PartialEq)]
pub struct Mirror(Vec<Option<Twin>>);

/// A joint's mirror image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Twin {
    /// The other joint; for a joint in the sagittal plane itself.
    pub joint: JointId,
    /// What an angle is multiplied by there, ±1.
    pub sign: f64,
}

impl Mirror {
    /// Finds the twins of a robot's joints.
    pub fn of(robot: &Robot) -> Self {
        let poses = robot.zero_pose();
        let hinges = robot.joints.iter();
        let hinges: Vec<(DVec3, DVec3)> = hinges
            .map(|joint| (poses.anchor(joint).metres(), poses.axis(joint)))
            .collect();
        let partners = limb_pairs(robot);
        let partner = |index: usize| {
            let mut pairs = partners
                .iter()
                .flat_map(|&[one, other]| [(one, other), (other, one)]);
            pairs.find_map(|(one, other)| (one.0 == index).then_some(other.0))
        };
        let twin = |(index, &(anchor, axis)): (usize, &(DVec3, DVec3))| {
            let (anchor, axis) = (mirrored_point(anchor), mirrored_axis(axis));
            let place = partner(index).or_else(|| {
                hinges.iter().position(|other| {
                    axis.cross(other.1).length() < TOLERANCE
                        && (other.0 - anchor).length() < TOLERANCE
                })
            })?;
            Some(Twin {
                joint: JointId(place),
                sign: if axis.dot(hinges[place].1) < 0.0 {
                    -1.0
                } else {
                    1.0
                },
            })
        };
        Self(hinges.iter().enumerate().map(twin).collect())
    }

    /// The twin of a joint, `None` where the robot is not symmetric there.
    pub fn twin(&self, joint: JointId) -> Option<Twin> {
        self.0[joint.0]
    }

    /// The mirrored posture, rad; joints without a twin keep their angle.
    pub fn posture(&self, angles: &JointAngles) -> JointAngles {
        let mut mirrored = angles.clone();
        for (index, twin) in self.0.iter().enumerate() {
            if let Some(twin) = twin {
                mirrored[twin.joint] = twin.sign * angles[JointId(index)];
            }
        }
        mirrored
    }
}

/// The hinges of both sides' limbs by pairs, left and right, on the way from the root to toe and forearm;
/// of a limb that has more of them on one side, as many as both have.
pub(crate) fn limb_pairs(robot: &Robot) -> Vec<[JointId; 2]> {
    let [left, right] = robot.chain.sides();
    let mut pairs = Vec::new();
    for end in LIMBS {
        let [lefts, rights] = [left, right].map(|side| hinges_to(robot, end(robot, side)));
        pairs.extend(
            lefts
                .into_iter()
                .zip(rights)
                .map(|(left, right)| [left, right]),
        );
    }
    pairs
}

impl Robot {
    /// The hinges of both sides' limbs by pairs, left and right, on the way from the root to toe and
    /// forearm.
    pub fn limb_pairs(&self) -> Vec<[JointId; 2]> {
        limb_pairs(self)
    }
}

/// The last body of a side's limb.
type LimbEnd = fn(&Robot, &SideLayout) -> BodyId;

/// Leg and arm.
pub(crate) const LIMBS: [LimbEnd; 2] = [
    |_, side| side.toe.0,
    |robot, side| robot.joints[side.forearm[1].0].body,
];

/// The hinges on the way from the root to a body.
pub(crate) fn hinges_to(robot: &Robot, body: BodyId) -> Vec<JointId> {
    let hinges = robot
        .up_to_root(body)
        .filter_map(|body| robot.bodies[body.0].joint);
    let mut hinges: Vec<JointId> = hinges.collect();
    hinges.reverse();
    hinges
}

/// The mirror image of a point or a direction.
pub(crate) const fn mirrored_point(point: DVec3) -> DVec3 {
    DVec3::new(point.x, -point.y, point.z)
}

/// The mirror image of an axis of rotation.
pub(crate) const fn mirrored_axis(axis: DVec3) -> DVec3 {
    DVec3::new(-axis.x, axis.y, -axis.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Root, Transform};
    use crate::robot::testing;

    #[test]
    fn twins_are_each_others_and_the_image_of_the_image_is_the_posture() {
        let robot = testing::two_armed();
        let mirror = Mirror::of(&robot);
        for index in 0..robot.joints.len() {
            let twin = mirror.twin(JointId(index)).unwrap();
            let back = mirror.twin(twin.joint).unwrap();
            assert_eq!(back.joint, JointId(index));
            assert!((back.sign - twin.sign).abs() < f64::EPSILON);
        }
        let chain = &robot.chain;
        let pairs = chain.left.commanded_joints().into_iter();
        for (left, right) in pairs.zip(chain.right.commanded_joints()) {
            assert_eq!(mirror.twin(left).unwrap().joint, right);
        }
        let posture = JointAngles::from_fn(robot.joints.len(), |joint| 0.1 * joint.0 as f64);
        assert_eq!(mirror.posture(&mirror.posture(&posture)), posture);
    }

    /// The mirrored posture puts every body's hinge where the mirror image of its twin's is.
    #[test]
    fn left_mirrors_right() {
        let robot = testing::two_armed();
        let mirror = Mirror::of(&robot);
        let root = Transform::<Root, Root>::translation(DVec3::ZERO);
        let angle = |joint: JointId| 0.3 - 0.07 * joint.0 as f64;
        let posture = JointAngles::from_fn(robot.joints.len(), angle);
        let poses = robot.forward_kinematics(root, &posture);
        let images = robot.forward_kinematics(root, &mirror.posture(&posture));
        for (index, joint) in robot.joints.iter().enumerate() {
            let twin = &robot.joints[mirror.twin(JointId(index)).unwrap().joint.0];
            let here = poses.point((joint.body, joint.anchor)).metres();
            let there = images.point((twin.body, twin.anchor)).metres();
            let off = there - DVec3::new(here.x, -here.y, here.z);
            assert!(off.length() < 1e-9, "{}: {off}", joint.name);
        }
    }
}
