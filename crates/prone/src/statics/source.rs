//! The statics as a [`TorqueSource`]: gait parameters to torques.

use std::borrow::Borrow;

use crate::chain::GaitParameters;
use crate::mapping::{Mapping, MappingError};
use crate::robot::{JointAngles, Range, Robot};
use crate::torque_map::{JointTorques, TorqueGap, TorqueSource};

use super::{HalfRobot, Rest, RestError, Stance, SymmetryError, rest};

/// Torques of one robot at rest, through one mapping.
///
/// The commanded pose is brought within the stops, as a servo would; torques have the recordings'
/// sign ([`Rest::load`]) and are those of the right side, as recorded.
#[derive(Debug)]
pub struct StaticTorques<R: Borrow<Robot>> {
    robot: R,
    half: HalfRobot,
    mapping: Mapping,
    stops: Vec<Range>,
    stance: Stance,
}

/// Why the statics has no torques for a posture.
#[derive(Debug, thiserror::Error)]
pub enum StaticsError {
    /// The robot cannot take the posture.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The pose has no rest.
    #[error(transparent)]
    Rest(#[from] RestError),
    /// The stops are those of another robot.
    #[error("{stops} stops are given, robot {robot} has {joints} joints")]
    Stops {
        /// How many stops there are.
        stops: usize,
        /// The robot's name.
        robot: String,
        /// How many joints it has.
        joints: usize,
    },
}

impl<R: Borrow<Robot>> StaticTorques<R> {
    /// A source; `stops` hold in the order of the robot's joints.
    ///
    /// # Errors
    /// [`SymmetryError`] where the robot is no mirrored one.
    pub fn new(
        robot: R,
        mapping: Mapping,
        stops: &[Range],
        stance: Stance,
    ) -> Result<Self, SymmetryError> {
        Ok(Self {
            half: HalfRobot::from_robot(robot.borrow())?,
            robot,
            mapping,
            stops: stops.to_vec(),
            stance,
        })
    }

    /// The commanded joint angles of a posture, within the stops.
    ///
    /// # Errors
    /// [`TorqueGap::Closure`] or, from the mapping, [`TorqueGap::Source`].
    pub fn command(&self, at: GaitParameters) -> Result<JointAngles, TorqueGap> {
        let chain = self.mapping.chain().close(at)?;
        let joints = self
            .mapping
            .joint_angles(self.robot.borrow(), &chain)
            .map_err(|error| source(error.into()))?;
        let (stops, count) = (self.stops.len(), joints.as_slice().len());
        if stops != count {
            return Err(source(StaticsError::Stops {
                stops,
                robot: self.robot.borrow().name.clone(),
                joints: count,
            }));
        }
        Ok(joints.within(&self.stops))
    }

    /// All that is known of a posture at rest.
    pub fn rest(&self, at: GaitParameters) -> Result<Rest, TorqueGap> {
        let command = self.command(at)?;
        let robot = self.robot.borrow();
        rest(robot, &self.half, &command, self.stance).map_err(|error| source(error.into()))
    }
}

impl<R: Borrow<Robot> + Sync> TorqueSource for StaticTorques<R> {
    fn torques(&self, at: GaitParameters) -> Result<JointTorques, TorqueGap> {
        let rest = self.rest(at)?;
        let joints = self.robot.borrow().chain.right.pitch_joints();
        Ok(JointTorques::from_array(
            joints.map(|joint| rest.load(joint)),
        ))
    }
}

fn source(error: StaticsError) -> TorqueGap {
    TorqueGap::Source(Box::new(error))
}
