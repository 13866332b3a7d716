//! What the cost of a gait is made of, in the robot's own figures.

use super::graded::Norm;
use crate::robot::Robot;

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// ∫ Σ w τ² dt, N²·m²·s; w of ankle, knee, hip, shoulder.
    Torque {
        /// w, 1 each in the published study.
        weights: [f64; 4],
    },
    /// The largest |τ| over the manufacturer's effort limit of its joint.
    Peak,
    /// ∫ Σ (τ/`τ_nominal`)² dt, s: what warms the motors.
    Heat,
}

/// A robot lacks what an objective needs.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{joint} of {robot} has no motor in robot.toml, which the objective `heat` needs")]
pub struct NoMotor {
    /// The robot's name.
    pub robot: String,
    /// The joint's name.
    pub joint: String,
}

impl Objective {
    /// Unweighted squared torque.
    pub const TORQUE: Self = Self::Torque { weights: [1.0; 4] };

    /// Name in files and records.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Torque { .. } => "torque",
            Self::Peak => "peak",
            Self::Heat => "heat",
        }
    }

    /// Unit of the torque part.
    pub const fn unit(&self) -> &'static str {
        match self {
            Self::Torque { .. } => "N²·m²·s",
            Self::Peak => "of the effort limit",
            Self::Heat => "s",
        }
    }

    /// The norm on a robot, for the right side, whose torques are recorded.
    pub fn norm(&self, robot: &Robot) -> Result<Norm, NoMotor> {
        let joints = robot.chain.right.pitch_joints();
        let joints = joints.map(|id| &robot.joints[id.0]);
        Ok(match *self {
            Self::Torque { weights } => Norm::SquaredTorque { weights },
            Self::Peak => Norm::Peak {
                rated: joints.map(|joint| joint.effort_limit),
            },
            Self::Heat => {
                let mut nominal = [0.0; 4];
                for (nominal, joint) in nominal.iter_mut().zip(joints) {
                    let motor = joint.motor.ok_or_else(|| NoMotor {
                        robot: robot.name.clone(),
                        joint: joint.name.clone(),
                    })?;
                    *nominal = motor.nominal;
                }
                Norm::Heat { nominal }
            }
        })
    }
}
