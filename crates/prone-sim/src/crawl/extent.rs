//! How much room a crawl takes beside itself, and how near the robot's parts came to one another in
//! it: measured postures, every [`super::ROW_STEP`].

use glam::DVec3;

use prone::frames::{Ground, Root, Transform};
use prone::robot::{BodyPoses, JointAngles, Robot};
use prone::steering::Bearing;

use crate::self_collision::{Found, SelfCollision};
use crate::world::World;

/// How far the robot reaches to either side of the line through its root along its own heading, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sides {
    /// To its left.
    pub left: f64,
    /// To its right.
    pub right: f64,
}

/// The two parts of the robot that came nearest to one another.
#[derive(Debug, Clone, PartialEq)]
pub struct NearestParts {
    /// Names of the shapes.
    pub shapes: (String, String),
    /// Between their surfaces, m; negative where they were in one another.
    pub distance_m: f64,
    /// When, s since the first pull began.
    pub time: f64,
}

/// The nearest parts while a crawl goes on.
pub(super) struct Nearness {
    /// Nothing of a robot that has no two parts to compare.
    collision: Option<SelfCollision>,
    found: Option<(Found, f64)>,
}

impl Sides {
    /// Of a robot that has not been anywhere.
    pub(super) const NONE: Self = Self {
        left: f64::NEG_INFINITY,
        right: f64::NEG_INFINITY,
    };

    /// Of a posture, from the colliding shapes.
    pub(super) fn from_poses(
        robot: &Robot,
        poses: &BodyPoses<Ground>,
        root: &Transform<Ground, Root>,
    ) -> Self {
        let (sin, cos) = Bearing::of_prone(root).yaw.sin_cos();
        let left = DVec3::new(-sin, cos, 0.0);
        let line = root.origin().metres().dot(left);
        Self {
            left: robot.reach(poses, left) - line,
            right: robot.reach(poses, -left) + line,
        }
    }

    /// Takes in what reaches farther.
    pub(super) fn widen(&mut self, other: Self) {
        self.left = self.left.max(other.left);
        self.right = self.right.max(other.right);
    }

    /// Of both sides, m.
    pub fn width(&self) -> f64 {
        self.left + self.right
    }
}

impl Nearness {
    pub(super) fn new(world: &World) -> Self {
        Self {
            collision: SelfCollision::new(world).ok(),
            found: None,
        }
    }

    /// A measured posture, `time` s after the first pull began.
    pub(super) fn see(&mut self, posture: &JointAngles, time: f64) {
        let Some(collision) = &mut self.collision else {
            return;
        };
        let before = self.found.map(|(found, _)| found);
        // An angle that is no number ends the simulation, which says so itself.
        let Ok(found) = collision.nearer(before, posture, 0) else {
            return;
        };
        let is_nearer = before.is_none_or(|before| found.distance < before.distance);
        if is_nearer {
            self.found = Some((found, time));
        }
    }

    pub(super) fn finish(self) -> Option<NearestParts> {
        let (found, time) = self.found?;
        let nearest = self.collision?.named(found);
        Some(NearestParts {
            shapes: nearest.shapes,
            distance_m: nearest.distance_m,
            time,
        })
    }
}

#[cfg(test)]
mod tests;
