//! The published chapter's main result, as the files of one folder.

use rayon::prelude::*;
use serde::Serialize;

use prone_sim::camera::PictureError;
use prone_sim::regime::{
    CONTROL_STEP, Effort, SERVO_RATE, SERVO_SPEED, SOLIMP, SOLREF, Stops, TIME_STEP,
};
use prone_sim::{LoadedRobot, Regime, World, WorldError};

use crate::figures::{self, Figure, FigureError};
use crate::output::{Artefacts, RUN_FILE};
use crate::summary::{self, Summary};
use crate::torque_study::{self, Observer, Plan, StudyError};
use crate::{agreement, contact_story, frames, published, report, tables};

/// Which program made a result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Program {
    /// Its version.
    pub version: &'static str,
    /// The commit it was built from, `unknown` outside a checkout.
    pub commit: &'static str,
}

/// A finished reproduction.
#[derive(Debug)]
pub struct Reproduction {
    /// The files, by path in the result folder; all the same for the same input.
    pub artefacts: Artefacts,
    /// The figures of the study.
    pub summary: Summary,
    /// Engine steps done in all.
    pub engine_steps: usize,
}

/// What was run, for `run.json` and the report.
#[derive(Debug, Clone, Serialize)]
pub(crate) struct RunInfo {
    pub(crate) program: &'static str,
    #[serde(flatten)]
    pub(crate) built: Program,
    pub(crate) engine: String,
    pub(crate) robot: RobotInfo,
    pub(crate) options: Options,
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct RobotInfo {
    pub(crate) name: String,
    pub(crate) folder: String,
    pub(crate) sha256: String,
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct Options {
    pub(crate) gaits: Vec<GaitInfo>,
    pub(crate) durations_s: Vec<f64>,
    pub(crate) showcase_s: f64,
    pub(crate) regime: &'static str,
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
}

#[derive(Debug, Clone, Serialize)]
pub(crate) struct GaitInfo {
    pub(crate) name: String,
    pub(crate) description: String,
    pub(crate) mapping: &'static str,
    pub(crate) arm: &'static str,
}

/// Why a reproduction fails.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// The robot does not compile with floor and servos.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The study has no result.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// A figure cannot be drawn.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// A picture cannot be encoded.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A table cannot be written or read.
    #[error("table: {0}")]
    Csv(#[from] csv::Error),
    /// A JSON file cannot be written.
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
}

/// Pixels per unit of an SVG figure in its PNG.
const PNG_SCALE: f32 = 2.0;

/// Runs the study on the current rayon pool and makes every file of the result.
///
/// # Errors
/// [`ReproduceError`].
pub fn run(
    robot: &LoadedRobot,
    plan: &Plan,
    program: &Program,
    observer: &dyn Observer,
) -> Result<Reproduction, ReproduceError> {
    let world = World::new(robot, Regime::TORQUE_STUDY)?;
    let study = torque_study::run(&world, plan, observer)?;
    let bins = published::torque_bins()?;
    let agreement = agreement::of(&study.pulls, &bins);
    let stories = study
        .pulls
        .iter()
        .filter(|pull| (pull.duration_s - study.showcase_s).abs() < 1e-9)
        .map(contact_story::of)
        .collect();
    let summary = summary::of(&study, agreement, stories);
    let info = run_info(robot, &world, plan, program);

    let mut artefacts = Artefacts::new();
    for pull in &study.pulls {
        let name = format!("torques/{}", tables::torque_file_name(pull));
        artefacts.insert(name, tables::torques(pull)?);
    }
    artefacts.insert("costs.csv".into(), tables::costs(&study.costs)?);
    artefacts.insert(
        "agreement.csv".into(),
        tables::agreement(&summary.agreement)?,
    );
    artefacts.insert("summary.json".into(), json(&summary)?);
    artefacts.insert(RUN_FILE.into(), json(&info)?);

    let drawn = figures::study_figures(&study.chains, &study.pulls, &study.costs)?;
    let photographed = study
        .snapshots
        .par_iter()
        .map(|(gait, snapshots)| frames::of(&world, gait, study.showcase_s, snapshots))
        .collect::<Result<Vec<_>, _>>()?;
    if let Some((_, snapshots)) = study.snapshots.first()
        && let Some(middle) = snapshots.get(snapshots.len() / 2)
    {
        artefacts.insert("figures/crawl.png".into(), frames::cover(&world, middle)?);
    }
    let pngs = drawn
        .par_iter()
        .map(|figure| figure.png(PNG_SCALE))
        .collect::<Result<Vec<_>, _>>()?;
    let html = report::html(&info, &summary, &drawn, &photographed);
    artefacts.insert("report.html".into(), html.into_bytes());
    for (figure, png) in drawn.into_iter().zip(pngs) {
        insert_figure(&mut artefacts, figure, png);
    }
    for frames in photographed {
        insert_figure(&mut artefacts, frames.figure, frames.png);
    }
    Ok(Reproduction {
        artefacts,
        summary,
        engine_steps: study.engine_steps,
    })
}

fn insert_figure(artefacts: &mut Artefacts, figure: Figure, png: Vec<u8>) {
    artefacts.insert(format!("figures/{}.png", figure.stem), png);
    artefacts.insert(
        format!("figures/{}.svg", figure.stem),
        figure.svg.into_bytes(),
    );
}

fn json(value: &impl Serialize) -> Result<Vec<u8>, serde_json::Error> {
    let mut text = serde_json::to_vec_pretty(value)?;
    text.push(b'\n');
    Ok(text)
}

fn run_info(robot: &LoadedRobot, world: &World, plan: &Plan, program: &Program) -> RunInfo {
    let regime = world.regime();
    let study = &robot.robot().study;
    let moved = study.stops.iter().map(|(joint, range)| {
        let name = &robot.robot().joints[joint.0].name;
        format!("{name} {} to {} rad", range.lower, range.upper)
    });
    RunInfo {
        program: "prone",
        built: program.clone(),
        engine: prone_sim::engine_version(),
        robot: RobotInfo {
            name: robot.robot().name.clone(),
            folder: robot.files().folder.clone(),
            sha256: robot.files().hash(),
        },
        options: Options {
            gaits: plan
                .gaits()
                .iter()
                .map(|gait| GaitInfo {
                    name: gait.name.clone(),
                    description: gait.description.clone(),
                    mapping: gait.mapping.name(),
                    arm: gait.arm.name(),
                })
                .collect(),
            durations_s: plan.durations_s(),
            showcase_s: plan.showcase_s(),
            regime: regime.name,
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
            servo_rate_per_s: SERVO_RATE,
            servo_speed_rad_s: SERVO_SPEED,
            solref: SOLREF,
            solimp: SOLIMP,
            start_posture: study.start_posture.clone(),
            settle_s: prone_sim::pull::SETTLE,
        },
    }
}
