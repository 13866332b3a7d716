//! What is followed over time: a phase of a cycle, or what comes before the first one.

use std::sync::Arc;

use crate::gait::cycle::{CheckedCycle, Easing, RecoveryPath};
use crate::port::{JointCommand, Knot, Segment};
use crate::robot::{JointAngles, Range, Robot};

use super::error::CrawlerError;
use super::pilot::Stage;
use super::program::Begin;

/// Shortest way to the first posture, s: nothing begins with a jerk.
const SHORTEST_WAY: f64 = 0.5;

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

impl PhaseKind {
    /// The phases of a cycle, in order.
    pub(super) const ALL: [Self; 2] = [Self::ClosedChain, Self::Waypoints];
}

impl Course {
    /// The way to a posture from where the joints are measured, none of which may be so far beyond
    /// its stop that it cannot be there: as long as all need together where none passes a share of
    /// its speed limit.
    pub(super) fn way(
        robot: &Robot,
        stops: &[Range],
        measured: &JointAngles,
        to: &JointAngles,
        speed: f64,
    ) -> Result<Self, CrawlerError> {
        let mut joints = robot.joints.iter().zip(stops).zip(measured.as_slice());
        let beyond =
            joints.find(|((_, stop), angle)| stop.excess(**angle).abs() > Begin::BEYOND_STOP);
        if let Some(((joint, stop), &angle)) = beyond {
            return Err(CrawlerError::BeyondStop {
                joint: joint.name.clone(),
                angle,
                lower: stop.lower,
                upper: stop.upper,
                most: Begin::BEYOND_STOP,
            });
        }
        let joints = robot.joints.iter().zip(measured.pairs(to));
        let times = joints.map(|(joint, (from, to))| {
            Easing::Smoothstep.peak_speed() * (to - from).abs() / (speed * joint.speed_limit)
        });
        Ok(Self::Way {
            from: measured.within(stops),
            to: to.clone(),
            seconds: times.fold(SHORTEST_WAY, f64::max),
        })
    }

    /// How long it lasts, s.
    pub(super) fn seconds(&self) -> f64 {
        match self {
            Self::Way { seconds, .. }
            | Self::Rest { seconds, .. }
            | Self::Recovery { seconds, .. } => *seconds,
            Self::Pull(cycle) => cycle.pull().duration().seconds(),
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
                Stage::Pull {
                    s,
                    planned_pitch: cycle.pull().nearest(s).root_pitch,
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
