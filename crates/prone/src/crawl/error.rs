//! Why a crawl cannot begin or go on.

use crate::gait::cycle::CycleError;

use super::felt::FeltError;
use super::pilot::PilotError;

/// Why a crawl cannot begin or go on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CrawlerError {
    /// The pilot, or the beginning, asks for a cycle that is not there.
    #[error("cycle {} of the program was asked for, and it has {cycles}", asked + 1)]
    NoCycle {
        /// Its index, from 0; the message counts from 1.
        asked: usize,
        /// How many there are.
        cycles: usize,
    },
    /// A cycle cannot be planned. Of the first one, before anything is crawled, this is an error of
    /// its plan alone.
    #[error("{}{source}", in_cycle(*cycle))]
    Cycle {
        /// From 1.
        cycle: usize,
        /// The cycle's name.
        gait: String,
        /// What is wrong.
        source: Box<CycleError>,
    },
    /// The pilot cannot decide.
    #[error("in cycle {cycle} ({gait}): {source}")]
    Pilot {
        /// From 1.
        cycle: usize,
        /// The cycle's name.
        gait: String,
        /// What is wrong.
        source: PilotError,
    },
    /// What is felt is nothing that a crawl can go by.
    #[error("in cycle {cycle} ({gait}): {problem}")]
    Felt {
        /// From 1.
        cycle: usize,
        /// The cycle's name.
        gait: String,
        /// What is wrong.
        problem: FeltError,
    },
    /// A joint is measured where it cannot be, before the crawl begins.
    #[error(
        "{joint} is measured at {angle} rad, more than {most} rad beyond its stops {lower}..{upper} rad"
    )]
    BeyondStop {
        /// Name of the joint.
        joint: String,
        /// Where it is measured, rad.
        angle: f64,
        /// Its lower stop, rad.
        lower: f64,
        /// Its upper stop, rad.
        upper: f64,
        /// How far beyond it may be, rad.
        most: f64,
    },
    /// A share of the joints' speed limits that no crawl can begin with.
    #[error("a share of {share} of the joints' speed limits is outside 0..1")]
    BeginSpeed {
        /// What was asked for.
        share: f64,
    },
    /// A rest that no crawl can begin with.
    #[error("a rest of {seconds} s is outside 0..60 s")]
    Rest {
        /// What was asked for, s.
        seconds: f64,
    },
}

/// Where a plan is wrong, for messages: nothing has been crawled when the first one is made.
fn in_cycle(cycle: usize) -> String {
    if cycle == 1 {
        String::new()
    } else {
        format!("in cycle {cycle}: ")
    }
}
