//! What each motor did in a crawl, beside what its manufacturer says it can.

use prone::robot::Robot;
use prone_record::crawl_summary::JointSummary;
use prone_sim::crawl::Effort;

/// What each motor of a robot did, in the order of its joints.
pub(super) fn summaries(robot: &Robot, effort: &Effort) -> Vec<JointSummary> {
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
