//! Forward kinematics: joint angles to body poses.
//!
//! For a body b with parent p, zero-pose transform `p_from_b0`, and a hinge with unit axis a
//! through the anchor c (both in b): `p_from_b = p_from_b0 · T(c) R(a, q) T(−c)`.

use glam::{DQuat, DVec3};

use super::{BodyId, Joint, JointAngles, Robot};
use crate::frames::{Frame, Link, Point, Root, Transform};

/// The pose of every body in frame `F`, in the order of [`Robot::bodies`].
#[derive(Debug, Clone, PartialEq)]
pub struct BodyPoses<F: Frame>(Vec<Transform<F, Link>>);

impl<F: Frame> BodyPoses<F> {
    /// The pose of one body.
    pub fn of(&self, body: BodyId) -> &Transform<F, Link> {
        &self.0[body.0]
    }

    /// A point of a body, in `F`.
    pub fn point(&self, (body, point): (BodyId, Point<Link>)) -> Point<F> {
        *self.of(body) * point
    }

    /// The anchor of a joint, in `F`.
    pub fn anchor(&self, joint: &Joint) -> Point<F> {
        self.point((joint.body, joint.anchor))
    }

    /// The unit axis of a joint, in `F`.
    pub fn axis(&self, joint: &Joint) -> DVec3 {
        self.of(joint.body).rotate(joint.axis)
    }
}

impl Robot {
    /// Body poses for joint angles and a pose of the root.
    pub fn forward_kinematics<F: Frame>(
        &self,
        frame_from_root: Transform<F, Root>,
        angles: &JointAngles,
    ) -> BodyPoses<F> {
        let mut poses: Vec<Transform<F, Link>> = Vec::with_capacity(self.bodies.len());
        for body in &self.bodies {
            let parent = match body.parent {
                // The root body's own frame is the root frame.
                None => frame_from_root * Transform::<Root, Link>::translation(DVec3::ZERO),
                Some(parent) => poses[parent.0] * body.parent_from_body,
            };
            let pose = match body.joint {
                None => parent,
                Some(id) => {
                    let joint = &self.joints[id.0];
                    let turn = DQuat::from_axis_angle(joint.axis, angles[id]);
                    let anchor = joint.anchor.metres();
                    parent * Transform::<Link, Link>::new(turn, anchor - turn * anchor)
                }
            };
            poses.push(pose);
        }
        BodyPoses(poses)
    }

    /// Centre of mass of the whole robot, in `F`.
    pub fn centre_of_mass<F: Frame>(&self, poses: &BodyPoses<F>) -> Point<F> {
        let moment: DVec3 = self
            .bodies
            .iter()
            .zip(&poses.0)
            .map(|(body, pose)| body.mass * (*pose * body.centre_of_mass).metres())
            .sum();
        Point::new(moment / self.mass())
    }
}
