//! Limits that depend on another joint, along the waypoints of a planned cycle.

use super::super::super::trajectory::note;
use super::super::super::{Clamp, LimitsPolicy};
use super::super::{CheckedCycle, CycleError, RecoveryPath};
use super::Planner;
use crate::robot::JointAngles;

/// Time between two postures that are looked at, s.
const COUPLED_STEP: f64 = 0.01;
/// Over less, s, as rounding may leave it before a waypoint, a difference of angles is no speed.
const SHORTEST_STEP: f64 = 1e-6;

impl Planner<'_> {
    /// Holds a planned cycle against limits that depend on another joint: what lies beyond is an
    /// error or noted, by the cycle's policy, and no joint follows its limit too fast. Postures of the
    /// way are kept within as they are made ([`RecoveryPath::at`]).
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
        let mut before = path.at(begin);
        for (name, end) in checked.recovery_ends() {
            let place = format!("waypoint {name}");
            let mut time: f64 = begin;
            while time < end {
                let posture = path.straight(time);
                self.within_coupled(&place, &posture, time / seconds, clamps)?;
                let next = (time + COUPLED_STEP).min(end);
                if next - time > SHORTEST_STEP {
                    let after = path.at(next);
                    self.slow_enough(&place, [&before, &after], next - time)?;
                    before = after;
                }
                time += COUPLED_STEP;
            }
            // Each waypoint is looked at, wherever the steps fall.
            self.within_coupled(&place, &path.straight(end), end / seconds, clamps)?;
            begin = end;
        }
        Ok(())
    }

    /// A limit that moves with another joint carries what it holds back along: no faster than any joint may
    /// move.
    fn slow_enough(
        &self,
        place: &str,
        [from, to]: [&JointAngles; 2],
        seconds: f64,
    ) -> Result<(), CycleError> {
        for limit in &self.robot.coupled_limits {
            let joint = &self.robot.joints[limit.joint.0];
            let speed = (to[limit.joint] - from[limit.joint]).abs() / seconds;
            // Rounding apart, as the joint may move at its limit by itself.
            if speed > joint.speed_limit * (1.0 + 1e-6) {
                return Err(CycleError::Speed {
                    cycle: self.cycle.name.clone(),
                    place: place.to_owned(),
                    joint: joint.name.clone(),
                    speed,
                    limit: joint.speed_limit,
                });
            }
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
            let excess = limit.excess(posture);
            if excess == 0.0 {
                continue;
            }
            if self.cycle.limits == LimitsPolicy::Refuse || excess.is_nan() {
                return Err(CycleError::Coupled {
                    cycle: self.cycle.name.clone(),
                    place: place.to_owned(),
                    beyond: Box::new(limit.beyond(self.robot, posture)),
                });
            }
            note(clamps, limit.joint, excess, share);
        }
        Ok(())
    }
}
