//! What a cycle is steered by, in joint angles: in the pull, after it, and at waypoints.

use std::collections::BTreeMap;

use super::super::super::CheckedTrajectory;
use super::super::{CycleError, Steer, TimeScale, Waypoint};
use super::Planner;
use crate::robot::JointId;

impl Planner<'_> {
    /// An error where the cycle cannot be steered so far.
    pub(super) fn check_steer(&self, Steer { turn, shift }: Steer) -> Result<(), CycleError> {
        let steering = self.cycle.steering.as_ref();
        let limits = steering.map_or((0.0, 0.0), |it| (it.limit, it.shift_limit));
        for (what, asked, limit) in [("turn", turn, limits.0), ("shift", shift, limits.1)] {
            // NaN is within no limit.
            if !(-limit..=limit).contains(&asked) {
                return Err(CycleError::Turn {
                    cycle: self.cycle.name.clone(),
                    what,
                    asked_deg: asked.to_degrees(),
                    limit_deg: limit.to_degrees(),
                });
            }
        }
        Ok(())
    }

    /// The joints that the steering moves, with their factors of the turn.
    pub(super) fn swing(&self) -> Result<Vec<(JointId, f64)>, CycleError> {
        let named = self.cycle.steering.iter().flat_map(|it| &it.joints);
        let swing = named.map(|(name, &factor)| {
            let joint = self.joint("steering", name)?;
            self.check_outside_chain("steering", joint)?;
            Ok((joint, factor))
        });
        swing.collect()
    }

    /// By how much a turn moves each joint at the end of the pull, rad; 0 for the joints that the
    /// steering names, which go back with the first waypoint.
    pub(super) fn aside(
        &self,
        pull: Option<&CheckedTrajectory>,
        turn: f64,
        scale: TimeScale,
    ) -> Result<Vec<f64>, CycleError> {
        let none = vec![0.0; self.robot.joints.len()];
        let Some(pull) = pull.filter(|_| turn != 0.0) else {
            return Ok(none);
        };
        let Some(straight) = self.pull(0.0, scale)? else {
            return Ok(none);
        };
        let pairs = pull.last().joints.pairs(&straight.last().joints);
        let mut aside: Vec<f64> = pairs.map(|(turned, straight)| turned - straight).collect();
        for (joint, _) in self.swing()? {
            aside[joint.0] = 0.0;
        }
        Ok(aside)
    }

    /// What turn and shift add to the joints of a waypoint, rad.
    pub(super) fn added(
        &self,
        place: &str,
        waypoint: &Waypoint,
        steer: Steer,
    ) -> Result<BTreeMap<JointId, f64>, CycleError> {
        let steering = self.cycle.steering.as_ref();
        let w = steering.map_or(0.0, |steering| steering.at_waypoints(steer.turn));
        let x = steering.map_or(0.0, |steering| steering.shift_at_waypoints(steer.shift));
        let mut added: BTreeMap<JointId, f64> = BTreeMap::new();
        for (factors, command) in [(&waypoint.turn, w), (&waypoint.shift, x)] {
            for (name, factor) in factors {
                let joint = self.joint(place, name)?;
                *added.entry(joint).or_default() += factor * command;
                let twin = self.mirror.twin(joint);
                let twin = twin.filter(|twin| {
                    let name = &self.robot.joints[twin.joint.0].name;
                    twin.joint != joint && !factors.contains_key(name)
                });
                if let Some(twin) = twin {
                    *added.entry(twin.joint).or_default() -= twin.sign * factor * command;
                }
            }
        }
        Ok(added)
    }
}
