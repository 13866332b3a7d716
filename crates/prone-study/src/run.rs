//! Running an experiment, whoever asks for it: the command line, a client in another language, a
//! worker.
//!
//! [`run`] keeps everything in memory and takes all cores; a [`Session`] says how many threads, which
//! program, and what figures are held against.

use std::sync::Arc;
use std::time::{Duration, Instant};

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use prone::gait::cycle::Cycle;
use prone::gait::{PhaseDuration, PhaseDurationError};
use prone::regime::Regime;
use prone_files::{FileError, gait_file};
use prone_record::crawl_summary::CrawlSummary;
use prone_record::experiment::{
    ChangedText, Detail, Experiment, PassageExperiment, PullExperiment,
};
use prone_record::output::Artefacts;
use prone_record::program::Program;
use prone_record::pulls::PullRecord;
use prone_record::recorded::Command;
use prone_sim::crawl::CrawlError;
use prone_sim::pull::{self, Keep, PullError, Start};
use prone_sim::{LoadError, LoadedRobot, World, WorldError};

use crate::crawl::pull::PullRecording;
use crate::crawl::record::{self, RecordError, Recording};
use crate::crawl::{
    self, CrawlRunError, CrawlSetup, CrawlSetupError, GaitSource, RefusedCycle, summary,
};
use crate::pulls::pull_record;
use crate::search::passage::{Passage, PassageError};
use crate::search::run::SearchError;
use crate::search::settings::{self, SettingError};
use crate::watch::Watch;

/// The range that a joint swept on a robot, rad, where one is published.
pub type JointRanges = Arc<dyn Fn(&str) -> Option<(f64, f64)> + Send + Sync>;

/// How experiments are run.
#[derive(Clone)]
pub struct Session {
    /// The program that records name.
    pub program: Program,
    /// Worker threads; `None` takes all cores.
    pub threads: Option<usize>,
    /// Ranges that the figure of joint angles is held against.
    pub joint_ranges: JointRanges,
}

/// What came out of an experiment.
#[derive(Debug)]
pub enum Outcome {
    /// Of a pull.
    Pull(Box<PullOutcome>),
    /// Of a crawl.
    Crawl(Box<CrawlOutcome>),
    /// Of a question whether a robot gets under a ceiling.
    Passage(Box<PassageOutcome>),
}

/// What came out of a pull.
#[derive(Debug)]
pub struct PullOutcome {
    /// Torques, angles, contacts of every control step.
    pub record: PullRecord,
    /// The files of its record folder.
    pub artefacts: Artefacts,
}

/// What came out of a crawl.
#[derive(Debug)]
pub struct CrawlOutcome {
    /// The crawl in figures.
    pub summary: CrawlSummary,
    /// Where it was to end, mm, if it did not get there.
    pub missed_mm: Option<f64>,
    /// The files of its record folder but `timing.json`, where rows were asked for.
    pub artefacts: Option<Artefacts>,
    /// What it took.
    pub took: Took,
}

/// Whether a robot gets under a ceiling.
#[derive(Debug)]
pub struct PassageOutcome {
    /// The answer.
    pub passage: Passage,
    /// The fastest cycle that fits, where there is one.
    pub cycle: Option<Cycle>,
}

/// What an experiment took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Took {
    /// Wall time.
    pub wall: Duration,
    /// Worker threads.
    pub threads: usize,
    /// Engine steps.
    pub engine_steps: usize,
}

