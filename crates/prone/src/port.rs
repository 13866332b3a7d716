//! The port: what can be asked of anything that can be driven, a robot or a simulation of one.
//!
//! One trait per capability, so that a backend implements what it has and a user asks for what it
//! needs. No trait names a robot or a simulator, and none does input or output itself. A crawl
//! needs [`Sense`], [`Command`], [`Pace`] and [`Stop`] ([`crate::crawl::drive`]); [`Limits`] is what
//! a plan is checked against. Stiffness, posture, walk and image come with their first implementor.
//!
//! All traits are object safe and share one error, so that a backend can be chosen at run time and
//! wrapped by checks.

use std::error::Error;

use crate::attitude::ImuReading;
use crate::robot::{ContactGroup, JointAngles, Range, Robot};
use crate::steering::Bearing;

/// What a robot feels at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct Senses {
    /// When, s, on the port's own clock, which never goes back.
    pub time: f64,
    /// Measured joint angles, rad, one for each of the robot's joints.
    pub angles: JointAngles,
    /// What the inertial unit says.
    pub inertial: InertialUnit,
    /// Where the robot is and where it heads, in the frame of the line that it follows, where
    /// something knows.
    pub bearing: Option<Bearing>,
    /// Normal force of the ground by [`ContactGroup::ALL`], N, where it is felt.
    pub touch: Option<[f64; ContactGroup::COUNT]>,
}

/// State of an inertial unit at one instant.
#[derive(Debug, Clone, PartialEq)]
pub enum InertialUnit {
    /// The robot has none, or it is not read.
    Absent,
    /// It has been read.
    Reading(ImuReading),
    /// It should have been read, and could not be.
    Failed {
        /// What the backend knows about it.
        reason: String,
    },
}

/// What the joints are to do.
#[derive(Debug, Clone, PartialEq)]
pub enum JointCommand {
    /// Go on with the last command.
    Continue,
    /// Hold these angles, rad, until the next command.
    SetPoint(JointAngles),
    /// Go along a path in time.
    Segment(Segment),
}

/// A path in time. It begins when the command is taken, where the joints were last sent; from there
/// to the first knot and from knot to knot every joint goes on a straight line; after the last one
/// it stays there.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// In the order of time; the first one lies after the beginning.
    pub knots: Vec<Knot>,
}

/// An instant of a [`Segment`].
#[derive(Debug, Clone, PartialEq)]
pub struct Knot {
    /// Since the segment began, s.
    pub seconds: f64,
    /// Joint angles, rad.
    pub angles: JointAngles,
}

/// Why a port did not do what it was asked for.
#[derive(Debug, thiserror::Error)]
pub enum PortError {
    /// The other side does not answer.
    #[error("the link is lost: {reason}")]
    Lost {
        /// What is known about it.
        reason: String,
    },
    /// A check between the caller and the robot said no.
    #[error("refused: {reason}")]
    Refused {
        /// What was asked for, and the bound.
        reason: String,
    },
    /// The backend's own error.
    #[error(transparent)]
    Backend(Box<dyn Error + Send + Sync>),
}

/// Something that feels.
pub trait Sense {
    /// What is felt now. Calling it twice at one instant is a second sample of noisy sensors.
    ///
    /// # Errors
    /// [`PortError`]. A single failed inertial unit is not an error here, but
    /// [`InertialUnit::Failed`].
    fn sense(&mut self) -> Result<Senses, PortError>;
}

/// Something whose joints can be commanded.
pub trait Command {
    /// Hands over a command, and returns before it is carried out.
    fn command(&mut self, command: &JointCommand) -> Result<(), PortError>;
}

/// Something that keeps its own time.
pub trait Pace {
    /// Time now, s, as in [`Senses::time`].
    fn time(&self) -> f64;

    /// Usual time from one [`Pace::wait`] to the next, s. A crawler counts in the same
    /// ([`crate::crawl::drive`] refuses any other).
    fn tick(&self) -> f64;

    /// Returns when the next tick has come: a simulation computes it, a robot is waited for.
    fn wait(&mut self) -> Result<(), PortError>;
}

/// Something that can be brought to rest.
pub trait Stop {
    /// Ends whatever path is being followed: every joint holds the last angle that it was sent. A
    /// posture under load sags below its set-point, so that commanding what is measured would lower
    /// the robot with every call; this may be called at any time, and a second call changes nothing.
    fn stop(&mut self) -> Result<(), PortError>;
}

/// Something that knows its bounds.
pub trait Limits {
    /// The robot that is driven: its joints with their effort and speed limits.
    fn robot(&self) -> &Robot;

    /// Stops that hold there, rad, in the order of the robot's joints.
    fn stops(&self) -> &[Range];
}

impl Segment {
    /// Joint angles at a time since the segment began, s, where it began at `from`.
    pub fn at(&self, seconds: f64, from: &JointAngles) -> JointAngles {
        let mut before = (0.0, from);
        for knot in &self.knots {
            if seconds < knot.seconds {
                let share = (seconds - before.0) / (knot.seconds - before.0);
                return before.1.towards(&knot.angles, share.max(0.0));
            }
            before = (knot.seconds, &knot.angles);
        }
        before.1.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_segment_is_straight_between_knots_and_ends_in_the_last() {
        let at = |radians: f64| JointAngles::from_fn(1, |_| radians);
        let knot = |seconds: f64, radians: f64| Knot {
            seconds,
            angles: at(radians),
        };
        let segment = Segment {
            knots: vec![knot(1.0, 2.0), knot(3.0, -2.0)],
        };
        for (seconds, radians) in [
            (-1.0, 0.0),
            (0.0, 0.0),
            (0.5, 1.0),
            (1.0, 2.0),
            (2.0, 0.0),
            (3.0, -2.0),
            (9.0, -2.0),
        ] {
            let found = segment.at(seconds, &at(0.0)).as_slice()[0];
            assert!((found - radians).abs() < 1e-15, "{seconds} s: {found}");
        }
        assert_eq!(Segment { knots: Vec::new() }.at(1.0, &at(0.3)), at(0.3));
    }
}
