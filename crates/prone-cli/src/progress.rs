//! A progress bar on a terminal, silence elsewhere.

use std::io::Write as _;
use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use prone_record::search::Search;
use prone_study::export::film;
use prone_study::pulls::Observer;
use prone_study::torque_map::build;

use crate::Failure;
use crate::interrupt;

/// Progress of a study.
pub(crate) struct Progress {
    bar: ProgressBar,
}

impl Progress {
    /// Shows progress in `phases` steps.
    pub(crate) fn new(phases: usize) -> Result<Self, Failure> {
        let bar = bar(phases, "simulating")?;
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

/// Progress of a search, in evaluations.
pub(crate) struct SearchProgress {
    bar: ProgressBar,
}

impl SearchProgress {
    /// Shows how far a search is.
    pub(crate) fn new(search: &Search) -> Result<Self, Failure> {
        let bar = ProgressBar::new(search.allowance());
        let template = "searching {bar:30} {pos}/{len} evaluations  {elapsed}, {eta} left  {msg}";
        bar.set_style(ProgressStyle::with_template(template).map_err(Failure::work)?);
        bar.set_position(search.evaluations());
        bar.reset_eta();
        Ok(Self { bar })
    }

    /// After a generation.
    pub(crate) fn show(&self, search: &Search) {
        self.bar.set_position(search.evaluations());
        if let Some((run, best)) = search.best() {
            let (violation, value) = (best.score.violation(), best.score.value());
            self.bar.set_message(format!(
                "best: torque {value:.4}, violations {violation:.4}, seed {}",
                run.seed
            ));
        }
    }

    /// All is searched.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

/// Progress of a torque map.
pub(crate) struct RowProgress {
    bar: ProgressBar,
    journal: PathBuf,
}

impl RowProgress {
    /// Shows progress in rows; `journal` is where earlier ones would come from.
    pub(crate) fn new(rows: usize, journal: PathBuf) -> Result<Self, Failure> {
        let bar = bar(rows, "measuring")?;
        Ok(Self { bar, journal })
    }

    /// All work is done.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl build::Observer for RowProgress {
    fn taken_over(&self, rows: usize) {
        if rows > 0 {
            let all = self.bar.length().unwrap_or(0);
            let journal = self.journal.display();
            // Where nobody listens, the work goes on. The bar steps aside meanwhile.
            self.bar.suspend(|| {
                let _ = writeln!(
                    std::io::stderr(),
                    "{rows} of {all} rows taken over from {journal}"
                );
            });
        }
        self.bar.set_position(rows as u64);
    }

    fn row_done(&self) {
        self.bar.inc(1);
    }

    fn stop(&self) -> bool {
        interrupt::requested()
    }
}

/// Progress of a film.
pub(crate) struct FilmProgress {
    bar: ProgressBar,
}

impl FilmProgress {
    /// Shows progress in pictures.
    pub(crate) fn new(pictures: usize) -> Result<Self, Failure> {
        let bar = bar(pictures, "filming")?;
        Ok(Self { bar })
    }

    /// All work is done.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl film::Observer for FilmProgress {
    fn pictures_done(&self, count: usize) {
        self.bar.inc(count as u64);
    }

    fn stop(&self) -> bool {
        interrupt::requested()
    }
}

fn bar(steps: usize, message: &'static str) -> Result<ProgressBar, Failure> {
    // indicatif draws on standard error, and only if that is a terminal.
    let bar = ProgressBar::new(steps as u64);
    let style = ProgressStyle::with_template("{msg:<12} {bar:30} {pos}/{len}  {elapsed}")
        .map_err(Failure::work)?;
    bar.set_style(style);
    bar.set_message(message);
    bar.tick();
    Ok(bar)
}
