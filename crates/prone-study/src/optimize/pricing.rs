//! What every pricing of gaits has in common, and what a price is divided by.

use prone::chain::ClosedChain;
use prone::cost::graded::{Per, Price};
use prone::gait::Gait;
use prone::mapping::{Mapping, MappingError};
use prone::robot::Robot;

/// Prices gaits of one mapping.
pub trait Pricing: Sync {
    /// The price as a search needs it: what is already beaten by its violations may lack a torque
    /// part. Depends on nothing but the gait.
    fn price(&self, gait: &Gait) -> Price;

    /// The price with a torque part wherever there can be one, whatever rules are broken.
    fn quote(&self, gait: &Gait) -> Price {
        self.price(gait)
    }
}

/// How far the shoulder of the planned chain advances, m.
pub(super) fn advance(chain: &ClosedChain, gait: &Gait) -> f64 {
    let arm = |s: f64| gait.upper_arm.value(s).cos();
    chain.shoulder_to_elbow * (arm(0.0) - arm(1.0))
}

/// A gait that has no price per metre.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum AdvanceError {
    /// Its mapping does not fit the robot.
    #[error(transparent)]
    Mapping(#[from] MappingError),
    /// The ends of its upper arm's curve do not carry the shoulder forward.
    #[error(
        "gait {gait} has no price per metre: its shoulder advances {advance_mm:.1} mm in a pull"
    )]
    NoAdvance {
        /// The gait's name.
        gait: String,
        /// Planned advance, mm.
        advance_mm: f64,
    },
}

/// Shortest advance that a price is divided by, m.
const SHORTEST_ADVANCE: f64 = 1e-3;

/// Whether a gait, and with it every one whose upper arm has the same ends, has a price per metre.
///
/// # Errors
/// [`AdvanceError`].
pub fn check_advance(robot: &Robot, gait: &Gait) -> Result<(), AdvanceError> {
    let mapping = Mapping::new(robot, gait.mapping, gait.arm)?;
    let advance = advance(mapping.chain(), gait);
    if advance >= SHORTEST_ADVANCE {
        return Ok(());
    }
    Err(AdvanceError::NoAdvance {
        gait: gait.name.clone(),
        advance_mm: advance * 1e3,
    })
}

/// Whether a price is per phase or per metre of planned advance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Share {
    /// One phase.
    Phase,
    /// One metre.
    Metre,
}

impl Share {
    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Phase => "phase",
            Self::Metre => "metre",
        }
    }

    /// What the torque part of a gait is divided by.
    pub(super) fn of(self, chain: &ClosedChain, gait: &Gait) -> Per {
        match self {
            Self::Phase => Per::Phase,
            Self::Metre => Per::Metre {
                advance: advance(chain, gait),
            },
        }
    }
}
