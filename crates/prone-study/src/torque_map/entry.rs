//! Rows of a map, as they are measured and as a journal keeps them.

use prone::torque_map::TorqueGap;
use serde::{Deserialize, Serialize};

/// What a row of a map holds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum Entry {
    /// The posture is held.
    Held {
        /// Torques of the right side in the recordings' sign, N·m.
        torques: [f64; 4],
        /// What carries, both sides together, N.
        contacts: [f64; 4],
    },
    /// The chain does not close.
    Open,
    /// The source had no torques.
    Failed,
}

/// A row by its index, in the order in which rows are done.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct KeptRow(pub(super) usize, pub(super) Entry);

impl Entry {
    /// Torques and contact forces as measured; numbers that are not finite are no measurement.
    pub(super) fn from_measured(measured: &Result<[[f64; 4]; 2], TorqueGap>) -> Self {
        match *measured {
            Ok(numbers) if numbers.as_flattened().iter().all(|n| n.is_finite()) => {
                let [torques, contacts] = numbers;
                Self::Held { torques, contacts }
            }
            Err(TorqueGap::Closure(_)) => Self::Open,
            Ok(_) | Err(_) => Self::Failed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_as_they_were_written() {
        let held = Entry::Held {
            torques: [0.1 + 0.2, -0.0, 1e-300, 7.0],
            contacts: [1.0 / 3.0, 0.0, 5e-324, 1.0],
        };
        for (entry, text) in [
            (held, None),
            (Entry::Open, Some("[17,\"open\"]")),
            (Entry::Failed, Some("[17,\"failed\"]")),
        ] {
            let written = serde_json::to_string(&KeptRow(17, entry)).unwrap();
            assert!(text.is_none_or(|text| text == written), "{written}");
            let read: KeptRow = serde_json::from_str(&written).unwrap();
            assert_eq!(read, KeptRow(17, entry));
        }
    }
}
