//! Whether what is felt is what a crawl can go by.

use crate::port::Senses;
use crate::robot::Robot;

use super::timing::Timing;

/// How many ticks in a row may always come at one instant: a backend may repeat its last message.
/// More may, as long as they last no longer than a gap may.
const FEW_FROZEN: usize = 10;

/// Why a crawl cannot go by what is felt.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FeltError {
    /// The senses' clock goes back, or is none.
    #[error("the senses' clock says {time_s} s, which does not follow {before_s} s")]
    Time {
        /// Time of the tick before, s.
        before_s: f64,
        /// Time of this tick, s.
        time_s: f64,
    },
    /// Nothing was felt for so long that the crawl is not what was planned any more.
    #[error("nothing was felt for {seconds} s; at most {longest_s} s may go by")]
    Gap {
        /// Time between two ticks, s.
        seconds: f64,
        /// The bound, s.
        longest_s: f64,
    },
    /// The senses' clock stands still.
    #[error("the senses' clock has stood at {time_s} s for {ticks} ticks")]
    Frozen {
        /// Where it stands, s.
        time_s: f64,
        /// For how many ticks.
        ticks: usize,
    },
    /// The measured joints are not the robot's, or one of them is not measured.
    #[error("joint angles are not measured: {problem}")]
    Angles {
        /// What is wrong.
        problem: String,
    },
}

/// The ticks of a crawl so far, as the senses' clock has them.
#[derive(Debug, Clone)]
pub(super) struct Ticks {
    timing: Timing,
    /// Time of the last one, s.
    last: Option<f64>,
    /// How many in a row came at one instant.
    frozen: usize,
}

impl Ticks {
    pub(super) const fn new(timing: Timing) -> Self {
        Self {
            timing,
            last: None,
            frozen: 0,
        }
    }

    /// Takes in a tick: the time since the one before, s, 0 for the first; `None` where the clock
    /// stands still, as it may for a moment in a pause, but not for ever.
    pub(super) fn take(
        &mut self,
        robot: &Robot,
        senses: &Senses,
    ) -> Result<Option<f64>, FeltError> {
        let time_s = senses.time;
        let before_s = self.last.unwrap_or(0.0);
        let forwards = time_s.is_finite() && self.last.is_none_or(|last| time_s >= last);
        if !forwards {
            return Err(FeltError::Time { before_s, time_s });
        }
        check_angles(robot, senses)?;
        let elapsed = self
            .timing
            .snapped(self.last.map_or(0.0, |last| time_s - last));
        let longest_s = self.timing.longest_gap();
        if self.last.is_some() && elapsed == 0.0 {
            self.frozen += 1;
            let ticks = self.frozen;
            if ticks > FEW_FROZEN && ticks as f64 * self.timing.tick() > longest_s {
                return Err(FeltError::Frozen { time_s, ticks });
            }
            return Ok(None);
        }
        if elapsed > longest_s {
            let seconds = elapsed;
            return Err(FeltError::Gap { seconds, longest_s });
        }
        (self.last, self.frozen) = (Some(time_s), 0);
        Ok(Some(elapsed))
    }
}

/// Every joint of the robot, and no other, must be measured.
fn check_angles(robot: &Robot, senses: &Senses) -> Result<(), FeltError> {
    let (angles, joints) = (senses.angles.as_slice(), &robot.joints);
    let problem = if angles.len() == joints.len() {
        let mut measured = joints.iter().zip(angles);
        let unmeasured = measured.find(|(_, angle)| !angle.is_finite());
        unmeasured.map(|(joint, angle)| format!("{} is at {angle} rad", joint.name))
    } else {
        let (angles, joints) = (angles.len(), joints.len());
        Some(format!("there are {angles} for {joints} joints"))
    };
    problem.map_or(Ok(()), |problem| Err(FeltError::Angles { problem }))
}
