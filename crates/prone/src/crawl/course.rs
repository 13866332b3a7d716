//! What is followed over time: a phase of a cycle, or what comes before the first one.

use std::sync::Arc;

use crate::gait::cycle::{CheckedCycle, Easing, RecoveryPath};
use crate::port::{JointCommand, Knot, Segment};
use crate::robot::JointAngles;

use super::pilot::Stage;

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
    Pull(Arc<CheckedCycle>),
    /// The waypoints of a cycle.
    Recovery { path: RecoveryPath, seconds: f64 },
}

impl Course {
    /// How long it lasts, s.
    pub(super) fn seconds(&self) -> f64 {
        match self {
            Self::Way { seconds, .. }
            | Self::Rest { seconds, .. }
            | Self::Recovery { seconds, .. } => *seconds,
            Self::Pull(cycle) => cycle.pull_seconds(),
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
            Self::Pull(cycle) => cycle.pull_at(time),
            Self::Recovery { path, .. } => path.at(time),
        }
    }

    /// What it is for at that time.
    pub(super) fn stage(&self, time: f64) -> Stage {
        match self {
            Self::Pull(cycle) => {
                let s = time.min(self.seconds()) / self.seconds();
                let pull = cycle.pull();
                Stage::Pull {
                    s,
                    planned_pitch: pull.map_or(cycle.root_pitch(), |it| it.nearest(s).root_pitch),
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
