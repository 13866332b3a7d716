//! How the robot of a document is driven, and within what its cycles are searched.

use prone::robot::{Control, SearchSetup, ServoLaw, SteeringGains, bounds};

use super::document::{ControlDocument, SearchDocument, SteeringDocument};
use super::place::{Place, Violation};

pub(super) fn read(place: Place<'_>, document: &ControlDocument) -> Result<Control, Violation> {
    let ControlDocument {
        command_step_s,
        servo_rate_per_s,
        servo_speed_rad_s,
        stiff_servo_gain_nms,
        steering,
        uphill_rad,
    } = document;
    let positive = |key, value: &f64, largest| place.key(key).positive(*value, largest);
    Ok(Control {
        command_step: positive("command_step_s", command_step_s, bounds::COMMAND_STEP)?,
        servo: ServoLaw {
            rate: positive("servo_rate_per_s", servo_rate_per_s, bounds::SERVO_RATE)?,
            speed: positive("servo_speed_rad_s", servo_speed_rad_s, bounds::SPEED)?,
        },
        stiff_servo_gain: positive("stiff_servo_gain_nms", stiff_servo_gain_nms, bounds::GAIN)?,
        steering: read_steering(place.key("steering"), steering)?,
        uphill: positive("uphill_rad", uphill_rad, bounds::SLOPE)?,
    })
}

fn read_steering(
    place: Place<'_>,
    document: &SteeringDocument,
) -> Result<SteeringGains, Violation> {
    let SteeringDocument {
        yaw,
        lateral_rad_m,
        lateral_sum_rad_m,
    } = document;
    let gain = |key, value: &f64| place.key(key).within(*value, 0.0..=bounds::STEERING);
    Ok(SteeringGains {
        yaw: gain("yaw", yaw)?,
        lateral: gain("lateral_rad_m", lateral_rad_m)?,
        lateral_sum: gain("lateral_sum_rad_m", lateral_sum_rad_m)?,
    })
}

pub(super) fn read_search(
    place: Place<'_>,
    document: &SearchDocument,
) -> Result<SearchSetup, Violation> {
    let SearchDocument {
        least_advance_m,
        upper_arm_rad,
    } = document;
    let advance = place.key("least_advance_m");
    let upper_arm = place.key("upper_arm_rad");
    Ok(SearchSetup {
        least_advance: advance.positive(*least_advance_m, bounds::LENGTH)?,
        upper_arm: upper_arm.range(*upper_arm_rad, bounds::ANGLE)?,
    })
}
