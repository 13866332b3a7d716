//! A crawl of whole cycles: its figures, tables and pictures, and the files of its record folder.
//!
//! [`summary`] reduces a record to figures, [`record`] makes every file of a record folder. Both
//! read what [`prone_sim::crawl`] measured.

pub mod frames;
mod model;
pub mod pull;
pub mod record;
mod run;
mod setup;
pub mod summary;

pub use run::{GaitSource, PastObstacles};
pub use setup::{CrawlRunError, CrawlSetup, CrawlSetupError, RefusedCycle};
