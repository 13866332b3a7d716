//! A robot on a floor under a contact regime: the engine's compiled model.

use std::sync::Arc;

use mujoco_rs::mujoco_c::mjNGAIN;
use mujoco_rs::prelude::*;
use mujoco_rs::wrappers::mj_editing::{MjsGeom, MjtGeomInertia, MjtLimited};

use prone::robot::{BodyId, ContactGroup, Joint, Range, Robot};
use prone::statics::GRAVITY;

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

    /// The robot, for what outlives the world.
    pub(crate) fn shared_robot(&self) -> Arc<Robot> {
        Arc::clone(&self.robot)
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
    *spec.option_mut() = options(regime);
    let [torsional, rolling] = UNUSED_FRICTION;
    let friction = [regime.friction, torsional, rolling];
    for geom in spec.geom_iter_mut() {
        set_contact(geom, friction);
    }
    add_floor(&mut spec, friction);
    for joint in &robot.joints {
        let limit = match regime.effort {
            Effort::Published => joint.effort_limit,
            Effort::Uniform(limit) => limit,
        };
        let gain = match regime.servo {
            Servo::Robot => joint.servo_gain,
            Servo::Uniform(gain) => gain,
        };
        add_servo(&mut spec, joint, gain, limit);
    }
    let mut model = spec.compile()?;
    // In the compiled model angles are radians, whatever unit the text has.
    for (index, stop) in stops.iter().enumerate() {
        // The engine's joint 0 is the free one.
        let joint = index + 1;
        debug_assert_eq!(
            model.id_to_name(MjtObjBase::mjOBJ_JOINT, joint),
            Some(robot.joints[index].name.as_str())
        );
        model.jnt_range_mut()[joint] = [stop.lower, stop.upper];
    }
    Ok(model)
}

/// All that the model's `<option>` could say, replaced.
fn options(regime: Regime) -> MjOption {
    MjOption {
        timestep: regime.time_step,
        gravity: [0.0, 0.0, -GRAVITY],
        integrator: MjtIntegrator::mjINT_IMPLICITFAST as i32,
        solver: MjtSolver::mjSOL_NEWTON as i32,
        cone: MjtCone::mjCONE_ELLIPTIC as i32,
        impratio: regime.impratio,
        // A diverged run is an error of ours; the engine would restart it in silence.
        disableflags: MjtDisableBit::mjDSBL_AUTORESET as i32,
        enableflags: 0,
        ..MjOption::default()
    }
}

/// What a regime says about the contacts of a geom; `solref` and `solimp` are the geom's own.
fn set_contact(geom: &mut MjsGeom, friction: [f64; 3]) {
    geom.with_friction(friction)
        .with_condim(3)
        .with_priority(0)
        .with_margin(0.0)
        .with_gap(0.0)
        .with_surfacevel([0.0; 6])
        .with_adhesion(0.0);
}

/// A level plane. Every property is stated: a new geom starts from the model's `<default>`.
fn add_floor(spec: &mut MjSpec, friction: [f64; 3]) {
    // Without a name, so that it cannot clash with one in the model.
    let floor = spec.world_body_mut().add_geom();
    set_contact(floor, friction);
    floor.alt_mut().switch_quat();
    floor
        .with_type(MjtGeomBase::mjGEOM_PLANE)
        .with_size([FLOOR_HALF_LENGTH, FLOOR_HALF_LENGTH, 0.1])
        .with_pos([0.0; 3])
        .with_quat([1.0, 0.0, 0.0, 0.0])
        .with_fromto([f64::NAN; 6]) // unset
        // The robot's geoms touch whatever offers itself (contype 1), never one another.
        .with_contype(1)
        .with_conaffinity(1)
        .with_solmix(1.0)
        .with_solref(regime::SOLREF)
        .with_solimp(regime::SOLIMP)
        .with_mass(f64::NAN) // unset
        .with_typeinertia(MjtGeomInertia::mjINERTIA_VOLUME)
        .with_fluid_ellipsoid(0.0)
        .with_material("")
        .with_group(0);
}

/// A velocity servo on a hinge: gain, N·m·s/rad, and largest torque, N·m. Every property is stated here too.
fn add_servo(spec: &mut MjSpec, joint: &Joint, gain: f64, limit: f64) {
    spec.add_actuator()
        .with_name(&joint.name)
        .with_target(&joint.name)
        .with_trntype(MjtTrn::mjTRN_JOINT)
        .with_gear([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        .with_gainprm([0.0; mjNGAIN as usize])
        .with_forcerange([-limit, limit])
        .with_forcelimited(MjtLimited::mjLIMITED_TRUE)
        .with_ctrllimited(MjtLimited::mjLIMITED_FALSE)
        .with_ctrlrange([0.0; 2])
        .with_actlimited(MjtLimited::mjLIMITED_FALSE)
        .with_actrange([0.0; 2])
        .with_inheritrange(0.0)
        .with_damping([0.0; 3])
        .with_armature(0.0)
        .with_delay(0.0)
        .with_nsample(0)
        .with_actdim(-1) // follows from the kind of dynamics, which is none
        .with_group(0)
        .set_to_velocity(gain);
}
