//! One angle for each joint of a robot.

use std::ops::{Index, IndexMut};

use super::{JointId, Range, Robot};

/// One angle for each of a robot's joints, rad, in the order of [`Robot::joints`].
#[derive(Debug, Clone, PartialEq)]
pub struct JointAngles(Vec<f64>);

impl JointAngles {
    /// All joints at zero.
    pub fn zero(robot: &Robot) -> Self {
        Self(vec![0.0; robot.joints.len()])
    }

    /// As many angles as there are joints, each told by its joint, rad.
    pub fn from_fn(joints: usize, angle: impl FnMut(JointId) -> f64) -> Self {
        Self((0..joints).map(JointId).map(angle).collect())
    }

    /// As many angles as there are joints, each told by its joint, rad, if all of them can be told.
    ///
    /// # Errors
    /// The first error of `angle`.
    pub fn try_from_fn<E>(
        joints: usize,
        angle: impl FnMut(JointId) -> Result<f64, E>,
    ) -> Result<Self, E> {
        let angles: Result<_, E> = (0..joints).map(JointId).map(angle).collect();
        angles.map(Self)
    }

    /// The angles, rad.
    pub fn as_slice(&self) -> &[f64] {
        &self.0
    }

    /// Other angles for the same joints, each made of what it is now, rad.
    #[must_use]
    pub fn map(&self, mut angle: impl FnMut(JointId, f64) -> f64) -> Self {
        let joints = self.0.iter().enumerate();
        Self(
            joints
                .map(|(index, &now)| angle(JointId(index), now))
                .collect(),
        )
    }

    /// The nearest angles within stops, one for each joint, rad.
    #[must_use]
    pub(crate) fn within(&self, stops: &[Range]) -> Self {
        self.map(|joint, angle| stops[joint.0].clamp(angle))
    }

    /// The angles and those of another posture, joint by joint, rad.
    ///
    /// # Panics
    /// Where the postures have not equally many joints: they are of two robots, and no pairing means
    /// anything. What brings two robots together returns an error before it comes to this.
    pub fn pairs<'a>(&'a self, other: &'a Self) -> impl ExactSizeIterator<Item = (f64, f64)> + 'a {
        let (joints, others) = (self.0.len(), other.0.len());
        assert!(
            joints == others,
            "a posture of {joints} joints beside one of {others}"
        );
        self.0.iter().copied().zip(other.0.iter().copied())
    }

    /// The angles a share of the way towards others, joint by joint: 0 here, 1 there.
    ///
    /// # Panics
    /// As [`Self::pairs`].
    #[must_use]
    pub fn towards(&self, other: &Self, share: f64) -> Self {
        let pairs = self.pairs(other);
        Self(
            pairs
                .map(|(here, there)| here + share * (there - here))
                .collect(),
        )
    }
}

impl Index<JointId> for JointAngles {
    type Output = f64;

    fn index(&self, joint: JointId) -> &f64 {
        &self.0[joint.0]
    }
}

impl IndexMut<JointId> for JointAngles {
    fn index_mut(&mut self, joint: JointId) -> &mut f64 {
        &mut self.0[joint.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_posture_goes_to_another_joint_by_joint() {
        let here = JointAngles::from_fn(3, |joint| joint.0 as f64);
        let there = here.map(|joint, angle| angle + if joint.0 == 1 { 0.4 } else { 0.0 });
        assert_eq!(here.towards(&there, 0.0), here);
        let way = here.towards(&there, 0.25);
        for (joint, expected) in [(0, 0.0), (1, 1.1), (2, 2.0)] {
            assert!((way[JointId(joint)] - expected).abs() < 1e-15, "{way:?}");
        }
    }

    #[test]
    #[should_panic(expected = "a posture of 3 joints beside one of 2")]
    fn limit_postures_of_two_robots_are_not_paired() {
        let (one, other) = (3, 2);
        let posture = |joints| JointAngles::from_fn(joints, |_| 0.0);
        let _ = posture(one).towards(&posture(other), 0.5);
    }
}
