//! Running an experiment, whoever asks for it: the command line, a client in another language, a
//! worker.
//!
//! [`run`] keeps everything in memory and takes all cores; a [`Session`] says how many threads, which
//! program, and what figures are held against.

mod error;
mod search;
mod torque_map;

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

use rayon::{ThreadPool, ThreadPoolBuilder};
use serde_json::json;

use prone::gait::PhaseDuration;
use prone::gait::cycle::Cycle;
use prone::regime::Regime;
use prone_files::{cycle_file, gait_file};
use prone_record::crawl_summary::CrawlSummary;
use prone_record::cycle_cost::CycleCost;
use prone_record::experiment::{
    CrawlExperiment, Detail, Experiment, Limit, PassageExperiment, PullExperiment, check_heights,
};
use prone_record::lock::Lock;
use prone_record::output::{self, Artefacts};
use prone_record::program::Program;
use prone_record::pulls::PullRecord;
use prone_record::recorded::Command;
use prone_record::resumption::Opening;
use prone_record::single_file;
use prone_report::figures::PublishedRange;
use prone_sim::crawl::CrawlError;
use prone_sim::pull::{self, Keep, Start};
use prone_sim::{LoadedRobot, World};

use crate::crawl::pull::PullRecording;
use crate::crawl::record::{self, Recording};
use crate::crawl::{self, CrawlRunError, CrawlSetup, summary};
use crate::pulls::pull_record;
use crate::search::costed_cycle;
use crate::search::passage::{self, Offered, Passage, Plates, Under};
use crate::search::room::NoRoom;
use crate::search::run::Done;
use crate::watch::Watch;

pub use error::RunError;
pub use search::CostOutcome;
pub use torque_map::MapOutcome;

/// The range that a joint swept on a robot, where one is published.
pub type JointRanges = Arc<dyn Fn(&str) -> Option<PublishedRange> + Send + Sync>;

/// How experiments are run.
#[derive(Clone)]
pub struct Session {
    /// The program that records name.
    pub program: Program,
    /// Worker threads; `None` takes all cores.
    pub threads: Option<usize>,
    /// Ranges that the figure of joint angles is held against.
    pub joint_ranges: JointRanges,
    /// Where the result is put; `None` keeps it in memory.
    pub place: Option<Place>,
}

/// Where a result is put, and what becomes of unfinished work beside it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The result folder; of a passage the file of its cycle, of a torque map the map.
    pub path: PathBuf,
    /// Whether a search or a torque map goes on from what an earlier run has left.
    pub opening: Opening,
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
    /// The cost of a pull.
    Cost(Box<CostOutcome>),
    /// The cost of a cycle.
    CycleCost(Box<CycleCost>),
    /// Of a search.
    Search(Box<Done>),
    /// Of a torque map.
    TorqueMap(Box<MapOutcome>),
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
    /// The files of its record folder, where rows were asked for.
    pub artefacts: Option<Artefacts>,
}

/// Whether a robot gets under a ceiling.
#[derive(Debug)]
pub struct PassageOutcome {
    /// The answer.
    pub passage: Passage,
    /// The cycle of the answer, where there is one.
    pub cycle: Option<Cycle>,
}

/// Runs an experiment on all cores, in memory.
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
            place: None,
        }
    }
}

impl Session {
    /// Runs an experiment and puts its result in place.
    pub fn run(&self, experiment: &Experiment, watch: &dyn Watch) -> Result<Outcome, RunError> {
        Ok(match experiment {
            Experiment::Pull(it) => Outcome::Pull(Box::new(self.pull(it, watch)?)),
            Experiment::Crawl(it) => Outcome::Crawl(Box::new(self.crawl(it, watch)?)),
            Experiment::Passage(it) => Outcome::Passage(Box::new(self.passage(it, watch)?)),
            Experiment::Cost(it) => {
                let robot = LoadedRobot::load(it.robot.files()?)?;
                Outcome::Cost(Box::new(search::cost(it, &robot, watch)?))
            }
            Experiment::CycleCost(it) => {
                let robot = LoadedRobot::load(it.robot.files()?)?;
                Outcome::CycleCost(Box::new(costed_cycle::cost(it, &robot, watch)?))
            }
            Experiment::PullSearch(it) => Outcome::Search(Box::new(self.pull_search(it, watch)?)),
            Experiment::CycleSearch(it) => Outcome::Search(Box::new(self.cycle_search(it, watch)?)),
            Experiment::TorqueMap(it) => Outcome::TorqueMap(Box::new(self.torque_map(it, watch)?)),
        })
    }

