//! The published chapter's main result, as the files of one folder.

use std::collections::BTreeMap;
use std::time::Instant;

use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use prone::gait::cycle::{CheckedCycle, CycleError, TimeScale};
use prone::gait::{PhaseDuration, PhaseDurationError, TrajectoryError};
use prone::regime::Regime;
use prone::robot::Robot;
use prone_files::{gait_file, scene_file, shipped};
use prone_record::experiment::{GaitText, RobotText, SceneText, TextError};
use prone_record::output::{Artefacts, RUN_FILE, json};
use prone_record::program::{Program, RobotInfo};
use prone_record::recorded::Command;
use prone_record::{contact_story, tables as record_tables};
use prone_report::figure_list::FigureList;
use prone_report::report::{Arrangement, PAGE_FILE, Report, ReportError};
use prone_sim::crawl::CrawlError;
use prone_sim::pull::PullError;
use prone_sim::{LoadError, LoadedRobot, World, WorldError};
use prone_study::crawl::pull::PullRecording;
use prone_study::crawl::record::{RecordError, Recording};
use prone_study::crawl::{self, GaitSource};
use prone_study::frames::{self, FramesError};
use prone_study::run::{RunError, Session, timing};
use prone_study::watch::{Progress, Watch};

use crate::chapter::Thesis;
use crate::robot_numbers::{NumbersError, RobotNumbers};
use crate::run_info::RunInfo;
use crate::summary::{self, Summary};
use crate::table_crawl::{self, TableResult, TableStudy};
use crate::torque_study::{self, Plan, PlanError, StudyError, TorqueStudy};
use crate::{agreement, published, squeeze, tables};

/// A finished reproduction.
#[derive(Debug)]
pub struct Reproduction {
    /// The files, by path in the result folder; all but `timing.json` the same for the same input.
    pub artefacts: Artefacts,
    /// The figures of the study.
    pub summary: Summary,
    /// Engine steps done in all.
    pub engine_steps: usize,
}

