//! What a scene does to a robot in one place, and what its obstacles are called.

use glam::DVec3;

use super::Obstacle;
use crate::frames::{Ground, Point};
use crate::robot::BodyId;

/// What the world does to the robot in one place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactForce {
    /// The part of the robot.
    pub body: BodyId,
    /// The obstacle's place in [`super::Scene::obstacles`]; `None` for floor and rough
    /// ground.
    pub obstacle: Option<usize>,
    /// Where.
    pub at: Point<Ground>,
    /// Force on the robot in the ground frame, N.
    pub force: DVec3,
}

/// What an obstacle is called in records: its kind and which of them it is, from 1.
pub fn obstacle_name(obstacles: &[Obstacle], index: usize) -> String {
    let kind = obstacles[index].kind;
    let before = obstacles[..index].iter();
    let number = before.filter(|other| other.kind == kind).count() + 1;
    format!("{} {number}", kind.name())
}
