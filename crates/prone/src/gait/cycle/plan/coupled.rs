//! Limits that depend on another joint, along the waypoints of a planned cycle.

use super::super::super::trajectory::note;
use super::super::super::{Clamp, LimitsPolicy};
use super::super::{BeyondCoupled, CheckedCycle, CycleError, RecoveryPath};
use super::Planner;
use crate::robot::JointAngles;

/// Time between two postures that are looked at, s.
const COUPLED_STEP: f64 = 0.01;

impl Planner<'_> {
    /// Holds a planned cycle against limits that depend on another joint: what lies beyond is an
    /// error or noted, by the cycle's policy. Postures of the way are kept within as they are made
    /// ([`RecoveryPath::at`]).
    pub(super) fn check_coupled(
        &self,
        checked: &CheckedCycle,
        path: &RecoveryPath,
        clamps: &mut Vec<Clamp>,
    ) -> Result<(), CycleError> {
        if self.robot.coupled_limits.is_empty() {
            return Ok(());
        }
        let seconds = checked.recovery_seconds();
        let mut begin = 0.0;
        for (name, end) in checked.recovery_ends() {
            let place = format!("waypoint {name}");
            let mut time: f64 = begin;
            while time < end {
                let posture = path.straight(time);
                self.within_coupled(&place, &posture, time / seconds, clamps)?;
                time += COUPLED_STEP;
            }
            // Each waypoint is looked at, wherever the steps fall.
            self.within_coupled(&place, &path.straight(end), end / seconds, clamps)?;
            begin = time;
        }
        Ok(())
    }

    fn within_coupled(
        &self,
        place: &str,
        posture: &JointAngles,
        share: f64,
        clamps: &mut Vec<Clamp>,
    ) -> Result<(), CycleError> {
        for limit in &self.robot.coupled_limits {
            let (range, angle) = (limit.range(posture[limit.by]), posture[limit.joint]);
            let excess = range.excess(angle);
            if excess == 0.0 {
                continue;
            }
            if self.cycle.limits == LimitsPolicy::Refuse || excess.is_nan() {
                return Err(CycleError::Coupled {
                    cycle: self.cycle.name.clone(),
                    place: place.to_owned(),
                    beyond: Box::new(BeyondCoupled {
                        joint: self.robot.joints[limit.joint.0].name.clone(),
                        by: self.robot.joints[limit.by.0].name.clone(),
                        at: posture[limit.by],
                        angle,
                        lower: range.lower,
                        upper: range.upper,
                    }),
                });
            }
            note(clamps, limit.joint, excess, share);
        }
        Ok(())
    }
}
