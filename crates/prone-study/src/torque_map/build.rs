//! Measuring every node of a map, on all threads, with a journal.

use std::path::Path;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;
use serde::Serialize;

use prone::chain::GaitParameters;
use prone::robot::{ContactGroup, Robot};
use prone::statics::{Stance, StaticTorques, SupportRule};
use prone::torque_map::{
    self, ContactForces, GridError, JointTorques, Mask, RecordedMap, Row, TorqueGap, TorqueMap,
};
use prone_record::resumption::{Journal, Opening, ResumptionError, Work};
use prone_sim::World;
use prone_sim::settled::SettledTorques;

use super::BuildError;
use super::entry::Entry;
use super::job::REGIME;
use super::{Job, KeptRow};
use crate::watch::{Progress, Watch};
use prone_record::experiment::MapSource;

/// A map, ready to be put in place.
#[derive(Debug)]
pub struct Built {
    /// The file.
    pub text: String,
    /// What is in it.
    pub summary: Summary,
    /// To be removed once the file is in place; `None` where rows were kept in memory.
    pub journal: Option<Journal<KeptRow>>,
}

/// What is in a map.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// Where its torques come from.
    pub source: &'static str,
    /// Nodes of its grid.
    pub rows: usize,
    /// Rows that have torques.
    pub with_torques: usize,
    /// Rows where the chain does not close.
    pub open: usize,
    /// Rows where the source had no torques.
    pub failed: usize,
}

/// Builds a map on the current rayon pool. Where it has a place, its journal is beside that, and is
/// taken up or not. Its text depends on the job alone, not on threads or on what the journal held.
///
/// # Errors
/// [`BuildError`]; rows that were measured are then in the journal.
pub fn run(
    job: &Job<'_>,
    place: Option<(&Path, Opening)>,
    watch: &dyn Watch,
) -> Result<Built, BuildError> {
    let robot: &Robot = job.robot.robot();
    let mapping = job.mapping.clone();
    // The journal is opened last: what cannot be measured leaves none.
    let open = || open(job, place);
    let joints = robot.chain.right.pitch_joints();
    let (entries, journal) = match job.source {
        MapSource::Statics => {
            let stance = Stance::unsqueezed(SupportRule::AnyShape);
            let source = StaticTorques::new(robot, mapping, &robot.study_stops(), stance)?;
            let gauge = |at| {
                let rest = source.rest(at)?;
                let mut forces = [0.0; ContactGroup::COUNT];
                for support in rest.footing.supports() {
                    forces[support.group as usize] += support.reaction;
                }
                let forces = ContactGroup::as_in_the_study(forces);
                Ok([joints.map(|joint| rest.load(joint)), forces])
            };
            measure(job, gauge, open()?, watch)?
        }
        MapSource::Simulation => {
            let world = World::new(job.robot, REGIME)?;
            let source = SettledTorques::new(&world, mapping);
            let gauge = |at| {
                let means = source.settled(at)?.means;
                let torques = joints.map(|joint| -means.applied_torque[joint.0]);
                Ok([torques, ContactGroup::as_in_the_study(means.contact)])
            };
            measure(job, gauge, open()?, watch)?
        }
    };
    let recorded = recorded(job, &entries)?;
    let text = torque_map::write(&job.comments(), robot, &job.mapping, &recorded);
    let masked = |mask| recorded.map().masked(mask);
    let (rows, open, failed) = (job.rows(), masked(Mask::Open), masked(Mask::Failed));
    let summary = Summary {
        source: job.source.name(),
        rows,
        with_torques: rows - open - failed,
        open,
        failed,
    };
    Ok(Built {
        text,
        summary,
        journal,
    })
}

/// Where measured rows are kept, and those that were kept before, in the grid's order.
type Kept = (Option<Journal<KeptRow>>, Vec<Option<Entry>>);

fn open(job: &Job<'_>, place: Option<(&Path, Opening)>) -> Result<Kept, ResumptionError> {
    let mut entries = vec![None; job.rows()];
    let Some((out, opening)) = place else {
        return Ok((None, entries));
    };
    let (journal, kept) = Journal::<KeptRow>::open(Work::TorqueMap, out, &job.identity(), opening)?;
    for (line, row) in kept.iter().enumerate() {
        let KeptRow(index, entry) = *row;
        let place = entries.get_mut(index);
        *place.ok_or_else(|| journal.impossible(line, row))? = Some(entry);
    }
    Ok((Some(journal), entries))
}

/// Entries in the grid's order: those of the journal, and measured ones for the rest. A gauge gives
/// the torques of the right side in the recordings' sign, and what carries both sides.
fn measure(
    job: &Job<'_>,
    gauge: impl Fn(GaitParameters) -> Result<[[f64; 4]; 2], TorqueGap> + Sync,
    (journal, mut entries): Kept,
    watch: &dyn Watch,
) -> Result<(Vec<Entry>, Option<Journal<KeptRow>>), BuildError> {
    let rows = job.rows();
    let missing: Vec<usize> = (0..rows).filter(|row| entries[*row].is_none()).collect();
    watch.progress(&Progress::Measuring {
        rows,
        taken_over: rows - missing.len(),
        journal: journal.as_ref().map(Journal::path),
    });
    let journal = Mutex::new(journal);
    let measured: Result<Vec<Option<(usize, Entry)>>, ResumptionError> = missing
        .par_iter()
        .with_max_len(1)
        .map(|&row| {
            if watch.stop() {
                return Ok(None);
            }
            let entry = Entry::from_measured(&gauge(job.grid.grid().node(row)));
            if let Some(journal) = &mut *journal.lock().unwrap_or_else(PoisonError::into_inner) {
                journal.append(&KeptRow(row, entry))?;
            }
            watch.progress(&Progress::Done(1));
            Ok(Some((row, entry)))
        })
        .collect();
    let mut journal = journal.into_inner().unwrap_or_else(PoisonError::into_inner);
    if let Some(journal) = &mut journal {
        journal.flush()?;
    }
    for (row, entry) in measured?.into_iter().flatten() {
        entries[row] = Some(entry);
    }
    let done: Vec<Entry> = entries.into_iter().flatten().collect();
    if done.len() == rows {
        return Ok((done, journal));
    }
    let path = journal.as_ref().map(|journal| journal.path().to_owned());
    if let (Some(journal), true) = (journal, done.is_empty()) {
        // One that stays is taken over with its no rows.
        let _ = journal.remove();
    }
    Err(BuildError::Stopped {
        kept: done.len(),
        rows,
        journal: path,
    })
}

fn recorded(job: &Job<'_>, entries: &[Entry]) -> Result<RecordedMap, GridError> {
    let masked = |mask| {
        let recorded = None;
        (Row::Masked { mask, recorded }, None)
    };
    let row = |entry: &Entry| match *entry {
        Entry::Held { torques, contacts } => (
            Row::Torques(JointTorques::from_array(torques)),
            Some(ContactForces::from_array(contacts)),
        ),
        Entry::Open => masked(Mask::Open),
        Entry::Failed => masked(Mask::Failed),
    };
    let (rows, contacts) = entries.iter().map(row).unzip();
    RecordedMap::new(TorqueMap::new(*job.grid.grid(), rows)?, contacts)
}

#[cfg(test)]
mod tests;
