//! Who says which cycle comes next, and how it turns.

use crate::attitude::AttitudeError;
use crate::gait::cycle::Steer;
use crate::port::Senses;
use crate::robot::Robot;
use crate::steering::{HeadingHold, TurnTo};

/// Decides at the end of each pull; of a cycle without one, when it begins.
pub trait Pilot {
    /// What comes next.
    ///
    /// # Errors
    /// [`PilotError`], which ends the crawl.
    fn decide(&mut self, now: &Moment<'_>) -> Result<Decision, PilotError>;

    /// Called with all that is felt, also at rest before the first cycle, for senses that must not
    /// miss anything.
    ///
    /// # Errors
    /// [`PilotError`], which ends the crawl.
    fn feel(&mut self, now: &Moment<'_>) -> Result<(), PilotError> {
        let _ = now;
        Ok(())
    }
}

/// An instant of a crawl, as a pilot may look at it.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'a> {
    /// The robot's model.
    pub robot: &'a Robot,
    /// What it feels.
    pub senses: &'a Senses,
    /// Time since the moment before, s; 0 where the pilot decides.
    pub elapsed: f64,
    /// What it has been doing in that time; where the pilot decides, always [`Stage::Recovery`], as
    /// no pull goes on then.
    pub stage: Stage,
}

/// Part of a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stage {
    /// Toes and elbows carry the body.
    Pull {
        /// Phase, 0 to 1.
        s: f64,
        /// The root's pitch in the planned chain on level ground, rad.
        planned_pitch: f64,
    },
    /// The limbs are open chains: they go back, or to the first posture, or rest there.
    Recovery,
}

/// What comes next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// Index of the cycle among those of the crawl.
    pub cycle: usize,
    /// What it is steered by.
    pub steer: Steer,
}

impl Decision {
    /// The crawl's first cycle, turned.
    const fn turned(turn: f64) -> Self {
        Self {
            cycle: 0,
            steer: Steer { turn, shift: 0.0 },
        }
    }
}

/// Why a pilot cannot decide.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PilotError {
    /// It follows a line or a heading, and nothing knows where the robot is.
    #[error("nothing tells where the robot is and where it heads")]
    NoBearing,
    /// It goes by the inertial unit, and there is none.
    #[error("there is no inertial unit to tell the slope")]
    NoInertialUnit,
    /// It goes by the inertial unit, which cannot be read.
    #[error("the inertial unit failed: {reason}")]
    InertialUnit {
        /// What the port said.
        reason: String,
    },
    /// The inertial unit says what cannot be.
    #[error("the inertial unit tells no attitude: {0}")]
    Attitude(#[from] AttitudeError),
    /// The measured joints do not tell how the robot would lie on a level floor.
    #[error("the measured joint angles tell no pitch on a level floor")]
    NoLevelPitch,
    /// Not once in a pull has the slope been felt.
    #[error("the slope has not been felt in this pull: no sample came while the body was carried")]
    NotFelt,
}

/// The same cycle and the same turn for ever.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Straight {
    /// Turn command, rad.
    pub turn: f64,
}

impl Pilot for Straight {
    fn decide(&mut self, _: &Moment<'_>) -> Result<Decision, PilotError> {
        Ok(Decision::turned(self.turn))
    }
}

/// The same cycle for ever, turned so that the robot keeps to its line.
impl Pilot for HeadingHold {
    fn decide(&mut self, now: &Moment<'_>) -> Result<Decision, PilotError> {
        let bearing = now.senses.bearing.ok_or(PilotError::NoBearing)?;
        Ok(Decision {
            cycle: 0,
            steer: self.steer(bearing),
        })
    }
}

/// The same cycle for ever, turned to a heading.
impl Pilot for TurnTo {
    fn decide(&mut self, now: &Moment<'_>) -> Result<Decision, PilotError> {
        let bearing = now.senses.bearing.ok_or(PilotError::NoBearing)?;
        Ok(Decision::turned(self.turn(bearing)))
    }
}

impl<P: Pilot + ?Sized> Pilot for Box<P> {
    fn decide(&mut self, now: &Moment<'_>) -> Result<Decision, PilotError> {
        (**self).decide(now)
    }

    fn feel(&mut self, now: &Moment<'_>) -> Result<(), PilotError> {
        (**self).feel(now)
    }
}

impl<P: Pilot + ?Sized> Pilot for &mut P {
    fn decide(&mut self, now: &Moment<'_>) -> Result<Decision, PilotError> {
        (**self).decide(now)
    }

    fn feel(&mut self, now: &Moment<'_>) -> Result<(), PilotError> {
        (**self).feel(now)
    }
}
