//! Columns of numbers, as small as a replay can bear.
//!
//! A column is one number where it does not change, 32-bit floats, or 16-bit whole numbers w that
//! stand for
//!
//! 1. value = offset + scale · w, with scale = (largest − smallest) / 65,534
//!
//! so that no value is off by more than half a scale. What is not a number is −32,768. Bytes are
//! little-endian, in base64.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

use crate::figures::extremes;

/// Stands for what is not a number.
const NOT_A_NUMBER: i16 = i16::MIN;

/// A packed column.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum Packed {
    Constant {
        constant: f64,
    },
    Floats {
        f32: String,
    },
    Wholes {
        i16: String,
        offset: f64,
        scale: f64,
    },
}

/// Exact to seven digits: instants and places, which grow with a run.
#[expect(
    clippy::cast_possible_truncation,
    reason = "seven digits are what is asked for"
)]
pub(super) fn floats(values: &[f64]) -> Packed {
    constant(values).unwrap_or_else(|| Packed::Floats {
        f32: base64(
            values
                .iter()
                .flat_map(|&value| (value as f32).to_le_bytes()),
        ),
    })
}

/// Exact to a 65,534th of the range.
pub(super) fn wholes(values: &[f64]) -> Packed {
    if let Some(constant) = constant(values) {
        return constant;
    }
    let finite = values.iter().copied().filter(|value| value.is_finite());
    let (offset, scale) = match extremes(finite) {
        Some((low, high)) if low < high => (f64::midpoint(low, high), (high - low) / 65_534.0),
        Some((low, _)) => (low, 1.0),
        None => (0.0, 1.0),
    };
    #[expect(
        clippy::cast_possible_truncation,
        reason = "within ±32,767 by the choice of the scale"
    )]
    let whole = |value: f64| {
        if value.is_finite() {
            ((value - offset) / scale).round() as i16
        } else {
            NOT_A_NUMBER
        }
    };
    Packed::Wholes {
        i16: base64(values.iter().flat_map(|&value| whole(value).to_le_bytes())),
        offset,
        scale,
    }
}

/// Numbers of things: a record has none beyond 16 bits.
pub(super) fn counts(values: impl IntoIterator<Item = usize>) -> String {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "the reader refuses larger ones"
    )]
    let short = values.into_iter().map(|value| value as u16);
    base64(short.flat_map(u16::to_le_bytes))
}

fn constant(values: &[f64]) -> Option<Packed> {
    let (&first, rest) = values.split_first()?;
    let same = first.is_finite() && rest.iter().all(|value| value.total_cmp(&first).is_eq());
    same.then_some(Packed::Constant { constant: first })
}

fn base64(bytes: impl Iterator<Item = u8>) -> String {
    STANDARD.encode(bytes.collect::<Vec<u8>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the script of the page does.
    fn unpack(packed: &Packed, count: usize) -> Vec<f64> {
        match packed {
            Packed::Constant { constant } => vec![*constant; count],
            Packed::Floats { f32: text } => STANDARD
                .decode(text)
                .unwrap()
                .chunks_exact(4)
                .map(|bytes| f64::from(f32::from_le_bytes(bytes.try_into().unwrap())))
                .collect(),
            Packed::Wholes {
                i16: text,
                offset,
                scale,
            } => STANDARD
                .decode(text)
                .unwrap()
                .chunks_exact(2)
                .map(
                    |bytes| match i16::from_le_bytes(bytes.try_into().unwrap()) {
                        NOT_A_NUMBER => f64::NAN,
                        whole => offset + scale * f64::from(whole),
                    },
                )
                .collect(),
        }
    }

    proptest::proptest! {
        #[test]
        fn wholes_are_within_half_a_scale(
            values in proptest::collection::vec(-1e4..1e4_f64, 1..200)
        ) {
            let packed = wholes(&values);
            let (low, high) = values.iter().fold((f64::MAX, f64::MIN), |(low, high), &value| {
                (low.min(value), high.max(value))
            });
            let half = (high - low) / 65_534.0 / 2.0;
            for (back, value) in unpack(&packed, values.len()).iter().zip(&values) {
                // Half a scale, and the rounding of doubles of this size.
                assert!((back - value).abs() <= half + 1e-11, "{back} {value}");
            }
        }
    }

    #[test]
    fn the_ends_of_a_range_are_kept() {
        let back = unpack(&wholes(&[-2.0857, 0.1, 2.0857]), 3);
        assert!((back[0] + 2.0857).abs() < 1e-12 && (back[2] - 2.0857).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_a_number_stays_so() {
        let back = unpack(&wholes(&[1.0, f64::NAN, 3.0, f64::INFINITY]), 4);
        assert!(back[1].is_nan() && back[3].is_nan());
        assert!((back[2] - 3.0).abs() < 1e-12);
        let back = unpack(&wholes(&[f64::NAN, 7.0]), 2);
        assert!(back[0].is_nan() && (back[1] - 7.0).abs() < 1e-12);
        assert!(unpack(&wholes(&[f64::NAN; 2]), 2)[1].is_nan());
        assert_eq!(wholes(&[]), wholes(&[]));
    }

    #[test]
    fn what_does_not_change_is_one_number() {
        assert_eq!(wholes(&[0.5; 900]), Packed::Constant { constant: 0.5 });
        assert_eq!(floats(&[2.0]), Packed::Constant { constant: 2.0 });
        let back = unpack(&floats(&[0.02, 59.98]), 2);
        assert!((back[1] - 59.98).abs() < 1e-5);
    }
}
