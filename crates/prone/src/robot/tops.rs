//! How high each part of the body comes.

use glam::DVec3;

use super::{BodyPoses, ContactGroup, Robot, Shape};
use crate::frames::Ground;

/// A part of the body whose height is recorded apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum BodyPart {
    /// Neck and head.
    Head,
    /// Trunk and pelvis.
    Trunk,
    /// From the shoulders to the hands.
    Arms,
    /// Thighs and shins.
    Legs,
    /// From the ankles on.
    Feet,
}

impl BodyPart {
    /// All parts, in the order of every array over them.
    pub const ALL: [Self; 5] = [Self::Head, Self::Trunk, Self::Arms, Self::Legs, Self::Feet];

    /// Name in records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Head => "head",
            Self::Trunk => "trunk",
            Self::Arms => "arms",
            Self::Legs => "legs",
            Self::Feet => "feet",
        }
    }

    /// The part that a shape belongs to.
    pub fn of(robot: &Robot, shape: &Shape) -> Self {
        let body = &robot.bodies[shape.body.0];
        match body.contact_group {
            ContactGroup::Head => Self::Head,
            ContactGroup::Toe => Self::Feet,
            ContactGroup::Elbow | ContactGroup::Hand => Self::Arms,
            ContactGroup::Torso => Self::Trunk,
            ContactGroup::Leg => Self::Legs,
        }
    }

    /// The parts that a robot's shapes belong to, in their order.
    pub fn of_shapes(robot: &Robot) -> Vec<Self> {
        let shapes = robot.shapes.iter();
        shapes.map(|shape| Self::of(robot, shape)).collect()
    }
}

/// Highest points above the floor, m, by [`BodyPart::ALL`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tops(pub [f64; 5]);

impl Tops {
    /// Of nothing yet.
    pub const NONE: Self = Self([f64::NEG_INFINITY; 5]);

    /// Of a robot in its poses; `parts` are those of its shapes.
    pub fn from_poses(robot: &Robot, parts: &[BodyPart], poses: &BodyPoses<Ground>) -> Self {
        let mut tops = Self::NONE;
        for (shape, part) in robot.shapes.iter().zip(parts) {
            let top = shape.reach_along(poses.of(shape.body), DVec3::Z);
            let place = &mut tops.0[*part as usize];
            *place = place.max(top);
        }
        tops
    }

    /// Of all parts.
    pub fn highest(&self) -> f64 {
        self.0.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// The part that reaches highest.
    pub fn part(&self) -> BodyPart {
        let parts = BodyPart::ALL.into_iter().zip(self.0);
        parts
            .max_by(|a, b| a.1.total_cmp(&b.1))
            .map_or(BodyPart::Trunk, |(part, _)| part)
    }

    /// Raises each part's point to another's where that is higher.
    pub fn raise(&mut self, other: &Self) {
        for (top, other) in self.0.iter_mut().zip(other.0) {
            *top = top.max(other);
        }
    }
}
