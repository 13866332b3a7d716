//! Static torques by simulation: a pose is held until nothing changes, then read.
//!
//! The robot is laid down in the commanded pose, its trunk pitched as in the planar chain, the
//! lowest point on the floor, and let go; it drops some millimetres, sags into its servos and
//! rolls onto whatever carries it. It is at rest when no motor's mean torque has changed by more
//! than [`STILL`] from one control step to the next. Whatever is left to come is then that
//! change times the ratio of the slowest time constant to a control step: 2 to 3 in the regime
//! `table`, about 12 in `torque-study`.

use prone::chain::GaitParameters;
use prone::frames::{Ground, Root, Transform};
use prone::mapping::{Mapping, MappingError};
use prone::robot::JointAngles;
use prone::torque_map::{JointTorques, TorqueGap, TorqueSource};

use crate::simulation::{Placement, Simulation, SimulationError, StepMeans};
use crate::world::World;
use prone::regime::CONTROL_STEP;

/// Largest change of a motor's mean torque between control steps at rest, N·m.
pub const STILL: f64 = 1e-4;

/// Control steps after which a pose that still moves is given up: five seconds. `table` needs one,
/// `torque-study` three to four; in `locomotion` the squeeze creeps for longer than that.
pub const MOST_STEPS: usize = 100;

/// A pose at rest.
#[derive(Debug, Clone, PartialEq)]
pub struct Settled {
    /// Torques and contact forces over the last control step.
    pub means: StepMeans,
    /// Joint angles, rad.
    pub angles: JointAngles,
    /// Pose of the root.
    pub ground_from_root: Transform<Ground, Root>,
}

/// Why a pose has no settled torques.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SettleError {
    /// The robot cannot take the posture.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The run broke down.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// It rocks, slides or creeps.
    #[error("torques still change by {change:.1e} N·m per control step after {after_s} s")]
    Moving {
        /// Largest change in the last control step, N·m.
        change: f64,
        /// Time since it was let go, s.
        after_s: f64,
    },
}

/// Lays a robot down and waits until it is at rest.
pub fn settle(world: &World, placement: &Placement) -> Result<Settled, SettleError> {
    let mut simulation = Simulation::new(world, placement);
    let mut means = simulation.control_step()?;
    let mut change = f64::INFINITY;
    for _ in 2..=MOST_STEPS {
        let next = simulation.control_step()?;
        change = largest_change(&means, &next);
        means = next;
        if change <= STILL {
            return Ok(Settled {
                means,
                angles: simulation.joint_angles(),
                ground_from_root: simulation.ground_from_root(),
            });
        }
    }
    Err(SettleError::Moving {
        change,
        after_s: MOST_STEPS as f64 * CONTROL_STEP,
    })
}

fn largest_change(before: &StepMeans, after: &StepMeans) -> f64 {
    let pairs = before.applied_torque.iter().zip(&after.applied_torque);
    pairs
        .map(|(before, after)| (after - before).abs())
        .fold(0.0, f64::max)
}

/// Settled torques of one robot in one world, through one mapping, as a [`TorqueSource`].
///
/// Torques have the recordings' sign, minus the applied torque, and are those of the right side, as
/// recorded. Each posture is a run of its own: answers depend on nothing asked before.
#[derive(Debug)]
pub struct SettledTorques {
    world: World,
    mapping: Mapping,
}

impl SettledTorques {
    /// A source.
    pub fn new(world: &World, mapping: Mapping) -> Self {
        Self {
            world: world.clone(),
            mapping,
        }
    }

    /// All that is known of a posture at rest.
    ///
    /// # Errors
    /// [`TorqueGap::Closure`], or [`TorqueGap::Source`] with a [`SettleError`].
    pub fn settled(&self, at: GaitParameters) -> Result<Settled, TorqueGap> {
        let chain = self.mapping.chain().close(at)?;
        let source = |error: SettleError| TorqueGap::Source(Box::new(error));
        let posture = self.mapping.joint_angles(self.world.robot(), &chain);
        let placement = Placement {
            posture: posture.map_err(|error| source(error.into()))?,
            pitch: self.mapping.root_pitch(&chain),
        };
        settle(&self.world, &placement).map_err(source)
    }
}

impl TorqueSource for SettledTorques {
    fn torques(&self, at: GaitParameters) -> Result<JointTorques, TorqueGap> {
        let settled = self.settled(at)?;
        let joints = self.world.robot().chain.right.pitch_joints();
        let load = joints.map(|joint| -settled.means.applied_torque[joint.0]);
        Ok(JointTorques::from_array(load))
    }
}
