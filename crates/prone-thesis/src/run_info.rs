//! What was run: `run.json`, and the last section of the report.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use prone::regime::{CONTROL_STEP, Effort, SOLIMP, SOLREF, Stops, TIME_STEP};
use prone_sim::{LoadedRobot, World};

use prone_record::curves_info::CurvesInfo;
use prone_thesis::torque_study::Plan;

/// What was run, for `run.json` and the report.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct RunInfo {
    pub program: Cow<'static, str>,
    #[serde(flatten)]
    pub built: Program,
    pub command: Cow<'static, str>,
    pub engine: String,
    pub robot: RobotInfo,
    pub options: Options,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Options {
    pub gaits: Vec<GaitInfo>,
    pub durations_s: Vec<f64>,
    pub showcase_s: f64,
    pub regime: Cow<'static, str>,
    pub friction: f64,
    pub impratio: f64,
    pub effort_limit: String,
    pub stops: String,
    pub time_step_s: f64,
    pub control_step_s: f64,
    pub servo_rate_per_s: f64,
    pub servo_speed_rad_s: f64,
    pub solref: [f64; 2],
    pub solimp: [f64; 5],
    pub start_posture: String,
    pub settle_s: f64,
    /// The crawl under the table, where the robot can do it.
    pub table: Option<TableInfo>,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct TableInfo {
    pub gait: String,
    pub description: String,
    pub scene: String,
    pub regime: Cow<'static, str>,
    pub friction: f64,
    pub impratio: f64,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct GaitInfo {
    pub name: String,
    pub description: String,
    pub mapping: Cow<'static, str>,
    pub arm: Cow<'static, str>,
    /// θ3, θ4 and α over the phase.
    pub curves: CurvesInfo,
}

impl RunInfo {
    pub fn of(
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
            program: "prone".into(),
            built: program.clone(),
            command: "reproduce".into(),
            engine: prone_sim::engine_version(),
            robot: RobotInfo::of(robot),
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
                effort_limit: match regime.effort {
                    Effort::Published => "the maker's".to_owned(),
                    Effort::Uniform(limit) => format!("{limit} N·m on every joint"),
                },
                stops: match regime.stops {
                    Stops::Maker => "the maker's".to_owned(),
                    Stops::Study => {
                        let moved: Vec<String> = moved.collect();
                        format!("the maker's, but {}", moved.join(", "))
                    }
                },
                time_step_s: TIME_STEP,
                control_step_s: CONTROL_STEP,
                servo_rate_per_s: world.servo_law().rate,
                servo_speed_rad_s: world.servo_law().speed,
                solref: SOLREF,
                solimp: SOLIMP,
                start_posture: study.start_posture.clone(),
                settle_s: prone_sim::pull::SETTLE,
                table,
            },
        }
    }
}
