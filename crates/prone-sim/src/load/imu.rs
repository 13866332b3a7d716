//! The inertial unit: `[imu]` of `robot.toml` with the sensors of the model.

use prone::frames::Transform;
use prone::robot::{BodyId, Imu, SensorNoise, bounds};
use prone_files::FileError;
use prone_files::robot_file::ImuTable;

use super::lookup::Lookup;
use super::model::Parts;

/// The root, parents before children.
const ROOT: BodyId = BodyId(0);

pub(super) fn read(lookup: &Lookup<'_>, table: &ImuTable, parts: &Parts) -> Result<Imu, FileError> {
    let name = &table.site;
    let (body, position) = lookup.site(name, parts)?;
    if body != ROOT {
        let message = format!(
            "site {} is on {}; the inertial unit must be on the root {}",
            name.get_ref(),
            parts.bodies[body.0].name,
            parts.bodies[ROOT.0].name
        );
        return Err(lookup.error(name, message));
    }
    let sensors = parts.sensors.get(name.get_ref());
    let complete = sensors.filter(|sensors| sensors.accelerometer && sensors.gyroscope);
    let Some(sensors) = complete else {
        let accelerometer = sensors.is_some_and(|sensors| sensors.accelerometer);
        let missing = if accelerometer {
            "gyro"
        } else {
            "accelerometer"
        };
        let message = format!(
            "{} has no {missing} at site {}",
            lookup.mjcf,
            name.get_ref()
        );
        return Err(lookup.error(name, message));
    };
    let bounded = |what, value, largest| lookup.within(name, what, value, largest);
    Ok(Imu {
        site: name.get_ref().clone(),
        // The root body's own frame is the root frame.
        root_from_sensor: Transform::new(sensors.link_from_sensor, position.metres()),
        accelerometer: SensorNoise {
            standard_deviation: bounded(
                "accelerometer_noise_m_s2",
                table.accelerometer_noise_m_s2,
                bounds::ACCELERATION,
            )?,
            bias_bound: bounded(
                "accelerometer_bias_m_s2",
                table.accelerometer_bias_m_s2,
                bounds::ACCELERATION,
            )?,
        },
        gyroscope: SensorNoise {
            standard_deviation: bounded(
                "gyroscope_noise_rad_s",
                table.gyroscope_noise_rad_s,
                bounds::TURN_RATE,
            )?,
            bias_bound: bounded(
                "gyroscope_bias_rad_s",
                table.gyroscope_bias_rad_s,
                bounds::TURN_RATE,
            )?,
        },
    })
}
