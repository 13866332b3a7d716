//! An ellipsoid as balls inside it, for formats that know no ellipsoid.
//!
//! Half-axes are a ≤ b ≤ c, along the axes that are called x, y and z here. A ball that lies inside
//! and touches the surface where y = ub and z = vc, on both sides of the plane x = 0, has
//!
//! ```text
//! centre = (0, u (b² − a²)/b, v (c² − a²)/c)                                     (1)
//! radius = a √(1 − u² (1 − a²/b²) − v² (1 − a²/c²))        u² + v² ≤ 1           (2)
//! ```
//!
//! since the normal at a point of the surface is along (x/a², y/b², z/c²). All these balls together
//! are the ellipsoid. Those on a few rings of the disc u² + v² ≤ 1 have nearly its convex hull, and
//! nowhere reach out of it.

use std::f64::consts::TAU;

use glam::DVec3;

/// Rings of the disc, around its middle. Ring k has 8k − 4 balls, one on either end of both axes.
const RINGS: u32 = 3;

/// Two centres nearer than this are one, m: an ellipsoid of revolution has the same ball again.
const SAME: f64 = 1e-9;

/// A ball inside an ellipsoid.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// Centre along the ellipsoid's axes, from its centre, m.
    pub centre: DVec3,
    /// Radius, m.
    pub radius: f64,
}

/// Balls inside the ellipsoid with these half-axes, m: one for a sphere, at most 37.
#[must_use]
pub fn balls(half_axes: DVec3) -> Vec<Ball> {
    let mut axes = [
        (half_axes.x, DVec3::X),
        (half_axes.y, DVec3::Y),
        (half_axes.z, DVec3::Z),
    ];
    axes.sort_by(|one, other| one.0.total_cmp(&other.0));
    let [(a, _), (b, along_b), (c, along_c)] = axes;
    let ring = |k: u32| {
        let balls = 8 * k - 4;
        (0..balls).map(move |ball| (k, TAU * f64::from(ball) / f64::from(balls)))
    };
    let mut found: Vec<Ball> = Vec::new();
    for (k, angle) in std::iter::once((0, 0.0)).chain((1..=RINGS).flat_map(ring)) {
        let (sine, cosine) = angle.sin_cos();
        let from_middle = f64::from(k) / f64::from(RINGS);
        let (u, v) = (from_middle * cosine, from_middle * sine);
        let centre = u * (b * b - a * a) / b * along_b + v * (c * c - a * a) / c * along_c;
        let left = 1.0 - u * u * (1.0 - (a / b).powi(2)) - v * v * (1.0 - (a / c).powi(2));
        let known = |ball: &Ball| ball.centre.distance(centre) < SAME;
        if !found.iter().any(known) {
            // Of u² + v² ≤ 1 what is left is at least (a/c)².
            let radius = a * left.sqrt();
            found.push(Ball { centre, radius });
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use prone::robot::Solid;

    use super::balls;

    /// How far all balls together reach in a direction of length 1, m.
    fn reach(half_axes: DVec3, direction: DVec3) -> f64 {
        let each = balls(half_axes).into_iter();
        each.map(|ball| ball.centre.dot(direction) + ball.radius)
            .fold(f64::NEG_INFINITY, f64::max)
    }

    #[test]
    fn limit_a_sphere_is_one_ball() {
        let found = balls(DVec3::splat(0.03));
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].centre, found[0].radius), (DVec3::ZERO, 0.03));
    }

    proptest! {
        /// Along its axes they reach as far as the ellipsoid.
        #[test]
        fn identity_the_balls_reach_the_ends_of_the_axes(
            half in prop::array::uniform3(0.01..0.1),
        ) {
            let half = DVec3::from(half);
            for (length, axis) in [(half.x, DVec3::X), (half.y, DVec3::Y), (half.z, DVec3::Z)] {
                for end in [axis, -axis] {
                    prop_assert!((reach(half, end) - length).abs() < 1e-12);
                }
            }
        }

        /// Never outside, and on the NAO's head and chest not far inside.
        #[test]
        fn identity_the_balls_have_the_hull_of_their_ellipsoid(
            longitude in 0.0..std::f64::consts::TAU,
            height in -1.0..1.0_f64,
        ) {
            let flat = (1.0 - height * height).sqrt();
            let direction = DVec3::new(flat * longitude.cos(), flat * longitude.sin(), height);
            for (half, inside) in [
                (DVec3::new(0.058, 0.064, 0.058), 0.2e-3),
                (DVec3::new(0.052, 0.070, 0.075), 1.2e-3),
            ] {
                let ellipsoid = Solid::Ellipsoid { half_axes: half };
                let short_by = ellipsoid.reach(direction) - reach(half, direction);
                prop_assert!((-1e-12..inside).contains(&short_by), "{short_by} {direction}");
            }
        }
    }
}
