//! The inertial unit of a simulated robot: the engine's sensors, made as bad as real ones.
//!
//! The model's accelerometer and gyro are read along the sensor's axes; bias and noise are added
//! there, and the sum is turned into the root frame:
//!
//! ```text
//! reading = root_from_sensor · (truth + b + σ n)
//! ```
//!
//! b is uniform within ± the bias bound, drawn once; n is standard normal, drawn for every sample.
//! The engine evaluates sensors at the beginning of a step, so a reading is one engine step
//! (2.5 ms) old. Where the sensor is off the root's centre it feels the root turn, as a real one
//! does.

use glam::DVec3;
use mujoco_rs::prelude::*;

use prone::attitude::ImuReading;
use prone::frames::{Root, Sensor, Transform};
use prone::robot::SensorNoise;

use crate::random::Random;
use crate::simulation::Simulation;
use crate::world::World;

/// Reads the inertial unit of a [`Simulation`]; the same seed gives the same errors.
#[derive(Debug, Clone)]
pub struct SimulatedImu {
    root_from_sensor: Transform<Root, Sensor>,
    accelerometer: SimulatedSensor,
    gyroscope: SimulatedSensor,
    random: Random,
}

/// The accelerometer or the gyroscope.
#[derive(Debug, Clone)]
struct SimulatedSensor {
    /// Where its three numbers begin among the engine's readings.
    address: usize,
    bias: DVec3,
    standard_deviation: f64,
}

/// Why a robot has no attitude.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum ImuError {
    /// Its files name none.
    #[error("robot {robot} has no inertial unit: its robot.toml has no [imu]")]
    NoImu {
        /// The robot's name.
        robot: String,
    },
}

impl SimulatedImu {
    /// The inertial unit of the robot in a world.
    ///
    /// # Errors
    /// [`ImuError::NoImu`].
    pub fn new(world: &World, seed: u64) -> Result<Self, ImuError> {
        let robot = world.robot();
        let none = || ImuError::NoImu {
            robot: robot.name.clone(),
        };
        let imu = robot.imu.as_ref().ok_or_else(none)?;
        let mut random = Random::new(seed);
        let mut sensor = |kind, noise: SensorNoise| {
            // The loader has made sure of both sensors.
            let address = address(&world.model, &imu.site, kind).ok_or_else(none)?;
            Ok(SimulatedSensor {
                address,
                bias: random.bias(noise.bias_bound),
                standard_deviation: noise.standard_deviation,
            })
        };
        Ok(Self {
            root_from_sensor: imu.root_from_sensor,
            accelerometer: sensor(MjtSensor::mjSENS_ACCELEROMETER, imu.accelerometer)?,
            gyroscope: sensor(MjtSensor::mjSENS_GYRO, imu.gyroscope)?,
            random,
        })
    }

    /// One sample, of the beginning of the simulation's last engine step. Read once per control
    /// step, and not after each engine step, it misses jolts.
    pub fn read(&mut self, simulation: &Simulation) -> ImuReading {
        let readings = simulation.sensor_readings();
        let mut sample = |sensor: &SimulatedSensor| {
            let truth = DVec3::from_slice(&readings[sensor.address..][..3]);
            truth + sensor.bias + self.random.noise(sensor.standard_deviation)
        };
        let specific_force = sample(&self.accelerometer);
        let angular_velocity = sample(&self.gyroscope);
        ImuReading {
            angular_velocity: self.root_from_sensor.rotate(angular_velocity),
            specific_force: self.root_from_sensor.rotate(specific_force),
        }
    }
}

/// Where the readings of a kind of sensor at a site begin.
fn address(model: &MjModel, site: &str, wanted: MjtSensor) -> Option<usize> {
    let site = model.name_to_id(MjtObjBase::mjOBJ_SITE, site)?;
    let mut sensors = model.sensor_type().iter().zip(model.sensor_objid());
    let index =
        sensors.position(|(&kind, &at)| kind == wanted && usize::try_from(at) == Ok(site))?;
    usize::try_from(model.sensor_adr()[index]).ok()
}

#[cfg(test)]
mod tests;
