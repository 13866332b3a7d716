//! Experiments with crawl gaits: from simulated runs to records, tables, figures and a report.
//!
//! [`torque_study`] simulates; everything after it reads records and computes no physics.
//! [`reproduce`] puts the published study together as the files of one result folder.

pub mod agreement;
pub mod contact_story;
pub mod crawl;
pub mod curves_info;
pub mod cycle_search;
pub mod export;
pub mod figure_list;
pub mod figures;
pub mod frames;
pub mod gait_sheet;
mod markup;
pub mod optimize;
pub mod output;
mod page_head;
pub mod published;
pub mod record;
pub mod recorded;
pub mod report;
pub mod reproduce;
pub mod robot_sheet;
pub mod run_info;
pub mod summary;
pub mod table_crawl;
pub mod tables;
pub mod torque_map;
pub mod torque_study;
pub mod view;
