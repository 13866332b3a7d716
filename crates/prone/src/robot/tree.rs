//! Which bodies hang on which: a robot is a tree with its root on top.

use super::{BodyId, Robot};

impl Robot {
    /// A body, its parent, and so on up to the root.
    pub fn up_to_root(&self, body: BodyId) -> impl Iterator<Item = BodyId> {
        std::iter::successors(Some(body), |body| self.bodies[body.0].parent)
    }

    /// Whether `body` is `ancestor` itself, or hangs on it by any number of joints: whether a joint
    /// that turns `ancestor` moves `body`.
    pub fn moves_with(&self, body: BodyId, ancestor: BodyId) -> bool {
        self.up_to_root(body).any(|above| above == ancestor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::{Link, Root, Transform};
    use crate::robot::{JointAngles, JointId, testing};

    #[test]
    fn every_body_moves_with_itself_its_parent_and_the_root() {
        let robot = testing::two_armed();
        for (index, body) in robot.bodies.iter().enumerate() {
            let id = BodyId(index);
            assert!(robot.moves_with(id, id), "{}", body.name);
            assert!(robot.moves_with(id, BodyId(0)), "{}", body.name);
            if let Some(parent) = body.parent {
                assert!(robot.moves_with(id, parent), "{}", body.name);
                assert!(!robot.moves_with(parent, id), "{}", body.name);
            }
        }
    }

    #[test]
    fn a_limb_does_not_move_with_another() {
        let robot = testing::two_armed();
        let [left, right] = robot.chain.sides();
        let body = |joint: JointId| robot.joints[joint.0].body;
        assert!(robot.moves_with(left.toe.0, body(left.hip)));
        assert!(!robot.moves_with(left.toe.0, body(right.hip)));
        assert!(!robot.moves_with(left.toe.0, body(left.shoulder)));
        assert!(robot.moves_with(body(left.forearm[1]), body(left.shoulder)));
        // An upper arm is not beyond its elbow.
        assert!(!robot.moves_with(left.elbow.0, body(left.forearm[0])));
    }

    /// A turned joint moves the bodies that hang on the one that it turns, and no others.
    #[test]
    fn what_moves_with_a_body_is_what_its_joint_moves() {
        let robot = testing::two_armed();
        let root = Transform::<Root, Root>::translation(glam::DVec3::ZERO);
        let zero = JointAngles::zero(&robot);
        let rest = robot.forward_kinematics(root, &zero);
        for (index, joint) in robot.joints.iter().enumerate() {
            let mut angles = zero.clone();
            angles[JointId(index)] = 0.5;
            let turned = robot.forward_kinematics(root, &angles);
            let changed = |before: &Transform<Root, Link>, after: &Transform<Root, Link>| {
                before.rotation().angle_between(after.rotation()) > 1e-6
            };
            for body in (0..robot.bodies.len()).map(BodyId) {
                assert_eq!(
                    robot.moves_with(body, joint.body),
                    changed(rest.of(body), turned.of(body)),
                    "{} turns {}",
                    joint.name,
                    robot.bodies[body.0].name
                );
            }
        }
    }
}