/// Why a reproduction fails.
#[derive(Debug, thiserror::Error)]
pub enum ReproduceError {
    /// The robot cannot be loaded.
    #[error(transparent)]
    Robot(#[from] LoadError),
    /// A gait or the table cannot be read.
    #[error(transparent)]
    Text(#[from] TextError),
    /// There is no study of these durations.
    #[error(transparent)]
    Plan(#[from] PlanError),
    /// The robot cannot follow a pull.
    #[error(transparent)]
    Trajectory(#[from] TrajectoryError),
    /// The result cannot be made, or not put in its place.
    #[error(transparent)]
    Run(#[from] RunError),
    /// The robot does not compile with floor and servos.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The study has no result.
    #[error(transparent)]
    Study(#[from] StudyError),
    /// The robot has no numbers for the report.
    #[error(transparent)]
    Numbers(#[from] NumbersError),
    /// The showcase duration is none.
    #[error(transparent)]
    Duration(#[from] PhaseDurationError),
    /// The frames of the simulated robot cannot be made.
    #[error(transparent)]
    Frames(#[from] FramesError),
    /// A record has no files.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A table cannot be written or read.
    #[error("table: {0}")]
    Csv(#[from] csv::Error),
    /// A JSON file cannot be written.
    #[error("JSON: {0}")]
    Json(#[from] serde_json::Error),
    /// The report of what was made cannot be written.
    #[error("report: {0}")]
    Report(#[from] ReportError),
}

impl ReproduceError {
    /// Whether the work failed, and not what was asked for: a gait that the robot cannot follow is
    /// wrong input, a diverging simulation is not.
    pub fn is_work(&self) -> bool {
        match self {
            Self::Run(error) => error.is_work(),
            Self::Study(error) => !matches!(
                error,
                StudyError::Trajectory(_)
                    | StudyError::World(_)
                    | StudyError::Cycle(_)
                    | StudyError::Pull(PullError::Trajectory(_) | PullError::StartPosture { .. })
            ),
            Self::Numbers(_)
            | Self::Duration(_)
            | Self::Frames(_)
            | Self::Record(_)
            | Self::Csv(_)
            | Self::Json(_)
            | Self::Report(_) => true,
            _ => false,
        }
    }

    /// Whether the work was to end.
    pub const fn is_stopped(&self) -> bool {
        matches!(
            self,
            Self::Run(RunError::Stopped)
                | Self::Frames(FramesError::Stopped)
                | Self::Record(RecordError::Frames(FramesError::Stopped))
                | Self::Study(StudyError::Stopped | StudyError::Crawl(CrawlError::Stopped))
        )
    }
}

/// How the report of a reproduction calls its own folder.
const OWN_NAME: &str = "this folder";

/// What is reproduced: the study's pulls at several durations, and its crawl under a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReproduceExperiment {
    /// The robot that crawls, and pulls unless `recorded` does.
    pub robot: RobotText,
    /// The version of its family whose torques were published, where that is another one: the study is
    /// of it, and the costs and torques of `robot` are put beside.
    #[serde(default)]
    pub recorded: Option<RobotText>,
    /// How long pulls last, s, multiples of 0.1.
    pub durations_s: Vec<f64>,
    /// The study's pulls, in the order of the records.
    pub gaits: Vec<GaitText>,
    /// Its crawl, which a robot that lacks joints of the cycle leaves out.
    pub table: Option<TableTexts>,
}

/// The crawl under the table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct TableTexts {
    /// The cycle.
    pub cycle: GaitText,
    /// The table.
    pub scene: SceneText,
}

impl ReproduceExperiment {
    /// The published study with a robot, and with the version of its family whose torques were
    /// published where that is another one: its gaits and its table as they ship, also for a robot
    /// that has gaits of its own of their names.
    pub fn new(robot: RobotText, recorded: Option<RobotText>, durations_s: Vec<f64>) -> Self {
        let shipped_gait = |name: &str| {
            let gait = shipped::gait_file(name)?;
            Some(GaitText::new(&gait.file, &gait.text))
        };
        let scene = shipped::scene_text(published::TABLE_SCENE);
        let scene = scene.map(|text| SceneText::new(published::TABLE_SCENE, text));
        let cycle = shipped_gait(published::TABLE_CYCLE);
        Self {
            robot,
            recorded,
            durations_s,
            gaits: published::GAITS
                .into_iter()
                .filter_map(shipped_gait)
                .collect(),
            table: cycle
                .zip(scene)
                .map(|(cycle, scene)| TableTexts { cycle, scene }),
        }
    }
}

/// The same, loaded.
struct Study<'a> {
    /// The robot of the study: the recorded version.
    robot: &'a LoadedRobot,
    /// The robot that crawls; `None` where it is that of the study.
    other: Option<&'a LoadedRobot>,
    plan: &'a Plan,
    /// The files of the gaits, by the gaits' names.
    gait_files: &'a BTreeMap<String, &'a GaitText>,
    table: Option<&'a TableStudy>,
}

/// Reproduces the study and puts the result in its place.
pub fn run(
    experiment: &ReproduceExperiment,
    session: &Session,
    watch: &dyn Watch,
) -> Result<Reproduction, ReproduceError> {
    let mut gaits = Vec::with_capacity(experiment.gaits.len());
    let mut gait_files = BTreeMap::new();
    for text in &experiment.gaits {
        let gait = text.parse(gait_file::parse)?;
        gait_files.insert(gait.name.clone(), text);
        gaits.push(gait);
    }
    let plan = Plan::new(gaits, &experiment.durations_s)?;
    let robot = load(&experiment.robot)?;
    plan.check(&World::new(&robot, Regime::TORQUE_STUDY)?)?;
    let recorded = experiment.recorded.as_ref().map(load).transpose()?;
    if let Some(recorded) = &recorded {
        plan.check(&World::new(recorded, Regime::TORQUE_STUDY)?)?;
    }
    let table = match &experiment.table {
        Some(texts) => table_study(robot.robot(), texts)?,
        None => None,
    };
    session.check_place()?;
    let pool = session.pool()?;
    let crawls = table.as_ref().map_or(0, |_| published::TABLE_CRAWLS.len());
    let beside = recorded.as_ref().map_or(0, |_| plan.proper_phases());
    watch.progress(&Progress::Simulating(plan.phases() + beside + crawls));
    let started = Instant::now();
    let study = Study {
        robot: recorded.as_ref().unwrap_or(&robot),
        other: recorded.as_ref().map(|_| &robot),
        plan: &plan,
        gait_files: &gait_files,
        table: table.as_ref(),
    };
    let mut made = pool.install(|| study.run(&session.program, watch))?;
    let threads = pool.current_num_threads();
    let timing = timing(started, threads, made.engine_steps)?;
    made.artefacts.insert("timing.json".into(), timing);
    session.publish(&made.artefacts, watch, || Ok(()))?;
    Ok(made)
}

fn load(robot: &RobotText) -> Result<LoadedRobot, ReproduceError> {
    Ok(LoadedRobot::load(robot.files().map_err(RunError::from)?)?)
}

/// The crawl under the table, for a robot that has the joints which its cycle names.
fn table_study(robot: &Robot, texts: &TableTexts) -> Result<Option<TableStudy>, ReproduceError> {
    let gait = GaitSource::from_text(&texts.cycle)?;
    let scene = texts.scene.parse(scene_file::parse)?;
    match CheckedCycle::plan(robot, &robot.stops(), &gait.cycle, 0.0, TimeScale::ONE) {
        Ok(_) => Ok(Some(TableStudy {
            gait,
            scene,
            scene_text: texts.scene.text.clone(),
        })),
        Err(CycleError::UnknownJoint { .. }) => Ok(None),
        Err(error) => Err(StudyError::from(error).into()),
    }
}

/// Pictures of the shown pulls and of the crawl on its way.
fn pictures(
    world: &World,
    study: &TorqueStudy,
    info: &RunInfo,
    table_result: Option<&TableResult>,
    artefacts: &mut Artefacts,
    watch: &dyn Watch,
) -> Result<FigureList, ReproduceError> {
    watch.progress(&Progress::Drawing);
    let photographed = study
        .shown
        .par_iter()
        .map(|(gait, pull)| {
            let number = frames_number(&gait.name);
            frames::of(
                world,
                number,
                &gait.name,
                study.showcase_s,
                &pull.snapshots,
                watch,
            )
        })
        .collect::<Result<Vec<_>, _>>()?;
    let mut list = FigureList::default();
    if let Some((gait, pull)) = study.shown.first()
        && let Some(first) = pull.snapshots.first()
        && let Some(middle) = pull.snapshots.get(pull.snapshots.len() / 2)
    {
        let start = frames::start(world, &gait.name, &info.options.start_posture, first, watch)?;
        list.picture(artefacts, start.figure, start.png);
        artefacts.insert(
            "figures/crawl.png".into(),
            frames::cover(world, middle, watch)?,
        );
    }
    for frames in photographed {
        list.picture(artefacts, frames.figure, frames.png);
    }
    if let Some(result) = table_result {
        let (world, longest) = (&result.world, &result.longest);
        let gait = longest
            .cycles
            .first()
            .map_or("", |cycle| cycle.gait.as_str());
        for frames in crawl::frames::on_its_way(world, gait, longest, watch)? {
            list.picture(artefacts, frames.figure, frames.png);
        }
    }
    Ok(list)
}

/// The pulls of the study with another robot.
fn beside(
    robot: &LoadedRobot,
    plan: &Plan,
    watch: &dyn Watch,
) -> Result<TorqueStudy, ReproduceError> {
    let world = World::new(robot, Regime::TORQUE_STUDY)?;
    Ok(torque_study::run_pulls(&world, plan, watch)?)
}

impl Study<'_> {
    /// Runs the study on the current rayon pool and makes every file of the result but `timing.json`.
    fn run(&self, program: &Program, watch: &dyn Watch) -> Result<Reproduction, ReproduceError> {
        let Study {
            robot, plan, table, ..
        } = *self;
        let crawler = self.other.unwrap_or(robot);
        let world = World::new(robot, Regime::TORQUE_STUDY)?;
        let (study, (beside, table_result)) = rayon::join(
            || torque_study::run(&world, plan, watch),
            || {
                rayon::join(
                    || self.other.map(|it| beside(it, plan, watch)).transpose(),
                    || {
                        let result = table.map(|table| table_crawl::run(crawler, table, watch));
                        result.transpose()
                    },
                )
            },
        );
        let (study, beside, table_result) = (study?, beside?, table_result?);
        let bins = published::torque_bins()?;
        let agreement = agreement::of(&study.pulls, &bins);
        let stories = study
            .pulls
            .iter()
            .filter(|pull| (pull.duration_s - study.showcase_s).abs() < 1e-9)
            .map(contact_story::of)
            .collect();
        let experiments = table_result
            .as_ref()
            .map_or_else(Vec::new, |result| result.experiments.clone());
        let showcase = PhaseDuration::new(study.showcase_s)?;
        let numbers = RobotNumbers::new(world.robot(), plan.gaits(), showcase)?;
        let squeezes = squeeze::of(world.robot(), &study.pulls, &bins);
        let summary = Summary {
            robot: Some(numbers),
            study_of: Some(RobotInfo::of(robot.robot(), robot.files())),
            crawl_of: table.map(|_| RobotInfo::of(crawler.robot(), crawler.files())),
            beside: self.other.zip(beside.as_ref()).map(|(other, study)| {
                let agreement = agreement::of(&study.pulls, &bins);
                summary::Beside::new(other, study, agreement)
            }),
            squeeze_ratios: squeeze::ratios(&squeezes),
            squeeze: squeezes,
            ..summary::of(&study, agreement, stories, experiments)
        };
        let info = RunInfo {
            crawler: self
                .other
                .map(|other| RobotInfo::of(other.robot(), other.files())),
            ..RunInfo::of(robot, &world, plan, table.map(TableStudy::info), program)
        };

        let mut artefacts = Artefacts::new();
        for pull in &study.pulls {
            let name = format!("torques/{}", record_tables::torque_file_name(pull));
            artefacts.insert(name, record_tables::torques(pull)?);
        }
        if let Some((other, beside)) = summary.beside.as_ref().zip(beside.as_ref()) {
            let name = other.file_suffix();
            for pull in &beside.pulls {
                let name = format!("torques-{name}/{}", record_tables::torque_file_name(pull));
                artefacts.insert(name, record_tables::torques(pull)?);
            }
            let costs = record_tables::costs(&beside.costs)?;
            artefacts.insert(format!("costs-{name}.csv"), costs);
        }
        artefacts.insert("squeeze.csv".into(), tables::squeeze(&summary.squeeze)?);
        artefacts.insert("chains.csv".into(), record_tables::chains(&study.chains)?);
        artefacts.insert("costs.csv".into(), record_tables::costs(&study.costs)?);
        artefacts.insert(
            "agreement.csv".into(),
            tables::agreement(&summary.agreement)?,
        );
        artefacts.insert("summary.json".into(), json(&summary)?);
        artefacts.insert(RUN_FILE.into(), json(&info)?);
        artefacts.extend(pull_records(self, &world, &study, program)?);
        if let Some((table, result)) = table.zip(table_result.as_ref()) {
            artefacts.extend(crawl_record(crawler, table, result, program)?);
        }

        let list = pictures(
            &world,
            &study,
            &info,
            table_result.as_ref(),
            &mut artefacts,
            watch,
        )?;
        list.finish(&mut artefacts)?;
        // The drawings are those of the report, made from the records as they will be read again.
        go_on(watch)?;
        let report = Report::from_artefacts(OWN_NAME, &artefacts, &Thesis, Arrangement::Chapter)?;
        go_on(watch)?;
        artefacts.extend(report.figures()?);
        artefacts.insert(PAGE_FILE.into(), report.html.into_bytes());
        let crawling = table_result.map_or(0, |result| result.engine_steps);
        Ok(Reproduction {
            artefacts,
            summary,
            engine_steps: study.engine_steps + crawling + beside.map_or(0, |it| it.engine_steps),
        })
    }
}

/// Fails where the work is to end.
fn go_on(watch: &dyn Watch) -> Result<(), RunError> {
    if watch.stop() {
        return Err(RunError::Stopped);
    }
    Ok(())
}

/// Number of the figure that shows the robot over a pull; of an unknown gait, the first one's.
fn frames_number(gait: &str) -> &'static str {
    let known = published::FIGURES
        .iter()
        .find(|numbers| numbers.gait == gait);
    known.unwrap_or(&published::FIGURES[0]).frames
}

/// The pulls that pictures show, each in a folder that can be replayed and exported.
fn pull_records(
    studied: &Study<'_>,
    world: &World,
    study: &TorqueStudy,
    program: &Program,
) -> Result<Artefacts, RecordError> {
    let mut artefacts = Artefacts::new();
    for (gait, pull) in &study.shown {
        let file = studied.gait_files.get(&gait.name);
        let recording = PullRecording {
            command: Command::ReproducePull,
            robot: studied.robot,
            world,
            gait,
            file: file.map_or(("", ""), |text| (&text.file, &text.text)),
            duration_s: study.showcase_s,
            start_posture: &world.robot().study.start_posture,
            pull,
        };
        let folder = format!("pulls/{}-{}s", gait.name, study.showcase_s);
        artefacts.extend(below(&folder, crawl::pull::files(&recording, program)?));
    }
    Ok(artefacts)
}

/// The shorter crawl under the table, likewise.
fn crawl_record(
    robot: &LoadedRobot,
    table: &TableStudy,
    result: &TableResult,
    program: &Program,
) -> Result<Artefacts, RecordError> {
    let Some(experiment) = result.experiments.first() else {
        return Ok(Artefacts::new());
    };
    let conditions = table.conditions(experiment);
    let recording = Recording {
        robot,
        world: &result.world,
        gait: &table.gait,
        conditions: &conditions,
        crawl: &result.shortest,
        summary: &experiment.ours,
    };
    let files = crawl::record::numbers(&recording, Command::ReproduceCrawl, program)?;
    let folder = format!("crawls/table-{}-cycles", experiment.published.cycles);
    Ok(below(&folder, files))
}

/// The same files in a folder.
fn below(folder: &str, files: Artefacts) -> Artefacts {
    let named = files.into_iter();
    named
        .map(|(name, bytes)| (format!("{folder}/{name}"), bytes))
        .collect()
}
