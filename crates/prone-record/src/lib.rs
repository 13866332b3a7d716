//! Records: what an experiment leaves behind, as types and as files. No physics engine is linked here.
//!
//! [`experiment`] is what is asked for. [`resumption`] keeps unfinished work, under a [`lock`];
//! [`output`] puts result folders in place whole or not at all; [`recorded`] reads the record of a
//! crawl or a pull, whoever made it. The other modules hold what results say.

pub mod broken_table;
pub mod contact_story;
pub mod crawl_outcome;
pub mod crawl_summary;
pub mod crawl_tables;
pub mod curves_info;
pub mod cycle_cost;
pub mod experiment;
pub mod figure_entry;
pub mod frontier;
pub mod gait_search;
pub mod head;
pub mod leftovers;
pub mod lock;
pub mod measure;
pub mod origin;
pub mod output;
pub mod program;
pub mod pulls;
pub mod real_path;
pub mod record_columns;
pub mod record_info;
pub mod recorded;
pub mod resumption;
pub mod search;
pub mod search_plan;
pub mod search_result;
pub mod single_file;
pub mod statistics;
pub mod tables;
pub mod unique_json;
