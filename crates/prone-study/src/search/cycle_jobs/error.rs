//! Why cycles cannot be searched.

use prone_files::plain_name::GaitNameError;
use prone_record::experiment::{Limit, TextError};
use prone_record::frontier::Quantity;
use prone_sim::crawl::CrawlError;

use super::super::cycle_cost::CycleCostError;
use super::super::room::NoRoom;
use super::super::settings::SettingError;

/// Why cycles cannot be searched.
#[derive(Debug, thiserror::Error)]
pub enum CycleSearchError {
    /// A number that no search can have.
    #[error(transparent)]
    Limit(#[from] Limit),
    /// A name that is none of a file.
    #[error(transparent)]
    Name(#[from] GaitNameError),
    /// A cycle cannot be read.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A value stands twice in the list.
    #[error("{value} {} is there twice", held.unit())]
    Twice {
        /// What is held.
        held: Quantity,
        /// At which value, in its unit.
        value: f64,
    },
    /// A frontier is between two quantities.
    #[error("a frontier is between two quantities, not between {0} and {0}", quantity.name())]
    Same {
        /// The one that was given twice.
        quantity: Quantity,
    },
    /// The other cycle's heats would not be looked at.
    #[error("worst_over changes nothing of the objective peak without most_heat")]
    WorstOverUnused,
    /// The margin leaves nothing of a ceiling.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// No gait of the robot fits under a ceiling.
    #[error("{ceiling_mm} mm is too low for {robot}: {reason}")]
    TooLow {
        /// The ceiling, mm.
        ceiling_mm: f64,
        /// The robot's name.
        robot: String,
        /// What does not fit.
        reason: String,
    },
    /// Only corners look at how far a held heading comes off its line.
    #[error("most_drift_mm is looked at in corners, which an ideal search leaves out")]
    DriftUnused,
    /// Only the objectives of heat and peak look at heats with several servos.
    #[error("{what} goes with the objectives heat and peak only")]
    HeatUnused {
        /// `worst_over` or `most_heat`.
        what: &'static str,
    },
    /// [`crate::watch::Watch::stop`] said so.
    #[error("stopped")]
    Stopped,
    /// A setting cannot be made.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// Cycles have no costs.
    #[error(transparent)]
    Costs(#[from] CycleCostError),
    /// The cycle that heats are compared with cannot be crawled.
    #[error("{gait}: {source}")]
    WorstOver {
        /// As it was called.
        gait: String,
        /// Why.
        source: CrawlError,
    },
    /// No cycle to begin with.
    #[error(
        "there is no cycle that {robot} can crawl to begin with{}",
        listed(refused)
    )]
    NoCycle {
        /// The robot's name.
        robot: String,
        /// Names of the cycles that were tried, and why they cannot be crawled.
        refused: Vec<(String, CrawlError)>,
    },
}

/// One line a cycle.
fn listed(refused: &[(String, CrawlError)]) -> String {
    let lines = refused.iter();
    let lines: Vec<String> = lines
        .map(|(cycle, error)| format!("\n  {cycle}: {error}"))
        .collect();
    lines.concat()
}
