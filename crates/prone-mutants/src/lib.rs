//! Mutants of every file that prone reads, and what has to hold of each of them.
//!
//! [`mutant`] makes a text of seeds and a number: the same number gives the same text, so that a
//! failure is named by its format and its number. `reading` hands a text to the readers within this
//! process, `program` runs the program on it as a child with limits, and `campaign` does either for
//! many. What has to hold is said in docs/fuzzing.md.

mod chance;
mod format;
mod mutants;

#[cfg(feature = "readers")]
pub mod campaign;
#[cfg(feature = "readers")]
pub mod commands;
#[cfg(feature = "readers")]
pub mod program;
#[cfg(feature = "readers")]
pub mod reading;
#[cfg(feature = "readers")]
mod sane;
#[cfg(feature = "readers")]
pub mod seeds;

pub use format::{Format, Syntax};
pub use mutants::mutant;
