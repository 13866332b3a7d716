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
    let site = lookup.site(name, parts)?;
    let (body, position) = site.at;
    if body != ROOT {
        let message = format!(
            "site {} is on {}; the inertial unit must be on the root {}",
            name.get_ref(),
            parts.bodies[body.0].name,
            parts.bodies[ROOT.0].name
        );
        return Err(lookup.error(name, message));
    }
    let sensors = [
        (site.accelerometer, "accelerometer"),
        (site.gyroscope, "gyro"),
    ];
    if let Some((_, missing)) = sensors.into_iter().find(|(is_there, _)| !is_there) {
        let message = format!(
            "{} has no {missing} at site {}",
            lookup.mjcf,
            name.get_ref()
        );
        return Err(lookup.error(name, message));
    }
    let acceleration = |what, value| lookup.within(name, what, value, bounds::ACCELERATION);
    let turn_rate = |what, value| lookup.within(name, what, value, bounds::TURN_RATE);
    Ok(Imu {
        site: name.get_ref().clone(),
        // The root body's own frame is the root frame.
        root_from_sensor: Transform::new(site.link_from_axes, position.metres()),
        accelerometer: SensorNoise {
            standard_deviation: acceleration(
                "accelerometer_noise_m_s2",
                table.accelerometer_noise_m_s2,
            )?,
            bias_bound: acceleration("accelerometer_bias_m_s2", table.accelerometer_bias_m_s2)?,
        },
        gyroscope: SensorNoise {
            standard_deviation: turn_rate("gyroscope_noise_rad_s", table.gyroscope_noise_rad_s)?,
            bias_bound: turn_rate("gyroscope_bias_rad_s", table.gyroscope_bias_rad_s)?,
        },
    })
}
