//! `[control]`, `[search]` and `[[coupled_limits]]` of `robot.toml`: bounds and units.

use prone::robot::bounds;
use prone::robot::{Control, CoupledLimit, Joint, Range, SearchSetup, SteeringGains};
use prone_files::FileError;
use prone_files::robot_file::{ControlTable, CoupledLimitTable, Number, SearchTable};

use super::lookup::Lookup;

pub(super) fn read(lookup: &Lookup<'_>, table: &ControlTable) -> Result<Control, FileError> {
    let number =
        |place: &Number, what, largest| lookup.positive(place, what, *place.get_ref(), largest);
    let gain =
        |place: &Number, what| lookup.within(place, what, *place.get_ref(), bounds::STEERING);
    let longest_ms = bounds::COMMAND_STEP * 1e3;
    let steepest_deg = bounds::SLOPE.to_degrees();
    let steering = &table.steering;
    Ok(Control {
        command_step: number(&table.command_step_ms, "command_step_ms", longest_ms)? * 1e-3,
        gear_efficiency: gears(lookup, &table.gear_efficiency)?,
        steering: SteeringGains {
            yaw: gain(&steering.yaw, "yaw")?,
            lateral: gain(&steering.lateral_rad_m, "lateral_rad_m")?,
            lateral_sum: gain(&steering.lateral_sum_rad_m, "lateral_sum_rad_m")?,
            aside: gain(&steering.aside_rad_m, "aside_rad_m")?,
            yaw_sum: gain(&steering.yaw_sum, "yaw_sum")?,
            ahead: gain(&steering.ahead_m, "ahead_m")?,
        },
        uphill: number(&table.uphill_deg, "uphill_deg", steepest_deg)?.to_radians(),
    })
}

fn gears(lookup: &Lookup<'_>, place: &Number) -> Result<f64, FileError> {
    let (value, (least, largest)) = (*place.get_ref(), bounds::GEAR_EFFICIENCY);
    if (least..=largest).contains(&value) {
        return Ok(value);
    }
    let message = format!("gear_efficiency must be within {least}..{largest}, not {value}");
    Err(lookup.error(place, message))
}

pub(super) fn search(lookup: &Lookup<'_>, table: &SearchTable) -> Result<SearchSetup, FileError> {
    let advance = &table.least_advance_mm;
    let [lower, upper] = &table.upper_arm_rad;
    let range = Range {
        lower: *lower.get_ref(),
        upper: *upper.get_ref(),
    };
    Ok(SearchSetup {
        least_advance: lookup.length(advance, "least_advance_mm", *advance.get_ref())?,
        upper_arm: lookup.range(lower, range)?,
    })
}

pub(super) fn coupled_limits(
    lookup: &Lookup<'_>,
    tables: &[CoupledLimitTable],
    joints: &[Joint],
) -> Result<Vec<CoupledLimit>, FileError> {
    let limits = tables.iter().map(|limit| {
        let (joint, by) = (&limit.joint, &limit.by);
        let lines = limit.table_deg.iter().map(|&[at, lower, upper]| {
            let angle = |degrees| lookup.angle(joint, "an angle of table_deg", degrees);
            let range = Range {
                lower: angle(lower)?,
                upper: angle(upper)?,
            };
            Ok((angle(at)?, range))
        });
        let lines = lines.collect::<Result<_, FileError>>()?;
        let (limited, other) = (lookup.joint(joint, joints)?, lookup.joint(by, joints)?);
        CoupledLimit::new(limited, other, lines).map_err(|error| lookup.error(joint, error))
    });
    limits.collect()
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
            ("gear efficiency", control.gear_efficiency, 0.6),
            ("yaw", control.steering.yaw, 0.8),
            ("lateral", control.steering.lateral, 2.0),
            ("lateral sum", control.steering.lateral_sum, 0.3),
            ("ahead", control.steering.ahead, 0.4),
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
