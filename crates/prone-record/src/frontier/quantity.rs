//! What a frontier is drawn between: a quantity that is held at given values, and one that is searched.

use serde::{Deserialize, Serialize};

use super::{ConfirmedSetting, CycleObjective};

/// A quantity of a crawl, in the unit that people read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Quantity {
    /// Height of the ceiling, mm; searched, the highest point of the robot.
    #[default]
    Ceiling,
    /// Advance per cycle, mm.
    Advance,
    /// Speed, mm/s.
    Speed,
    /// Heat per metre, s/m.
    Heat,
    /// Duty: RMS torque of the worst motor over its nominal torque.
    Duty,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Ceiling,
        Self::Advance,
        Self::Speed,
        Self::Heat,
        Self::Duty,
    ];

    /// Name in files, records and options, and of the rule that holds it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ceiling => "ceiling",
            Self::Advance => "advance",
            Self::Speed => "speed",
            Self::Heat => "heat",
            Self::Duty => "duty",
        }
    }

    /// Its unit, after a number.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Ceiling => "mm",
            Self::Advance => "mm per cycle",
            Self::Speed => "mm/s",
            Self::Heat => "s/m",
            Self::Duty => "of nominal",
        }
    }

    /// How it is held at a value, such as `under 165 mm` or `with at least 40 mm/s`.
    pub fn held_at(self, value: f64) -> String {
        let unit = self.unit();
        match self {
            Self::Ceiling => format!("under {value} {unit}"),
            Self::Advance | Self::Speed => format!("with at least {value} {unit}"),
            Self::Heat | Self::Duty => format!("with at most {value} {unit}"),
        }
    }

    /// Beginning of the names of cycles that are found where it is held at a value, such as
    /// `under-165` or `speed-40`.
    pub fn stem(self, value: f64) -> String {
        let word = if self == Self::Ceiling {
            "under"
        } else {
            self.name()
        };
        format!("{word}-{}", value.to_string().replace('.', "-"))
    }

    /// Column in which a table has the values at which it is held.
    pub const fn column(self) -> &'static str {
        match self {
            Self::Ceiling => "ceiling_mm",
            Self::Advance => "least_advance_mm",
            Self::Speed => "least_speed_mm_s",
            Self::Heat => "most_heat_s_m",
            Self::Duty => "most_duty",
        }
    }

    /// Decimals of that column.
    pub const fn decimals(self) -> usize {
        match self {
            Self::Ceiling | Self::Advance => 1,
            Self::Speed | Self::Heat | Self::Duty => 3,
        }
    }

    /// Axis on which it is held.
    pub const fn held_axis(self) -> &'static str {
        match self {
            Self::Ceiling => "ceiling above the floor, mm",
            Self::Advance => "least advance per cycle, mm",
            Self::Speed => "least speed, mm/s",
            Self::Heat => "largest heat per metre, s/m",
            Self::Duty => "largest duty of a motor (RMS over nominal torque)",
        }
    }

    /// Axis on which is what was reached.
    pub const fn reached_axis(self) -> &'static str {
        match self {
            Self::Ceiling => "highest point, mm",
            Self::Advance => "advance per cycle, mm",
            Self::Speed => "speed, mm/s",
            Self::Heat => "heat per metre, s/m",
            Self::Duty => "duty of the worst motor (RMS over nominal torque)",
        }
    }

    /// Least and largest value at which it can be held, in its unit.
    pub const fn bounds(self) -> (f64, f64) {
        match self {
            Self::Ceiling | Self::Advance => (1.0, 1e4),
            Self::Speed => (0.1, 1e4),
            Self::Heat | Self::Duty => (0.01, 1e3),
        }
    }

    /// The search for the best of it.
    pub const fn objective(self) -> CycleObjective {
        match self {
            Self::Ceiling => CycleObjective::Height,
            Self::Advance => CycleObjective::Advance,
            Self::Speed => CycleObjective::Speed,
            Self::Heat => CycleObjective::Heat,
            Self::Duty => CycleObjective::Duty,
        }
    }

    /// What a search is for, where a frontier can be drawn of it.
    pub const fn of_objective(objective: CycleObjective) -> Option<Self> {
        match objective {
            CycleObjective::Height => Some(Self::Ceiling),
            CycleObjective::Advance => Some(Self::Advance),
            CycleObjective::Speed => Some(Self::Speed),
            CycleObjective::Heat => Some(Self::Heat),
            CycleObjective::Duty => Some(Self::Duty),
            CycleObjective::Peak | CycleObjective::HeatRate => None,
        }
    }

    /// What a crawl came to, in its unit; unknown where it was not crawled or a motor is not known.
    pub fn reached(self, row: &ConfirmedSetting) -> Option<f64> {
        match self {
            Self::Ceiling => row.top_mm,
            Self::Advance => row.mm_per_cycle,
            Self::Speed => row.mm_per_s,
            Self::Heat => row.heat_per_metre_s,
            Self::Duty => row.duty,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_searched_is_the_quantity_itself() {
        for quantity in Quantity::ALL {
            let searched = Quantity::of_objective(quantity.objective());
            assert_eq!(searched, Some(quantity));
            let written = serde_json::to_value(quantity).unwrap();
            assert_eq!(written, quantity.name());
        }
        assert_eq!(Quantity::of_objective(CycleObjective::Peak), None);
    }
}
