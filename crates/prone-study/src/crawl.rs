//! A crawl of whole cycles: its figures, tables and pictures, and the files of its record folder.
//!
//! [`summary`] reduces a record to figures, [`record`] makes every file of a record folder. Both
//! read what [`prone_sim::crawl`] measured.

pub(crate) mod frames;
pub mod joints;
mod model;
pub(crate) mod pull;
pub mod record;
mod run;
pub mod summary;
mod tables;

pub use run::{Conditions, GaitSource, PastObstacles};
pub use summary::CrawlSummary;

use prone::scene::Obstacle;

/// What an obstacle is called in records: its kind and which of them it is, from 1.
pub fn obstacle_name(obstacles: &[Obstacle], index: usize) -> String {
    let kind = obstacles[index].kind;
    let before = obstacles[..index].iter();
    let number = before.filter(|other| other.kind == kind).count() + 1;
    format!("{} {number}", kind.name())
}
