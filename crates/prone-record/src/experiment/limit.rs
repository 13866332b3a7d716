//! Numbers that an experiment cannot have, wherever it comes from.

/// A number that an experiment cannot have.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{quantity} of {value}{unit} is outside {lowest} to {highest}{unit}")]
pub struct Limit {
    /// What it is.
    pub quantity: &'static str,
    /// Its unit, as it follows a number.
    pub unit: &'static str,
    /// What was asked for.
    pub value: f64,
    /// Its lower bound.
    pub lowest: f64,
    /// Its upper bound.
    pub highest: f64,
}

impl Limit {
    /// Checks a number; NaN is within nothing.
    pub fn check(
        quantity: &'static str,
        unit: &'static str,
        value: f64,
        (lowest, highest): (f64, f64),
    ) -> Result<(), Self> {
        if (lowest..=highest).contains(&value) {
            return Ok(());
        }
        Err(Self {
            quantity,
            unit,
            value,
            lowest,
            highest,
        })
    }
}
