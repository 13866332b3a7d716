//! The text formats of prone: `robot.toml`, `family.toml`, gait files, scene files and compiled
//! robots.
//!
//! At this border names carry units (`span_mm`, `constant_deg`) and numbers are converted once;
//! behind it everything is SI and radians. Every error names file, line and column. What ships
//! with the program is embedded ([`shipped`]).

pub mod compiled_robot;
mod curve_table;
pub mod cycle_file;
pub mod defaults;
mod error;
mod exactly;
mod family_file;
pub mod gait_file;
pub mod gait_text;
pub mod gaits;
pub mod model_file;
pub mod names;
mod odd_toml;
pub mod part_name;
pub mod plain_name;
pub mod robot_file;
pub mod robot_folder;
pub mod scene_file;
pub mod shipped;
pub mod text_file;

pub use error::FileError;
