//! A cycle that has been planned, and the pitch of its trunk.

use crate::gait::cycle::{CheckedCycle, Cycle, CycleError, TimeScale};
use crate::mapping::{Mapping, MappingError};
use crate::robot::{JointAngles, Range, Robot};

/// A cycle ready to be commanded.
#[derive(Debug, Clone)]
pub(super) struct Planned {
    pub(super) checked: CheckedCycle,
    mapping: Mapping,
}

/// Where a crawl begins.
#[derive(Debug, Clone, PartialEq)]
pub struct FirstPose {
    /// The first cycle's extension.
    pub posture: JointAngles,
    /// Turn of the root about +y, rad, with which the planned chain lies on a level floor there.
    pub root_pitch: f64,
}

/// Why a cycle has no plan.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PlanError {
    Cycle(Box<CycleError>),
    Mapping(MappingError),
}

impl Planned {
    pub(super) fn new(
        robot: &Robot,
        stops: &[Range],
        cycle: &Cycle,
        turn: f64,
        scale: TimeScale,
    ) -> Result<Self, PlanError> {
        let pull = &cycle.pull;
        Ok(Self {
            checked: CheckedCycle::plan(robot, stops, cycle, turn, scale)
                .map_err(|error| PlanError::Cycle(Box::new(error)))?,
            mapping: Mapping::new(robot, pull.mapping, pull.arm).map_err(PlanError::Mapping)?,
        })
    }

    pub(super) fn first_pose(&self) -> FirstPose {
        FirstPose {
            posture: self.checked.extension().clone(),
            root_pitch: self.root_pitch(0.0),
        }
    }

    /// Pitch of the root in the planned chain at a phase, rad.
    pub(super) fn root_pitch(&self, s: f64) -> f64 {
        let samples = self.checked.pull().samples();
        let last = samples.len() - 1;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and the number of samples"
        )]
        let nearest = ((s.clamp(0.0, 1.0) * last as f64).round() as usize).min(last);
        self.mapping.root_pitch(&samples[nearest].chain)
    }
}
