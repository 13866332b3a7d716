//! Whether a robot's own kinematics put its limbs where the planar chain says.
//!
//! The mapping reads lengths, zeros and signs at zero joint angles. That they hold at all others
//! takes joints that move what their names say and two sides that are alike, so a few postures
//! are compared with the robot's forward kinematics, and the first point that is off is named.

use glam::{DQuat, DVec3};

use super::{ArmMode, Mapping, MappingError, MappingVariant};
use crate::chain::ChainAngles;
use crate::frames::{Ground, Point, Root, Transform};
use crate::robot::{BodyPoses, JointId, Robot, SideLayout};

/// Largest distance from the planar chain, m: what six decimals in a model file leave over.
const TOLERANCE: f64 = 1e-6;

const POINTS: [&str; 6] = ["toe", "ankle", "knee", "hip", "shoulder", "elbow"];

/// Arbitrary postures, θ1 to θ5, and forearm angles, rad. None is zero and no two are equal, so that a joint
/// that moves the wrong part shows.
const PROBES: [([f64; 5], [f64; 2]); 3] = [
    ([0.9, -1.3, 0.4, 0.25, -1.1], [0.6, -0.8]),
    ([0.3, -0.6, 0.85, -0.35, -2.0], [-1.2, 0.5]),
    ([1.4, -2.1, -0.2, 0.7, -0.5], [0.9, 1.3]),
];

/// Compares the robot's limbs with its exact planar chain in a few postures, on both sides.
///
/// # Errors
/// [`MappingError::DoesNotClose`], and those of [`Mapping::new`] for the exact mapping.
pub fn check_kinematics(robot: &Robot) -> Result<(), MappingError> {
    let mapping = Mapping::new(robot, MappingVariant::Exact, ArmMode::FlatForearm)?;
    for (chain, forearm) in PROBES {
        let chain = ChainAngles::from_array(chain);
        let poses = grounded(robot, &mapping, &chain, forearm);
        let planar = mapping.chain().posture(&chain).points();
        for (side, layout) in ["left", "right"].into_iter().zip(robot.chain.sides()) {
            let ours = points(robot, &poses, layout);
            for ((point, ours), wanted) in POINTS.into_iter().zip(ours).zip(planar) {
                let off = (ours.x() - wanted.x()).hypot(ours.z() - wanted.z());
                if off.is_nan() || off > TOLERANCE {
                    return Err(MappingError::DoesNotClose {
                        side,
                        point,
                        off_mm: off * 1e3,
                    });
                }
            }
        }
    }
    Ok(())
}

/// The robot in a chain posture, its left toe at the origin.
fn grounded(
    robot: &Robot,
    mapping: &Mapping,
    chain: &ChainAngles,
    forearm: [f64; 2],
) -> BodyPoses<Ground> {
    let mut joints = mapping.unspread_limb_angles(robot, chain);
    for side in robot.chain.sides() {
        for (id, angle) in side.forearm.into_iter().zip(forearm) {
            joints[id] = angle;
        }
    }
    let turn = DQuat::from_rotation_y(mapping.root_pitch(chain));
    let turned = Transform::<Ground, Root>::new(turn, DVec3::ZERO);
    let toe = robot
        .forward_kinematics(turned, &joints)
        .point(robot.chain.left.toe);
    robot.forward_kinematics(Transform::<Ground, Root>::new(turn, -toe.metres()), &joints)
}

/// Toe to elbow, as in [`crate::chain::ChainPosture::points`].
fn points(robot: &Robot, poses: &BodyPoses<Ground>, side: &SideLayout) -> [Point<Ground>; 6] {
    let centre = |id: JointId| poses.anchor(&robot.joints[id.0]);
    [
        poses.point(side.toe),
        centre(side.ankle),
        centre(side.knee),
        centre(side.hip),
        centre(side.shoulder),
        poses.point(side.elbow),
    ]
}
