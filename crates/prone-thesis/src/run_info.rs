//! What was run: `run.json` of a reproduction.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use prone::regime::{CONTROL_STEP, SOLIMP, SOLREF, Stops, TorqueLimit, VelocityServo};
use prone_record::curves_info::CurvesInfo;
use prone_record::head::Head;
use prone_record::program::{Program, RobotInfo};
use prone_sim::{LoadedRobot, World};

use crate::torque_study::Plan;

/// What was run, for `run.json` and the report.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct RunInfo {
    #[serde(flatten)]
    pub(crate) head: Head,
    /// The robot of the study.
    pub(crate) robot: RobotInfo,
    /// The robot that crawls, where it is another version.
    #[serde(default)]
    pub(crate) crawler: Option<RobotInfo>,
    pub(crate) options: Options,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct Options {
    pub(crate) gaits: Vec<GaitInfo>,
    pub(crate) durations_s: Vec<f64>,
    pub(crate) showcase_s: f64,
    pub(crate) regime: Cow<'static, str>,
    pub(crate) friction: f64,
    pub(crate) impratio: f64,
    pub(crate) effort_limit: String,
    pub(crate) stops: String,
    pub(crate) time_step_s: f64,
    pub(crate) control_step_s: f64,
    pub(crate) servo_rate_per_s: f64,
    pub(crate) servo_speed_rad_s: f64,
    pub(crate) solref: [f64; 2],
    pub(crate) solimp: [f64; 5],
    pub(crate) start_posture: String,
    pub(crate) settle_s: f64,
    /// The crawl under the table, where the robot can do it.
    pub(crate) table: Option<TableInfo>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct TableInfo {
    pub(crate) gait: String,
    pub(crate) description: String,
    pub(crate) scene: String,
    pub(crate) regime: Cow<'static, str>,
    pub(crate) friction: f64,
    pub(crate) impratio: f64,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub(crate) struct GaitInfo {
    pub(crate) name: String,
    pub(crate) description: String,
    pub(crate) mapping: Cow<'static, str>,
    pub(crate) arm: Cow<'static, str>,
    /// θ3, θ4 and α over the phase.
    pub(crate) curves: CurvesInfo,
}

impl RunInfo {
    pub(crate) fn of(
        robot: &LoadedRobot,
        world: &World,
        plan: &Plan,
        table: Option<TableInfo>,
        program: &Program,
    ) -> Self {
        let regime = world.regime();
        let study = &robot.robot().study;
        let moved = study.stops.iter().map(|(joint, range)| {
            let name = &robot.robot().joints[joint.0].name;
            format!("{name} {} to {} rad", range.lower, range.upper)
        });
        Self {
            head: Head::new(
                program,
                "reproduce".to_owned(),
                Some(prone_sim::engine_version()),
            ),
            robot: RobotInfo::of(robot.robot(), robot.files()),
            crawler: None,
            options: Options {
                gaits: plan
                    .gaits()
                    .iter()
                    .map(|gait| GaitInfo {
                        name: gait.name.clone(),
                        description: gait.description.clone(),
                        mapping: gait.mapping.name().into(),
                        arm: gait.arm.name().into(),
                        curves: CurvesInfo::of(gait),
                    })
                    .collect(),
                durations_s: plan.durations_s(),
                showcase_s: plan.showcase_s(),
                regime: regime.name.into(),
                friction: regime.friction,
                impratio: regime.impratio,
                effort_limit: match regime.torque_limit {
                    TorqueLimit::Published => "the manufacturer's".to_owned(),
                    TorqueLimit::Uniform(limit) => format!("{limit} N·m on every joint"),
                },
                stops: match regime.stops {
                    Stops::Manufacturer => "the manufacturer's".to_owned(),
                    Stops::Study => {
                        let moved: Vec<String> = moved.collect();
                        format!("the manufacturer's, but {}", moved.join(", "))
                    }
                },
                time_step_s: regime.time_step,
                control_step_s: CONTROL_STEP,
                servo_rate_per_s: VelocityServo::RECORDINGS.rate,
                servo_speed_rad_s: VelocityServo::RECORDINGS.speed,
                solref: SOLREF,
                solimp: SOLIMP,
                start_posture: study.start_posture.clone(),
                settle_s: prone_sim::pull::SETTLE,
                table,
            },
        }
    }
}
