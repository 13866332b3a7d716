//! Whoever waits for work: is told how it goes, and may end it.

use prone_record::search::Search;

/// Is told how work goes, from many threads, and may end it.
pub trait Watch: Sync {
    /// Whether to begin nothing further.
    fn stop(&self) -> bool;

    /// What has been done since the last call.
    fn progress(&self, progress: &Progress<'_>);
}

/// How work goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Progress<'a> {
    /// Simulations begin, so many in all.
    Simulating(usize),
    /// So many steps more are done: phases, rows of a map or pictures.
    Done(usize),
    /// An earlier run left so many steps, which are taken over.
    TakenOver(usize),
    /// A search has done one more generation, or begins.
    Searching(&'a Search),
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
