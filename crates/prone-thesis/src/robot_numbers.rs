//! What a reproduction says of its robot: the numbers in the report's sentences.

use serde::{Deserialize, Serialize};

use prone::gait::{Gait, PhaseDuration, TrajectoryError};
use prone::mapping::MappingError;
use prone::robot::Robot;
use prone_study::gait_sheet;
use prone_study::robot_sheet::{self, ChainSheet};

/// Geometry and mass of a robot, as far as the report speaks of them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobotNumbers {
    /// Total mass, kg.
    pub mass_kg: f64,
    /// Height of the lowest joint centre in the planned chains, mm above the floor.
    pub lowest_centre_mm: f64,
    /// How far trunk, head and legs would then reach into the floor, mm.
    pub sunk_mm: f64,
    /// By the robot's own geometry.
    #[serde(flatten)]
    pub own: Geometry,
    /// As published, where it is.
    pub published: Option<Geometry>,
    /// By how much the right ankle's lower limit is tighter than the left's, degrees.
    pub ankle_tighter_deg: f64,
}

/// What a mapping takes for the geometry of a robot.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Geometry {
    /// Ankle joint angle minus θ2, degrees.
    pub ankle_deg: f64,
    /// Outward shoulder roll for the projected upper arm, degrees.
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
            own: Geometry::from_sheet(&sheet.derived),
            published: sheet.published.as_ref().map(Geometry::from_sheet),
            ankle_tighter_deg: (right - left).to_degrees(),
        })
    }
}

impl Geometry {
    fn from_sheet(sheet: &ChainSheet) -> Self {
        Self {
            ankle_deg: sheet.ankle_offset_deg,
            roll_deg: sheet.shoulder_roll_deg,
            trunk_mm: sheet.links_mm[TRUNK],
        }
    }
}
