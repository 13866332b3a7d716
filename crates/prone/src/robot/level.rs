//! How a robot lies on a level floor, by its joints alone.

use glam::{DQuat, DVec3};

use super::{ContactGroup, JointAngles, Robot};
use crate::frames::{Ground, Point, Root, Transform};

/// Turns until toes and elbows are level; each shrinks the rest by more than tenfold.
const ITERATIONS: usize = 4;

impl Robot {
    /// The pitch of the root (its turn about +y, rad) with which the lowest points of toes and
    /// elbows are at one height, near a first guess, for joint angles as measured: where they both
    /// carry the body, that is how it lies on a level floor. `None` without such shapes.
    pub fn level_pitch(&self, angles: &JointAngles, guess: f64) -> Option<f64> {
        let mut pitch = guess;
        for _ in 0..ITERATIONS {
            let turn = Transform::<Ground, Root>::new(DQuat::from_rotation_y(pitch), DVec3::ZERO);
            let poses = self.forward_kinematics(turn, angles);
            let lowest = |is_meant: fn(ContactGroup) -> bool| {
                self.bottom(&poses, |shape| {
                    is_meant(self.bodies[shape.body.0].contact_group)
                })
            };
            let middle = |of: [Point<Ground>; 2]| f64::midpoint(of[0].x(), of[1].x());
            let toe = middle(self.chain.sides().map(|side| poses.point(side.toe)));
            let elbow = middle(self.chain.sides().map(|side| poses.point(side.elbow)));
            let rise = lowest(ContactGroup::is_front) - lowest(|it| it == ContactGroup::Toe);
            // A turn about +y lowers what is in front.
            pitch += rise.atan2(elbow - toe);
            if !pitch.is_finite() {
                return None;
            }
        }
        Some(pitch)
    }
}