    /// Checks that a result folder can be put in its place, where it has one.
    ///
    /// # Errors
    /// [`RunError::Place`].
    pub fn check_place(&self) -> Result<(), RunError> {
        let place = self.place.as_ref();
        place.map_or(Ok(()), |place| {
            output::check(&place.path).map_err(RunError::Place)
        })
    }

    /// Checks the place and locks it: of two runs into one folder, the first to end would be lost.
    /// `what` names them in the error of the second.
    fn lock(&self, what: &'static str) -> Result<Option<Lock>, RunError> {
        self.check_place()?;
        let place = self.place.as_ref();
        let lock = place.map(|place| Lock::for_folder(&place.path, what));
        Ok(lock.transpose()?)
    }

    /// Puts a result folder in place, where it has one, and does what follows in the same step.
    ///
    /// # Errors
    /// [`RunError::Stopped`] if the work was to end before; [`RunError::Publish`], or that of `then`.
    pub fn publish(
        &self,
        artefacts: &Artefacts,
        watch: &dyn Watch,
        then: impl FnOnce() -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        uninterrupted(watch, || {
            if let Some(place) = &self.place {
                output::publish(&place.path, artefacts)?;
            }
            then()
        })
    }

    /// The worker threads of an experiment.
    ///
    /// # Errors
    /// [`RunError::Threads`].
    pub fn pool(&self) -> Result<ThreadPool, RunError> {
        let threads = self.threads.unwrap_or_default();
        Ok(ThreadPoolBuilder::new().num_threads(threads).build()?)
    }

