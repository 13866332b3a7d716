//! What a number of a robot belongs to, and how it is shown.

use crate::robot::{BodyId, JointId};

/// What a number belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum About {
    /// The robot.
    Robot,
    /// How far its planted chain spans.
    Span,
    /// How high it stands.
    StandingHeight,
    /// How long it lies.
    LyingLength,
    /// Mass of a body.
    Mass(BodyId),
    /// Centre of mass of a body.
    CentreOfMass(BodyId),
    /// Stops of a joint.
    Range(JointId),
    /// Axis and place of a joint.
    Hinge(JointId),
    /// Effort limit of a joint.
    Effort(JointId),
    /// Speed limit of a joint.
    Speed(JointId),
    /// Stiffness of a joint's servo.
    Stiffness(JointId),
    /// Continuous torque of a joint's motor.
    ContinuousTorque(JointId),
    /// Stall torque of a joint's motor.
    Stall(JointId),
}

/// A number with as many digits as a reader needs.
pub(super) fn short(value: f64) -> String {
    let size = value.abs();
    if size > 0.0 && !(1e-4..1e7).contains(&size) {
        return format!("{value:.3e}");
    }
    let rounded = format!("{value:.5}");
    rounded
        .trim_end_matches('0')
        .trim_end_matches('.')
        .to_owned()
}
