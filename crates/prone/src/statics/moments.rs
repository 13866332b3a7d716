//! Equation (4) of [`super`]: the moment about each joint of all that lies beyond it.
//!
//! Forces F and moments M about the root's origin are summed from the tips inwards, so that each
//! body is visited once:
//!
//! ```text
//! F_b = Σ forces on b + Σ_children F,   M_b = Σ r × F on b + Σ_children M      (1)
//! load_j = a_j · (M_b − c_j × F_b)                                             (2)
//! ```
//!
//! A limb and its mirror image add twice the sagittal part of their forces to the middle plane.

use glam::DVec3;

use super::balance::{Equilibrium, down, forward};
use super::half::{HalfPose, HalfRobot};
use super::{Footing, GRAVITY};
use crate::robot::Robot;

/// A force and its moment about the root's origin, in the root frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wrench {
    pub(super) force: DVec3,
    pub(super) moment: DVec3,
}

impl Wrench {
    fn of(force: DVec3, at: DVec3) -> Self {
        Self {
            force,
            moment: at.cross(force),
        }
    }

    fn join(&mut self, other: Self) {
        self.force += other.force;
        self.moment += other.moment;
    }

    /// Together with its mirror image.
    fn with_image(self) -> Self {
        Self {
            force: 2.0 * DVec3::new(self.force.x, 0.0, self.force.z),
            moment: 2.0 * DVec3::new(0.0, self.moment.y, 0.0),
        }
    }
}

/// Equation (2) for every joint of the whole robot, N·m.
pub(super) fn loads(
    robot: &Robot,
    half: &HalfRobot,
    pose: &HalfPose,
    wrenches: &[Wrench],
) -> Vec<f64> {
    let mut load = vec![0.0; robot.joints.len()];
    for ((body, pose), wrench) in half.bodies.iter().zip(&pose.0).zip(wrenches) {
        if let Some(pair) = &body.joint {
            let joint = &robot.joints[pair.this.0];
            let anchor = (*pose * joint.anchor).metres();
            let about_axis = pose
                .rotate(joint.axis)
                .dot(wrench.moment - anchor.cross(wrench.force));
            load[pair.mirror.0] = pair.sign * about_axis;
            load[pair.this.0] = about_axis;
        }
    }
    load
}

/// Equation (1): what each body of the half and all beyond it carry; for the root, nothing is
/// left over.
pub(super) fn wrenches(
    robot: &Robot,
    half: &HalfRobot,
    pose: &HalfPose,
    found: &Equilibrium,
    footing: &Footing,
) -> Vec<Wrench> {
    let (down, forward) = (down(found.pitch), forward(found.pitch));
    let mut wrenches: Vec<Wrench> = half
        .bodies
        .iter()
        .zip(&pose.0)
        .map(|(body, pose)| {
            let body = &robot.bodies[body.id.0];
            let weight = body.mass * GRAVITY * down;
            Wrench::of(weight, (*pose * body.centre_of_mass).metres())
        })
        .collect();
    for (contact, support) in found.contacts.iter().zip(footing.supports()) {
        let place = half.place(robot.shapes[contact.shape].body);
        let share = 1.0 / half.bodies[place].copies;
        let force = support.forward * forward - support.reaction * down;
        wrenches[place].join(Wrench::of(share * force, contact.point));
    }
    for (place, body) in half.bodies.iter().enumerate().rev() {
        if let Some(parent) = body.parent {
            let wrench = wrenches[place];
            let is_limb = body.copies > half.bodies[parent].copies;
            wrenches[parent].join(if is_limb { wrench.with_image() } else { wrench });
        }
    }
    wrenches
}
