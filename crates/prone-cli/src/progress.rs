//! A progress bar on a terminal, silence elsewhere.

use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};

use prone_record::gait_search::Broken;
use prone_record::measure::{Measure, broken_sentence};
use prone_record::search::Search;
use prone_study::watch::{self, Found, Watch};

use crate::{Failure, failure, interrupt};

/// What is finished when work is to end.
const PICTURE: &str = "this picture";

/// Steps of work of one kind, with a word for it.
const STEPS: &str = "{msg:<12} {bar:30} {pos}/{len}  {elapsed}";
/// Evaluations of a search.
const SEARCH: &str = "searching {bar:30} {pos}/{len} evaluations  {elapsed}, {eta} left  {msg}";

/// Progress of any work; Ctrl-C ends it.
pub(crate) struct Progress {
    bar: ProgressBar,
    steps: ProgressStyle,
    search: ProgressStyle,
}

impl Progress {
    /// Shows nothing until work begins.
    pub(crate) fn new() -> Result<Self, Failure> {
        let style = |template| ProgressStyle::with_template(template).map_err(Failure::work);
        // indicatif draws on standard error, and only if that is a terminal.
        let bar = ProgressBar::new(0);
        interrupt::beside(&bar);
        Ok(Self {
            bar,
            steps: style(STEPS)?,
            search: style(SEARCH)?,
        })
    }

    /// Shows pictures of a film.
    pub(crate) fn filming(pictures: usize) -> Result<Self, Failure> {
        let progress = Self::new()?;
        interrupt::work(PICTURE, None);
        progress.begin(pictures, "filming");
        Ok(progress)
    }

    /// All work is done.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }

    fn begin(&self, steps: usize, message: &'static str) {
        self.bar.set_message(message);
        self.bar.set_style(self.steps.clone());
        self.bar.set_length(steps as u64);
        self.bar.set_position(0);
        self.bar.tick();
    }

    /// After a generation, or before the first one.
    fn searched(&self, search: &Search, measure: Measure, broken: &[Broken]) {
        interrupt::finishing("this evaluation");
        if self.bar.length() != Some(search.allowance()) || self.bar.position() == 0 {
            self.bar.set_style(self.search.clone());
            self.bar.set_length(search.allowance());
            self.bar.set_position(search.evaluations());
            self.bar.reset_eta();
        }
        self.bar.set_position(search.evaluations());
        if let Some((run, best)) = search.best() {
            let (violation, value) = (best.score.violation(), best.score.value());
            // A value that is not known, as what is broken forbids to simulate, counts as 0.
            let value = Some(value).filter(|value| violation <= 0.0 || *value != 0.0);
            let value = value.map(|value| measure.sentence(value));
            let said = [value, broken_sentence(violation, broken)];
            let said: Vec<String> = said.into_iter().flatten().collect();
            let (said, seed) = (said.join(", "), run.seed);
            self.bar.set_message(format!("best: {said}, seed {seed}"));
        }
    }

    /// Where nobody listens, the work goes on. The bar steps aside meanwhile.
    fn say(&self, message: &str) {
        self.bar.suspend(|| failure::say(message));
    }

    fn measuring(&self, rows: usize, taken_over: usize, journal: Option<&Path>) {
        interrupt::finishing("this row");
        self.begin(rows, "measuring");
        if let (Some(journal), true) = (journal, taken_over > 0) {
            let journal = journal.display();
            self.say(&format!(
                "{taken_over} of {rows} rows taken over from {journal}"
            ));
        }
        self.bar.set_position(taken_over as u64);
    }

    fn found(&self, checkpoint: &Path, found: Found) {
        let path = checkpoint.display();
        self.say(&match found {
            Found::Nothing => format!("no search is kept in {path}: starting from the beginning"),
            Found::Torn => {
                format!("{path} breaks off before its search is whole: starting from the beginning")
            }
            Found::Replaced => format!(
                "replacing {path}, which an earlier search has left: --resume goes on from there"
            ),
            Found::ReplacedOther => {
                format!("replacing {path}, which another version of prone has left")
            }
            Found::Evaluations(evaluations) => {
                format!("going on after {evaluations} evaluations")
            }
        });
    }
}

impl Watch for Progress {
    fn stop(&self) -> bool {
        interrupt::requested()
    }

    fn publish(&self, put_in_place: &mut dyn FnMut()) -> bool {
        interrupt::uninterrupted(put_in_place).is_some()
    }

    fn progress(&self, progress: &watch::Progress<'_>) {
        match *progress {
            watch::Progress::Simulating(steps) => {
                interrupt::finishing("this simulation");
                self.begin(steps, "simulating");
            }
            watch::Progress::Drawing => {
                interrupt::finishing(PICTURE);
                self.bar.set_message("drawing");
                self.bar.tick();
            }
            watch::Progress::Measuring {
                rows,
                taken_over,
                journal,
            } => self.measuring(rows, taken_over, journal),
            watch::Progress::Searching {
                search,
                measure,
                broken,
            } => self.searched(search, measure, broken),
            watch::Progress::Found(checkpoint, found) => self.found(checkpoint, found),
            watch::Progress::Done(steps) => self.bar.inc(steps as u64),
        }
    }
}
