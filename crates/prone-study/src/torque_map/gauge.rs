//! Reading torques and contact forces of one posture from either source.

use prone::chain::GaitParameters;
use prone::robot::Robot;
use prone::statics::StaticTorques;
use prone::torque_map::{ContactForces, JointTorques, Mask, TorqueGap};
use prone_sim::World;
use prone_sim::settled::SettledTorques;

/// What a row of a map holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Entry {
    /// The posture is held.
    Held {
        torques: JointTorques,
        contacts: ContactForces,
    },
    /// Why there are no torques.
    Masked(Mask),
}

/// Something that measures a posture.
pub(super) trait Gauge: Sync {
    /// Torques of the right side in the recordings' sign, and what carries both sides.
    fn measure(&self, at: GaitParameters) -> Result<(JointTorques, ContactForces), TorqueGap>;
}

/// The statics.
pub(super) struct StaticGauge<'r> {
    pub(super) robot: &'r Robot,
    pub(super) source: StaticTorques<&'r Robot>,
}

/// The settled simulation.
pub(super) struct SettledGauge<'w> {
    pub(super) world: &'w World,
    pub(super) source: SettledTorques,
}

/// Measures one posture; numbers that are not finite are no measurement.
pub(super) fn entry(gauge: &impl Gauge, at: GaitParameters) -> Entry {
    match gauge.measure(at) {
        Ok((torques, contacts)) => {
            let mut numbers = torques.to_array().into_iter().chain(contacts.to_array());
            if numbers.all(f64::is_finite) {
                Entry::Held { torques, contacts }
            } else {
                Entry::Masked(Mask::Failed)
            }
        }
        Err(TorqueGap::Closure(_)) => Entry::Masked(Mask::Open),
        Err(_) => Entry::Masked(Mask::Failed),
    }
}

impl Gauge for StaticGauge<'_> {
    fn measure(&self, at: GaitParameters) -> Result<(JointTorques, ContactForces), TorqueGap> {
        let rest = self.source.rest(at)?;
        let joints = self.robot.chain.right.pitch_joints();
        let torques = joints.map(|joint| rest.load(joint));
        let mut forces = [0.0; 4];
        for support in rest.footing.supports() {
            forces[support.group as usize] += support.reaction;
        }
        Ok((
            JointTorques::from_array(torques),
            ContactForces::from_array(forces),
        ))
    }
}

impl Gauge for SettledGauge<'_> {
    fn measure(&self, at: GaitParameters) -> Result<(JointTorques, ContactForces), TorqueGap> {
        let means = self.source.settled(at)?.means;
        let joints = self.world.robot().chain.right.pitch_joints();
        let torques = joints.map(|joint| -means.actuator_torque[joint.0]);
        Ok((
            JointTorques::from_array(torques),
            ContactForces::from_array(means.contact),
        ))
    }
}
