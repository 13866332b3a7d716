//! What is followed over time: a phase of a cycle, or what comes before the first one.

use std::sync::Arc;

use crate::gait::cycle::{CycleError, Easing, RecoveryPath};
use crate::port::{JointCommand, Knot, Segment};
use crate::robot::JointAngles;

use super::pilot::Stage;
use super::planned::Planned;

/// Kind of a phase of a cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PhaseKind {
    /// Toes and elbows are planted, and the closed chain carries the body.
    ClosedChain,
    /// Limbs go from waypoint to waypoint as open chains.
    Waypoints,
}

/// A path of the joints over a time.
#[derive(Debug, Clone)]
pub(super) enum Course {
    /// From where the robot lies to the first posture.
    Way {
        from: JointAngles,
        to: JointAngles,
        seconds: f64,
    },
    /// A posture that is held.
    Rest { posture: JointAngles, seconds: f64 },
    /// The closed chain of a cycle.
    Pull(Arc<Planned>),
    /// The waypoints of a cycle.
    Recovery { path: RecoveryPath, seconds: f64 },
}

impl PhaseKind {
    /// The phases of a cycle, in order.
    pub(super) const fn of(_: &Planned) -> &'static [Self] {
        &[Self::ClosedChain, Self::Waypoints]
    }

    /// The phase at whose end the pilot decides: the way back leads to what comes next.
    pub(super) fn deciding(phases: &[Self]) -> usize {
        let pull = phases.iter().position(|phase| *phase == Self::ClosedChain);
        pull.unwrap_or_else(|| phases.len().saturating_sub(1))
    }
}

impl Course {
    /// The waypoints that lead from the pull of `from` to the extension of `next`.
    pub(super) fn recovery(from: &Planned, next: &Planned) -> Result<Self, CycleError> {
        Ok(Self::Recovery {
            path: next.checked.recovery_after(&from.checked)?,
            seconds: next.checked.recovery_seconds(),
        })
    }

    /// How long it lasts, s.
    pub(super) fn seconds(&self) -> f64 {
        match self {
            Self::Way { seconds, .. }
            | Self::Rest { seconds, .. }
            | Self::Recovery { seconds, .. } => *seconds,
            Self::Pull(planned) => planned.checked.pull().duration().seconds(),
        }
    }

    /// Joint angles at a time since it began, s, rad; after its end, those of its end.
    pub(super) fn posture(&self, time: f64) -> JointAngles {
        let time = time.min(self.seconds());
        match self {
            Self::Way { from, to, seconds } => {
                from.towards(to, Easing::Smoothstep.share(time / seconds))
            }
            Self::Rest { posture, .. } => posture.clone(),
            Self::Pull(planned) => planned.checked.pull_at(time),
            Self::Recovery { path, .. } => path.at(time),
        }
    }

    /// What it is for at that time.
    pub(super) fn stage(&self, time: f64) -> Stage {
        match self {
            Self::Pull(planned) => {
                let s = time.min(self.seconds()) / self.seconds();
                Stage::Pull {
                    s,
                    planned_pitch: planned.root_pitch(s),
                }
            }
            Self::Way { .. } | Self::Rest { .. } | Self::Recovery { .. } => Stage::Recovery,
        }
    }

    /// All of it as one command: a path in time, or the posture that is held.
    pub(super) fn whole(&self, every: f64) -> JointCommand {
        match self {
            Self::Rest { posture, .. } => JointCommand::SetPoint(posture.clone()),
            Self::Way { .. } | Self::Pull(_) | Self::Recovery { .. } => {
                JointCommand::Segment(self.segment(every))
            }
        }
    }

    /// A path in time with a knot at each waypoint and no two knots farther apart than `every`, s.
    fn segment(&self, every: f64) -> Segment {
        let ends = match self {
            Self::Recovery { path, .. } => path.ends().collect(),
            Self::Way { .. } | Self::Rest { .. } | Self::Pull(_) => vec![self.seconds()],
        };
        let mut knots = Vec::new();
        let mut begin = 0.0;
        for end in ends {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "minutes over milliseconds"
            )]
            let count = ((end - begin) / every).ceil().max(1.0) as usize;
            knots.extend((1..=count).map(|knot| {
                let seconds = begin + (end - begin) * knot as f64 / count as f64;
                Knot {
                    seconds,
                    angles: self.posture(seconds),
                }
            }));
            begin = end;
        }
        Segment { knots }
    }
}
