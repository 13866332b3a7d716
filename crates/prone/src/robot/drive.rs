//! Which motor turns which joints.

use super::{Joint, JointId, Robot};

/// A motor and the joints that it turns: one, or several that move together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drive {
    /// The joints, at least one. All have the same limits, servo and motor figures: those of the
    /// one motor.
    pub joints: Vec<JointId>,
}

impl Drive {
    /// The joint that the motor is named after.
    ///
    /// # Panics
    /// Where the drive has no joint, which [`Robot::drives`] never makes.
    pub fn named_after<'r>(&self, robot: &'r Robot) -> &'r Joint {
        &robot.joints[self.joints[0].0]
    }

    /// How many joints share what the motor does, as a number to divide by.
    pub const fn sharers(&self) -> f64 {
        self.joints.len() as f64
    }
}

impl Robot {
    /// The motors of the robot, in the order of their first joints; every joint is in exactly one.
    pub fn drives(&self) -> Vec<Drive> {
        let joints = (0..self.joints.len()).map(JointId);
        let drives = joints.filter_map(|joint| {
            let shared = self.shared_motors.iter().find(|it| it.contains(&joint));
            match shared {
                None => Some(Drive {
                    joints: vec![joint],
                }),
                Some(joints) if joints.first() == Some(&joint) => Some(Drive {
                    joints: joints.clone(),
                }),
                Some(_) => None,
            }
        });
        drives.collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::robot::JointId;
    use crate::robot::testing::two_armed;

    #[test]
    fn a_shared_motor_is_one_drive_and_every_joint_is_in_one() {
        let mut robot = two_armed();
        robot.shared_motors = vec![vec![JointId(2), JointId(5)]];
        let drives = robot.drives();
        assert_eq!(drives.len(), robot.joints.len() - 1);
        assert_eq!(drives[2].joints, [JointId(2), JointId(5)]);
        let mut seen: Vec<_> = drives.into_iter().flat_map(|it| it.joints).collect();
        seen.sort_unstable();
        assert_eq!(
            seen,
            (0..robot.joints.len()).map(JointId).collect::<Vec<_>>()
        );
    }
}
