//! The published study of 2015, done again: its numbers, how ours agree with them, its experiments
//! as one command, and its chapter of the report.
//!
//! [`torque_study`] simulates pulls, [`table_crawl`] the crawl under the table; [`reproduce`] puts
//! both together as the files of one result folder. [`chapter::Thesis`] is the publication that a
//! report is held against.

pub mod agreement;
pub mod chapter;
mod prose;
pub mod published;
mod report;
pub mod reproduce;
pub mod robot_numbers;
mod run_info;
pub mod squeeze;
pub mod summary;
pub mod table_crawl;
mod tables;
pub mod torque_study;
