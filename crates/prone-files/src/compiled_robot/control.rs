//! How the robot of a document is driven, what it senses, and within what its gaits are searched.

use std::collections::BTreeSet;

use serde::{Deserialize, Serialize};

use prone::robot::{
    Control, Imu, Robot, SearchSetup, SensorNoise, SteeringGains, StudySetup, bounds,
};

use super::bodies::{PoseDocument, ends};
use super::names::{Names, joint_name};
use super::place::{Place, Violation};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyDocument {
    start_posture: String,
    stops: Vec<StopDocument>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StopDocument {
    joint: String,
    range_rad: [f64; 2],
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImuDocument {
    site: String,
    root_from_sensor: PoseDocument,
    accelerometer_m_s2: NoiseDocument,
    gyroscope_rad_s: NoiseDocument,
}

/// What a sensor adds to the truth, in its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct NoiseDocument {
    standard_deviation: f64,
    bias_bound: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ControlDocument {
    command_step_s: f64,
    gear_efficiency: f64,
    steering: SteeringDocument,
    uphill_rad: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SteeringDocument {
    yaw: f64,
    lateral_rad_m: f64,
    lateral_sum_rad_m: f64,
    aside_rad_m: f64,
    yaw_sum: f64,
    ahead_m: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SearchDocument {
    least_advance_m: f64,
    upper_arm_rad: [f64; 2],
}

impl StudyDocument {
    pub(super) fn new(robot: &Robot) -> Self {
        let stops = robot.study.stops.iter();
        let stops = stops.map(|(joint, range)| StopDocument {
            joint: joint_name(robot, *joint),
            range_rad: ends(*range),
        });
        Self {
            start_posture: robot.study.start_posture.clone(),
            stops: stops.collect(),
        }
    }

    pub(super) fn read(&self, at: Place<'_>, names: &Names<'_>) -> Result<StudySetup, Violation> {
        let stops = at.key("stops");
        let mut moved = BTreeSet::new();
        for (index, stop) in self.stops.iter().enumerate() {
            if !moved.insert(&stop.joint) {
                let element = Place::Element(&stops, index);
                let message = format!("{:?} is there twice", stop.joint);
                return Err(element.key("joint").violation(message));
            }
        }
        Ok(StudySetup {
            start_posture: self.start_posture.clone(),
            stops: stops.each(&self.stops, |at, _, stop| {
                let joint = names.joint(at.key("joint"), &stop.joint)?;
                let range = at.key("range_rad");
                Ok((joint, range.range(stop.range_rad, bounds::ANGLE)?))
            })?,
        })
    }
}

impl ImuDocument {
    pub(super) fn new(imu: &Imu) -> Self {
        Self {
            site: imu.site.clone(),
            root_from_sensor: PoseDocument::new(&imu.root_from_sensor),
            accelerometer_m_s2: NoiseDocument::new(imu.accelerometer),
            gyroscope_rad_s: NoiseDocument::new(imu.gyroscope),
        }
    }

    pub(super) fn read(&self, at: Place<'_>) -> Result<Imu, Violation> {
        let accelerometer = at.key("accelerometer_m_s2");
        let gyroscope = at.key("gyroscope_rad_s");
        Ok(Imu {
            site: at.key("site").name(&self.site)?,
            root_from_sensor: self.root_from_sensor.read(at.key("root_from_sensor"))?,
            accelerometer: self
                .accelerometer_m_s2
                .read(accelerometer, bounds::ACCELERATION)?,
            gyroscope: self.gyroscope_rad_s.read(gyroscope, bounds::TURN_RATE)?,
        })
    }
}

impl NoiseDocument {
    const fn new(noise: SensorNoise) -> Self {
        Self {
            standard_deviation: noise.standard_deviation,
            bias_bound: noise.bias_bound,
        }
    }

    fn read(&self, at: Place<'_>, largest: f64) -> Result<SensorNoise, Violation> {
        let within = |key, value| at.key(key).within(value, 0.0..=largest);
        Ok(SensorNoise {
            standard_deviation: within("standard_deviation", self.standard_deviation)?,
            bias_bound: within("bias_bound", self.bias_bound)?,
        })
    }
}

impl ControlDocument {
    pub(super) const fn new(control: &Control) -> Self {
        Self {
            command_step_s: control.command_step,
            gear_efficiency: control.gear_efficiency,
            steering: SteeringDocument {
                yaw: control.steering.yaw,
                lateral_rad_m: control.steering.lateral,
                lateral_sum_rad_m: control.steering.lateral_sum,
                aside_rad_m: control.steering.aside,
                yaw_sum: control.steering.yaw_sum,
                ahead_m: control.steering.ahead,
            },
            uphill_rad: control.uphill,
        }
    }

    pub(super) fn read(&self, at: Place<'_>) -> Result<Control, Violation> {
        let positive = |key, value, largest| at.key(key).positive(value, largest);
        let (place, steering) = (at.key("steering"), &self.steering);
        let gain = |key, value| place.key(key).within(value, 0.0..=bounds::STEERING);
        let (least, largest) = bounds::GEAR_EFFICIENCY;
        Ok(Control {
            command_step: positive("command_step_s", self.command_step_s, bounds::COMMAND_STEP)?,
            gear_efficiency: at
                .key("gear_efficiency")
                .within(self.gear_efficiency, least..=largest)?,
            steering: SteeringGains {
                yaw: gain("yaw", steering.yaw)?,
                lateral: gain("lateral_rad_m", steering.lateral_rad_m)?,
                lateral_sum: gain("lateral_sum_rad_m", steering.lateral_sum_rad_m)?,
                aside: gain("aside_rad_m", steering.aside_rad_m)?,
                yaw_sum: gain("yaw_sum", steering.yaw_sum)?,
                ahead: gain("ahead_m", steering.ahead_m)?,
            },
            uphill: positive("uphill_rad", self.uphill_rad, bounds::SLOPE)?,
        })
    }
}

impl SearchDocument {
    pub(super) const fn new(search: &SearchSetup) -> Self {
        Self {
            least_advance_m: search.least_advance,
            upper_arm_rad: ends(search.upper_arm),
        }
    }

    pub(super) fn read(&self, at: Place<'_>) -> Result<SearchSetup, Violation> {
        let upper_arm = at.key("upper_arm_rad");
        Ok(SearchSetup {
            least_advance: at.key("least_advance_m").length(self.least_advance_m)?,
            upper_arm: upper_arm.range(self.upper_arm_rad, bounds::ANGLE)?,
        })
    }
}
