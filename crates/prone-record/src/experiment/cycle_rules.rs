//! Rules of searches of cycles, and of what a cycle costs by them.

use serde::{Deserialize, Serialize};

use super::{GaitText, Limit};
use crate::frontier::Quantity;

/// Rules of a search of cycles; the usual one where there is none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CycleRulesChoice {
    /// Height below which everything stays, mm.
    pub ceiling_mm: Option<f64>,
    /// Least advance per cycle, mm.
    pub least_advance_mm: Option<f64>,
    /// Largest torque that the position error of a shoulder may ask for before any limit, N·m.
    pub demanded_shoulder_nm: Option<f64>,
    /// Largest share of the weight on trunk, head and legs, percent.
    pub body_share_percent: Option<f64>,
    /// Largest heat, s/m, or the share of that of another cycle.
    pub most_heat: Option<f64>,
    /// Largest mean force on the head over 20 ms, N.
    pub most_head_n: Option<f64>,
    /// Farthest from the line where the heading is held, mm.
    #[serde(default)]
    pub most_drift_mm: Option<f64>,
    /// Least speed, mm/s.
    #[serde(default)]
    pub least_speed_mm_s: Option<f64>,
    /// Largest duty: RMS torque of the worst motor over its nominal torque.
    #[serde(default)]
    pub most_duty: Option<f64>,
    /// What the motors of a robot have to be able to do.
    #[serde(default)]
    pub verdict: Option<LeastVerdict>,
}

/// For how long the motors of a robot have to be able to do what is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LeastVerdict {
    /// As long as the battery lasts.
    Continuous,
    /// For minutes.
    Limited,
}

impl CycleRulesChoice {
    /// Heights and advances, mm: from one that can be measured to one that is none.
    pub const LENGTHS_MM: (f64, f64) = (1.0, 1e4);

    /// Forces on the head, N: from what a simulation has by rounding to more than a robot weighs.
    pub const HEAD_N: (f64, f64) = (0.01, 1e4);

    /// Torques and heats.
    pub const EFFORTS: (f64, f64) = (0.01, 1e3);

    /// Checks that every rule that is asked for is one.
    pub fn check(&self) -> Result<(), Limit> {
        let (lengths, efforts) = (Self::LENGTHS_MM, Self::EFFORTS);
        let rules = [
            ("a ceiling", " mm", self.ceiling_mm, lengths),
            ("a least advance", " mm", self.least_advance_mm, lengths),
            (
                "a demanded torque",
                " N·m",
                self.demanded_shoulder_nm,
                efforts,
            ),
            (
                "a share of the weight",
                " %",
                self.body_share_percent,
                (0.0, 100.0),
            ),
            ("a heat", "", self.most_heat, efforts),
            ("a drift", " mm", self.most_drift_mm, lengths),
            ("a force on the head", " N", self.most_head_n, Self::HEAD_N),
            (
                "a least speed",
                " mm/s",
                self.least_speed_mm_s,
                Quantity::Speed.bounds(),
            ),
            ("a duty", "", self.most_duty, Quantity::Duty.bounds()),
        ];
        let asked = |(what, unit, value, bounds): (_, _, Option<f64>, _)| {
            value.map_or(Ok(()), |value| Limit::check(what, unit, value, bounds))
        };
        rules.into_iter().try_for_each(asked)
    }
}

/// A gait, and how it was called by whoever asked.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NamedGait {
    /// As it was called: a name or a path.
    pub called: String,
    /// Its file.
    pub gait: GaitText,
}
