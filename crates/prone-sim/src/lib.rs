//! Crawling robots in the `MuJoCo` engine.
//!
//! [`LoadedRobot`] turns a robot's two files into [`prone::robot::Robot`]; a [`World`] puts it on a floor
//! or into a scene under a named contact regime ([`prone::regime`]); a [`Simulation`] steps it with the motors or servos
//! of that regime; [`pull`] runs one closed-chain phase and records it, [`crawl`] whole cycles; [`driven`]
//! makes a simulation something that can be driven, through [`prone::port`]; [`camera`] takes
//! pictures on the CPU. [`imu`] is what the robot feels of its attitude; [`self_collision`]
//! tells how near its limbs come to one another.
//!
//! The engine's model is shared, its data belongs to one run: runs on any number of threads give
//! the same bits.

pub mod camera;
pub mod crawl;
pub mod driven;
mod engine_log;
mod engine_numbers;
mod engine_options;
pub mod imu;
mod load;
mod model_view;
pub mod pull;
mod random;
pub mod self_collision;
pub mod settled;
mod simulation;
mod world;

pub use engine_options::EngineOptions;
pub use load::{LoadError, LoadedRobot, RobotFiles};
pub use model_view::{InertiaView, ShapeView};
pub use simulation::{Placement, Simulation, SimulationError, Snapshot, StepMeans};
pub use world::{TooStiff, World, WorldDrive, WorldError, WorldServo};

/// The version of the engine that is linked, as it reports itself.
pub fn engine_version() -> String {
    format!("MuJoCo {}", mujoco_rs::mujoco_version())
}
