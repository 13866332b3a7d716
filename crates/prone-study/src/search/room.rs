//! Whether anything of a robot can fit under a ceiling at all.

use prone::robot::Robot;

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

/// Why nothing of this robot passes so low, m, whatever its posture and its motion: one of its shapes
/// is thicker than that however it is turned.
pub fn too_low(robot: &Robot, height: f64) -> Option<String> {
    let (thickness, part) = thickest(robot)?;
    (thickness >= height).then(|| {
        format!(
            "the {part}, which is {:.1} mm thick however it is turned",
            thickness * 1e3
        )
    })
}

/// How thick the thickest part of a robot is, m, and the body's name: the least extent of a shape over all
/// directions, and of all shapes the largest.
pub fn thickest(robot: &Robot) -> Option<(f64, &str)> {
    let shapes = robot.shapes.iter();
    let parts = shapes.map(|shape| {
        let body = &robot.bodies[shape.body.0];
        (shape.solid.thickness(), body.name.as_str())
    });
    parts.max_by(|a, b| a.0.total_cmp(&b.0))
}

#[cfg(test)]
mod tests {
    use prone_files::shipped;
    use prone_sim::{LoadedRobot, RobotFiles};

    use super::*;

    #[test]
    fn reference_the_skull_of_the_nao() {
        let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        // Its ellipsoid in robot.xml has half-axes of 58, 64 and 58 mm.
        let (thickness, part) = thickest(robot.robot()).unwrap();
        assert_eq!(part, "Head");
        assert!((thickness - 0.116).abs() < 1e-9, "{thickness}");
        assert!(too_low(robot.robot(), 0.116).is_some());
        assert!(too_low(robot.robot(), 0.117).is_none());
    }
}
