//! What there is to be named: gaits, cycles, scenes and robots, those that ship and those that are a
//! robot's own.
//!
//! How high a cycle comes, how fast it is, what it asks of the motors: none of it is written down
//! anywhere. Each cycle is crawled, as `prone crawl run` does, and read off its summary.

use rayon::prelude::*;
use serde::Serialize;

use prone_files::gait_text::{GaitKind, GaitText};
use prone_files::gaits::Gaits;
use prone_files::robot_file::RobotFile;
use prone_files::robot_folder::{RobotFiles, RobotFolderError};
use prone_files::text_file::ReadError;
use prone_files::{FileError, cycle_file, gait_file, shipped};
use prone_record::crawl_summary::CrawlSummary;
use prone_record::experiment::{CrawlExperiment, Ending, Experiment, RobotText, TextFile};

use crate::run::{Outcome, RunError, Session};
use crate::watch::{Progress, Watch};

/// How many cycles each is crawled. The first one starts from rest, and the next two are what
/// follows.
pub const CYCLES: usize = 3;

/// What is listed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum ListedKind {
    /// A pull alone.
    Gait,
    /// A whole cycle.
    Cycle,
    /// A scene.
    Scene,
    /// A robot.
    Robot,
}

/// Where something listed comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Origin {
    /// It ships with the program.
    Shipped,
    /// It lies in the folder of the robot or of its family.
    Own,
}

/// A name and what it stands for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Listed {
    /// What it is.
    pub kind: ListedKind,
    /// Its name, as every command takes it.
    pub name: String,
    /// Where it comes from.
    pub origin: Origin,
    /// One sentence about it, out of its file; empty where the file has none or cannot be read.
    pub description: String,
    /// Why it cannot be used with the robot, or cannot be read; nothing where it can.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
    /// What a cycle's file says of it; nothing of anything else.
    #[serde(flatten)]
    pub cycle: Option<CycleFacts>,
    /// What a cycle came to; nothing where it was not crawled.
    #[serde(flatten)]
    pub figures: Option<CycleFigures>,
    /// The text of its file, to be crawled.
    #[serde(skip)]
    text: Option<TextFile>,
}

/// What a cycle's file says of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct CycleFacts {
    /// Whether it can turn.
    pub steers: bool,
    /// Whether it has a pull, or is made of waypoints alone.
    pub has_pull: bool,
}

/// What a cycle came to on level ground, in the locomotion regime.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CycleFigures {
    /// Highest point of the robot above the floor, mm.
    pub height_mm: f64,
    /// Path over cycles, mm.
    pub mm_per_cycle: f64,
    /// Path over time, mm/s.
    pub mm_per_s: f64,
    /// Motor heat per metre of path, s/m; nothing without progress, or where a motor is not known.
    pub heat_per_metre_s: Option<f64>,
    /// Motor heat per second; nothing where a motor is not known.
    pub heat_per_second: Option<f64>,
    /// The widest the robot gets about its own heading, mm.
    pub width_mm: Option<f64>,
    /// `continuous`, `limited` or `not on a robot`; nothing where a motor is not known.
    pub verdict: Option<String>,
    /// Largest mean force on the head over 20 ms, N.
    pub head_n: f64,
}

