//! What a frontier leaves behind: `result.json`, `frontier.csv`, `history.csv`.

mod setting_kind;

pub use setting_kind::{SettingKind, UnknownSetting};

use serde::{Deserialize, Serialize};

use crate::gait_search::Broken;
use crate::search::Search;
use crate::tables::{finish, number};

/// What is minimised.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CycleObjective {
    /// ∫ Σ (τ / nominal torque)² dt per metre, s/m.
    Heat,
    /// Minus the advance per cycle, m.
    Advance,
    /// Minus the speed, m/s.
    Speed,
    /// Largest torque that a shoulder's servo demands, with the robot's own servo gains, N·m.
    Peak,
}

impl CycleObjective {
    /// All objectives.
    pub const ALL: [Self; 4] = [Self::Heat, Self::Advance, Self::Speed, Self::Peak];

    /// The objective of a name in files and records, `None` for any other name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL
            .into_iter()
            .find(|objective| objective.name() == name)
    }

    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Heat => "heat",
            Self::Advance => "advance",
            Self::Speed => "speed",
            Self::Peak => "peak",
        }
    }
}

/// All searches of a frontier.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Frontier {
    /// What was searched.
    pub objective: CycleObjective,
    /// Distance kept from the ceiling, mm.
    pub margin_mm: f64,
    /// By ceiling and seed.
    pub found: Vec<Found>,
    /// Other cycles in the same settings, for comparison.
    pub compared: Vec<Compared>,
}

/// Another cycle in the settings of a confirmation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Compared {
    /// Its name.
    pub gait: String,
    /// What it does.
    pub confirmed: Confirmed,
}

/// What one search found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Found {
    /// The ceiling, mm, where there is one.
    pub ceiling_mm: Option<f64>,
    /// The seed.
    pub seed: u64,
    /// Evaluations.
    pub evaluations: u64,
    /// Name of the cycle.
    pub gait: String,
    /// The objective, as searched: minus metres per cycle, or s/m.
    pub value: Option<f64>,
    /// What it breaks of the rules of the search, in shares of their limits.
    pub violation: f64,
    /// The rules that are broken.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub broken: Vec<Broken>,
    /// Why it could not be crawled in the settings of the search, where it could not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub refused: Option<String>,
    /// Why the found cycle has lost the steering of the one that it was searched about, where it has.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unsteered: Option<String>,
    /// What it does in other settings.
    pub confirmed: Confirmed,
}

impl Found {
    /// What it does, for the head of its file.
    pub fn sentence(&self) -> String {
        let settings = self.confirmed.settings.iter().map(|row| match row {
            ConfirmedSetting {
                setting,
                mm_per_cycle: Some(advance),
                top_mm: Some(top),
                demanded_shoulder_nm: Some(shoulder),
                ..
            } => format!(
                "{setting}: {advance:.1} mm per cycle, {top:.1} mm high, {shoulder:.2} N·m asked of a shoulder."
            ),
            row => format!(
                "{}: {}.",
                row.setting,
                row.refused.as_deref().unwrap_or("not known")
            ),
        });
        settings.collect::<Vec<_>>().join("\n")
    }
}

/// What a confirmation says of a cycle under a ceiling.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Confirmed {
    /// Whether everything that was asked holds.
    pub holds: bool,
    /// What was found in each setting.
    pub settings: Vec<ConfirmedSetting>,
}

/// A cycle in one setting.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConfirmedSetting {
    /// What the setting changes.
    pub setting: SettingKind,
    /// Advance per cycle, mm; `None` where it cannot be crawled, with the reason below.
    pub mm_per_cycle: Option<f64>,
    /// Speed, mm/s.
    pub mm_per_s: Option<f64>,
    /// Change of heading per cycle, degrees, positive to the left.
    pub yaw_deg: Option<f64>,
    /// Highest point, mm.
    pub top_mm: Option<f64>,
    /// Part of the body that reaches it.
    pub top_part: Option<String>,
    /// Heat per metre, s/m.
    pub heat_per_metre_s: Option<f64>,
    /// Largest actuator torque over the manufacturer's effort limit.
    pub peak_torque_over_rated: Option<f64>,
    /// Joint in which `peak_torque_over_rated` was reached.
    pub peak_joint: Option<String>,
    /// Largest torque that a shoulder's servo demands, before the effort limit, N·m.
    pub demanded_shoulder_nm: Option<f64>,
    /// Advance over the first setting's.
    pub kept: Option<f64>,
    /// Why it cannot be crawled.
    pub refused: Option<String>,
}

impl ConfirmedSetting {
    /// A setting of which nothing is known.
    pub const fn unknown(setting: SettingKind) -> Self {
        Self {
            setting,
            mm_per_cycle: None,
            mm_per_s: None,
            yaw_deg: None,
            top_mm: None,
            top_part: None,
            heat_per_metre_s: None,
            peak_torque_over_rated: None,
            peak_joint: None,
            demanded_shoulder_nm: None,
            kept: None,
            refused: None,
        }
    }
}

/// `frontier.csv`: one row per ceiling, seed and setting.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn csv(frontier: &Frontier) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "ceiling_mm",
        "seed",
        "setting",
        "mm_per_cycle",
        "mm_per_s",
        "yaw_deg",
        "top_mm",
        "top_part",
        "heat_per_metre_s",
        "peak_torque_over_rated",
        "peak_joint",
        "demanded_shoulder_nm",
        "kept",
        "refused",
    ])?;
    let maybe = |value: Option<f64>, decimals| {
        value.map_or_else(String::new, |value| number(value, decimals))
    };
    for found in &frontier.found {
        for row in &found.confirmed.settings {
            table.write_record([
                maybe(found.ceiling_mm, 1),
                found.seed.to_string(),
                row.setting.to_string(),
                maybe(row.mm_per_cycle, 3),
                maybe(row.mm_per_s, 3),
                maybe(row.yaw_deg, 3),
                maybe(row.top_mm, 3),
                row.top_part.clone().unwrap_or_default(),
                maybe(row.heat_per_metre_s, 4),
                maybe(row.peak_torque_over_rated, 4),
                row.peak_joint.clone().unwrap_or_default(),
                maybe(row.demanded_shoulder_nm, 4),
                maybe(row.kept, 4),
                row.refused.clone().unwrap_or_default(),
            ])?;
        }
    }
    finish(table)
}

/// `history.csv`: one row per generation of each search, in the order of ceilings.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn history_csv(
    ceilings_mm: &[Option<f64>],
    searches: &[Search],
) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "ceiling_mm",
        "seed",
        "generation",
        "evaluations",
        "best_violation",
        "best_value",
        "mean_violation",
        "feasible",
    ])?;
    for (ceiling, search) in ceilings_mm.iter().zip(searches) {
        for run in search.runs() {
            for row in &run.history.0 {
                table.write_record([
                    ceiling.map_or_else(String::new, |ceiling| number(ceiling, 1)),
                    run.seed.to_string(),
                    row.generation.to_string(),
                    row.evaluations.to_string(),
                    number(row.best.violation(), 6),
                    number(row.best.value(), 6),
                    number(row.mean_violation, 6),
                    row.feasible.to_string(),
                ])?;
            }
        }
    }
    finish(table)
}
