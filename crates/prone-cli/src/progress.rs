//! A progress bar on a terminal, silence elsewhere.

use std::io::Write as _;
use std::path::PathBuf;

use indicatif::{ProgressBar, ProgressStyle};

use prone_record::search::Search;
use prone_study::watch::{self, Watch};

use crate::Failure;
use crate::interrupt;

/// Steps of work of one kind, with a word for it.
const STEPS: &str = "{msg:<12} {bar:30} {pos}/{len}  {elapsed}";
/// Evaluations of a search.
const SEARCH: &str = "searching {bar:30} {pos}/{len} evaluations  {elapsed}, {eta} left  {msg}";

/// Progress of any work; Ctrl-C ends it.
pub(crate) struct Progress {
    bar: ProgressBar,
    styles: Styles,
    /// What is done once all steps are.
    then: Option<&'static str>,
    /// Where earlier steps would come from.
    journal: PathBuf,
}

struct Styles {
    steps: ProgressStyle,
    search: ProgressStyle,
}

impl Progress {
    /// Shows simulations, and drawing after them.
    pub(crate) fn simulating(phases: usize) -> Result<Self, Failure> {
        let progress = Self::new(phases, "simulating")?;
        let then = Some("drawing");
        Ok(Self { then, ..progress })
    }

    /// Shows rows of a torque map; `journal` is where earlier ones would come from.
    pub(crate) fn measuring(rows: usize, journal: PathBuf) -> Result<Self, Failure> {
        let progress = Self::new(rows, "measuring")?;
        Ok(Self {
            journal,
            ..progress
        })
    }

    /// Shows pictures of a film.
    pub(crate) fn filming(pictures: usize) -> Result<Self, Failure> {
        Self::new(pictures, "filming")
    }

    /// Shows a search, and simulations after it.
    pub(crate) fn searching() -> Result<Self, Failure> {
        Self::simulating(0)
    }

    fn new(steps: usize, message: &'static str) -> Result<Self, Failure> {
        let style = |template| ProgressStyle::with_template(template).map_err(Failure::work);
        let styles = Styles {
            steps: style(STEPS)?,
            search: style(SEARCH)?,
        };
        // indicatif draws on standard error, and only if that is a terminal.
        let progress = Self {
            bar: ProgressBar::new(0),
            styles,
            then: None,
            journal: PathBuf::new(),
        };
        progress.begin(steps, message);
        Ok(progress)
    }

    /// All work is done.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn begin(&self, steps: usize, message: &'static str) {
        self.bar.set_style(self.styles.steps.clone());
        self.bar.set_length(steps as u64);
        self.bar.set_position(0);
        self.bar.set_message(message);
        self.bar.tick();
    }

    /// After a generation, or before the first one.
    fn searched(&self, search: &Search) {
        if self.bar.length() != Some(search.allowance()) || self.bar.position() == 0 {
            self.bar.set_style(self.styles.search.clone());
            self.bar.set_length(search.allowance());
            self.bar.set_position(search.evaluations());
            self.bar.reset_eta();
        }
        self.bar.set_position(search.evaluations());
        if let Some((run, best)) = search.best() {
            let (violation, value) = (best.score.violation(), best.score.value());
            self.bar.set_message(format!(
                "best: torque {value:.4}, violations {violation:.4}, seed {}",
                run.seed
            ));
        }
    }

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
}

impl Watch for Progress {
    fn stop(&self) -> bool {
        interrupt::requested()
    }

    fn progress(&self, progress: &watch::Progress<'_>) {
        match *progress {
            watch::Progress::Simulating(steps) => self.begin(steps, "simulating"),
            watch::Progress::Searching(search) => self.searched(search),
            watch::Progress::TakenOver(steps) => self.taken_over(steps),
            watch::Progress::Done(steps) => {
                self.bar.inc(steps as u64);
                let all = self.bar.position() == self.bar.length().unwrap_or(0);
                if let (true, Some(then)) = (all, self.then) {
                    self.bar.set_message(then);
                    self.bar.tick();
                }
            }
        }
    }
}
