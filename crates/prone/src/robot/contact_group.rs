//! What of a robot touches the ground.

use std::fmt;

/// Parts of the body whose ground contact is recorded together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ContactGroup {
    /// Feet: the rear support of the chain.
    Toe,
    /// Arms to the forearms: the front support.
    Elbow,
    /// Trunk and pelvis.
    Torso,
    /// Thighs and shins.
    Leg,
    /// Neck and head, which nothing should rest on; their height is recorded apart.
    Head,
    /// Hands, whose motors are the weakest.
    Hand,
}

impl ContactGroup {
    /// All groups, in the order of a record's columns.
    pub const ALL: [Self; Self::COUNT] = [
        Self::Toe,
        Self::Elbow,
        Self::Torso,
        Self::Leg,
        Self::Head,
        Self::Hand,
    ];

    /// How many there are.
    pub const COUNT: usize = 6;

    /// The groups of the published study, which counts hands as elbows and the head as torso.
    pub const OF_THE_STUDY: [Self; 4] = [Self::Toe, Self::Elbow, Self::Torso, Self::Leg];

    /// Lower-case name, as in `robot.toml` and the record's columns.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Toe => "toe",
            Self::Elbow => "elbow",
            Self::Torso => "torso",
            Self::Leg => "leg",
            Self::Head => "head",
            Self::Hand => "hand",
        }
    }

    /// Whether it is the front support of the chain: arms with their hands.
    pub const fn is_front(self) -> bool {
        matches!(self, Self::Elbow | Self::Hand)
    }

    /// Whether it is the body, which the chain should carry: trunk, head and legs.
    pub const fn is_body(self) -> bool {
        matches!(self, Self::Torso | Self::Leg | Self::Head)
    }

    /// Forces by [`Self::ALL`] as forces by [`Self::OF_THE_STUDY`].
    pub const fn as_in_the_study(forces: [f64; Self::COUNT]) -> [f64; 4] {
        let [toe, elbow, torso, leg, head, hand] = forces;
        [toe, elbow + hand, torso + head, leg]
    }
}

impl fmt::Display for ContactGroup {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
