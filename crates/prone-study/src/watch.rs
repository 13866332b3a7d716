//! Looking on while an experiment runs, from many threads.

/// Is told how an experiment goes, and may stop it.
pub trait Watch: Sync {
    /// Whether to end before the next piece of work.
    fn stop(&self) -> bool;
}

/// Watches nothing and never stops.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unwatched;

impl Watch for Unwatched {
    fn stop(&self) -> bool {
        false
    }
}
