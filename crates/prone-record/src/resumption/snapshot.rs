//! Unfinished work whose state is one value: the file is replaced as a whole.

use std::marker::PhantomData;
use std::path::Path;
use std::time::{Duration, Instant};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{Opening, Place, ResumptionError, Standing, Work};
use crate::single_file;

/// Time between two writes at least: a cheap search has thousands of generations a second.
const INTERVAL: Duration = Duration::from_secs(2);

/// The kept state `S` of a piece of work, locked.
#[derive(Debug)]
pub struct Snapshot<S> {
    place: Place,
    written: Option<Instant>,
    state: PhantomData<fn(S) -> S>,
}

/// What an earlier program has left.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Earlier<S> {
    /// Nothing.
    Nothing,
    /// A file that breaks off before its state is whole, as a machine that goes down leaves it.
    Torn,
    /// A state to go on from.
    State(S),
    /// Something that was to be discarded: it stays until the first state is written.
    Discarded {
        /// Whether this program could go on from such a file, under an equal plan.
        readable: bool,
    },
}

impl<S: Serialize + DeserializeOwned> Snapshot<S> {
    /// Locks the unfinished work of a result and reads what is kept of it; nothing is written yet.
    /// Where nothing is unfinished, the state that a finished work has left in its result folder is
    /// what is resumed.
    pub fn open(
        work: Work,
        result: &Path,
        plan: &impl Serialize,
        opening: Opening,
    ) -> Result<(Self, Earlier<S>), ResumptionError> {
        let place = Place::new(work, result, plan)?;
        let earlier = match (place.standing()?, opening) {
            (Standing::Nothing, Opening::Resume) if place.path.exists() => Earlier::Torn,
            (Standing::Nothing, Opening::Resume) => finished(&place.within(result))?,
            (Standing::Nothing, _) => Earlier::Nothing,
            (Standing::Kept(_), Opening::Restart) => Earlier::Discarded { readable: true },
            (Standing::Other(_), Opening::Restart) => Earlier::Discarded { readable: false },
            (Standing::Other(format), Opening::Resume) => return Err(place.other_format(format)),
            (Standing::Kept(bytes), Opening::Resume) => {
                let (mut states, _) = place.states(&bytes)?;
                states.pop().map_or(Earlier::Torn, Earlier::State)
            }
        };
        let snapshot = Self {
            place,
            written: None,
            state: PhantomData,
        };
        Ok((snapshot, earlier))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.place.path
    }

    /// Writes now and then; whole or not at all.
    ///
    /// # Errors
    /// [`ResumptionError::Write`].
    pub fn keep(&mut self, state: &S) -> Result<(), ResumptionError> {
        if self.written.is_some_and(|at| at.elapsed() < INTERVAL) {
            return Ok(());
        }
        self.write(state)
    }

    /// Writes; whole or not at all.
    ///
    /// # Errors
    /// [`ResumptionError::Write`].
    pub fn write(&mut self, state: &S) -> Result<(), ResumptionError> {
        let mut text = self.place.head()?;
        text.push_str(&self.place.line(state)?);
        single_file::write(&self.place.path, text.as_bytes())?;
        self.written = Some(Instant::now());
        Ok(())
    }

    /// Removes it: the result is in place.
    ///
    /// # Errors
    /// [`ResumptionError::Write`].
    pub fn remove(&self) -> Result<(), ResumptionError> {
        self.place.remove()
    }
}

/// What a finished work has left in its result folder. It was put in place whole: what breaks off there was
/// cut since, and is refused, as work that begins anew would replace the result.
fn finished<S: DeserializeOwned>(place: &Place) -> Result<Earlier<S>, ResumptionError> {
    match place.standing()? {
        Standing::Nothing if place.path.exists() => Err(place.damaged(1, "")),
        Standing::Nothing => Ok(Earlier::Nothing),
        Standing::Other(format) => Err(place.other_format(format)),
        Standing::Kept(bytes) => {
            let (mut states, _) = place.states(&bytes)?;
            let state = states.pop().map(Earlier::State);
            state.ok_or_else(|| place.damaged(2, ""))
        }
    }
}
