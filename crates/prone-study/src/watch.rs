//! Whoever waits for work: is told how it goes, may end it, and lets its result be put in place.

use std::path::Path;

use prone_record::gait_search::Broken;
use prone_record::measure::Measure;
use prone_record::search::Search;

/// Is told how work goes, from many threads, and may end it.
pub trait Watch: Sync {
    /// Whether to begin nothing further; once it is so, it stays so.
    fn stop(&self) -> bool;

    /// What has been done since the last call.
    fn progress(&self, progress: &Progress<'_>);

    /// Does what is not to be stopped halfway, unless the work is to end; whether it was done.
    fn publish(&self, put_in_place: &mut dyn FnMut()) -> bool {
        let goes_on = !self.stop();
        if goes_on {
            put_in_place();
        }
        goes_on
    }
}

/// How work goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress<'a> {
    /// Simulations begin, so many in all.
    Simulating(usize),
    /// What was simulated is drawn.
    Drawing,
    /// Rows of a torque map begin.
    Measuring {
        /// Rows in all.
        rows: usize,
        /// Rows that an earlier run left, which are taken over.
        taken_over: usize,
        /// From where, if rows are kept.
        journal: Option<&'a Path>,
    },
    /// So many steps more are done: phases, rows of a map or pictures.
    Done(usize),
    /// A search has found this in the place of its checkpoint.
    Found(&'a Path, Found),
    /// A search has done one more generation, or begins.
    Searching {
        /// The search.
        search: &'a Search,
        /// How its values are read.
        measure: Measure,
        /// Rules that its best breaks, as far as they are known.
        broken: &'a [Broken],
    },
}

/// What stands in the place of a search's checkpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// Nothing to go on from, though that was asked for.
    Nothing,
    /// A file that breaks off: the search begins anew.
    Torn,
    /// An earlier search, which is replaced.
    Replaced,
    /// Something of another version, which is replaced.
    ReplacedOther,
    /// A search of so many evaluations, which goes on.
    Evaluations(u64),
}

/// Nobody waits: the work goes on to its end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn stop(&self) -> bool {
        false
    }

    fn progress(&self, _: &Progress<'_>) {}
}
