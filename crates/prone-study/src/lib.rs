//! Experiments with crawl gaits: what simulates and what searches, from a robot to a record.
//!
//! [`crawl`] and [`pulls`] turn what was simulated into records, [`optimize`] and [`cycle_search`]
//! search, [`torque_map`] measures maps, [`export`] takes films.

pub mod crawl;
pub mod cycle_search;
pub mod export;
pub mod frames;
pub mod gait_sheet;
pub mod optimize;
pub mod pulls;
pub mod robot_sheet;
pub mod run;
pub mod torque_map;
pub mod watch;
