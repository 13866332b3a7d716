//! The inertial measurement unit.

use crate::frames::{Root, Sensor, Transform};

/// Three accelerometers and three gyroscopes, fixed to the root.
#[derive(Debug, Clone, PartialEq)]
pub struct Imu {
    /// Name of its site in the model.
    pub site: String,
    /// Where it sits, and how its axes lie.
    pub root_from_sensor: Transform<Root, Sensor>,
    /// Of each accelerometer, m/s².
    pub accelerometer: SensorNoise,
    /// Of each gyroscope, rad/s.
    pub gyroscope: SensorNoise,
}

/// What one axis of a sensor adds to the truth, in the sensor's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SensorNoise {
    /// Of one sample; samples are independent.
    pub standard_deviation: f64,
    /// The bias is constant during a run and within plus or minus this.
    pub bias_bound: f64,
}
