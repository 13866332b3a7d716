//! A pull, simulated from the gait's own first pose, held until it has settled, and what it comes to.
//!
//! Torque is **joint torque in the sign of the recordings**, of the right side, averaged over
//! control steps, as in [`prone_record::pulls`]; its integral is that of the published study
//! ([`prone::cost::squared_torque_integral`]). The share of the weight that trunk, head and legs carry is
//!
//! ```text
//! share = ∫ (N_torso + N_leg) dt / ∫ Σ N dt                                      (1)
//! ```

use prone::cost::graded::Norm;
use prone::cost::{CostError, squared_torque_integral};
use prone::gait::{Gait, PhaseDuration};
use prone::regime::CONTROL_STEP;
use prone::robot::{ContactGroup, Robot};
use prone::torque_map::JointTorques;
use prone_sim::pull::{self, Keep, Pull, PullError, Start};
use prone_sim::{Placement, Simulation, World};

/// Why a pull has no cost by simulation.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PullTrialError {
    /// It cannot be simulated.
    #[error(transparent)]
    Pull(#[from] PullError),
    /// Its record has no cost.
    #[error(transparent)]
    Cost(#[from] CostError),
}

/// Where most gaits of a search begin: settled once for all of them.
#[derive(Debug)]
pub(super) struct Begun(Option<(Placement, Simulation)>);

impl Begun {
    /// Settles where a gait begins. One that cannot be simulated is no reason against the gaits
    /// around it.
    pub(super) fn settle(world: &World, gait: &Gait, duration: PhaseDuration) -> Self {
        let begin = || {
            let trajectory = pull::plan(world, gait, duration).ok()?;
            let placement = pull::placement(world, &trajectory, Start::FirstPose).ok()?;
            let simulation = pull::settle(world, &placement).ok()?;
            Some((placement, simulation))
        };
        Self(begin())
    }

    /// Simulates a gait's pull, whatever rules it breaks: the same as alone, to the bit; ended at once
    /// when `stopped` says so.
    pub(super) fn pull(
        &self,
        stopped: &dyn Fn() -> bool,
        world: &World,
        gait: &Gait,
        duration: PhaseDuration,
    ) -> Result<Pull, PullError> {
        let trajectory = pull::plan(world, gait, duration).map_err(PullError::from)?;
        let placement = pull::placement(world, &trajectory, Start::FirstPose)?;
        let ended = |source| PullError::in_simulation(gait, duration, source);
        let simulation = match &self.0 {
            Some((begun, simulation)) if *begun == placement => simulation.clone(),
            _ => pull::settle_unless(stopped, world, &placement).map_err(ended)?,
        };
        pull::proceed_unless(stopped, simulation, trajectory, Keep::Rows).map_err(ended)
    }
}

/// Joint torques of each control step in the sign of the recordings, right side, N·m.
pub(super) fn torques(robot: &Robot, pull: &Pull) -> Vec<[f64; 4]> {
    let joints = robot.chain.right.pitch_joints();
    let rows = pull.rows.iter();
    rows.map(|row| joints.map(|joint| -row.applied_torque[joint.0]))
        .collect()
}

/// A norm of a record: integrals by the published trapezoid rule, peaks over control steps.
pub fn torque_part(robot: &Robot, pull: &Pull, norm: &Norm) -> Result<f64, CostError> {
    let scale = match norm {
        Norm::SquaredTorque { weights } => weights.map(f64::sqrt),
        Norm::Heat { nominal } => nominal.map(f64::recip),
        Norm::Peak { .. } => {
            let torques = torques(robot, pull).into_iter();
            let torques: Vec<_> = torques.map(JointTorques::from_array).collect();
            return Ok(norm.of(&torques, CONTROL_STEP));
        }
    };
    let times: Vec<f64> = pull.rows.iter().map(|row| row.time).collect();
    let mut torques = torques(robot, pull);
    for row in &mut torques {
        for (torque, scale) in row.iter_mut().zip(scale) {
            *torque *= scale;
        }
    }
    squared_torque_integral(&times, &torques)
}

/// Equation (1); rows are equally long.
pub(super) fn body_share(pull: &Pull) -> f64 {
    let (mut body, mut all) = (0.0, 0.0);
    for (group, column) in ContactGroup::ALL.into_iter().zip(0..) {
        let sum: f64 = pull.rows.iter().map(|row| row.contact[column]).sum();
        all += sum;
        if group.is_body() {
            body += sum;
        }
    }
    body / all
}
