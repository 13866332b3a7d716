//! How the engine numbers bodies and writes down rotations.
//!
//! Its body 0 is the world, the robot's bodies follow in their order. Its quaternions begin with the
//! real part. A free root has seven coordinates, its position and its quaternion, and six speeds;
//! those of the joints follow.

use glam::DQuat;
use mujoco_rs::prelude::MjModel;

use prone::robot::BodyId;

/// The engine's body 0.
pub(crate) const WORLD_BODY: i32 = 0;
/// Coordinates of a free root: position and quaternion.
pub(crate) const FREE_JOINT: usize = 7;
/// Speeds of a free root: three linear, three angular.
pub(crate) const FREE_JOINT_SPEEDS: usize = 6;

/// The robot's body that has a number in the engine; `None` for the world.
pub(crate) fn robot_body(number: i32) -> Option<BodyId> {
    let number = usize::try_from(number).ok()?;
    number.checked_sub(1).map(BodyId)
}

/// Whether a geom touches anything at all.
pub(crate) fn collides(model: &MjModel, geom: usize) -> bool {
    model.geom_contype()[geom] != 0 || model.geom_conaffinity()[geom] != 0
}

pub(crate) const fn rotation([w, x, y, z]: [f64; 4]) -> DQuat {
    DQuat::from_xyzw(x, y, z, w)
}

pub(crate) const fn real_first(turn: DQuat) -> [f64; 4] {
    [turn.w, turn.x, turn.y, turn.z]
}
