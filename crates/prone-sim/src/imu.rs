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

use std::f64::consts::TAU;

use glam::DVec3;
use mujoco_rs::prelude::*;

use prone::attitude::ImuReading;
use prone::robot::{Imu, SensorNoise};

use crate::simulation::Simulation;
use crate::world::World;

/// Reads the inertial unit of a [`Simulation`]; the same seed gives the same errors.
#[derive(Debug, Clone)]
pub struct SimulatedImu {
    imu: Imu,
    /// Where three numbers of each begin among the engine's readings.
    addresses: Addresses,
    accelerometer_bias: DVec3,
    gyroscope_bias: DVec3,
    random: Random,
}

#[derive(Debug, Clone, Copy)]
struct Addresses {
    accelerometer: usize,
    gyroscope: usize,
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
        let imu = robot.imu.clone().ok_or_else(none)?;
        let addresses = addresses(&world.model, &imu).ok_or_else(none)?;
        let mut random = Random(seed);
        Ok(Self {
            accelerometer_bias: random.bias(imu.accelerometer),
            gyroscope_bias: random.bias(imu.gyroscope),
            imu,
            addresses,
            random,
        })
    }

    /// One sample, of the beginning of the simulation's last engine step.
    pub fn read(&mut self, simulation: &Simulation) -> ImuReading {
        let readings = simulation.sensor_readings();
        let truth = |start: usize| DVec3::from_slice(&readings[start..start + 3]);
        let specific_force = truth(self.addresses.accelerometer)
            + self.accelerometer_bias
            + self.random.noise(self.imu.accelerometer);
        let angular_velocity = truth(self.addresses.gyroscope)
            + self.gyroscope_bias
            + self.random.noise(self.imu.gyroscope);
        let root_from_sensor = &self.imu.root_from_sensor;
        ImuReading {
            angular_velocity: root_from_sensor.rotate(angular_velocity),
            specific_force: root_from_sensor.rotate(specific_force),
        }
    }
}

/// The sensors at the inertial unit's site; the loader has made sure of both.
fn addresses(model: &MjModel, imu: &Imu) -> Option<Addresses> {
    let imu = model.name_to_id(MjtObjBase::mjOBJ_SITE, &imu.site)?;
    let address = |wanted| {
        let mut sensors = model.sensor_type().iter().zip(model.sensor_objid());
        let index = sensors
            .position(|(&kind, &site)| kind == wanted && usize::try_from(site) == Ok(imu))?;
        usize::try_from(model.sensor_adr()[index]).ok()
    };
    Some(Addresses {
        accelerometer: address(MjtSensor::mjSENS_ACCELEROMETER)?,
        gyroscope: address(MjtSensor::mjSENS_GYRO)?,
    })
}

/// `SplitMix64` (Steele, Lea and Flood 2014), whose sequence never changes. The optimisers have a
/// generator of their own in a crate that knows no robot; noise needs no long period.
#[derive(Debug, Clone)]
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1): the upper 53 bits.
    fn uniform(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.next() >> 11) as f64 * STEP
    }

    /// Standard normal (Box and Muller 1958, the cosine half).
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }

    fn bias(&mut self, noise: SensorNoise) -> DVec3 {
        let axes = [(); 3].map(|()| noise.bias_bound * (2.0 * self.uniform() - 1.0));
        DVec3::from_array(axes)
    }

    fn noise(&mut self, noise: SensorNoise) -> DVec3 {
        let axes = [(); 3].map(|()| noise.standard_deviation * self.normal());
        DVec3::from_array(axes)
    }
}

#[cfg(test)]
mod tests;
