//! Who says which cycle comes next, and how it turns.

use glam::DVec3;

use prone::frames::{Ground, Root, Transform};
pub use prone::steering::Bearing;

use super::CrawlError;
use crate::simulation::Simulation;

/// Decides at the end of each pull.
pub trait Pilot {
    /// What comes after the pull that has just ended.
    ///
    /// # Errors
    /// [`CrawlError`], which ends the crawl.
    fn decide(&mut self, now: &Moment<'_, '_>) -> Result<Decision, CrawlError>;

    /// Called with every command, for sensors that must not miss anything.
    fn sense(&mut self, _now: &Moment<'_, '_>) {}
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

impl Moment<'_, '_> {
    /// Where the robot is and where it heads, from the simulation itself.
    pub fn bearing(&self) -> Bearing {
        bearing(&self.simulation.ground_from_root())
    }
}

/// Where a prone robot is and where it heads.
///
/// It lies on its belly, so that forward is where the top of its trunk points: the root's z axis.
pub(super) fn bearing(ground_from_root: &Transform<Ground, Root>) -> Bearing {
    let ahead = ground_from_root.rotate(DVec3::Z);
    let origin = ground_from_root.origin().metres();
    Bearing {
        x: origin.x,
        y: origin.y,
        yaw: ahead.y.atan2(ahead.x),
    }
}
