//! What one cycle costs, as a search of cycles would cost it: the output of `prone cost` of a cycle.

use serde::Serialize;

use crate::frontier::{ConfirmedSetting, CycleObjective};
use crate::gait_search::Broken;

/// The cost of a cycle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CycleCost {
    /// The cycle.
    pub gait: String,
    /// What is minimised.
    pub objective: CycleObjective,
    /// Its value as it is read, in [`Self::unit`]; unknown where it cannot be crawled.
    pub value: Option<f64>,
    /// Unit of the value.
    pub unit: &'static str,
    /// The value with its unit, as it is printed.
    #[serde(skip)]
    pub sentence: Option<String>,
    /// What is broken in all, in shares of limits.
    pub violations: f64,
    /// The rules that are broken.
    pub broken: Vec<Broken>,
    /// Why it could not be crawled, where it could not.
    pub refused: Option<String>,
    /// What it comes to in each setting of a search, and what it breaks there.
    pub settings: Vec<SettingCost>,
}

/// A cycle in one setting of a search.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SettingCost {
    /// What it does.
    #[serde(flatten)]
    pub row: ConfirmedSetting,
    /// The rules that it breaks there.
    pub broken: Vec<Broken>,
}
