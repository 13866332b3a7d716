//! What the motors do in a crawl.

use prone::robot::{Joint, JointId, Robot};

/// What the motors of a robot did.
#[derive(Debug, Clone, PartialEq)]
pub struct Effort {
    /// Over which time, s.
    pub seconds: f64,
    /// By joint.
    pub joints: Vec<JointEffort>,
}

/// What one motor did. Torque is **actuator torque**, after the effort limit, unless it says
/// demanded.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointEffort {
    /// ∫ τ² dt, N²·m²·s.
    pub square: f64,
    /// ∫ max(τω, 0) dt, J: a motor is not given back what it brakes.
    pub work: f64,
    /// Largest |τ|, N·m.
    pub peak: f64,
    /// Largest |τ| demanded by the servo, before the effort limit, N·m.
    pub demanded_peak: f64,
    /// How long the servo demanded more than the effort limit, s.
    pub saturated: f64,
    /// How long the servo demanded more than the motor's nominal torque, s.
    pub over_nominal: f64,
}

/// What one motor does in one engine step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MotorStep {
    /// **Actuator torque**, after the effort limit, N·m.
    pub torque: f64,
    /// **Demanded torque**, before the effort limit, N·m.
    pub demanded: f64,
    /// Speed of the joint about the same axis, rad/s.
    pub speed: f64,
    /// Length of the step, s.
    pub seconds: f64,
}

impl JointEffort {
    /// Adds a step of the motor of a joint, whose limits say what is too much.
    pub fn add_step(&mut self, step: &MotorStep, joint: &Joint) {
        let MotorStep {
            torque,
            demanded,
            speed,
            seconds,
        } = *step;
        let demanded = demanded.abs();
        self.square += torque * torque * seconds;
        self.work += (torque * speed).max(0.0) * seconds;
        self.peak = self.peak.max(torque.abs());
        self.demanded_peak = self.demanded_peak.max(demanded);
        if demanded > joint.effort_limit {
            self.saturated += seconds;
        }
        if joint.motor.is_some_and(|motor| demanded > motor.nominal) {
            self.over_nominal += seconds;
        }
    }

    fn add(&mut self, other: &Self) {
        self.square += other.square;
        self.work += other.work;
        self.peak = self.peak.max(other.peak);
        self.demanded_peak = self.demanded_peak.max(other.demanded_peak);
        self.saturated += other.saturated;
        self.over_nominal += other.over_nominal;
    }
}

impl Effort {
    pub(super) fn none(robot: &Robot) -> Self {
        Self {
            seconds: 0.0,
            joints: vec![JointEffort::default(); robot.joints.len()],
        }
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.seconds += other.seconds;
        for (joint, other) in self.joints.iter_mut().zip(&other.joints) {
            joint.add(other);
        }
    }

    /// ∫ Σ (τ / nominal torque)² dt over the joints whose motor is known, s: in proportion to the heat of
    /// their windings.
    pub fn heat(&self, robot: &Robot) -> f64 {
        let joints = robot.joints.iter().zip(&self.joints);
        let heats = joints.filter_map(|(joint, effort)| {
            let nominal = joint.motor?.nominal;
            Some(effort.square / (nominal * nominal))
        });
        heats.sum()
    }

    /// ∫ Σ max(τω, 0) dt, J.
    pub fn work(&self) -> f64 {
        self.joints.iter().map(|joint| joint.work).sum()
    }

    /// The largest |τ| over the effort limit, and whose it is.
    pub fn peak_over_limit(&self, robot: &Robot) -> (f64, JointId) {
        let shares = robot.joints.iter().zip(&self.joints).enumerate();
        shares
            .map(|(index, (joint, effort))| (effort.peak / joint.effort_limit, JointId(index)))
            .fold(
                (0.0, JointId(0)),
                |best, next| if next.0 > best.0 { next } else { best },
            )
    }
}

#[cfg(test)]
mod tests;
