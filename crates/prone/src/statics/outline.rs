//! Collision shapes as parts whose support function is cheap.
//!
//! Every primitive is the convex hull of balls, or of ellipsoids with half-axes matrix
//! Q = R diag(a²) Rᵀ about a centre o:
//!
//! ```text
//! ball:      h(d) = o·d + r            p(d) = o + r d                          (1)
//! ellipsoid: h(d) = o·d + √(dᵀQd)      p(d) = o + Q d / √(dᵀQd)                (2)
//! ```
//!
//! A capsule is two balls, a cuboid eight of radius zero, a cylinder two flat ellipsoids.

use glam::{DMat3, DVec3};

use crate::frames::{Frame, Link, Transform};
use crate::robot::{Shape, Solid};

/// One part of a shape.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    /// Index in [`crate::robot::Robot::shapes`].
    pub(super) shape: usize,
    centre: DVec3,
    bulge: Bulge,
}

/// How far a part extends from its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Bulge {
    /// Radius.
    Ball(f64),
    /// Q of equation (2).
    Ellipsoid(DMat3),
}

impl Part {
    /// The parts of a shape in its body's frame.
    pub(super) fn from_shape(shape: &Shape, index: usize) -> Vec<Self> {
        let axes = DMat3::from_quat(shape.link_from_geom.rotation());
        let origin = shape.link_from_geom.origin().metres();
        let part = |offset: DVec3, bulge: Bulge| Self {
            shape: index,
            centre: origin + axes * offset,
            bulge,
        };
        let ends = |half_length: f64| [-half_length, half_length].map(|z| DVec3::Z * z);
        let ellipsoid = |half_axes: DVec3| {
            let squares = DMat3::from_diagonal(half_axes * half_axes);
            Bulge::Ellipsoid(axes * squares * axes.transpose())
        };
        match shape.solid {
            Solid::Sphere { radius } => vec![part(DVec3::ZERO, Bulge::Ball(radius))],
            Solid::Capsule {
                radius,
                half_length,
            } => ends(half_length)
                .map(|end| part(end, Bulge::Ball(radius)))
                .to_vec(),
            Solid::Ellipsoid { half_axes } => vec![part(DVec3::ZERO, ellipsoid(half_axes))],
            Solid::Cylinder {
                radius,
                half_length,
            } => {
                let cap = ellipsoid(DVec3::new(radius, radius, 0.0));
                ends(half_length).map(|end| part(end, cap)).to_vec()
            }
            Solid::Cuboid { half_edges } => (0..8)
                .map(|corner| {
                    let sign = |bit: u8| if corner & bit == 0 { -1.0 } else { 1.0 };
                    let signs = DVec3::new(sign(1), sign(2), sign(4));
                    part(signs * half_edges, Bulge::Ball(0.0))
                })
                .collect(),
        }
    }

    /// The same part in another frame.
    pub(super) fn placed<F: Frame>(&self, frame_from_link: &Transform<F, Link>) -> Self {
        let centre = frame_from_link.rotation() * self.centre + frame_from_link.origin().metres();
        let bulge = match self.bulge {
            Bulge::Ball(radius) => Bulge::Ball(radius),
            Bulge::Ellipsoid(squares) => {
                let turn = DMat3::from_quat(frame_from_link.rotation());
                Bulge::Ellipsoid(turn * squares * turn.transpose())
            }
        };
        Self {
            shape: self.shape,
            centre,
            bulge,
        }
    }

    /// h(d) for a unit vector.
    pub(super) fn reach(&self, direction: DVec3) -> f64 {
        let bulge = match &self.bulge {
            Bulge::Ball(radius) => *radius,
            // Rounding may leave it below zero on the axis of a flat cap.
            Bulge::Ellipsoid(squares) => direction.dot(*squares * direction).max(0.0).sqrt(),
        };
        self.centre.dot(direction) + bulge
    }

    /// p(d) for a unit vector; the middle where a flat cap touches as a whole.
    pub(super) fn touching(&self, direction: DVec3) -> DVec3 {
        match &self.bulge {
            Bulge::Ball(radius) => self.centre + *radius * direction,
            Bulge::Ellipsoid(squares) => {
                let along = *squares * direction;
                let square = direction.dot(along);
                if square > 0.0 {
                    self.centre + along / square.sqrt()
                } else {
                    self.centre
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DQuat;
    use proptest::prelude::*;

    use super::*;
    use crate::frames::Root;
    use crate::robot::BodyId;

    proptest! {
        /// The parts' hull reaches exactly as far as the shape they are made of, and the touching
        /// point is as far out as it says.
        #[test]
        fn parts_have_the_support_function_of_their_shape(
            axis in prop::array::uniform3(-1.0..1.0_f64), turn in -3.0..3.0_f64,
            towards in prop::array::uniform3(-1.0..1.0_f64), which in 0..5_usize,
        ) {
            let (axis, towards) = (DVec3::from_array(axis), DVec3::from_array(towards));
            prop_assume!(axis.length() > 0.1 && towards.length() > 0.1);
            let (axis, towards) = (axis.normalize(), towards.normalize());
            let solid = [
                Solid::Sphere { radius: 0.03 },
                Solid::Capsule { radius: 0.02, half_length: 0.05 },
                Solid::Ellipsoid { half_axes: DVec3::new(0.02, 0.05, 0.09) },
                Solid::Cylinder { radius: 0.02, half_length: 0.05 },
                Solid::Cuboid { half_edges: DVec3::new(0.02, 0.05, 0.09) },
            ][which];
            let shape = Shape {
                name: String::new(),
                body: BodyId(0),
                link_from_geom: Transform::new(DQuat::from_axis_angle(axis, turn), towards),
                solid,
            };
            let root_from_link =
                Transform::<Root, Link>::new(DQuat::from_axis_angle(towards, 1.0), axis);
            let down = (axis + 2.0 * towards).normalize();
            let parts: Vec<_> =
                Part::from_shape(&shape, 0).iter().map(|part| part.placed(&root_from_link)).collect();
            let reach = parts.iter().map(|part| part.reach(down)).fold(f64::MIN, f64::max);
            prop_assert!((reach - shape.reach_along(&root_from_link, down)).abs() < 1e-12);
            for part in parts {
                prop_assert!((part.touching(down).dot(down) - part.reach(down)).abs() < 1e-12);
            }
        }
    }
}
