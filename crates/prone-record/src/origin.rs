//! Where a record comes from: a simulation, a robot, or a log of another program.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// What was recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Origin {
    /// A simulation.
    Simulated(Box<Simulated>),
    /// A robot.
    Robot(RobotOrigin),
    /// A log of another program.
    Imported(Imported),
}

/// A simulation: the engine, and what its compiled model says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Simulated {
    /// Name and version of the engine.
    pub engine: String,
    /// Contacts, stops and motors.
    #[serde(flatten)]
    pub regime: RegimeInfo,
    /// Name of the integrator.
    pub integrator: String,
    /// Name of the solver of constraints.
    pub solver: String,
    /// Most iterations of the solver per step.
    pub solver_iterations: usize,
    /// Improvement of the cost, scaled, below which the solver ends.
    pub solver_tolerance: f64,
    /// Form of the friction cone.
    pub cone: String,
    /// Acceleration of gravity in the ground frame, m/s²; a slope tilts it.
    pub gravity_m_s2: [f64; 3],
    /// Velocity gain of the servo of each joint, N·m·s/rad.
    pub servo_gains_nms_rad: BTreeMap<String, f64>,
    /// Torque limit of the servo of each joint, N·m.
    pub effort_limits_nm: BTreeMap<String, f64>,
}

/// How contacts, stops and motors were modelled.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RegimeInfo {
    /// Name of the contact regime.
    pub name: String,
    /// Sliding friction of the regime; a scene may replace it by side.
    pub friction: f64,
    /// Ratio of frictional to normal constraint impedance.
    pub impratio: f64,
    /// Torque limits, in words.
    pub effort_limit: String,
    /// Joint stops, in words.
    pub stops: String,
    /// Velocity gains of the servos, in words.
    pub servo_gain: String,
    /// Rate of the servo law, 1/s.
    pub servo_rate_per_s: f64,
    /// Largest speed that a servo commands, rad/s.
    pub servo_speed_rad_s: f64,
    /// Length of an engine step, s.
    pub time_step_s: f64,
    /// Time between two commands, s.
    pub command_step_s: f64,
    /// How long the robot settled before the first command, s.
    pub settle_s: f64,
    /// Soft-contact time constant, s, and damping ratio.
    pub solref: [f64; 2],
    /// Soft-contact impedance.
    pub solimp: [f64; 5],
}

/// A robot that was recorded while it was driven.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RobotOrigin {
    /// Name or address of the robot on the network.
    pub host: String,
    /// Versions of the software on the robot, by its names.
    #[serde(default)]
    pub versions: BTreeMap<String, String>,
    /// What the driver was set to, by name.
    #[serde(default)]
    pub settings: BTreeMap<String, String>,
}

/// A log that another program wrote.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Imported {
    /// The program and the file.
    pub from: String,
}

impl Origin {
    /// The contact regime, of a simulation.
    pub const fn regime(&self) -> Option<&RegimeInfo> {
        match self {
            Self::Simulated(simulated) => Some(&simulated.regime),
            Self::Robot(_) | Self::Imported(_) => None,
        }
    }
}
