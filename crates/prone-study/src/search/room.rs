//! Whether anything of a robot can fit under a ceiling at all.

use glam::DVec3;

use prone::frames::{Ground, Root, Transform};
use prone::robot::{ContactGroup, JointAngles, Robot};

/// A margin that is as large as its ceiling.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("a margin of {margin_mm} mm leaves no room under a ceiling of {ceiling_mm} mm")]
pub struct NoRoom {
    /// The ceiling, mm.
    pub ceiling_mm: f64,
    /// The margin, mm.
    pub margin_mm: f64,
}

impl NoRoom {
    /// Checks that a margin leaves room under a ceiling; NaN leaves none.
    pub fn check(ceiling_mm: f64, margin_mm: f64) -> Result<(), Self> {
        if margin_mm < ceiling_mm {
            return Ok(());
        }
        Err(Self {
            ceiling_mm,
            margin_mm,
        })
    }
}

/// Why no gait of this robot is so low, m, whatever its form.
pub fn too_low(robot: &Robot, height: f64) -> Option<String> {
    let foot = foot_length(robot);
    (foot > height).then(|| {
        format!(
            "the foot, {:.1} mm long: with toes planted it passes through the vertical in every closed-chain gait, and {:.1} mm are left",
            foot * 1e3,
            height * 1e3
        )
    })
}

/// How long the foot is along its sole, m: its shapes' extent forward in the zero pose, in which a
/// humanoid stands on flat soles. The longer of both feet.
pub fn foot_length(robot: &Robot) -> f64 {
    let upright = Transform::<Ground, Root>::translation(DVec3::ZERO);
    let poses = robot.forward_kinematics(upright, &JointAngles::zero(robot));
    let sides = robot.chain.sides().map(|side| {
        let y = poses.point(side.toe).metres().y;
        let feet = robot.shapes.iter().filter(|shape| {
            let body = &robot.bodies[shape.body.0];
            let centre = (*poses.of(shape.body) * shape.link_from_geom)
                .origin()
                .metres();
            body.contact_group == ContactGroup::Toe && centre.y * y > 0.0
        });
        let (mut front, mut back) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        for shape in feet {
            front = front.max(shape.reach_along(poses.of(shape.body), DVec3::X));
            back = back.max(shape.reach_along(poses.of(shape.body), DVec3::NEG_X));
        }
        front + back
    });
    sides[0].max(sides[1])
}

#[cfg(test)]
mod tests {
    use prone_files::shipped;
    use prone_sim::{LoadedRobot, RobotFiles};

    use super::*;

    #[test]
    fn reference_the_sole_of_the_nao() {
        let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        // The sole's box in robot.xml is 160.6 mm long.
        assert!((foot_length(robot.robot()) - 0.1606).abs() < 1e-9);
    }
}
