//! Building a torque map, with a journal where it has a place.

use std::time::{Duration, Instant};

use prone_record::experiment::TorqueMapExperiment;
use prone_record::single_file;
use prone_sim::LoadedRobot;

use super::{RunError, Session, uninterrupted};
use crate::torque_map::build::{self, Built, Summary};
use crate::torque_map::{BuildError, Job, NodeGrid};
use crate::watch::Watch;

/// A torque map.
#[derive(Debug)]
pub struct MapOutcome {
    /// Its file.
    pub text: String,
    /// What is in it.
    pub summary: Summary,
    /// Wall time.
    pub wall: Duration,
    /// Worker threads.
    pub threads: usize,
}

impl Session {
    /// Measures a torque map; what is measured is kept beside its place.
    pub(super) fn torque_map(
        &self,
        experiment: &TorqueMapExperiment,
        watch: &dyn Watch,
    ) -> Result<MapOutcome, RunError> {
        let grid = NodeGrid::new(experiment.step_deg, experiment.theta4_max_deg);
        let grid = grid.map_err(BuildError::from)?;
        let robot = LoadedRobot::load(experiment.robot.files()?)?;
        let job = Job::new(&robot, experiment.source, grid, &self.program)?;
        let place = self.place.as_ref();
        if let Some(place) = place {
            single_file::check_place(&place.path).map_err(RunError::PlaceOfFile)?;
        }
        let pool = self.pool()?;
        let started = Instant::now();
        let kept = place.map(|place| (&*place.path, place.opening));
        let built = pool.install(|| build::run(&job, kept, watch));
        let Built {
            text,
            summary,
            journal,
        } = built?;
        let wall = started.elapsed();
        let path = journal.as_ref().map(|journal| journal.path().to_owned());
        let published = uninterrupted(watch, || {
            if let Some(place) = place {
                let written = single_file::write(&place.path, text.as_bytes());
                written.map_err(|source| RunError::PublishFile {
                    source,
                    journal: path.clone(),
                })?;
            }
            // Only then the journal goes.
            journal.map_or(Ok(()), |journal| Ok(journal.remove()?))
        });
        published.map_err(|error| match (error, path) {
            (RunError::Stopped, Some(journal)) => RunError::StoppedMap {
                done: summary.rows,
                rows: summary.rows,
                journal,
            },
            (error, _) => error,
        })?;
        Ok(MapOutcome {
            text,
            summary,
            wall,
            threads: pool.current_num_threads(),
        })
    }
}