/// Why an experiment has no outcome.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// A crawl cannot be set up.
    #[error(transparent)]
    Setup(#[from] CrawlSetupError),
    /// A text is not the one that was asked for.
    #[error(transparent)]
    Changed(#[from] ChangedText),
    /// The robot cannot be loaded.
    #[error(transparent)]
    Robot(#[from] LoadError),
    /// A gait is malformed.
    #[error(transparent)]
    Text(#[from] FileError),
    /// The robot does not compile with its floor.
    #[error(transparent)]
    World(#[from] WorldError),
    /// A duration that no pull can have.
    #[error(transparent)]
    Duration(#[from] PhaseDurationError),
    /// A pull has no record.
    #[error(transparent)]
    Pull(#[from] PullError),
    /// A crawl has no record.
    #[error(transparent)]
    Crawl(CrawlRunError),
    /// The robot cannot crawl a cycle.
    #[error(transparent)]
    Cycle(#[from] RefusedCycle),
    /// A record has no files.
    #[error(transparent)]
    Record(#[from] RecordError),
    /// A margin that is as large as its ceiling.
    #[error("a margin of {margin_mm} mm leaves no room under a ceiling of {ceiling_mm} mm")]
    NoRoom {
        /// The ceiling, mm.
        ceiling_mm: f64,
        /// The margin, mm.
        margin_mm: f64,
    },
    /// Cycles cannot be tried.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A search under a ceiling has no result.
    #[error(transparent)]
    Passage(PassageError),
    /// The worker threads cannot be started.
    #[error("cannot start worker threads: {0}")]
    Threads(#[from] ThreadPoolBuildError),
    /// [`Watch::stop`] said so.
    #[error("stopped")]
    Stopped,
}

/// Runs an experiment on all cores, in memory.
///
/// # Errors
/// [`RunError`].
pub fn run(experiment: &Experiment, watch: &dyn Watch) -> Result<Outcome, RunError> {
    Session::default().run(experiment, watch)
}

impl Default for Session {
    fn default() -> Self {
        Self {
            program: Program {
                version: env!("CARGO_PKG_VERSION").into(),
                commit: "unknown".into(),
            },
            threads: None,
            joint_ranges: Arc::new(|_| None),
        }
    }
}

impl Session {
    /// Runs an experiment in memory.
    ///
    /// # Errors
    /// [`RunError`].
    pub fn run(&self, experiment: &Experiment, watch: &dyn Watch) -> Result<Outcome, RunError> {
        match experiment {
            Experiment::Pull(pull) => Ok(Outcome::Pull(Box::new(self.pull(pull, watch)?))),
            Experiment::Crawl(crawl) => {
                let setup = CrawlSetup::new(crawl)?;
                Ok(Outcome::Crawl(Box::new(self.crawl(&setup, watch)?)))
            }
            Experiment::Passage(passage) => {
                Ok(Outcome::Passage(Box::new(self.passage(passage, watch)?)))
            }
        }
    }

    /// The worker threads of an experiment.
    ///
    /// # Errors
    /// [`RunError::Threads`].
    pub fn pool(&self) -> Result<ThreadPool, RunError> {
        let threads = self.threads.unwrap_or_default();
        Ok(ThreadPoolBuilder::new().num_threads(threads).build()?)
    }

    /// Simulates a crawl that was set up.
    ///
    /// # Errors
    /// [`RunError`].
    pub fn crawl(&self, setup: &CrawlSetup, watch: &dyn Watch) -> Result<CrawlOutcome, RunError> {
        let started = Instant::now();
        // Pictures are taken on it.
        let pool = match setup.detail() {
            Detail::Sums => None,
            Detail::Rows => Some(self.pool()?),
        };
        let crawl = setup.run(&|| watch.stop()).map_err(|error| match error {
            CrawlRunError::Crawl(CrawlError::Stopped) => RunError::Stopped,
            other => RunError::Crawl(other),
        })?;
        let summary = summary::of(
            &setup.world,
            &setup.gait.cycle,
            setup.scale,
            &crawl,
            setup.past,
        )
        .map_err(|error| setup.gait.refused(&error))?;
        let artefacts = match &pool {
            None => None,
            Some(pool) => {
                let recording = Recording {
                    robot: &setup.robot,
                    world: &setup.world,
                    gait: &setup.gait,
                    conditions: &setup.conditions,
                    crawl: &crawl,
                    summary: &summary,
                };
                let ranges = &*self.joint_ranges;
                Some(pool.install(|| record::files(&recording, &self.program, &ranges))?)
            }
        };
        let past = setup.past.filter(|_| !crawl.arrived);
        Ok(CrawlOutcome {
            summary,
            missed_mm: past.map(|past| past.x * 1e3),
            artefacts,
            took: Took {
                wall: started.elapsed(),
                threads: pool
                    .as_ref()
                    .map_or(1, rayon::ThreadPool::current_num_threads),
                engine_steps: crawl.engine_steps,
            },
        })
    }

    /// Tries cycles under a ceiling, and searches one where none fits and that is asked for.
    ///
    /// # Errors
    /// [`RunError`].
    pub fn passage(
        &self,
        experiment: &PassageExperiment,
        watch: &dyn Watch,
    ) -> Result<PassageOutcome, RunError> {
        let (ceiling_mm, margin_mm) = (experiment.ceiling_mm, experiment.margin_mm);
        // NaN leaves none either.
        let leaves_room = margin_mm < ceiling_mm;
        if !leaves_room {
            return Err(RunError::NoRoom {
                ceiling_mm,
                margin_mm,
            });
        }
        let robot = LoadedRobot::load(experiment.robot.files()?)?;
        let sources = experiment.cycles.iter();
        let sources = sources.map(|it| Ok((GaitSource::from_text(&it.gait)?.cycle, &*it.origin)));
        let sources: Vec<(Cycle, &str)> = sources.collect::<Result<_, CrawlSetupError>>()?;
        let settings = settings::for_advance(&robot)?;
        let (ceiling, margin) = (ceiling_mm * 1e-3, margin_mm * 1e-3);
        let tried = sources.iter().map(|(cycle, origin)| (cycle, *origin));
        let mut passage = Passage::try_all(robot.robot(), &settings[0], tried, ceiling, margin);
        let mut cycles: Vec<Cycle> = sources.into_iter().map(|(cycle, _)| cycle).collect();
        if let (Some(asked), true) = (experiment.search, passage.may_be_searched()) {
            let height = ceiling - margin;
            let found = self
                .pool()?
                .install(|| passage.search(asked, &robot, &cycles, ceiling_mm, height, watch));
            cycles.extend(found.map_err(|error| match error {
                PassageError::Result(SearchError::Stopped) => RunError::Stopped,
                other => RunError::Passage(other),
            })?);
        }
        if watch.stop() {
            return Err(RunError::Stopped);
        }
        // What was searched last is the one of its name.
        let best = passage.best.as_ref();
        let cycle = best.and_then(|best| {
            let mut last_first = cycles.into_iter().rev();
            last_first.find(|cycle| cycle.pull.name == best.gait)
        });
        Ok(PassageOutcome { passage, cycle })
    }

    fn pull(
        &self,
        experiment: &PullExperiment,
        watch: &dyn Watch,
    ) -> Result<PullOutcome, RunError> {
        let robot = LoadedRobot::load(experiment.robot.files()?)?;
        let gait = gait_file::parse(&experiment.gait.file, experiment.gait.checked()?)?;
        let duration = PhaseDuration::new(experiment.duration_s)?;
        let world = World::new(&robot, Regime::TORQUE_STUDY)?;
        if watch.stop() {
            return Err(RunError::Stopped);
        }
        let keep = Keep::Shown { pictures: 0 };
        let pull = pull::run(&world, &gait, duration, Start::FirstPose, keep)?;
        let recording = PullRecording {
            command: Command::Pull,
            robot: &robot,
            world: &world,
            gait: &gait,
            file: (&experiment.gait.file, &experiment.gait.text),
            duration_s: duration.seconds(),
            start_posture: "the gait's own first pose",
            pull: &pull,
        };
        Ok(PullOutcome {
            record: pull_record(world.robot(), &gait, duration, &pull),
            artefacts: crawl::pull::files(&recording, &self.program)?,
        })
    }
}
