//! A progress bar on a terminal, silence elsewhere; and Ctrl-C.

use std::sync::atomic::{AtomicBool, Ordering};

use anyhow::anyhow;
use indicatif::{ProgressBar, ProgressStyle};

use prone_study::torque_study::Observer;

use crate::Failure;

/// Set by Ctrl-C.
static STOP: AtomicBool = AtomicBool::new(false);

/// Progress of a study.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// Shows progress in `phases` steps and lets Ctrl-C end the work before the next one; a second
    /// Ctrl-C ends the program at once.
    pub(crate) fn new(phases: usize) -> Result<Self, Failure> {
        ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::Relaxed) {
                std::process::exit(130);
            }
        })
        .map_err(|error| Failure::Work(anyhow!("cannot listen for Ctrl-C: {error}")))?;
        // indicatif draws on standard error, and only if that is a terminal.
        let bar = ProgressBar::new(phases as u64);
        let style = ProgressStyle::with_template("{msg:<12} {bar:30} {pos}/{len}  {elapsed}")
            .map_err(Failure::work)?;
        bar.set_style(style);
        bar.set_message("simulating");
        bar.tick();
        Ok(Self { bar })
    }

    /// All work is done.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for Progress {
    fn phase_done(&self) {
        self.bar.inc(1);
        if self.bar.position() == self.bar.length().unwrap_or(0) {
            self.bar.set_message("drawing");
            self.bar.tick();
        }
    }

    fn stop(&self) -> bool {
        STOP.load(Ordering::Relaxed)
    }
}
