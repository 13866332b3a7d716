//! Rows of a map as a journal keeps them.

use prone::torque_map::{ContactForces, JointTorques, Mask};
use serde::{Deserialize, Serialize};

use super::gauge::Entry;

/// A row by its index, in the order in which rows are done.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct KeptRow(usize, KeptEntry);

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
enum KeptEntry {
    Held {
        torques: [f64; 4],
        contacts: [f64; 4],
    },
    /// The chain does not close.
    Open,
    /// The source had no torques.
    Failed,
}

impl KeptRow {
    pub(super) fn new(index: usize, entry: &Entry) -> Self {
        let entry = match *entry {
            Entry::Held { torques, contacts } => KeptEntry::Held {
                torques: torques.to_array(),
                contacts: contacts.to_array(),
            },
            Entry::Masked(Mask::Open) => KeptEntry::Open,
            // No measurement has another mask.
            Entry::Masked(Mask::Failed | Mask::Missing | Mask::Mirrored) => KeptEntry::Failed,
        };
        Self(index, entry)
    }

    pub(super) fn entry(self) -> (usize, Entry) {
        let entry = match self.1 {
            KeptEntry::Held { torques, contacts } => Entry::Held {
                torques: JointTorques::from_array(torques),
                contacts: ContactForces::from_array(contacts),
            },
            KeptEntry::Open => Entry::Masked(Mask::Open),
            KeptEntry::Failed => Entry::Masked(Mask::Failed),
        };
        (self.0, entry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_as_they_were_written() {
        let held = Entry::Held {
            torques: JointTorques::from_array([0.1 + 0.2, -0.0, 1e-300, 7.0]),
            contacts: ContactForces::from_array([1.0 / 3.0, 0.0, 5e-324, 1.0]),
        };
        for (entry, text) in [
            (held, None),
            (Entry::Masked(Mask::Open), Some("[17,\"open\"]")),
            (Entry::Masked(Mask::Failed), Some("[17,\"failed\"]")),
        ] {
            let written = serde_json::to_string(&KeptRow::new(17, &entry)).unwrap();
            assert!(text.is_none_or(|text| text == written), "{written}");
            let read: KeptRow = serde_json::from_str(&written).unwrap();
            assert_eq!(read.entry(), (17, entry));
        }
    }
}
