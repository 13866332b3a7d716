//! `[control]`, `[search]` and `[pictures]` of `robot.toml`: bounds and units.

use prone::robot::bounds;
use prone::robot::{Control, Range, SearchSetup, ServoLaw, SteeringGains};
use prone_files::FileError;
use prone_files::robot_file::{ControlTable, PicturesTable, SearchTable, SteeringTable};

use super::lookup::Lookup;

pub(super) fn read(lookup: &Lookup<'_>, table: &ControlTable) -> Result<Control, FileError> {
    let step = &table.command_step_ms;
    let longest = bounds::COMMAND_STEP * 1e3;
    let step_ms = lookup.positive(step, "command_step_ms", *step.get_ref(), longest)?;
    let (rate, speed) = (&table.servo_rate_per_s, &table.servo_speed_rad_s);
    let gain = &table.stiff_servo_gain_nms;
    let uphill = &table.uphill_deg;
    let steepest = bounds::SLOPE.to_degrees();
    Ok(Control {
        command_step: step_ms * 1e-3,
        servo: ServoLaw {
            rate: lookup.positive(
                rate,
                "servo_rate_per_s",
                *rate.get_ref(),
                bounds::SERVO_RATE,
            )?,
            speed: lookup.positive(speed, "servo_speed_rad_s", *speed.get_ref(), bounds::SPEED)?,
        },
        stiff_servo_gain: lookup.positive(
            gain,
            "stiff_servo_gain_nms",
            *gain.get_ref(),
            bounds::GAIN,
        )?,
        steering: steering(lookup, &table.steering)?,
        uphill: lookup
            .positive(uphill, "uphill_deg", *uphill.get_ref(), steepest)?
            .to_radians(),
    })
}

fn steering(lookup: &Lookup<'_>, table: &SteeringTable) -> Result<SteeringGains, FileError> {
    let gain = |what, place| lookup.within(place, what, *place.get_ref(), bounds::STEERING);
    Ok(SteeringGains {
        yaw: gain("yaw", &table.yaw)?,
        lateral: gain("lateral_rad_m", &table.lateral_rad_m)?,
        lateral_sum: gain("lateral_sum_rad_m", &table.lateral_sum_rad_m)?,
    })
}

pub(super) fn search(lookup: &Lookup<'_>, table: &SearchTable) -> Result<SearchSetup, FileError> {
    let advance = &table.least_advance_mm;
    let [lower, upper] = &table.upper_arm_rad;
    Ok(SearchSetup {
        least_advance: lookup.length(advance, "least_advance_mm", *advance.get_ref())?,
        upper_arm: lookup.range(
            lower,
            Range {
                lower: *lower.get_ref(),
                upper: *upper.get_ref(),
            },
        )?,
    })
}

/// How long the robot lies, m.
pub(super) fn lying_length(lookup: &Lookup<'_>, table: &PicturesTable) -> Result<f64, FileError> {
    let length = &table.lying_length_mm;
    lookup.length(length, "lying_length_mm", *length.get_ref())
}

#[cfg(test)]
mod tests {
    use prone_files::shipped::NAO;

    use crate::{LoadedRobot, RobotFiles};

    /// Every recorded result was computed with these bits; units are converted to the same.
    #[test]
    fn regression_the_nao_is_controlled_by_the_numbers_of_its_results() {
        let loaded = LoadedRobot::load(RobotFiles::shipped(&NAO)).unwrap();
        let robot = loaded.robot();
        let (control, search) = (robot.control, robot.search);
        for (what, value, bits) in [
            ("command step", control.command_step, 0.01_f64),
            ("rate", control.servo.rate, 20.0),
            ("speed", control.servo.speed, 3.0),
            ("stiff gain", control.stiff_servo_gain, 20.0),
            ("yaw", control.steering.yaw, 0.9),
            ("lateral", control.steering.lateral, 3.5),
            ("lateral sum", control.steering.lateral_sum, 0.35),
            ("uphill", control.uphill, 1.5_f64.to_radians()),
            ("least advance", search.least_advance, 0.12),
            ("lowest upper arm", search.upper_arm.lower, -1.75),
            ("highest upper arm", search.upper_arm.upper, -0.35),
            ("lying length", robot.lying_length, 0.6),
        ] {
            assert_eq!(value.to_bits(), bits.to_bits(), "{what}: {value}");
        }
    }
}
