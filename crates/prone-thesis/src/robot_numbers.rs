//! What a reproduction says of its robot: the numbers in the report's sentences.

use serde::{Deserialize, Serialize};

use prone::gait::{Gait, PhaseDuration, TrajectoryError};
use prone::mapping::MappingError;
use prone::robot::Robot;
use prone_study::gait_sheet;
use prone_study::robot_sheet;

/// Geometry and mass of a robot, as far as the report speaks of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobotNumbers {
    /// Total mass, kg.
    pub mass_kg: f64,
    /// Height of the lowest joint centre in the planned chains, mm above the floor.
    pub lowest_centre_mm: f64,
    /// How far trunk and legs would then reach into the floor, mm.
    pub sunk_mm: f64,
    /// Ankle joint angle minus θ2 by the robot's geometry, degrees.
    pub ankle_deg: f64,
    /// Outward shoulder roll for the projected upper arm, degrees.
    pub roll_deg: f64,
    /// Hip to shoulder, mm.
    pub trunk_mm: f64,
    /// The same three as published, where they are.
    pub published: Option<PublishedGeometry>,
    /// By how much the right ankle's lower limit is tighter than the left's, degrees.
    pub ankle_tighter_deg: f64,
}

/// Geometry as published.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct PublishedGeometry {
    /// Ankle joint angle minus θ2, degrees.
    pub ankle_deg: f64,
    /// Outward shoulder roll, degrees.
    pub roll_deg: f64,
    /// Hip to shoulder, mm.
    pub trunk_mm: f64,
}

/// Why a robot has no such numbers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NumbersError {
    /// Its limbs form no sagittal chain.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// It cannot follow a gait.
    #[error(transparent)]
    Trajectory(#[from] TrajectoryError),
}

/// Place of hip to shoulder among the links of a chain.
const TRUNK: usize = 3;

impl RobotNumbers {
    /// Of a robot and the gaits of a study.
    ///
    /// # Errors
    /// [`NumbersError`].
    pub fn new(
        robot: &Robot,
        gaits: &[Gait],
        duration: PhaseDuration,
    ) -> Result<Self, NumbersError> {
        let sheet = robot_sheet::of(robot)?;
        let (mut lowest_centre_mm, mut bottom_mm) = (f64::INFINITY, 0.0_f64);
        for gait in gaits {
            for row in gait_sheet::of(robot, gait, duration)?.rows {
                lowest_centre_mm = row.centres_mm.into_iter().fold(lowest_centre_mm, f64::min);
                bottom_mm = bottom_mm.min(row.body_bottom_mm);
            }
        }
        let lower = |joint: prone::robot::JointId| robot.joints[joint.0].range.lower;
        let [left, right] = robot.chain.sides().map(|side| lower(side.ankle));
        Ok(Self {
            mass_kg: sheet.mass_kg,
            lowest_centre_mm,
            sunk_mm: -bottom_mm,
            ankle_deg: sheet.derived.ankle_offset_deg,
            roll_deg: sheet.derived.shoulder_roll_deg,
            trunk_mm: sheet.derived.links_mm[TRUNK],
            published: sheet.published.map(|published| PublishedGeometry {
                ankle_deg: published.ankle_offset_deg,
                roll_deg: published.shoulder_roll_deg,
                trunk_mm: published.links_mm[TRUNK],
            }),
            ankle_tighter_deg: (right - left).to_degrees(),
        })
    }
}
