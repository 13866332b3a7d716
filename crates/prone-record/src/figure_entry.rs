//! `figures.json`: what the drawings and pictures of a result folder show.
//!
//! A report shows those again that it cannot draw from tables, such as what the engine's camera saw.

use serde::{Deserialize, Serialize};

/// Name of the file.
pub const FIGURES_FILE: &str = "figures.json";

/// One drawing or picture.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FigureEntry {
    /// Path of its files in the folder, without extension.
    pub file: String,
    /// Number of its original in the thesis; empty where it has none.
    pub number: String,
    /// A few words.
    pub title: String,
    /// What is shown, in which unit, from which source.
    pub caption: String,
    /// Description for readers who do not see it.
    pub alt: String,
    /// Whether it is a picture: its SVG only wraps its PNG.
    pub picture: bool,
}
