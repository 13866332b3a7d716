//! What a crawler is asked for, and what comes to pass while it crawls.

use std::sync::Arc;

use crate::gait::cycle::{CheckedCycle, Cycle, TimeScale};
use crate::robot::{Range, Robot};

use super::course::PhaseKind;
use super::error::CrawlerError;
use super::pilot::Decision;
use super::timing::Timing;

/// What is crawled.
#[derive(Debug, Clone)]
pub struct Program {
    /// The cycles between which the pilot chooses; the first one begins, its pull without a turn.
    pub cycles: Vec<Cycle>,
    /// What all durations are multiplied by.
    pub scale: TimeScale,
    /// After how many cycles it ends.
    pub most_cycles: usize,
    /// How it begins.
    pub begin: Begin,
    /// When the crawler is asked, and in which form it answers.
    pub timing: Timing,
}

/// How a crawl begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Begin {
    /// In the first cycle's extension ([`CheckedCycle::extension`]), where it rests first. Whoever begins
    /// so has brought the robot there: the first set-point is commanded wherever the joints are.
    InExtension {
        /// For how long, s.
        rest: f64,
    },
    /// Wherever the joints are when it is first asked: they go to the extension on a straight line
    /// from rest to rest, all at once, and rest there. A joint that is measured beyond its stop
    /// begins at the stop, as nothing is commanded beyond; one that is measured more than
    /// [`Begin::BEYOND_STOP`] beyond is an error. Nothing looks at what is in their way: this is for
    /// a robot that lies on its belly.
    Lying {
        /// Share of each joint's speed limit that is used, above 0, at most 1.
        speed: f64,
        /// For how long it rests, s.
        rest: f64,
    },
}

/// When a crawl that has been asked to stop does so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Halt {
    /// When the cycle is over: the robot is in an extension again. Before the first cycle it ends in
    /// the first extension, and before the first tick at that tick, which commands nothing.
    AfterCycle,
    /// At the next tick, wherever the joints are then.
    AtOnce,
}

/// Why a crawl has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// All cycles are done.
    Cycles,
    /// It was asked to.
    Halted(Halt),
}

/// What has come to pass in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// A cycle has begun: [`super::Crawler::cycle`].
    CycleBegan,
    /// A phase of it has ended; another one of it, or the cycle's end, follows.
    PhaseEnded(PhaseKind),
    /// The cycle has ended.
    CycleEnded,
    /// The crawl has ended; whatever comes next goes on from [`super::Crawler::commanded`].
    Ended(Ended),
}

impl Program {
    /// Plans the cycle that was decided for, which is the crawl's `number`th, from 1.
    pub(super) fn plan(
        &self,
        robot: &Robot,
        stops: &[Range],
        decision: Decision,
        number: usize,
    ) -> Result<Arc<CheckedCycle>, CrawlerError> {
        let cycle = self.cycles.get(decision.cycle);
        let cycle = cycle.ok_or(CrawlerError::NoCycle {
            asked: decision.cycle,
            cycles: self.cycles.len(),
        })?;
        let steer = cycle.shifted_as_far(decision.steer);
        let planned = CheckedCycle::plan_steered(robot, stops, cycle, steer, self.scale);
        planned.map(Arc::new).map_err(|source| CrawlerError::Cycle {
            cycle: number,
            gait: cycle.name.clone(),
            source: Box::new(source),
        })
    }
}

impl Begin {
    /// How far beyond its stop a joint may be measured when a crawl begins, rad. Joints are off by a
    /// degree or two; one that is farther off is not where the robot's model can have it.
    pub const BEYOND_STOP: f64 = 0.1;

    /// Longest rest before the first cycle, s.
    const LONGEST_REST: f64 = 60.0;

    /// For how long it rests before the first cycle, s.
    pub(super) const fn rest(self) -> f64 {
        match self {
            Self::InExtension { rest } | Self::Lying { rest, .. } => rest,
        }
    }

    /// An error where no crawl can begin so.
    pub(super) fn check(self) -> Result<(), CrawlerError> {
        let seconds = self.rest();
        if !(0.0..=Self::LONGEST_REST).contains(&seconds) {
            return Err(CrawlerError::Rest { seconds });
        }
        match self {
            Self::Lying { speed, .. } if !(speed > 0.0 && speed <= 1.0) => {
                Err(CrawlerError::BeginSpeed { share: speed })
            }
            Self::Lying { .. } | Self::InExtension { .. } => Ok(()),
        }
    }
}
