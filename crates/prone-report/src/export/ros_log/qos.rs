//! How a topic was offered: the quality of service of its publisher, as rosbag2 writes it.
//!
//! The policies are numbers, those of `rmw/types.h`. rosbag2 of Humble and Iron reads numbers alone.
//! Jazzy and later write words, and read both: they tell by the first policy which it is.

/// How long an offer lasts beyond the moment in which a message is sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Qos {
    /// To those who listen; a publisher's default.
    Volatile,
    /// To those who come later too: the last message is kept for them.
    Latched,
}

impl Qos {
    /// The list of profiles, of which there is one, in YAML.
    pub(super) fn yaml(self) -> String {
        const KEEP_LAST: u8 = 1;
        const RELIABLE: u8 = 1;
        const AUTOMATIC: u8 = 1;
        let (depth, durability) = match self {
            Self::Volatile => (10, 2),
            Self::Latched => (1, 1),
        };
        // A time of 0 is none that was asked for.
        let unlimited = "\n    sec: 0\n    nsec: 0";
        format!(
            "- history: {KEEP_LAST}\n  depth: {depth}\n  reliability: {RELIABLE}\n  \
             durability: {durability}\n  deadline:{unlimited}\n  lifespan:{unlimited}\n  \
             liveliness: {AUTOMATIC}\n  liveliness_lease_duration:{unlimited}\n  \
             avoid_ros_namespace_conventions: false"
        )
    }
}
