//! Torque maps as an experiment: building them, comparing two, drawing one.
//!
//! [`build`] asks a source at every node of a [`NodeGrid`] and keeps a journal, so that a build that
//! is killed goes on where it was. [`compare`] and [`plot`] read maps and compute no physics.

pub mod build;
pub mod compare;
mod entry;
mod grid;
mod job;
pub mod plot;

pub use entry::KeptRow;
pub use grid::{MOST_ROWS, NodeGrid, NodeGridError};
pub use job::{BuildError, Job};
