//! Collision primitives, and how far they reach in a direction.

use glam::DVec3;

use super::{BodyId, BodyPoses, Robot};
use crate::frames::{Frame, Geom, Ground, Link, Transform};

/// A primitive fixed to a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// Name in the model.
    pub name: String,
    /// The body it is fixed to.
    pub body: BodyId,
    /// Its pose in the body.
    pub link_from_geom: Transform<Link, Geom>,
    /// What it is.
    pub solid: Solid,
}

/// A convex primitive about its own origin, metres; long axes lie along z (MJCF's convention).
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Solid {
    /// A ball.
    Sphere {
        /// Radius.
        radius: f64,
    },
    /// A cylinder with round caps.
    Capsule {
        /// Radius.
        radius: f64,
        /// Half the cylindrical part's length.
        half_length: f64,
    },
    /// An ellipsoid.
    Ellipsoid {
        /// Half-axes.
        half_axes: DVec3,
    },
    /// A cylinder with flat caps.
    Cylinder {
        /// Radius.
        radius: f64,
        /// Half the length.
        half_length: f64,
    },
    /// A cuboid.
    Cuboid {
        /// Half-edges.
        half_edges: DVec3,
    },
}

impl Solid {
    /// The support function: how far the solid reaches from its origin along a unit vector of
    /// its own frame, metres.
    pub fn reach(&self, direction: DVec3) -> f64 {
        match *self {
            Self::Sphere { radius } => radius,
            Self::Capsule {
                radius,
                half_length,
            } => radius + half_length * direction.z.abs(),
            Self::Ellipsoid { half_axes } => (half_axes * direction).length(),
            Self::Cylinder {
                radius,
                half_length,
            } => radius * direction.truncate().length() + half_length * direction.z.abs(),
            Self::Cuboid { half_edges } => half_edges.dot(direction.abs()),
        }
    }
}

impl Solid {
    /// Least extent over all directions, metres: turned any way, it needs at least that much room
    /// between two parallel planes.
    pub fn thickness(&self) -> f64 {
        2.0 * match *self {
            Self::Sphere { radius } | Self::Capsule { radius, .. } => radius,
            Self::Ellipsoid { half_axes } => half_axes.min_element(),
            Self::Cylinder {
                radius,
                half_length,
            } => radius.min(half_length),
            Self::Cuboid { half_edges } => half_edges.min_element(),
        }
    }
}

impl Shape {
    /// How far the shape reaches along a unit direction of frame `F`, metres from its origin.
    pub fn reach_along<F: Frame>(&self, frame_from_link: &Transform<F, Link>, axis: DVec3) -> f64 {
        let frame_from_geom = *frame_from_link * self.link_from_geom;
        let local = frame_from_geom.rotation().inverse() * axis;
        frame_from_geom.origin().metres().dot(axis) + self.solid.reach(local)
    }
}

impl Robot {
    /// Height above the floor of the highest point of the shapes that `wanted` selects, metres;
    /// −∞ where it selects none.
    pub fn top(&self, poses: &BodyPoses<Ground>, wanted: impl Fn(&Shape) -> bool) -> f64 {
        self.reach_of(poses, DVec3::Z, wanted)
    }

    /// How far the robot reaches along a unit direction of the ground frame, m from its origin.
    pub fn reach(&self, poses: &BodyPoses<Ground>, direction: DVec3) -> f64 {
        self.reach_of(poses, direction, |_| true)
    }

    /// Height above the floor of the lowest point of the shapes that `wanted` selects, metres; ∞
    /// where it selects none.
    pub fn bottom(&self, poses: &BodyPoses<Ground>, wanted: impl Fn(&Shape) -> bool) -> f64 {
        -self.reach_of(poses, DVec3::NEG_Z, wanted)
    }

    fn reach_of(
        &self,
        poses: &BodyPoses<Ground>,
        direction: DVec3,
        wanted: impl Fn(&Shape) -> bool,
    ) -> f64 {
        let shapes = self.shapes.iter().filter(|shape| wanted(shape));
        shapes
            .map(|shape| shape.reach_along(poses.of(shape.body), direction))
            .fold(f64::NEG_INFINITY, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// No point of the surface reaches farther than the support function says, and one
        /// comes close.
        #[test]
        fn reach_bounds_the_surface(x in -1.0..1.0_f64, y in -1.0..1.0_f64, z in -1.0..1.0_f64) {
            prop_assume!(DVec3::new(x, y, z).length() > 0.1);
            let direction = DVec3::new(x, y, z).normalize();
            let half = DVec3::new(0.02, 0.05, 0.09);
            let ellipsoid = Solid::Ellipsoid { half_axes: half };
            let cuboid = Solid::Cuboid { half_edges: half };
            let mut farthest: f64 = 0.0;
            for i in 0..120 {
                for j in 0..60 {
                    let (u, v) = (f64::from(i) * 0.0524, f64::from(j) * 0.0524);
                    let unit = DVec3::new(u.cos() * v.sin(), u.sin() * v.sin(), v.cos());
                    farthest = farthest.max((half * unit).dot(direction));
                }
            }
            prop_assert!(farthest <= ellipsoid.reach(direction) + 1e-12);
            prop_assert!(farthest > 0.99 * ellipsoid.reach(direction));
            // A box holds its ellipsoid.
            prop_assert!(cuboid.reach(direction) >= ellipsoid.reach(direction));
        }
    }

    #[test]
    fn a_capsule_is_longest_along_its_axis() {
        let capsule = Solid::Capsule {
            radius: 0.02,
            half_length: 0.05,
        };
        assert!((capsule.reach(DVec3::Z) - 0.07).abs() < 1e-15);
        assert!((capsule.reach(DVec3::X) - 0.02).abs() < 1e-15);
        let cylinder = Solid::Cylinder {
            radius: 0.02,
            half_length: 0.05,
        };
        assert!((cylinder.reach(DVec3::Z) - 0.05).abs() < 1e-15);
    }
}
