//! A robot on a floor under a contact regime: the engine's compiled model.

use std::sync::Arc;

use mujoco_rs::prelude::*;
use mujoco_rs::wrappers::mj_editing::MjtLimited;

use prone::robot::{BodyId, ContactGroup, JointId, Range, Robot};

use crate::engine_log;
use crate::load::LoadedRobot;
use crate::regime::{self, Effort, Regime, Servo, Stops};

/// Rolling and torsional friction, m: the engine's defaults. Contacts are three-dimensional
/// (condim 3), which leaves both unused; they are stated so that no hidden default is.
const UNUSED_FRICTION: [f64; 2] = [0.005, 0.0001];

/// Half-length of the floor's drawn square, m; the plane itself is endless.
const FLOOR_HALF_LENGTH: f64 = 5.0;

/// A compiled model, shared by any number of simulations.
#[derive(Debug, Clone)]
pub struct World {
    pub(crate) model: Arc<MjModel>,
    robot: Arc<Robot>,
    regime: Regime,
    stops: Vec<Range>,
    /// Contact group of each geom of the engine's model; `None` for the environment.
    pub(crate) geom_groups: Vec<Option<ContactGroup>>,
}

/// Why a world cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WorldError {
    /// The engine refuses the model with floor and servos.
    #[error("the engine cannot compile {robot} in regime {regime}: {message}")]
    Compile {
        /// The robot's name.
        robot: String,
        /// The regime's name.
        regime: &'static str,
        /// The engine's message.
        message: String,
    },
}

impl World {
    /// Puts a robot on a level floor.
    ///
    /// # Errors
    /// [`WorldError::Compile`] where the engine refuses the model.
    pub fn new(loaded: &LoadedRobot, regime: Regime) -> Result<Self, WorldError> {
        let robot = Arc::clone(loaded.robot());
        let stops = match regime.stops {
            Stops::Maker => robot.stops(),
            Stops::Study => robot.study_stops(),
        };
        let model = compile(loaded, regime, &stops).map_err(|error| WorldError::Compile {
            robot: robot.name.clone(),
            regime: regime.name,
            message: engine_log::one_line(&error.to_string()),
        })?;
        let geom_groups = model
            .geom_bodyid()
            .iter()
            .map(|&body| {
                // The engine's body 0 is the world; the robot's bodies follow in order.
                let index = usize::try_from(body).ok()?.checked_sub(1)?;
                Some(robot.bodies[BodyId(index).0].contact_group)
            })
            .collect();
        Ok(Self {
            model: Arc::new(model),
            robot,
            regime,
            stops,
            geom_groups,
        })
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The contact regime.
    pub const fn regime(&self) -> &Regime {
        &self.regime
    }

    /// The joint stops that hold in this world, in the order of the robot's joints.
    pub fn stops(&self) -> &[Range] {
        &self.stops
    }
}

fn compile(loaded: &LoadedRobot, regime: Regime, stops: &[Range]) -> Result<MjModel, MjEditError> {
    engine_log::silence();
    let robot = loaded.robot();
    let mut spec = MjSpec::from_xml_string(loaded.mjcf())?;

    let option = spec.option_mut();
    option.timestep = regime::TIME_STEP;
    option.integrator = MjtIntegrator::mjINT_IMPLICITFAST as i32;
    option.solver = MjtSolver::mjSOL_NEWTON as i32;
    option.cone = MjtCone::mjCONE_ELLIPTIC as i32;
    option.impratio = regime.impratio;
    // A diverged run is an error of ours; the engine would restart it in silence.
    option.disableflags |= MjtDisableBit::mjDSBL_AUTORESET as i32;

    let [torsional, rolling] = UNUSED_FRICTION;
    let friction = [regime.friction, torsional, rolling];
    for geom in spec.geom_iter_mut() {
        *geom.friction_mut() = friction;
    }
    let floor = spec.world_body_mut().add_geom();
    floor
        .with_name("floor")
        .with_type(MjtGeomBase::mjGEOM_PLANE)
        .with_size([FLOOR_HALF_LENGTH, FLOOR_HALF_LENGTH, 0.1])
        // The robot's geoms touch whatever offers itself (contype 1), never one another.
        .with_contype(1)
        .with_conaffinity(1)
        .with_friction(friction)
        .with_solref(regime::SOLREF)
        .with_solimp(regime::SOLIMP);

    for (index, (joint, stop)) in robot.joints.iter().zip(stops).enumerate() {
        debug_assert_eq!(robot.joint(&joint.name), Some(JointId(index)));
        if let Some(hinge) = spec.joint_mut(&joint.name) {
            hinge.with_range([stop.lower, stop.upper]);
        }
        let limit = match regime.effort {
            Effort::Published => joint.effort_limit,
            Effort::Uniform(limit) => limit,
        };
        let gain = match regime.servo {
            Servo::Robot => joint.servo_gain,
            Servo::Uniform(gain) => gain,
        };
        spec.add_actuator()
            .with_name(&joint.name)
            .with_target(&joint.name)
            .with_trntype(MjtTrn::mjTRN_JOINT)
            .with_forcerange([-limit, limit])
            .with_forcelimited(MjtLimited::mjLIMITED_TRUE)
            .set_to_velocity(gain);
    }
    spec.compile()
}
