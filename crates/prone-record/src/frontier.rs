//! What a frontier leaves behind: `result.json`, `frontier.csv`, `history.csv`.

mod quantity;
mod setting_kind;

pub use quantity::Quantity;
pub use setting_kind::SettingKind;

pub use crate::measure::CycleObjective;

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

use crate::gait_search::Broken;
use crate::measure::{Heats, Measure};
use crate::search::Search;
use crate::tables::{columns, maybe, number};

/// All searches of a frontier.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Frontier {
    /// What was searched.
    pub objective: CycleObjective,
    /// Unit of [`Found::reached`].
    #[serde(default)]
    pub unit: String,
    /// What a heat is in it.
    #[serde(default)]
    pub heats: Heats,
    /// What is held, at the values of [`Found::at`].
    #[serde(default)]
    pub held: Quantity,
    /// Distance kept from the ceiling, mm.
    pub margin_mm: f64,
    /// Whether every search came to its own end, or the time was over.
    #[serde(default = "complete")]
    pub complete: bool,
    /// By what is held and seed.
    pub found: Vec<Found>,
    /// Other cycles in the same settings, for comparison.
    pub compared: Vec<Compared>,
}

/// Searches of cycles had no time budget once.
const fn complete() -> bool {
    true
}

impl Frontier {
    /// How the values of its searches are read.
    pub fn measure(&self) -> Measure {
        Measure::of_cycles(self.objective, self.heats)
    }

    /// The best of what was found: what breaks less, then what is worth more.
    pub fn best(&self) -> Option<&Found> {
        self.found.iter().min_by(|a, b| a.order(b))
    }

    /// The best of what was found at a value of what is held.
    pub fn best_at(&self, at: Option<f64>) -> Option<&Found> {
        let same = |other: Option<f64>| match other.zip(at) {
            Some((a, b)) => a.total_cmp(&b).is_eq(),
            None => other.is_none() && at.is_none(),
        };
        let own = self.found.iter().filter(|found| same(found.at));
        own.min_by(|a, b| a.order(b))
    }
}

/// How far a point of a frontier can be counted on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// It holds in the settings of the confirmation.
    Robust,
    /// It keeps the rules in the settings of the search, and does not hold in those of the
    /// confirmation.
    Ideal,
    /// It breaks rules of the search.
    Broken,
}

impl Standing {
    /// Name in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Robust => "robust",
            Self::Ideal => "ideal",
            Self::Broken => "broken",
        }
    }
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
    /// Where the held quantity is held, in its unit, where it is.
    #[serde(alias = "ceiling_mm")]
    pub at: Option<f64>,
    /// The seed.
    pub seed: u64,
    /// Evaluations.
    pub evaluations: u64,
    /// Name of the cycle.
    pub gait: String,
    /// The objective, as searched: what is minimised.
    pub value: Option<f64>,
    /// The same as it is read, in the unit of the frontier.
    #[serde(default)]
    pub reached: Option<f64>,
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
    /// What breaks less comes first, then what is worth more.
    fn order(&self, other: &Self) -> Ordering {
        let value = |found: &Self| found.value.unwrap_or(f64::INFINITY);
        let broken = self.violation.total_cmp(&other.violation);
        broken.then(value(self).total_cmp(&value(other)))
    }

    /// How far it can be counted on, as a point at which a quantity is held. A confirmation judges the
    /// ceiling itself; what else is held is a rule of the search.
    pub fn standing(&self, held: Quantity) -> Standing {
        let mut broken = self.broken.iter();
        let off = held != Quantity::Ceiling && broken.any(|it| it.rule == held.name());
        if self.confirmed.holds && !off {
            Standing::Robust
        } else if self.violation > 0.0 {
            Standing::Broken
        } else {
            Standing::Ideal
        }
    }

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
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
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
    /// Duty: RMS torque of the worst motor over what its gear passes on of the nominal torque.
    #[serde(default)]
    pub duty: Option<f64>,
    /// Joint that the worst motor is named after.
    #[serde(default)]
    pub duty_joint: Option<String>,
    /// Largest applied torque over the manufacturer's effort limit.
    pub peak_torque_over_rated: Option<f64>,
    /// Joint in which `peak_torque_over_rated` was reached.
    pub peak_joint: Option<String>,
    /// Largest torque that a shoulder's servo demands, before the effort limit, N·m.
    pub demanded_shoulder_nm: Option<f64>,
    /// Largest mean force on the head over 20 ms, N.
    pub head_n: Option<f64>,
    /// Advance over the first setting's.
    pub kept: Option<f64>,
    /// Why it cannot be crawled.
    pub refused: Option<String>,
}

/// `frontier.csv`: one row per value that is held, seed and setting.
pub fn csv<'f>(frontier: &'f Frontier) -> Result<Vec<u8>, csv::Error> {
    let decimals = frontier.held.decimals();
    let settings = |found: &'f Found| {
        let settings = found.confirmed.settings.iter();
        settings.map(move |setting| (found, setting))
    };
    columns(
        frontier.found.iter().flat_map(settings),
        [
            (frontier.held.column(), &|(found, _)| {
                maybe(found.at, decimals)
            }),
            ("seed", &|(found, _)| found.seed.to_string()),
            ("standing", &|(found, _)| {
                found.standing(frontier.held).name().to_owned()
            }),
            ("setting", &|(_, it)| it.setting.to_string()),
            ("mm_per_cycle", &|(_, it)| maybe(it.mm_per_cycle, 3)),
            ("mm_per_s", &|(_, it)| maybe(it.mm_per_s, 3)),
            ("yaw_deg", &|(_, it)| maybe(it.yaw_deg, 3)),
            ("top_mm", &|(_, it)| maybe(it.top_mm, 3)),
            ("top_part", &|(_, it)| {
                it.top_part.clone().unwrap_or_default()
            }),
            ("heat_per_metre_s", &|(_, it)| maybe(it.heat_per_metre_s, 4)),
            ("duty", &|(_, it)| maybe(it.duty, 4)),
            ("duty_joint", &|(_, it)| {
                it.duty_joint.clone().unwrap_or_default()
            }),
            ("peak_torque_over_rated", &|(_, it)| {
                maybe(it.peak_torque_over_rated, 4)
            }),
            ("peak_joint", &|(_, it)| {
                it.peak_joint.clone().unwrap_or_default()
            }),
            ("demanded_shoulder_nm", &|(_, it)| {
                maybe(it.demanded_shoulder_nm, 4)
            }),
            ("head_n", &|(_, it)| maybe(it.head_n, 3)),
            ("kept", &|(_, it)| maybe(it.kept, 4)),
            ("refused", &|(_, it)| it.refused.clone().unwrap_or_default()),
        ],
    )
}