/// Why there is no list.
#[derive(Debug, thiserror::Error)]
pub enum CatalogueError {
    /// The folder of the robot's own gaits, or a file in it, cannot be read.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// The robot's text is malformed.
    #[error(transparent)]
    Text(#[from] FileError),
    /// The robot, or one that ships, cannot be read.
    #[error(transparent)]
    Robot(#[from] RobotFolderError),
    /// The watch said stop, or the worker threads cannot be started.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// Everything that a robot can be used with, by kind: its own before what ships, each name once.
/// Nothing is simulated. `named` is what the user called the robot, where it is not one that ships.
pub fn list(robot: &RobotFiles, named: Option<&str>) -> Result<Vec<Listed>, CatalogueError> {
    let mut all = gaits(&robot.gaits, GaitKind::Pull)?;
    all.extend(gaits(&robot.gaits, GaitKind::Cycle)?);
    for name in shipped::scene_names() {
        let scene = shipped::scene(name).transpose()?;
        let description = scene.map(|scene| scene.description).unwrap_or_default();
        all.push(Listed::new(ListedKind::Scene, name, description));
    }
    let own = named.filter(|name| shipped::robot(name).is_none());
    if let Some(name) = own {
        all.push(Listed {
            origin: Origin::Own,
            ..robot_of(name, robot)?
        });
    }
    for name in shipped::robot_names() {
        if let Some(source) = shipped::robot(&name) {
            all.push(robot_of(&name, &RobotFiles::shipped(source?))?);
        }
    }
    Ok(all)
}

/// Crawls the cycles of a list on the threads of a session, and sorts them: the lowest first, those
/// that cannot be crawled last.
pub fn measure(
    listed: &mut [Listed],
    robot: &RobotFiles,
    session: &Session,
    watch: &dyn Watch,
) -> Result<(), CatalogueError> {
    let robot = RobotText::from_files(robot);
    let wanted = |it: &Listed| it.text.is_some() && it.refused.is_none();
    let cycles = listed.iter().filter(|it| wanted(it)).count();
    watch.progress(&Progress::Simulating(cycles));
    let crawled: Result<(), RunError> = session.pool()?.install(|| {
        let cycles = listed.par_iter_mut().filter(|it| wanted(it));
        cycles.try_for_each(|it| {
            let Some(text) = it.text.clone() else {
                return Ok(());
            };
            let experiment = CrawlExperiment {
                ending: Ending::Cycles(CYCLES),
                ..CrawlExperiment::new(robot.clone(), text)
            };
            match session.run(&Experiment::Crawl(Box::new(experiment)), watch) {
                Ok(Outcome::Crawl(crawl)) => {
                    it.figures = Some(CycleFigures::from_summary(&crawl.summary));
                }
                Ok(_) => {}
                Err(RunError::Stopped) => return Err(RunError::Stopped),
                Err(error) => it.refused = Some(error.to_string()),
            }
            watch.progress(&Progress::Done(1));
            Ok(())
        })
    });
    crawled?;
    listed.sort_by(|a, b| {
        let height = |it: &Listed| {
            let figures = it.figures.as_ref();
            figures.map_or(f64::INFINITY, |figures| figures.height_mm)
        };
        let kinds = a.kind.cmp(&b.kind);
        kinds.then(height(a).total_cmp(&height(b)))
    });
    Ok(())
}

impl CycleFigures {
    fn from_summary(summary: &CrawlSummary) -> Self {
        let tops = summary.top_mm.to_array();
        Self {
            height_mm: tops.into_iter().fold(f64::NEG_INFINITY, f64::max),
            mm_per_cycle: summary.mm_per_cycle,
            mm_per_s: summary.mm_per_s,
            heat_per_metre_s: summary.heat_per_metre_s,
            heat_per_second: summary.heat_per_second,
            width_mm: summary.width_mm,
            verdict: summary.verdict.duty.clone(),
            head_n: summary.ground.head.peak_n,
        }
    }
}

impl Listed {
    fn new(kind: ListedKind, name: &str, description: String) -> Self {
        Self {
            kind,
            name: name.to_owned(),
            origin: Origin::Shipped,
            description,
            refused: None,
            cycle: None,
            figures: None,
            text: None,
        }
    }

    /// A gait, whole or with what is wrong with its file.
    fn from_gait(kind: GaitKind, name: &str, gait: &GaitText) -> Self {
        let text = TextFile::new(&gait.file, &gait.text);
        let listed = match kind {
            GaitKind::Pull => gait_file::parse(&gait.file, &gait.text)
                .map(|pull| Self::new(ListedKind::Gait, name, pull.description)),
            GaitKind::Cycle => cycle_file::parse(&gait.file, &gait.text).map(|cycle| Self {
                cycle: Some(CycleFacts {
                    steers: cycle.steering.is_some(),
                    has_pull: cycle.pull.is_some(),
                }),
                text: Some(text),
                ..Self::new(ListedKind::Cycle, name, cycle.description)
            }),
        };
        let listed = listed.unwrap_or_else(|error| {
            let kind = match kind {
                GaitKind::Pull => ListedKind::Gait,
                GaitKind::Cycle => ListedKind::Cycle,
            };
            Self {
                refused: Some(error.to_string()),
                ..Self::new(kind, name, String::new())
            }
        });
        let origin = match gait.read {
            Some(_) => Origin::Own,
            None => Origin::Shipped,
        };
        Self { origin, ..listed }
    }
}

/// The gaits of a kind that a robot knows by name.
fn gaits(gaits: &Gaits, kind: GaitKind) -> Result<Vec<Listed>, ReadError> {
    let mut listed = Vec::new();
    for name in gaits.names(kind.name_kind())? {
        let Some(gait) = gaits.find(&name)? else {
            continue;
        };
        // A robot's own of the other kind may have the name of one that ships.
        let is_cycle = gait.is_cycle();
        if is_cycle == (kind == GaitKind::Cycle) {
            listed.push(Listed::from_gait(kind, &name, &gait));
        }
    }
    Ok(listed)
}

/// A robot, described by the name that its `robot.toml` has.
fn robot_of(name: &str, files: &RobotFiles) -> Result<Listed, FileError> {
    let table = RobotFile::parse(&files.toml_name(), &files.toml)?;
    Ok(Listed::new(
        ListedKind::Robot,
        name,
        table.name.into_inner(),
    ))
}

#[cfg(test)]
mod tests;
