//! A scene's friction, which belongs to the sides of the robot.
//!
//! The engine takes the larger friction of two geoms. So the robot's geoms carry it, and all that
//! they touch has none.

use mujoco_rs::prelude::MjModel;

use prone::robot::{BodyId, JointId, Robot};
use prone::scene::SideFriction;

use super::GeomRole;

/// Which friction a body has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Left,
    Right,
    /// Trunk and head.
    Middle,
}

pub(super) fn set_by_side(
    model: &mut MjModel,
    roles: &[GeomRole],
    robot: &Robot,
    friction: SideFriction,
) {
    let sides = sides(robot);
    for (geom, role) in model.geom_friction_mut().iter_mut().zip(roles) {
        geom[0] = match role {
            GeomRole::Robot(body) => match sides[body.0] {
                Side::Left => friction.left,
                Side::Right => friction.right,
                Side::Middle => friction.mean(),
            },
            GeomRole::Floor | GeomRole::Obstacle(_) | GeomRole::Marker => 0.0,
        };
    }
}

/// The side of each body: a leg is the part of the tree that holds its hip and not the other one,
/// an arm the same with the shoulders; what is in no limb is in the middle.
fn sides(robot: &Robot) -> Vec<Side> {
    let (left, right) = (&robot.chain.left, &robot.chain.right);
    let limbs = [
        (Side::Left, limb(robot, left.hip, right.hip)),
        (Side::Left, limb(robot, left.shoulder, right.shoulder)),
        (Side::Right, limb(robot, right.hip, left.hip)),
        (Side::Right, limb(robot, right.shoulder, left.shoulder)),
    ];
    (0..robot.bodies.len())
        .map(|body| {
            limbs
                .iter()
                .find(|(_, root)| robot.moves_with(BodyId(body), *root))
                .map_or(Side::Middle, |(side, _)| *side)
        })
        .collect()
}

/// The first body of the limb that holds `joint` and not `other`.
fn limb(robot: &Robot, joint: JointId, other: JointId) -> BodyId {
    let [body, other] = [joint, other].map(|joint| robot.joints[joint.0].body);
    robot
        .up_to_root(body)
        .take_while(|above| !robot.moves_with(other, *above))
        .last()
        .unwrap_or(body)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LoadedRobot, RobotFiles};
    use prone_files::shipped;

    #[test]
    fn limbs_have_sides_and_trunk_and_head_have_none() {
        let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let robot = loaded.robot();
        let sides = sides(robot);
        let (left, right) = (&robot.chain.left, &robot.chain.right);
        assert_eq!(sides[left.toe.0.0], Side::Left);
        assert_eq!(sides[left.elbow.0.0], Side::Left);
        assert_eq!(sides[right.toe.0.0], Side::Right);
        assert_eq!(sides[right.elbow.0.0], Side::Right);
        let count = |wanted| sides.iter().filter(|&&side| side == wanted).count();
        assert_eq!(count(Side::Left), count(Side::Right));
        // The trunk, the neck and the head.
        assert_eq!(count(Side::Middle), 3);
        for (body, side) in robot.bodies.iter().zip(&sides) {
            assert!(!body.is_head || *side == Side::Middle, "{}", body.name);
        }
    }
}
