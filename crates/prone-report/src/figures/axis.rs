//! One axis: its range and its ticks at 1, 2 or 5 times a power of ten.

/// Range and label of one axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Axis {
    /// Quantity and unit.
    pub(super) label: String,
    pub(super) low: f64,
    pub(super) high: f64,
}

/// Ticks of an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Ticks {
    /// Values with a label.
    pub(super) major: Vec<(f64, String)>,
    /// Values between them.
    pub(super) minor: Vec<f64>,
}

impl Axis {
    /// Exactly from `low` to `high`.
    pub(super) fn exactly(label: &str, low: f64, high: f64) -> Self {
        let (low, high) = opened(low, high);
        Self {
            label: label.to_owned(),
            low,
            high,
        }
    }

    /// From tick to tick, so that every value lies inside with some room.
    pub(super) fn covering(label: &str, values: impl IntoIterator<Item = f64>) -> Self {
        /// Steps of a range on which its ends are rounded.
        const STEPS: f64 = 8.0;
        /// Room beyond the extreme values, per range.
        const ROOM: f64 = 0.03;
        let extremes = extremes(values.into_iter().filter(|value| value.is_finite()));
        let (low, high) = extremes.map_or((0.0, 1.0), |(low, high)| opened(low, high));
        let step = Step::at_least((high - low) / STEPS).size();
        let room = ROOM * (high - low);
        // What is never negative starts at zero at the lowest.
        let floor = if low >= 0.0 { 0.0 } else { f64::NEG_INFINITY };
        Self {
            label: label.to_owned(),
            low: (((low - room) / step).floor() * step).max(floor),
            high: ((high + room) / step).ceil() * step,
        }
    }

    /// At most `most` labelled ticks, and four or five steps between them.
    pub(super) fn ticks(&self, most: usize) -> Ticks {
        let round = Step::at_least((self.high - self.low) / most.max(2) as f64);
        let (step, places) = (round.size(), round.decimals());
        let label = |value: f64| {
            let text = format!("{value:.places$}");
            // The minus sign, as wide as a plus, not the hyphen.
            if value < -step / 2.0 {
                text.replace('-', "−")
            } else {
                text.replace('-', "")
            }
        };
        let major = self.multiples(step).into_iter();
        Ticks {
            major: major.map(|value| (value, label(value))).collect(),
            minor: self.multiples(step / round.parts()),
        }
    }

    /// Where `value` lies: 0 at the low end, 1 at the high end.
    pub(super) fn fraction(&self, value: f64) -> f64 {
        (value - self.low) / (self.high - self.low)
    }

    /// Whether `value` lies within the range.
    pub(super) fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    fn multiples(&self, step: f64) -> Vec<f64> {
        /// Part of a step by which rounding may miss an end of the range.
        const SLACK: f64 = 1e-6;
        let first = (self.low / step - SLACK).ceil();
        let count = (self.high / step + SLACK).floor() - first;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "under 100"
        )]
        let count = count.clamp(0.0, 100.0) as usize;
        (0..=count).map(|i| (first + i as f64) * step).collect()
    }
}

/// The least and the largest value; nothing of none.
pub(crate) fn extremes(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let ranges = values.map(|value| (value, value));
    ranges.reduce(|(low, high), (value, _)| (low.min(value), high.max(value)))
}

/// The range, widened if it is too narrow to draw.
fn opened(low: f64, high: f64) -> (f64, f64) {
    let magnitude = low.abs().max(high.abs()).max(1e-6);
    if high - low > 1e-9 * magnitude {
        (low, high)
    } else {
        (low - 0.5 * magnitude, high + 0.5 * magnitude)
    }
}

/// A distance between ticks: 1, 2 or 5 times a power of ten.
#[derive(Debug, Clone, Copy)]
struct Step {
    digit: u8,
    exponent: f64,
}

impl Step {
    /// The least step that is not below `size`.
    fn at_least(size: f64) -> Self {
        /// Rounding may leave a round size a little above itself.
        const SLACK: f64 = 1e-9;
        let exponent = size.log10().floor();
        let mut steps = [1, 2, 5].into_iter().map(|digit| Self { digit, exponent });
        let enough = steps.find(|step| step.size() >= size * (1.0 - SLACK));
        enough.unwrap_or(Self {
            digit: 1,
            exponent: exponent + 1.0,
        })
    }

    fn size(self) -> f64 {
        f64::from(self.digit) * 10_f64.powf(self.exponent)
    }

    /// Round steps into which it divides.
    fn parts(self) -> f64 {
        if self.digit == 2 { 4.0 } else { 5.0 }
    }

    /// Decimals that tell its multiples apart.
    fn decimals(self) -> usize {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 to 12"
        )]
        let places = (-self.exponent).clamp(0.0, 12.0) as usize;
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64, most: usize) -> Vec<String> {
        Axis::exactly("", low, high)
            .ticks(most)
            .major
            .into_iter()
            .map(|tick| tick.1)
            .collect()
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(labels(0.0, 10.0, 6), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(labels(-0.3, 0.3, 4), ["−0.2", "0.0", "0.2"]);
        assert_eq!(
            labels(0.0, 0.5, 5),
            ["0.0", "0.1", "0.2", "0.3", "0.4", "0.5"]
        );
        assert_eq!(labels(-90.0, -30.0, 4), ["−80", "−60", "−40"]);
    }

    #[test]
    fn covering_leaves_every_value_inside() {
        let values = [-2.34, 0.0, 1.98];
        let axis = Axis::covering("", values);
        assert!(values.iter().all(|value| axis.fraction(*value) > 0.0));
        assert!(values.iter().all(|value| axis.fraction(*value) < 1.0));
    }

    #[test]
    fn what_is_never_negative_starts_at_zero() {
        assert!(Axis::covering("", [0.0, 12.0]).low.abs() < 1e-12);
        assert!(Axis::covering("", [-0.1, 12.0]).low < -0.1);
    }

    #[test]
    fn ranges_without_extent_are_drawn() {
        for values in [
            vec![],
            vec![0.0],
            vec![3.0, 3.0],
            vec![f64::NAN],
            vec![1e9, 1e9],
        ] {
            let axis = Axis::covering("", values.clone());
            assert!(axis.high > axis.low, "{values:?}");
            assert!(axis.ticks(5).major.len() > 1, "{values:?}");
        }
    }

    #[test]
    fn minor_ticks_divide_major_ones() {
        let ticks = Axis::exactly("", 0.0, 4.0).ticks(2);
        assert_eq!(ticks.major.len(), 3);
        assert_eq!(ticks.minor, [0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0]);
    }
}
