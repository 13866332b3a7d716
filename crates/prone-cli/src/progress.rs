//! A progress bar on a terminal, silence elsewhere.

use indicatif::{ProgressBar, ProgressStyle};

use prone_study::torque_study::Observer;

use crate::Failure;
use crate::interrupt;

/// Progress of a study.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// Shows progress in `phases` steps.
    pub(crate) fn new(phases: usize) -> Result<Self, Failure> {
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
        interrupt::requested()
    }
}