/// `history.csv`: one row per generation of each search, in the order of the values at which a quantity
/// is held. `best_value` is as searched, `best_reached` in the unit beside it.
pub fn history_csv<'s>(
    held: (Quantity, &'s [Option<f64>]),
    measure: Measure,
    searches: &'s [Search],
) -> Result<Vec<u8>, csv::Error> {
    let (held, values) = held;
    let runs = |(&ceiling, search): (&'s Option<f64>, &'s Search)| {
        let runs = search.runs().iter();
        let generations = runs.flat_map(|run| run.history.0.iter().map(move |it| (run.seed, it)));
        generations.map(move |(seed, it)| (ceiling, seed, it))
    };
    columns(
        values.iter().zip(searches).flat_map(runs),
        [
            (held.column(), &|(at, _, _)| maybe(*at, held.decimals())),
            ("seed", &|(_, seed, _)| seed.to_string()),
            ("generation", &|(_, _, it)| it.generation.to_string()),
            ("evaluations", &|(_, _, it)| it.evaluations.to_string()),
            ("best_violation", &|(_, _, it)| {
                number(it.best.violation(), 6)
            }),
            ("best_value", &|(_, _, it)| number(it.best.value(), 6)),
            ("mean_violation", &|(_, _, it)| number(it.mean_violation, 6)),
            ("feasible", &|(_, _, it)| it.feasible.to_string()),
            ("best_reached", &|(_, _, it)| {
                number(measure.read(it.best.value()), 4)
            }),
            ("unit", &|_| measure.unit.to_owned()),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(violation: f64, rule: &'static str, holds: bool) -> Found {
        let broken = Broken {
            rule: rule.into(),
            count: 1,
            sum: violation,
        };
        Found {
            at: Some(40.0),
            seed: 1,
            evaluations: 16,
            gait: "speed-40-seed-1".to_owned(),
            value: Some(35.0),
            reached: Some(35.0),
            violation,
            broken: Some(broken)
                .filter(|_| violation > 0.0)
                .into_iter()
                .collect(),
            refused: None,
            unsteered: None,
            confirmed: Confirmed {
                holds,
                settings: Vec::new(),
            },
        }
    }

    #[test]
    fn a_point_that_is_not_where_it_is_held_is_not_robust() {
        let standing = |violation, rule, holds, held| found(violation, rule, holds).standing(held);
        let speed = Quantity::Speed;
        assert_eq!(standing(0.0, "speed", true, speed), Standing::Robust);
        assert_eq!(standing(0.0, "speed", false, speed), Standing::Ideal);
        assert_eq!(standing(0.1, "speed", true, speed), Standing::Broken);
        assert_eq!(standing(0.1, "head", true, speed), Standing::Robust);
        // A confirmation judges the ceiling itself; a search has a margin below it.
        let ceiling = Quantity::Ceiling;
        assert_eq!(standing(0.1, "ceiling", true, ceiling), Standing::Robust);
        assert_eq!(standing(0.1, "ceiling", false, ceiling), Standing::Broken);
    }

    /// What an earlier release wrote, which held nothing but ceilings.
    #[test]
    fn a_frontier_of_ceilings_is_read() {
        let written = serde_json::json!({
            "objective": "advance", "margin_mm": 1.0, "compared": [],
            "found": [{
                "ceiling_mm": 165.0, "seed": 1, "evaluations": 16, "gait": "under-165-seed-1",
                "value": -0.1, "violation": 0.0, "confirmed": { "holds": true, "settings": [] },
            }],
        });
        let read: Frontier = serde_json::from_value(written).unwrap();
        assert_eq!((read.held, read.complete), (Quantity::Ceiling, true));
        assert_eq!(read.best_at(Some(165.0)).unwrap().at, Some(165.0));
        assert!(read.best_at(None).is_none() && read.best_at(Some(1.0)).is_none());
        assert_eq!(read.measure().sentence(-0.1), "100.0 mm per cycle");
    }

    #[test]
    fn tables_name_what_is_held() {
        let frontier = Frontier {
            objective: CycleObjective::Heat,
            unit: "s/m".to_owned(),
            heats: Heats::PerMetre,
            held: Quantity::Speed,
            margin_mm: 1.0,
            complete: true,
            found: vec![Found {
                confirmed: Confirmed {
                    holds: true,
                    settings: vec![ConfirmedSetting::default()],
                },
                ..found(0.0, "", true)
            }],
            compared: Vec::new(),
        };
        let table = String::from_utf8(csv(&frontier).unwrap()).unwrap();
        let head = "least_speed_mm_s,seed,standing,setting,";
        assert!(table.starts_with(head), "{table}");
        assert!(table.contains("\n40.000,1,robust,as it is,"), "{table}");
    }
}
