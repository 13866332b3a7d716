//! Frames in the types.
//!
//! Convention: right-handed, x forward, y left, z up. A rotation about +y by `q` therefore turns
//! +x towards −z. In the sagittal plane (x, z) angles are counted from +x towards +z, so the same
//! rotation changes a sagittal angle by `−q`.
//!
//! ```
//! use prone::frames::{Ground, Link, Point, Root, Transform};
//!
//! let ground_from_root = Transform::<Ground, Root>::translation(glam::DVec3::Z);
//! let root_from_knee = Transform::<Root, Link>::translation(glam::DVec3::X);
//! let knee: Point<Ground> = ground_from_root * root_from_knee * Point::ORIGIN;
//! assert_eq!(knee.metres(), glam::DVec3::new(1.0, 0.0, 1.0));
//! ```

use std::marker::PhantomData;
use std::ops::Mul;

use glam::{DQuat, DVec3};

/// Names a coordinate frame at compile time.
pub trait Frame: Copy {}

/// Fixed to the floor: x the direction of travel, z up, z = 0 on the floor. The closed chain's
/// origin is the toe contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Ground {}
/// Fixed to the robot's root body (the trunk), as its model defines it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Root {}
/// Fixed to one body of the robot; which one is said beside the value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Link {}
/// Fixed to one collision primitive, long axis along z; which one is said beside the value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Geom {}
/// Fixed to the inertial measurement unit, along its own axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Sensor {}

impl Frame for Ground {}
impl Frame for Root {}
impl Frame for Link {}
impl Frame for Geom {}
impl Frame for Sensor {}

/// A point in frame `F`, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point<F: Frame> {
    metres: DVec3,
    frame: PhantomData<F>,
}

impl<F: Frame> Point<F> {
    /// The origin of the frame.
    pub const ORIGIN: Self = Self::new(DVec3::ZERO);

    /// A point from its coordinates, metres.
    pub const fn new(metres: DVec3) -> Self {
        Self {
            metres,
            frame: PhantomData,
        }
    }

    /// A point of the sagittal plane (y = 0), metres.
    pub const fn sagittal(x: f64, z: f64) -> Self {
        Self::new(DVec3::new(x, 0.0, z))
    }

    /// The coordinates, metres.
    pub const fn metres(self) -> DVec3 {
        self.metres
    }

    /// Forward coordinate, metres.
    pub const fn x(self) -> f64 {
        self.metres.x
    }

    /// Upward coordinate, metres.
    pub const fn z(self) -> f64 {
        self.metres.z
    }
}

/// The rigid motion that takes coordinates in `Source` to coordinates in `Target`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transform<Target: Frame, Source: Frame> {
    rotation: DQuat,
    translation: DVec3,
    frames: PhantomData<(Target, Source)>,
}

impl<Target: Frame, Source: Frame> Transform<Target, Source> {
    /// A transform from a unit quaternion and the source's origin in the target frame, metres.
    pub const fn new(rotation: DQuat, translation: DVec3) -> Self {
        Self {
            rotation,
            translation,
            frames: PhantomData,
        }
    }

    /// The source frame moved by `translation`, metres, without turning.
    pub const fn translation(translation: DVec3) -> Self {
        Self::new(DQuat::IDENTITY, translation)
    }

    /// The source's origin in the target frame.
    pub const fn origin(&self) -> Point<Target> {
        Point::new(self.translation)
    }

    /// The rotation part, a unit quaternion.
    pub const fn rotation(&self) -> DQuat {
        self.rotation
    }

    /// Turns a free vector (an axis, a direction) of the source frame into the target frame.
    pub fn rotate(&self, vector: DVec3) -> DVec3 {
        self.rotation * vector
    }
}

impl<A: Frame, B: Frame, C: Frame> Mul<Transform<B, C>> for Transform<A, B> {
    type Output = Transform<A, C>;

    fn mul(self, b_from_c: Transform<B, C>) -> Transform<A, C> {
        Transform::new(
            self.rotation * b_from_c.rotation,
            self.rotation * b_from_c.translation + self.translation,
        )
    }
}

impl<A: Frame, B: Frame> Mul<Point<B>> for Transform<A, B> {
    type Output = Point<A>;

    fn mul(self, point: Point<B>) -> Point<A> {
        Point::new(self.rotation * point.metres + self.translation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_about_left_lowers_what_is_in_front() {
        let ground_from_root =
            Transform::<Ground, Root>::new(DQuat::from_rotation_y(0.1), DVec3::ZERO);
        let front = ground_from_root * Point::<Root>::new(DVec3::X);
        assert!(front.z() < 0.0, "the convention of this module's header");
    }

    #[test]
    fn composed_transforms_act_one_after_the_other() {
        let a = Transform::<Ground, Root>::new(DQuat::from_rotation_z(0.7), DVec3::X);
        let b = Transform::<Root, Link>::new(DQuat::from_rotation_x(-0.3), DVec3::Z);
        let p = Point::<Link>::new(DVec3::new(0.1, 0.2, 0.3));
        let at_once = (a * b) * p;
        let in_turn = a * (b * p);
        assert!((at_once.metres() - in_turn.metres()).length() < 1e-15);
    }
}
