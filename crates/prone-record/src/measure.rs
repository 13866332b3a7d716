//! What a search of cycles is for, and how the value of a search is read: in its own unit, with its own
//! sign.
//!
//! Searches minimise, so that what is to be large is negative in them, and is in SI units. People read
//! `104.8 mm/s`.

use serde::{Deserialize, Serialize};

use crate::gait_search::Broken;

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
    /// ∫ Σ (τ / nominal torque)² dt per second.
    #[serde(rename = "heat-rate")]
    HeatRate,
    /// Largest torque that the position error of a shoulder asks for before any limit, with the
    /// robot's own stiffness, N·m.
    Peak,
    /// Duty: RMS torque of the worst motor over its nominal torque.
    Duty,
    /// Highest point of the robot, m.
    Height,
}

impl CycleObjective {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::Heat,
        Self::HeatRate,
        Self::Advance,
        Self::Speed,
        Self::Peak,
        Self::Duty,
        Self::Height,
    ];

    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Heat => "heat",
            Self::HeatRate => "heat-rate",
            Self::Advance => "advance",
            Self::Speed => "speed",
            Self::Peak => "peak",
            Self::Duty => "duty",
            Self::Height => "height",
        }
    }
}

/// What a searched value is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Measure {
    /// What it is called.
    pub what: &'static str,
    /// Its unit; `–` where it has none.
    pub unit: &'static str,
    /// One searched unit in that unit; negative where more is better.
    factor: f64,
    decimals: usize,
    /// Whether the unit alone does not tell what it is.
    named: bool,
}

impl Measure {
    /// Of a search of cycles; of heats that are held against those of another cycle where `over` is.
    pub const fn of_cycles(objective: CycleObjective, over: Heats) -> Self {
        let (what, unit, factor, decimals, named) = match (objective, over) {
            (CycleObjective::Heat, Heats::OverAnother) => {
                ("heat over another cycle's", "–", 1.0, 4, true)
            }
            (CycleObjective::Heat, Heats::PerMetre) => ("heat", "s/m", 1.0, 1, true),
            (CycleObjective::HeatRate, _) => ("heat per second", "–", 1.0, 2, true),
            (CycleObjective::Advance, _) => ("advance", "mm per cycle", -1e3, 1, false),
            (CycleObjective::Speed, _) => ("speed", "mm/s", -1e3, 1, false),
            (CycleObjective::Peak, _) => ("demanded of a shoulder", "N·m", 1.0, 2, true),
            (CycleObjective::Duty, _) => ("duty of the worst motor", "of nominal", 1.0, 3, true),
            (CycleObjective::Height, _) => ("height", "mm", 1e3, 1, true),
        };
        Self {
            what,
            unit,
            factor,
            decimals,
            named,
        }
    }

    /// Of a search of pulls: the torque part, in the unit of its objective.
    pub const fn of_pulls(unit: &'static str) -> Self {
        Self {
            what: "torque part",
            unit,
            factor: 1.0,
            decimals: 4,
            named: true,
        }
    }

    /// A searched value in the unit that is read.
    pub fn read(&self, value: f64) -> f64 {
        // No minus in front of a zero.
        value * self.factor + 0.0
    }

    /// A searched value as it is printed, such as `104.8 mm/s` or `heat 35.1 s/m`.
    pub fn sentence(&self, value: f64) -> String {
        let number = self.number(value);
        let unit = match self.unit {
            "–" => String::new(),
            unit => format!(" {unit}"),
        };
        if self.named {
            format!("{} {number}{unit}", self.what)
        } else {
            format!("{number}{unit}")
        }
    }

    /// A searched value in the unit that is read, without the unit.
    pub fn number(&self, value: f64) -> String {
        format!("{:.*}", self.decimals, self.read(value))
    }
}

/// What the heat of a search of cycles is.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Heats {
    /// s/m.
    #[default]
    PerMetre,
    /// Shares of the heats of another cycle.
    OverAnother,
}

/// By how much rules are broken, and which: `breaks rules by 0.18 (ceiling, head)`; nothing where none
/// is.
pub fn broken_sentence(violation: f64, broken: &[Broken]) -> Option<String> {
    if violation <= 0.0 {
        return None;
    }
    // What is broken by less than a hundredth is not printed as nothing.
    let amount = if violation < 0.01 {
        format!("{violation:.1e}")
    } else {
        format!("{violation:.2}")
    };
    let rules: Vec<&str> = broken.iter().map(|it| &*it.rule).collect();
    Some(match rules[..] {
        [] => format!("breaks rules by {amount}"),
        _ => format!("breaks rules by {amount} ({})", rules.join(", ")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_read_in_its_own_unit_and_sign() {
        let read =
            |objective, value| Measure::of_cycles(objective, Heats::PerMetre).sentence(value);
        assert_eq!(read(CycleObjective::Speed, -0.1048), "104.8 mm/s");
        assert_eq!(read(CycleObjective::Advance, -0.138), "138.0 mm per cycle");
        assert_eq!(read(CycleObjective::Advance, 0.0), "0.0 mm per cycle");
        assert_eq!(read(CycleObjective::Heat, 35.06), "heat 35.1 s/m");
        assert_eq!(read(CycleObjective::Height, 0.1651), "height 165.1 mm");
        let over = Measure::of_cycles(CycleObjective::Heat, Heats::OverAnother);
        assert_eq!(over.sentence(0.61), "heat over another cycle's 0.6100");
        let pulls = Measure::of_pulls("N²·m²·s");
        assert_eq!(pulls.sentence(3.4392), "torque part 3.4392 N²·m²·s");
    }

    #[test]
    fn what_is_broken_is_named() {
        let broken = |rule: &'static str| Broken {
            rule: rule.into(),
            count: 1,
            sum: 0.09,
        };
        assert_eq!(broken_sentence(0.0, &[]), None);
        let said = broken_sentence(0.18, &[broken("ceiling"), broken("head")]);
        assert_eq!(
            said.as_deref(),
            Some("breaks rules by 0.18 (ceiling, head)")
        );
        assert_eq!(
            broken_sentence(0.0004, &[]).as_deref(),
            Some("breaks rules by 4.0e-4")
        );
    }
}
