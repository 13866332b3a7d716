//! Who says which cycle comes next, and how it turns.

use glam::DVec3;

use prone::frames::{Ground, Root, Transform};
pub use prone::steering::Bearing;
use prone::steering::{HeadingHold, TurnTo};

use super::CrawlError;
use crate::simulation::Simulation;

/// Decides at the end of each pull.
pub trait Pilot {
    /// What comes after the pull that has just ended.
    ///
    /// # Errors
    /// [`CrawlError`], which ends the crawl.
    fn decide(&mut self, now: &Moment<'_, '_>) -> Result<Decision, CrawlError>;

    /// Called after every engine step, for sensors that must not miss anything.
    fn sense(&mut self, _now: &Moment<'_, '_>) {}
}

impl Pilot for Box<dyn Pilot> {
    fn decide(&mut self, now: &Moment<'_, '_>) -> Result<Decision, CrawlError> {
        (**self).decide(now)
    }

    fn sense(&mut self, now: &Moment<'_, '_>) {
        (**self).sense(now);
    }
}

/// What comes next.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decision {
    /// Index of the cycle among those of the plan.
    pub cycle: usize,
    /// Turn command, rad, positive to the left.
    pub turn: f64,
}

/// An instant of a crawl, as a pilot may look at it.
#[derive(Debug, Clone, Copy)]
pub struct Moment<'s, 'w> {
    /// The robot.
    pub simulation: &'s Simulation<'w>,
    /// What it is doing.
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
    /// The limbs go back.
    Recovery,
}

/// The same cycle and the same turn for ever.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Straight {
    /// Turn command, rad.
    pub turn: f64,
}

impl Pilot for Straight {
    fn decide(&mut self, _: &Moment<'_, '_>) -> Result<Decision, CrawlError> {
        Ok(Decision {
            cycle: 0,
            turn: self.turn,
        })
    }
}

/// Where a pilot learns where the robot is and where it heads: the simulation itself, or the
/// robot's own senses.
pub trait BearingSource {
    /// In the frame of the line that is to be followed.
    ///
    /// # Errors
    /// [`CrawlError`], which ends the crawl.
    fn bearing(&mut self, now: &Moment<'_, '_>) -> Result<Bearing, CrawlError>;

    /// Called with every command, for senses that add up what they feel.
    fn sense(&mut self, _now: &Moment<'_, '_>) {}
}

/// The simulation's own bearing, without error, along the x axis of the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Exact;

impl BearingSource for Exact {
    fn bearing(&mut self, now: &Moment<'_, '_>) -> Result<Bearing, CrawlError> {
        Ok(now.bearing())
    }
}

/// The same cycle for ever, turned so that the robot keeps to its line.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldLine<S> {
    source: S,
    hold: HeadingHold,
}

impl<S: BearingSource> HoldLine<S> {
    /// Turns by at most `limit`, rad, on what `source` says.
    pub fn new(source: S, limit: f64) -> Self {
        Self {
            source,
            hold: HeadingHold::new(limit),
        }
    }
}

impl<S: BearingSource> Pilot for HoldLine<S> {
    fn decide(&mut self, now: &Moment<'_, '_>) -> Result<Decision, CrawlError> {
        let bearing = self.source.bearing(now)?;
        Ok(Decision {
            cycle: 0,
            turn: self.hold.turn(bearing),
        })
    }

    fn sense(&mut self, now: &Moment<'_, '_>) {
        self.source.sense(now);
    }
}

/// The same cycle for ever, turned to a heading.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldHeading<S> {
    /// Where it learns its heading.
    pub source: S,
    /// Where it turns to.
    pub to: TurnTo,
}

impl<S: BearingSource> Pilot for HoldHeading<S> {
    fn decide(&mut self, now: &Moment<'_, '_>) -> Result<Decision, CrawlError> {
        let bearing = self.source.bearing(now)?;
        Ok(Decision {
            cycle: 0,
            turn: self.to.turn(bearing),
        })
    }

    fn sense(&mut self, now: &Moment<'_, '_>) {
        self.source.sense(now);
    }
}

impl Moment<'_, '_> {
    /// Where the robot is and where it heads, from the simulation itself.
    pub fn bearing(&self) -> Bearing {
        bearing(&self.simulation.ground_from_root())
    }
}

/// Where a prone robot is and where it heads.
///
/// It lies on its belly, so that forward is where the top of its trunk points: the root's z axis.
pub fn bearing(ground_from_root: &Transform<Ground, Root>) -> Bearing {
    let ahead = ground_from_root.rotate(DVec3::Z);
    let origin = ground_from_root.origin().metres();
    Bearing {
        x: origin.x,
        y: origin.y,
        yaw: ahead.y.atan2(ahead.x),
    }
}
