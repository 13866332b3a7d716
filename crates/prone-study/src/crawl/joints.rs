//! What each motor did in a crawl, beside what its manufacturer says it can.

use serde::{Deserialize, Serialize};

use prone::robot::Robot;
use prone_sim::crawl::Effort;

/// One joint over a whole crawl. Torque is **actuator torque**, after the effort limit, unless it
/// says demanded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct JointSummary {
    /// The manufacturer's name.
    pub joint: String,
    /// The manufacturer's effort limit, N·m.
    pub effort_limit_nm: f64,
    /// Continuous torque of the motor at the joint, before gear losses, N·m, where it is known.
    pub nominal_nm: Option<f64>,
    /// Largest |τ|, N·m.
    pub peak_nm: f64,
    /// √(∫ τ² dt / time), N·m.
    pub rms_nm: f64,
    /// Largest |τ| that the servo demanded, N·m.
    pub demanded_peak_nm: f64,
    /// Share of the time in which the servo demanded more than the effort limit.
    pub saturated_share: f64,
    /// ∫ (τ / nominal torque)² dt, s; nothing where the motor is not known.
    pub heat_s: Option<f64>,
    /// ∫ max(τω, 0) dt, J.
    pub work_j: f64,
    /// What the winding lost, J ([`prone::robot::Motor::winding_loss`]): an estimate; nothing where
    /// the motor's speed without load is not known.
    pub winding_loss_j: Option<f64>,
}

/// In the order of the robot's joints.
pub(super) fn of(robot: &Robot, effort: &Effort) -> Vec<JointSummary> {
    let pairs = robot.joints.iter().zip(&effort.joints);
    let summaries = pairs.map(|(joint, did)| JointSummary {
        joint: joint.name.clone(),
        effort_limit_nm: joint.effort_limit,
        nominal_nm: joint.motor.map(|motor| motor.nominal),
        peak_nm: did.peak,
        rms_nm: (did.square / effort.seconds).sqrt(),
        demanded_peak_nm: did.demanded_peak,
        saturated_share: did.saturated / effort.seconds,
        heat_s: joint
            .motor
            .map(|motor| did.square / (motor.nominal * motor.nominal)),
        work_j: did.work,
        winding_loss_j: joint
            .motor
            .and_then(|motor| motor.winding_loss())
            .map(|watts_per_square| did.square * watts_per_square),
    });
    summaries.collect()
}

/// What all windings lost, J; nothing where that of a joint is not known.
pub(super) fn winding_loss(joints: &[JointSummary]) -> Option<f64> {
    joints.iter().map(|joint| joint.winding_loss_j).sum()
}
