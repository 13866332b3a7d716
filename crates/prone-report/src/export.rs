//! A record in formats that other tools open.
//!
//! | module | format | read by |
//! |---|---|---|
//! | [`table`] | CSV, one line per joint and instant | data frames, plots |
//! | [`ros_log`] | MCAP with the messages of ROS 2 | Foxglove, Rerun, `PlotJuggler` |
//! | [`numpy`] | `.npz` | `NumPy` |
//! | [`urdf`] | the robot as URDF | ROS, physics engines |
//! | [`key_frames`] | one cycle as JSON | reinforcement learning |
//! | [`timeline`] | one cycle as a Choregraphe project | Choregraphe |
//!
//! The two of one cycle say how far the record's joints were behind it ([`lag`]).
//! Names carry their unit in every format that has room for it; docs/export.md lists them.

pub mod key_frames;
pub mod lag;
pub mod numpy;
pub mod ros_log;
pub mod table;
pub mod timeline;
pub mod urdf;
