//! The motors of a run: what they are told before an engine step, and what they gave over it.
//!
//! The engine applies more, or less, than it reports of an actuator with damping: it reports the
//! force at the speed before the step and moves by that at the speed after it. So torques are worked
//! out here, from the speeds on both sides of the step.

use std::sync::Arc;

use mujoco_rs::prelude::*;

use prone::motor::{Driven, MotorStep};

use crate::engine_numbers::{FREE_JOINT, FREE_JOINT_SPEEDS};
use crate::world::{World, WorldDrive, WorldServo};

/// What motors do over one engine step.
#[derive(Debug, Clone)]
pub(super) struct Motors {
    /// What each drive that is a motor was told, by the world's drives.
    driven: Vec<Option<Driven>>,
    /// |Position error| that the controller of each drive goes by, rad: the mean of its joints', as
    /// far as it is beyond the play of the gear.
    lags: Vec<f64>,
    /// Joint speeds before the step, rad/s.
    before: Vec<f64>,
    /// By joint, N·m.
    applied: Vec<f64>,
    /// By the world's drives.
    steps: Vec<MotorStep>,
}

const IDLE: MotorStep = MotorStep {
    torque: 0.0,
    power: 0.0,
    lag: 0.0,
    supply_clipped: false,
    current_limited: false,
};

impl Motors {
    pub(super) fn at_rest(world: &World) -> Self {
        let (joints, drives) = (world.robot().joints.len(), world.drives().len());
        Self {
            driven: vec![None; drives],
            lags: vec![0.0; drives],
            before: vec![0.0; joints],
            applied: vec![0.0; joints],
            steps: vec![IDLE; drives],
        }
    }

    pub(super) fn applied(&self) -> &[f64] {
        &self.applied
    }

    pub(super) fn steps(&self) -> &[MotorStep] {
        &self.steps
    }

    /// Tells the engine's actuators what to do in the next step.
    pub(super) fn command(
        &mut self,
        world: &World,
        data: &mut MjData<Arc<MjModel>>,
        reference: &[f64],
    ) {
        self.before
            .copy_from_slice(&data.qvel()[FREE_JOINT_SPEEDS..]);
        for (index, WorldDrive { drive, servo }) in world.drives().iter().enumerate() {
            let joints = drive.joints.iter().map(|joint| joint.0);
            let sharers = drive.sharers();
            let (mut error, mut speed) = (0.0, 0.0);
            for joint in joints.clone() {
                error += (reference[joint] - data.qpos()[FREE_JOINT + joint]) / sharers;
                speed += self.before[joint] / sharers;
            }
            match servo {
                WorldServo::Motor(motor) => {
                    let error = motor.beyond_play(error);
                    self.lags[index] = error.abs();
                    let told = motor.drive(error, speed);
                    for joint in joints {
                        data.ctrl_mut()[joint] = told.torque / sharers;
                    }
                    self.driven[index] = Some(told);
                }
                WorldServo::Velocity { law, .. } => {
                    self.lags[index] = error.abs();
                    for joint in joints {
                        let error = reference[joint] - data.qpos()[FREE_JOINT + joint];
                        data.ctrl_mut()[joint] = law.command(error);
                    }
                }
            }
        }
    }

    /// Works out what was given over the step, from the speeds before and after it.
    pub(super) fn read(&mut self, world: &World, data: &MjData<Arc<MjModel>>) {
        let after = &data.qvel()[FREE_JOINT_SPEEDS..];
        for (index, WorldDrive { drive, servo }) in world.drives().iter().enumerate() {
            let mut step = MotorStep {
                lag: self.lags[index],
                ..IDLE
            };
            if let Some(driven) = self.driven[index] {
                step.supply_clipped = driven.supply_clipped;
                step.current_limited = driven.current_limited;
            }
            for joint in drive.joints.iter().map(|joint| joint.0) {
                let torque = match (servo, self.driven[index]) {
                    (WorldServo::Motor(motor), Some(driven)) => {
                        motor.applied(&driven, after[joint]) / drive.sharers()
                    }
                    (WorldServo::Motor(_), None) => 0.0,
                    (WorldServo::Velocity { gain, limit, .. }, _) => {
                        let commanded = data.ctrl()[joint];
                        let asked = gain * (commanded - self.before[joint]);
                        // At its limit the engine takes the servo's damping away.
                        if asked.abs() >= *limit {
                            step.current_limited = true;
                            asked.clamp(-limit, *limit)
                        } else {
                            gain * (commanded - after[joint])
                        }
                    }
                };
                self.applied[joint] = torque;
                step.torque += torque;
                step.power += torque * f64::midpoint(self.before[joint], after[joint]);
            }
            self.steps[index] = step;
        }
    }
}
