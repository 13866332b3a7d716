//! Ctrl-C, and the signals that ask for the same: SIGTERM and SIGHUP.

use std::process;
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::anyhow;

use crate::Failure;
use crate::failure::STOPPED;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum State {
    /// Nobody asked for anything.
    Working,
    /// To end before the next phase; asked again, at once.
    Stopping,
    /// A result is being put in place, which takes a moment and is not stopped halfway.
    Publishing,
    /// All is written; whoever waits for the rest need not.
    Done,
}

static STATE: Mutex<State> = Mutex::new(State::Working);

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on a signal ends the work before the next phase, and a second one at once.
pub(crate) fn listen() -> Result<(), Failure> {
    let done = ctrlc::try_set_handler(|| {
        let mut state = state();
        match *state {
            State::Working => *state = State::Stopping,
            State::Publishing => {}
            State::Stopping | State::Done => process::exit(STOPPED.into()),
        }
    });
    match done {
        // Under `nohup` signals are ignored, and stay so. Whatever ends the program then leaves at
        // most a hidden folder, which the next run removes.
        Ok(()) | Err(ctrlc::Error::MultipleHandlers) => Ok(()),
        Err(error) => Err(Failure::Work(anyhow!("cannot listen for Ctrl-C: {error}"))),
    }
}

/// Whether the work is to end.
pub(crate) fn requested() -> bool {
    *state() == State::Stopping
}

/// Does what is not to be stopped halfway; `None` if the work is to end.
pub(crate) fn uninterrupted<T>(work: impl FnOnce() -> T) -> Option<T> {
    {
        let mut state = state();
        if *state == State::Stopping {
            return None;
        }
        *state = State::Publishing;
    }
    let done = work();
    *state() = State::Done;
    Some(done)
}

/// Puts a result in place, unless the work is to end.
pub(crate) fn publish(put_in_place: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    uninterrupted(put_in_place).unwrap_or(Err(Failure::Stopped))
}
