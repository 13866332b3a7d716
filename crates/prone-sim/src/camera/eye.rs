//! What a camera of the robot itself sees.

use std::sync::Arc;

use glam::DVec3;
use mujoco_rs::prelude::{MjData, MjModel};

use prone::robot::BodyId;

use super::Camera;

/// How far behind the camera's place in the model its pictures are taken, m: that place may be on
/// the face, which touches the floor when the head is pitched down.
const DEPTH: f64 = 0.005;

impl Camera {
    /// The first camera of the robot's model where it is now; `None` for a model without one.
    ///
    /// `data` must be up to date.
    pub fn eye(data: &MjData<Arc<MjModel>>) -> Option<Self> {
        let fov = data.model().cam_fovy().first()?;
        let position = DVec3::from_array(*data.cam_xpos().first()?);
        let [_, y, z] = columns(data.cam_xmat().first()?);
        // In the engine a camera looks along -z, with +y up.
        let position = position + DEPTH * z;
        let body = usize::try_from(*data.model().cam_bodyid().first()?).ok()?;
        Some(Self {
            position,
            target: position - z,
            vertical_fov: fov.to_radians(),
            up: y,
            // The engine's body 0 is the world.
            inside: body.checked_sub(1).map(BodyId),
        })
    }
}

/// The axes of a frame as columns of its matrix, which the engine keeps row by row.
const fn columns(rows: &[f64; 9]) -> [DVec3; 3] {
    let m = rows;
    [
        DVec3::new(m[0], m[3], m[6]),
        DVec3::new(m[1], m[4], m[7]),
        DVec3::new(m[2], m[5], m[8]),
    ]
}
