//! A scene's friction, which belongs to the sides of the robot.
//!
//! The engine takes the larger friction of two geoms. So the robot's geoms carry it, and all that
//! they touch has none.

use mujoco_rs::prelude::MjModel;

use prone::robot::{BodyId, JointId, Robot};
use prone::scene::SideFriction;

use super::GeomRole;

pub(super) fn set_by_side(
    model: &mut MjModel,
    roles: &[GeomRole],
    robot: &Robot,
    friction: SideFriction,
) {
    let of_bodies = of_bodies(robot, friction);
    for (geom, role) in model.geom_friction_mut().iter_mut().zip(roles) {
        geom[0] = match role {
            GeomRole::Robot(body) => of_bodies[body.0],
            GeomRole::Floor | GeomRole::Obstacle(_) | GeomRole::Marker => 0.0,
        };
    }
}

/// The friction of each body: a leg is the part of the tree that holds its hip and not the other one,
/// an arm the same with the shoulders; what is in no limb has the mean of both sides.
fn of_bodies(robot: &Robot, friction: SideFriction) -> Vec<f64> {
    let (left, right) = (&robot.chain.left, &robot.chain.right);
    let limbs = [
        (friction.left, limb(robot, left.hip, right.hip)),
        (friction.left, limb(robot, left.shoulder, right.shoulder)),
        (friction.right, limb(robot, right.hip, left.hip)),
        (friction.right, limb(robot, right.shoulder, left.shoulder)),
    ];
    (0..robot.bodies.len())
        .map(|body| {
            limbs
                .iter()
                .find(|(_, root)| robot.moves_with(BodyId(body), *root))
                .map_or(friction.mean(), |(friction, _)| *friction)
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
        const FRICTION: SideFriction = SideFriction {
            left: 1.0,
            right: 2.0,
        };
        const MIDDLE: f64 = 1.5;
        let is = |one: f64, other: f64| (one - other).abs() < 1e-12;
        let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let robot = loaded.robot();
        let bodies = of_bodies(robot, FRICTION);
        let sides = [FRICTION.left, FRICTION.right];
        for (side, friction) in robot.chain.sides().into_iter().zip(sides) {
            assert!(is(bodies[side.toe.0.0], friction));
            assert!(is(bodies[side.elbow.0.0], friction));
        }
        let count = |wanted| bodies.iter().filter(|&&it| is(it, wanted)).count();
        assert_eq!(count(FRICTION.left), count(FRICTION.right));
        // The trunk, the neck and the head.
        assert_eq!(count(MIDDLE), 3);
        for (body, &friction) in robot.bodies.iter().zip(&bodies) {
            assert!(!body.is_head() || is(friction, MIDDLE), "{}", body.name);
        }
    }
}
