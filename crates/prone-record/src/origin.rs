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
    /// What drove the joints, by the joint that each motor is named after.
    pub servos: BTreeMap<String, ServoInfo>,
    /// Damping of each joint, the back-EMF of its motor included, N·m·s/rad.
    pub joint_damping_nms_rad: BTreeMap<String, f64>,
}

/// What drove one or more joints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "law", rename_all = "kebab-case")]
pub enum ServoInfo {
    /// A direct-current motor under a position controller ([`prone::motor`]).
    DcMotor {
        /// The joints that it turns.
        joints: Vec<String>,
        /// Torque that the controller asks for per position error, N·m/rad.
        stiffness_nm_rad: f64,
        /// Largest torque that the supply gives at rest, behind the gear, N·m.
        supply_torque_nm: f64,
        /// Largest torque that the current limit allows, N·m.
        current_torque_nm: f64,
        /// What the torque loses per speed, N·m·s/rad.
        back_emf_nms_rad: f64,
        /// Whether the motor's figures were assumed from the joint's limits.
        assumed: bool,
        /// Play of the gear from one edge to the other, rad, where there is any.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        backlash_rad: Option<f64>,
    },
    /// The velocity servo of the published recordings.
    Velocity {
        /// The joints that have one each.
        joints: Vec<String>,
        /// Velocity gain, N·m·s/rad.
        gain_nms_rad: f64,
        /// Commanded speed per position error, 1/s.
        rate_per_s: f64,
        /// Largest commanded speed, rad/s.
        speed_rad_s: f64,
        /// Torque limit, N·m.
        limit_nm: f64,
    },
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
    /// What drives the joints, in words.
    pub servo: String,
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
