//! Where the bodies are, and how fast the joints turn, by what was recorded.

use glam::DQuat;

use prone::frames::{Ground, Link, Transform};

use super::{Recorded, RecordedRow};

impl Recorded {
    /// Speed of each joint at each row, rad/s: the difference of the neighbouring rows' angles over
    /// the time between them; NaN where one of those angles was not recorded.
    pub fn joint_speeds(&self) -> Vec<Vec<f64>> {
        let last = self.rows.len().saturating_sub(1);
        let speeds = (0..self.rows.len()).map(|index| {
            let before = &self.rows[index.saturating_sub(1)];
            let after = &self.rows[(index + 1).min(last)];
            let seconds = after.time_s - before.time_s;
            let pairs = before.angles.pairs(&after.angles);
            let speed = |(from, to): (f64, f64)| {
                // A record of one row does not tell a speed.
                if seconds > 0.0 {
                    (to - from) / seconds
                } else {
                    0.0
                }
            };
            pairs.map(speed).collect()
        });
        speeds.collect()
    }

    /// Pose of each body in its parent at a row, the root's in the ground; `None` where the angle
    /// of the body's hinge, or the root's pose, was not recorded.
    pub fn parent_from_bodies(&self, row: &RecordedRow) -> Vec<Option<Transform<Link, Link>>> {
        let poses = self.bodies.iter().map(|body| {
            let rest = if body.parent.is_some() {
                body.parent_from_body
            } else {
                let root = row.ground_from_root.as_ref()?;
                Transform::new(root.rotation(), root.origin().metres())
            };
            let Some(hinge) = body.hinge else {
                return Some(rest);
            };
            let angle = row.angles.as_slice()[hinge.joint];
            if angle.is_nan() {
                return None;
            }
            let turn = DQuat::from_axis_angle(hinge.axis, angle);
            let anchor = hinge.anchor.metres();
            Some(rest * Transform::new(turn, anchor - turn * anchor))
        });
        poses.collect()
    }

    /// Pose of each body in the ground at a row; `None` where an angle on the way from the ground to
    /// the body, or the root's pose, was not recorded.
    pub fn ground_from_bodies(&self, row: &RecordedRow) -> Vec<Option<Transform<Ground, Link>>> {
        let mut poses: Vec<Option<Transform<Ground, Link>>> = Vec::with_capacity(self.bodies.len());
        for (body, parent_from_body) in self.bodies.iter().zip(self.parent_from_bodies(row)) {
            let pose = parent_from_body.and_then(|parent_from_body| match body.parent {
                Some(parent) => Some(poses[parent]? * parent_from_body),
                None => Some(Transform::new(
                    parent_from_body.rotation(),
                    parent_from_body.origin().metres(),
                )),
            });
            poses.push(pose);
        }
        poses
    }
}