    fn crawl(
        &self,
        experiment: &CrawlExperiment,
        watch: &dyn Watch,
    ) -> Result<CrawlOutcome, RunError> {
        let setup = CrawlSetup::new(experiment)?;
        let _lock = self.lock("crawl that is recorded in this folder")?;
        let started = Instant::now();
        // Pictures are taken on it.
        let pool = match setup.detail {
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
        let mut artefacts = None;
        if let Some(pool) = &pool {
            let recording = Recording {
                robot: &setup.robot,
                world: &setup.world,
                gait: &setup.gait,
                conditions: &setup.conditions,
                crawl: &crawl,
                summary: &summary,
            };
            let ranges = &*self.joint_ranges;
            let mut files =
                pool.install(|| record::files(&recording, &self.program, &ranges, watch))?;
            let threads = pool.current_num_threads();
            let timing = timing(started, threads, crawl.engine_steps)?;
            files.insert("timing.json".into(), timing);
            self.publish(&files, watch, || Ok(()))?;
            artefacts = Some(files);
        }
        let past = setup.past.filter(|_| !crawl.arrived);
        Ok(CrawlOutcome {
            summary,
            missed_mm: past.map(|past| past.x * 1e3),
            artefacts,
        })
    }

    /// Tries cycles under a ceiling, and searches one where none fits and that is asked for.
    fn passage(
        &self,
        experiment: &PassageExperiment,
        watch: &dyn Watch,
    ) -> Result<PassageOutcome, RunError> {
        let (ceiling_mm, margin_mm) = (experiment.ceiling_mm, experiment.margin_mm);
        check_heights(ceiling_mm, margin_mm)?;
        NoRoom::check(ceiling_mm, margin_mm)?;
        let lengths = PassageExperiment::LENGTHS_M;
        Limit::check("a plate", " m", experiment.length_m, lengths)?;
        if let Some(place) = &self.place {
            single_file::check_place(&place.path).map_err(RunError::PlaceOfFile)?;
        }
        let robot = LoadedRobot::load(experiment.robot.files()?)?;
        let cycles = experiment.cycles.iter();
        let cycles = cycles.map(|it| it.gait.parse(cycle_file::parse));
        let mut cycles: Vec<Cycle> = cycles.collect::<Result<_, _>>()?;
        let under = Under {
            height: ceiling_mm * 1e-3,
            length: experiment.length_m,
            margin: margin_mm * 1e-3,
        };
        let plates = Plates::new(&robot, under)?;
        let pool = self.pool()?;
        let called = experiment.cycles.iter().map(|it| it.called.clone());
        let mut called: Vec<String> = called.collect();
        let mut passage = {
            let offered = experiment.cycles.iter().zip(&cycles);
            let offered = offered.map(|(asked, cycle)| Offered {
                cycle,
                called: &asked.called,
                origin: &asked.origin,
            });
            let offered: Vec<Offered<'_>> = offered.collect();
            pool.install(|| Passage::answer(&plates, &offered, watch))
        };
        if watch.stop() {
            return Err(RunError::Stopped);
        }
        if let (Some(asked), true) = (experiment.search, passage.may_be_searched()) {
            let searched =
                passage::candidates(&robot, &cycles, under.height - under.margin, watch)?;
            let found = pool.install(|| passage::search(asked, &searched, ceiling_mm, watch))?;
            if let Some(cycle) = found {
                let offered = Offered {
                    cycle: &cycle,
                    called: &cycle.name,
                    origin: "searched",
                };
                pool.install(|| passage.take(&plates, &[offered], watch));
                called.push(cycle.name.clone());
                cycles.push(cycle);
            }
        }
        let named = passage.named();
        let cycle = named.and_then(|named| {
            let mut all = called.iter().zip(&cycles);
            all.find(|(called, _)| **called == named.gait)
        });
        let cycle = cycle.map(|(_, cycle)| cycle.clone());
        uninterrupted(watch, || {
            let found = self.place.as_ref().zip(named).zip(cycle.as_ref());
            found.map_or(Ok(()), |((place, named), cycle)| {
                let through = if passage.robust {
                    format!("in all {} corners", passage.corners)
                } else {
                    "as in the model, not in all corners".to_owned()
                };
                let header = format!(
                    "Passes {ceiling_mm} mm over {} m {through}, with {:.1} mm to spare, {:.1} mm per cycle (prone crawl under).",
                    passage.length_m, named.margin_mm, named.mm_per_cycle
                );
                let text = cycle_file::write(cycle, &header);
                let written = single_file::write(&place.path, text.as_bytes());
                written.map_err(|source| RunError::PublishFile { source, journal: None })
            })
        })?;
        Ok(PassageOutcome { passage, cycle })
    }

    fn pull(
        &self,
        experiment: &PullExperiment,
        watch: &dyn Watch,
    ) -> Result<PullOutcome, RunError> {
        let robot = LoadedRobot::load(experiment.robot.files()?)?;
        let gait = experiment.gait.parse(gait_file::parse)?;
        let _lock = self.lock("pull that is recorded in this folder")?;
        let duration = PhaseDuration::new(experiment.duration_s)?;
        let world = World::new(&robot, Regime::TORQUE_STUDY)?;
        if watch.stop() {
            return Err(RunError::Stopped);
        }
        let keep = Keep::Shown { pictures: 0 };
        let stopped = || watch.stop();
        let pull = pull::run_unless(&stopped, &world, &gait, duration, Start::FirstPose, keep)?;
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
        let artefacts = crawl::pull::files(&recording, &self.program)?;
        self.publish(&artefacts, watch, || Ok(()))?;
        Ok(PullOutcome {
            record: pull_record(world.robot(), &gait, duration, &pull),
            artefacts,
        })
    }
}

/// Does what is not to be stopped halfway.
fn uninterrupted(
    watch: &dyn Watch,
    work: impl FnOnce() -> Result<(), RunError>,
) -> Result<(), RunError> {
    let (mut work, mut done) = (Some(work), Ok(()));
    let published = watch.publish(&mut || {
        if let Some(work) = work.take() {
            done = work();
        }
    });
    if published {
        done
    } else {
        Err(RunError::Stopped)
    }
}

/// `timing.json`.
pub fn timing(
    started: Instant,
    threads: usize,
    engine_steps: usize,
) -> Result<Vec<u8>, serde_json::Error> {
    serde_json::to_vec_pretty(&json!({
        "wall_s": started.elapsed().as_secs_f64(),
        "threads": threads,
        "engine_steps": engine_steps,
    }))
}
