//! A robot in a scene under a contact regime: the engine's compiled model.

pub(crate) mod drives;
mod friction;
mod scenery;

use std::sync::Arc;

use mujoco_rs::prelude::*;
use mujoco_rs::wrappers::mj_editing::{MjsGeom, MjtGeomInertia};

use prone::robot::{BodyId, Range, Robot};
use prone::scene::{Obstacle, Scene, SceneError};
use prone::statics::GRAVITY;

use crate::engine_log;
use crate::engine_numbers::robot_body;
use crate::load::LoadedRobot;
use prone::regime::{self, Regime, Servo, Stops};
use scenery::Scenery;

pub use drives::{TooStiff, WorldDrive, WorldServo};

/// Rolling and torsional friction, m: the engine's defaults. Contacts are three-dimensional
/// (condim 3), which leaves both unused; they are stated so that no hidden default is.
const UNUSED_FRICTION: [f64; 2] = [0.005, 0.0001];

/// Half-length of the floor's drawn square, m; the plane itself is endless.
const FLOOR_HALF_LENGTH: f64 = 5.0;

/// A compiled model, shared by any number of simulations; a clone shares all of it.
#[derive(Debug, Clone)]
pub struct World {
    pub(crate) model: Arc<MjModel>,
    robot: Arc<Robot>,
    regime: Regime,
    stops: Arc<[Range]>,
    drives: Arc<[WorldDrive]>,
    scene: Arc<Scene>,
    obstacles: Arc<[Obstacle]>,
    /// What each geom of the engine's model is.
    pub(crate) geom_roles: Arc<[GeomRole]>,
}

/// What a geom of the engine's model is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum GeomRole {
    /// Part of a body of the robot.
    Robot(BodyId),
    /// The floor, or rough ground on it.
    Floor,
    /// An obstacle, by its place in [`Scene::obstacles`].
    Obstacle(usize),
    /// Seen, never touched.
    Marker,
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
    /// A servo that no engine step of this length can hold.
    #[error("{robot} in regime {regime}: {source}")]
    Servo {
        /// The robot's name.
        robot: String,
        /// The regime's name.
        regime: &'static str,
        /// Which joint, and by how much.
        source: TooStiff,
    },
    /// The scene holds what cannot be built.
    #[error("scene {scene}: {error}")]
    Scene {
        /// The scene's name.
        scene: String,
        /// What is wrong with it.
        error: SceneError,
    },
}

impl World {
    /// Puts a robot on a level floor.
    ///
    /// # Errors
    /// [`WorldError::Compile`] where the engine refuses the model, [`WorldError::Servo`] where its step
    /// is too long for a servo.
    pub fn new(loaded: &LoadedRobot, regime: Regime) -> Result<Self, WorldError> {
        Self::in_scene(loaded, regime, &Scene::level())
    }

    /// Puts a robot into a scene. The scene's friction, where it has one, replaces the regime's.
    ///
    /// # Errors
    /// [`WorldError`] where the scene is invalid, the engine refuses the model, or its step is too long
    /// for a servo.
    pub fn in_scene(
        loaded: &LoadedRobot,
        regime: Regime,
        scene: &Scene,
    ) -> Result<Self, WorldError> {
        scene.check().map_err(|error| WorldError::Scene {
            scene: scene.name.clone(),
            error,
        })?;
        let robot = Arc::clone(loaded.robot());
        let stops = match regime.stops {
            Stops::Manufacturer => robot.stops(),
            Stops::Study => robot.study_stops(),
        };
        let scenery = Scenery::from_scene(scene);
        let drives = drives::in_regime(&robot, &regime);
        let compiled = compile(loaded, regime, &stops, &drives, &scenery);
        let model = compiled.map_err(|error| WorldError::Compile {
            robot: robot.name.clone(),
            regime: regime.name,
            message: engine_log::one_line(&error.to_string()),
        })?;
        drives::check(&model, &robot, &regime, &drives).map_err(|source| WorldError::Servo {
            robot: robot.name.clone(),
            regime: regime.name,
            source,
        })?;
        Ok(Self {
            geom_roles: geom_roles(&model, &scenery).into(),
            model: Arc::new(model),
            robot,
            regime,
            stops: stops.into(),
            drives: drives.into(),
            scene: Arc::new(scene.clone()),
            obstacles: scene.obstacles().into(),
        })
    }

    /// The robot.
    pub fn robot(&self) -> &Robot {
        &self.robot
    }

    /// The robot, for what outlives the world.
    pub fn shared_robot(&self) -> Arc<Robot> {
        Arc::clone(&self.robot)
    }

    /// Mass of the robot in this world, kg: that of its model times the regime's factor.
    pub fn mass(&self) -> f64 {
        self.robot.mass() * self.regime.mass_factor
    }

