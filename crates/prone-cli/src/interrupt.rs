//! Ctrl-C, and the signals that ask for the same: SIGTERM and SIGHUP.
//!
//! The first one is answered at once, in one line. Where a command has nothing to lose it ends there.
//! Work that has begun is asked to give way ([`requested`]) and says what is kept of it; what does not
//! give way in time is ended, and so is everything by a second signal. However it ends, what is
//! hidden beside a result goes ([`leftovers`]), and the exit code is the same.

use std::fs;
use std::path::PathBuf;
use std::process;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError, mpsc};
use std::thread;
use std::time::Duration;

use anyhow::anyhow;
use indicatif::ProgressBar;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;

use prone_record::leftovers;
use prone_record::resumption::Work;

use crate::Failure;
use crate::failure::STOPPED;

/// How long work may take to give way before it is ended: with what ending takes, below two seconds.
const PATIENCE: Duration = Duration::from_millis(1500);

/// How long a last line may take: whoever should read it may not.
const LAST_WORDS: Duration = Duration::from_millis(200);

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    /// Reading and checking what was typed, or work that writes nothing until its end: nothing is lost.
    Preparing,
    /// Work that gives way, and may keep something.
    Working,
    /// To end before the next step; asked again, at once.
    Stopping,
    /// A result is being put in place, which takes a moment and is not stopped halfway.
    Publishing,
    /// The same, and somebody asked to stop.
    Answered,
    /// All is written; whoever waits for the rest need not.
    Done,
}

struct State {
    stage: Stage,
    /// What is finished before the work ends, as in "this picture".
    step: &'static str,
    /// Where unfinished work is kept, where it is.
    kept: Option<(Work, PathBuf)>,
    /// What steps aside for a line.
    bar: Option<ProgressBar>,
}

static STATE: Mutex<State> = Mutex::new(State {
    stage: Stage::Preparing,
    step: "this step",
    kept: None,
    bar: None,
});

/// The same as [`Stage::Stopping`], for whoever asks at every step of a simulation.
static STOPPING: AtomicBool = AtomicBool::new(false);

static LISTENING: AtomicBool = AtomicBool::new(false);

fn state() -> MutexGuard<'static, State> {
    STATE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// From now on signals are answered here. Those that are ignored, as under `nohup` and in the
/// background of a script, stay so.
pub(crate) fn listen() -> Result<(), Failure> {
    if LISTENING.swap(true, Ordering::Relaxed) {
        return Ok(());
    }
    let failed = |error| Failure::Work(anyhow!("cannot listen for Ctrl-C: {error}"));
    let ignored = ignored();
    let heard = [SIGINT, SIGTERM, SIGHUP].into_iter();
    let heard = heard.filter(|signal| ignored & (1 << (signal - 1)) == 0);
    let mut signals = Signals::new(heard).map_err(failed)?;
    let listener = thread::Builder::new().name("signals".to_owned());
    let listening = listener.spawn(move || signals.forever().for_each(|_| answer()));
    listening.map(drop).map_err(failed)
}

/// The signals that this program was told to ignore, a bit each; none where that is unknown.
fn ignored() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.unwrap_or_default()
}

/// Answers a signal.
fn answer() {
    let mut state = state();
    match state.stage {
        Stage::Preparing => end(&state, "stopped; nothing was written"),
        Stage::Working => {
            state.stage = Stage::Stopping;
            let step = state.step;
            let line = format!("stopping after {step}; Ctrl-C again ends at once");
            // Before the work gives way, which may end the program sooner than this is said.
            let _ = say(&state, line).recv_timeout(LAST_WORDS);
            drop(state);
            STOPPING.store(true, Ordering::Relaxed);
            // Where it cannot be started, a second signal still ends the work.
            let _ = thread::Builder::new().spawn(|| {
                thread::sleep(PATIENCE);
                end_at_once();
            });
        }
        Stage::Publishing => {
            state.stage = Stage::Answered;
            let line = "the result is being put in place, which is not stopped halfway; Ctrl-C again ends at once";
            say(&state, line.to_owned());
        }
        Stage::Stopping | Stage::Answered => {
            drop(state);
            end_at_once();
        }
        Stage::Done => end(&state, "stopped; the work was done"),
    }
}

/// Says a line without waiting for whoever reads it; what is to be heard before the end is waited for
/// a little.
fn say(state: &State, line: String) -> mpsc::Receiver<()> {
    let bar = state.bar.clone();
    let (said, heard) = mpsc::channel();
    // Where it cannot be started, nobody hears.
    let _ = thread::Builder::new().spawn(move || {
        match bar {
            Some(bar) => bar.suspend(|| crate::failure::say(&line)),
            None => crate::failure::say(&line),
        }
        let _ = said.send(());
    });
    heard
}

/// Ends the program, unless its work has given way meanwhile.
fn end_at_once() {
    let state = state();
    if state.stage == Stage::Done {
        return;
    }
    let kept = state.kept.as_ref().filter(|(_, path)| path.exists());
    let line = match kept {
        None => "stopped at once; nothing was written".to_owned(),
        Some((work, path)) => {
            let path = path.display();
            match work {
                Work::Search => format!(
                    "stopped at once; the search as it was kept last is in {path}, and --resume goes on from there"
                ),
                Work::TorqueMap => format!(
                    "stopped at once; rows that are kept are in {path}, and are taken over by the same command"
                ),
            }
        }
    };
    end(&state, &line);
}

/// Ends the program with a last line; the state is locked, so that nobody else ends it meanwhile.
fn end(state: &State, line: &str) -> ! {
    leftovers::remove_all();
    let heard = say(state, line.to_owned());
    let _ = heard.recv_timeout(LAST_WORDS);
    process::exit(STOPPED.into())
}

/// Work begins that gives way; what is kept of it is where `kept` says.
pub(crate) fn work(step: &'static str, kept: Option<(Work, PathBuf)>) {
    let mut state = state();
    state.step = step;
    state.kept = kept;
    if state.stage == Stage::Preparing {
        state.stage = Stage::Working;
    }
}

/// From now on this is what is finished before the work ends, as in "this picture".
pub(crate) fn finishing(step: &'static str) {
    state().step = step;
}

/// Lines step in front of this bar.
pub(crate) fn beside(bar: &ProgressBar) {
    state().bar = Some(bar.clone());
}

/// The work has ended, in whatever way, and says so itself.
pub(crate) fn ended() {
    state().stage = Stage::Done;
}

/// Whether the work is to end.
pub(crate) fn requested() -> bool {
    STOPPING.load(Ordering::Relaxed)
}

/// Does what is not to be stopped halfway; `None` if the work is to end.
pub(crate) fn uninterrupted<T>(work: impl FnOnce() -> T) -> Option<T> {
    {
        let mut state = state();
        if state.stage == Stage::Stopping {
            return None;
        }
        state.stage = Stage::Publishing;
    }
    let done = work();
    ended();
    Some(done)
}

/// Puts a result in place, unless the work is to end.
pub(crate) fn publish(put_in_place: impl FnOnce() -> Result<(), Failure>) -> Result<(), Failure> {
    uninterrupted(put_in_place).unwrap_or(Err(Failure::Stopped))
}
