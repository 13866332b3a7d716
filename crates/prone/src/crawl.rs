//! Crawling: the state machine that turns what is felt into what is commanded.
//!
//! ```text
//! lying ──way──> extension ──rest──> [ phase, phase, … ] ──> [ phase, … ] ──> … ──> done
//! ```
//!
//! A [`Crawler`] is told what a robot feels ([`crate::port::Senses`]) and answers with what its
//! joints are to do ([`crate::port::JointCommand`]). It knows no robot but by its model, no engine
//! and no clock but the senses' own, so that a simulation, a robot and a test drive it alike, and
//! whatever the robot does next goes on from where the crawl has left it. [`drive`] is the loop
//! around a crawler and a port.
//!
//! A cycle is a sequence of phases ([`PhaseKind`]), of which the pull by the closed chain is one
//! kind. Once in a cycle a [`Pilot`] says which cycle comes next and how it turns: at the end of the
//! pull, so that the way back leads to the next one's first posture, or, without a pull, when the cycle
//! begins.

mod course;
mod crawler;
mod drive;
mod error;
mod felt;
mod pilot;
mod program;
mod slope;
mod timing;
mod way;

pub use course::PhaseKind;
pub use crawler::Crawler;
pub use drive::{DriveError, Watch, drive};
pub use error::CrawlerError;
pub use felt::FeltError;
pub use pilot::{Decision, Moment, Pilot, PilotError, Stage, Straight};
pub use program::{Begin, Ended, Event, Halt, Program};
pub use slope::SlopeAware;
pub use timing::{Delivery, Timing, TimingError};

#[cfg(test)]
mod tests;