    /// Whether both are one compiled model, shared.
    pub fn shares_model_with(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.model, &other.model)
    }

    /// The contact regime.
    pub const fn regime(&self) -> &Regime {
        &self.regime
    }

    /// Efficiency of the gears: what the motors of the regime suppose, or the robot's.
    pub fn gear_efficiency(&self) -> f64 {
        let control = &self.robot.control;
        match self.regime.servo {
            Servo::DcMotor(motors) => motors.gear_efficiency(control),
            Servo::Velocity(_) => control.gear_efficiency,
        }
    }

    /// What drives the robot's joints, in the order of [`Robot::drives`].
    pub fn drives(&self) -> &[WorldDrive] {
        &self.drives
    }

    /// The joint stops that hold in this world, in the order of the robot's joints.
    pub fn stops(&self) -> &[Range] {
        &self.stops
    }

    /// What the robot is in.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// [`Scene::obstacles`] of the scene.
    pub fn obstacles(&self) -> &[Obstacle] {
        &self.obstacles
    }

    /// Whether a geom is there to be crawled on.
    pub(crate) fn is_ground(&self, role: GeomRole) -> bool {
        match role {
            GeomRole::Floor => true,
            GeomRole::Obstacle(index) => self.obstacles[index].kind.is_ground(),
            GeomRole::Robot(_) | GeomRole::Marker => false,
        }
    }
}

/// What each geom is. The engine numbers the world's geoms first, in the order in which they were
/// added; a robot's model has none there.
fn geom_roles(model: &MjModel, scenery: &Scenery) -> Vec<GeomRole> {
    let mut scenery = scenery.roles().into_iter();
    let bodies = model.geom_bodyid().iter();
    bodies
        .map(|&body| match robot_body(body) {
            Some(body) => GeomRole::Robot(body),
            None => scenery.next().unwrap_or(GeomRole::Floor),
        })
        .collect()
}

fn compile(
    loaded: &LoadedRobot,
    regime: Regime,
    stops: &[Range],
    drives: &[WorldDrive],
    scenery: &Scenery,
) -> Result<MjModel, MjEditError> {
    let robot = loaded.robot();
    let mut spec = crate::load::spec(loaded.model())?;
    let floor = &scenery.scene.floor;
    *spec.option_mut() = options(regime, floor.slope);
    let [torsional, rolling] = UNUSED_FRICTION;
    let friction = [regime.friction, torsional, rolling];
    for geom in spec.geom_iter_mut() {
        set_contact(geom, friction);
    }
    add_world_geom(&mut spec, friction)
        .with_type(MjtGeomBase::mjGEOM_PLANE)
        .with_size([FLOOR_HALF_LENGTH, FLOOR_HALF_LENGTH, 0.1]);
    scenery.add_to(&mut spec, friction)?;
    drives::add_actuators(&mut spec, robot, drives);
    let mut model = spec.compile()?;
    scale_masses(&mut model, robot, regime.mass_factor);
    drives::add_back_emf(&mut model, drives);
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
    if let Some(sides) = floor.friction {
        let roles = geom_roles(&model, scenery);
        friction::set_by_side(&mut model, &roles, robot, sides);
    }
    Ok(model)
}

/// Multiplies masses and moments of inertia of all bodies of the robot; the world, obstacles included,
/// has none. What the engine derives from them is worked out anew.
fn scale_masses(model: &mut MjModel, robot: &Robot, factor: f64) {
    // With a factor of 1 the model stays as it was compiled, to the bit.
    if (factor - 1.0).abs() > 0.0 {
        model.set_totalmass(robot.mass() * factor);
        MjData::new(model).set_const();
    }
}

/// All that the model's `<option>` could say, replaced.
fn options(regime: Regime, slope: f64) -> MjOption {
    MjOption {
        timestep: regime.time_step,
        // Uphill is +x. A level floor has +0 there, not -0.
        gravity: [0.0 - GRAVITY * slope.sin(), 0.0, -GRAVITY * slope.cos()],
        integrator: MjtIntegrator::mjINT_IMPLICITFAST as i32,
        solver: MjtSolver::mjSOL_NEWTON as i32,
        // The same forces to rounding. Left to itself the engine would take dense matrices for a robot
        // of this size, whose updates by elliptic cones take half the time of a crawl.
        jacobian: MjtJacobian::mjJAC_SPARSE as i32,
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

/// A geom that stands still and that the robot touches. Every property is stated: a new geom
/// starts from the model's `<default>`.
fn add_world_geom(spec: &mut MjSpec, friction: [f64; 3]) -> &mut MjsGeom {
    // Without a name, so that it cannot clash with one in the model.
    let geom = spec.world_body_mut().add_geom();
    set_contact(geom, friction);
    geom.alt_mut().switch_quat();
    geom.with_pos([0.0; 3])
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
        .with_group(0)
}
