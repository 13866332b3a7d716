//! A torque map.

use serde::{Deserialize, Serialize};

use super::RobotText;

/// Torques at every node of a grid over θ3, θ4 and α, under the conditions of the published table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TorqueMapExperiment {
    /// The robot whose torques are measured.
    pub robot: RobotText,
    /// Where they come from.
    pub source: MapSource,
    /// Distance of neighbours along all three angles, degrees.
    pub step_deg: f64,
    /// Upper end of θ4, degrees.
    pub theta4_max_deg: f64,
}

/// Where the torques of a map come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MapSource {
    /// A rigid body at rest, by moment balance.
    Statics,
    /// A pose held in the engine until nothing changes.
    Simulation,
}

impl MapSource {
    /// Name in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Statics => "statics",
            Self::Simulation => "simulation",
        }
    }
}
