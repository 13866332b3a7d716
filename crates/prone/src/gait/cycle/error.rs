//! Why a cycle cannot be crawled.

use super::super::{PhaseDurationError, TrajectoryError};
use super::Cycle;
use crate::robot::BeyondCoupled;

/// Why a cycle cannot be crawled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CycleError {
    /// The pull has no trajectory.
    #[error(transparent)]
    Pull(#[from] TrajectoryError),
    /// The pull would be too short or too long at this time scale.
    #[error("cycle {cycle}: {source}")]
    Duration {
        /// The cycle's name.
        cycle: String,
        /// What is wrong.
        source: PhaseDurationError,
    },
    /// A joint that the robot does not have.
    #[error("cycle {cycle}, {place}: robot {robot} has no joint {joint}")]
    UnknownJoint {
        /// The cycle's name.
        cycle: String,
        /// Pull, steering or a waypoint.
        place: String,
        /// The robot's name.
        robot: String,
        /// The joint's name.
        joint: String,
        /// The joints that the robot has.
        known: Box<[String]>,
    },
    /// A joint that the chain commands already.
    #[error("cycle {cycle}, {place}: {joint} belongs to the chain, which moves it")]
    ChainJoint {
        /// The cycle's name.
        cycle: String,
        /// Pull or steering.
        place: String,
        /// The joint's name.
        joint: String,
    },
    /// A stretch of the recovery that takes no time, or ages.
    #[error("cycle {cycle}, {place}: {seconds} s is outside {}..{} s", Cycle::STRETCH_SECONDS.0, Cycle::STRETCH_SECONDS.1)]
    Seconds {
        /// The cycle's name.
        cycle: String,
        /// The waypoint.
        place: String,
        /// What was asked for.
        seconds: f64,
    },
    /// A turn that the cycle has no steering for.
    #[error(
        "cycle {cycle}: a {what} of {asked_deg:.2}° is more than its steering's {limit_deg:.2}°"
    )]
    Turn {
        /// The cycle's name.
        cycle: String,
        /// Turn or shift.
        what: &'static str,
        /// What was asked for, degrees.
        asked_deg: f64,
        /// The largest, degrees; 0 without steering.
        limit_deg: f64,
    },
    /// A joint of a waypoint passes its limit and the policy is to refuse.
    #[error(
        "cycle {cycle}, {place}: {joint} {angle:.4} rad is outside {lower:.4}..{upper:.4}, by {excess:.4} rad; \
         `limits = \"clamp\"` in the file would stop it there"
    )]
    Limit {
        /// The cycle's name.
        cycle: String,
        /// The waypoint.
        place: String,
        /// The joint's name.
        joint: String,
        /// What is asked for, rad.
        angle: f64,
        /// The lower stop, rad.
        lower: f64,
        /// The upper stop, rad.
        upper: f64,
        /// How far outside, rad.
        excess: f64,
    },
    /// A joint passes the limit that another joint's angle sets it, and the policy is to refuse.
    #[error(
        "cycle {cycle}, {place}: {beyond}; `limits = \"clamp\"` in the file would stop it there"
    )]
    Coupled {
        /// The cycle's name.
        cycle: String,
        /// The waypoint that it is on its way to.
        place: String,
        /// What lies beyond, boxed as all other errors are smaller.
        beyond: Box<BeyondCoupled>,
    },
    /// The stops are those of another robot.
    #[error("cycle {cycle}: {stops} stops are given, robot {robot} has {joints} joints")]
    Stops {
        /// The cycle's name.
        cycle: String,
        /// How many stops there are.
        stops: usize,
        /// The robot's name.
        robot: String,
        /// How many joints it has.
        joints: usize,
    },
    /// A cycle without a pull that goes nowhere.
    #[error("cycle {cycle}: without a pull it needs two waypoints or more, not {waypoints}")]
    FewWaypoints {
        /// The cycle's name.
        cycle: String,
        /// How many it has.
        waypoints: usize,
    },
    /// A turn or a shift adds to an angle that a waypoint does not give.
    #[error(
        "cycle {cycle}, {place}: a turn or a shift moves {joint}, to which the waypoint gives no angle"
    )]
    NothingToTurn {
        /// The cycle's name.
        cycle: String,
        /// The waypoint.
        place: String,
        /// The joint's name.
        joint: String,
    },
    /// A joint would have to be faster than it is.
    #[error(
        "cycle {cycle}, {place}: {joint} would need {speed:.2} rad/s, above its limit of {limit:.2} rad/s"
    )]
    Speed {
        /// The cycle's name.
        cycle: String,
        /// The pull or the waypoint that it goes to.
        place: String,
        /// The joint's name.
        joint: String,
        /// The largest speed, rad/s.
        speed: f64,
        /// The manufacturer's limit, rad/s.
        limit: f64,
    },
    /// The pull before it was planned for another robot.
    #[error(
        "cycle {cycle} is planned for a robot of {joints} joints, and {previous} before it for one of {others}"
    )]
    OtherRobot {
        /// The cycle's name.
        cycle: String,
        /// How many joints its robot has.
        joints: usize,
        /// The name of the cycle whose pull is before it.
        previous: String,
        /// How many joints that one's robot has.
        others: usize,
    },
}

impl CycleError {
    /// Which part of the cycle it is about: `pull`, `steering`, `extension` for the approach to it,
    /// `recovery` for all of it, or a waypoint by its name.
    pub fn place(&self) -> &str {
        match self {
            Self::Pull(_) | Self::Duration { .. } => "pull",
            Self::Turn { .. } => "steering",
            Self::OtherRobot { .. } | Self::Stops { .. } | Self::FewWaypoints { .. } => "recovery",
            Self::UnknownJoint { place, .. }
            | Self::ChainJoint { place, .. }
            | Self::Seconds { place, .. }
            | Self::Limit { place, .. }
            | Self::Coupled { place, .. }
            | Self::NothingToTurn { place, .. }
            | Self::Speed { place, .. } => place.strip_prefix("waypoint ").unwrap_or(place),
        }
    }
}
