//! Experiments with crawl gaits: what simulates and what searches, from a robot to a record.
//!
//! [`run`] is the entry: it runs an experiment of any kind. [`crawl`] and [`pulls`] turn what was simulated into records, [`search`]
//! searches, [`torque_map`] measures maps, [`export`] takes films; [`watch`] is how whoever waits for
//! them is told.

pub mod catalogue;
pub mod crawl;
pub mod export;
pub mod frames;
pub mod gait_sheet;
pub mod pulls;
pub mod robot_sheet;
pub mod run;
pub mod search;
pub mod torque_map;
pub mod watch;
