//! The text formats of prone: `robot.toml`, gait files and scene files.
//!
//! At this border names carry units (`span_mm`, `constant_deg`) and numbers are converted once;
//! behind it everything is SI and radians. Every error names file, line and column. What ships
//! with the program is embedded ([`shipped`]).

mod curve_table;
pub mod cycle_file;
mod error;
mod exactly;
pub mod gait_file;
pub mod robot_file;
pub mod scene_file;
pub mod shipped;
pub mod text_file;

pub use error::FileError;
