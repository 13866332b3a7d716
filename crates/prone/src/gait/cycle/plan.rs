//! From a cycle to a [`CheckedCycle`]: turn, twins, stops.

use std::collections::BTreeMap;

use super::super::trajectory::{Company, note};
use super::super::{CheckedTrajectory, Clamp, Curve, LimitsPolicy, PhaseDuration};
use super::checked::{Stretch, last};
use super::{Approach, CheckedCycle, Cycle, CycleError, FastestJoint, Steering, TimeScale};
use crate::robot::{JointId, Mirror, Range, Robot, SideLayout};

/// Time between two samples of a planned pull, s: commands in between are interpolated.
const SAMPLE_STEP: f64 = 0.005;

impl CheckedCycle {
    /// Plans a cycle with a turn command, rad, at a time scale, and holds it against `stops` (one
    /// per joint) and the robot's joint speeds.
    ///
    /// # Errors
    /// [`CycleError`], naming cycle, place, joint and amount.
    pub fn plan(
        robot: &Robot,
        stops: &[Range],
        cycle: &Cycle,
        turn: f64,
        scale: TimeScale,
    ) -> Result<Self, CycleError> {
        let planner = Planner {
            robot,
            stops,
            cycle,
            mirror: Mirror::of(robot),
        };
        planner.check_turn(turn)?;
        let seconds = cycle.pull_duration.seconds() * scale.value();
        let duration = PhaseDuration::new(seconds).map_err(|source| CycleError::Duration {
            cycle: cycle.pull.name.clone(),
            source,
        })?;
        let pull = planner.pull(duration, turn)?;
        let aside = planner.aside(&pull, duration, turn)?;
        let mut clamps = pull.clamps().to_vec();
        let mut stretches = planner.waypoints(scale, &mut clamps)?;
        stretches.push(Stretch {
            name: "extension".to_owned(),
            approach: planner.scaled("extension", cycle.approach, scale)?,
            targets: pull.samples()[0]
                .joints
                .as_slice()
                .iter()
                .copied()
                .map(Some)
                .collect(),
        });
        clamps.sort_by_key(|clamp| clamp.joint);
        let mut checked = Self {
            name: cycle.pull.name.clone(),
            turn,
            pull,
            stretches,
            aside,
            stops: stops.to_vec(),
            clamps,
            fastest: FastestJoint {
                joint: String::new(),
                speed: 0.0,
                limit: f64::INFINITY,
            },
            speed_limits: robot
                .joints
                .iter()
                .map(|joint| (joint.name.clone(), joint.speed_limit))
                .collect(),
        };
        checked.fastest = checked.pull_speed()?;
        let recovery = checked.recovery_speed(&checked.path(&checked))?;
        if recovery.share() > checked.fastest.share() {
            checked.fastest = recovery;
        }
        Ok(checked)
    }
}

struct Planner<'a> {
    robot: &'a Robot,
    stops: &'a [Range],
    cycle: &'a Cycle,
    mirror: Mirror,
}

impl Planner<'_> {
    fn check_turn(&self, turn: f64) -> Result<(), CycleError> {
        let limit = self
            .cycle
            .steering
            .as_ref()
            .map_or(0.0, |steering| steering.limit);
        // NaN is no turn either.
        if turn.abs() <= limit {
            return Ok(());
        }
        Err(CycleError::Turn {
            cycle: self.cycle.pull.name.clone(),
            turn_deg: turn.to_degrees(),
            limit_deg: limit.to_degrees(),
        })
    }

    fn pull(&self, duration: PhaseDuration, turn: f64) -> Result<CheckedTrajectory, CycleError> {
        let chain = self.robot.chain.sides().map(SideLayout::commanded_joints);
        let outside = |place: &str, joint: JointId| {
            if chain.iter().flatten().any(|&id| id == joint) {
                return Err(CycleError::ChainJoint {
                    cycle: self.cycle.pull.name.clone(),
                    place: place.to_owned(),
                    joint: self.robot.joints[joint.0].name.clone(),
                });
            }
            Ok(joint)
        };
        let mut company: Vec<(JointId, f64, &Curve)> = Vec::new();
        for (joint, sign, curve) in self.with_twins("pull", &self.cycle.company)? {
            company.push((outside("pull", joint)?, sign, curve));
        }
        let mut swing: Vec<(JointId, f64)> = Vec::new();
        let mut spread = 0.0;
        if let Some(Steering {
            spread: k, joints, ..
        }) = &self.cycle.steering
        {
            spread = *k;
            for (name, &factor) in joints {
                swing.push((outside("steering", self.joint("steering", name)?)?, factor));
            }
        }
        let at = |s: f64| {
            let asymmetry = turn * (1.0 - 2.0 * s);
            let along = company
                .iter()
                .map(|&(joint, sign, curve)| (joint, sign * curve.value(s)));
            let mut joints: Vec<_> = along.collect();
            joints.extend(
                swing
                    .iter()
                    .map(|&(joint, factor)| (joint, factor * asymmetry)),
            );
            Company {
                spread: [spread * asymmetry, -spread * asymmetry],
                joints,
            }
        };
        let gait = &self.cycle.pull;
        let intervals = intervals(duration);
        Ok(CheckedTrajectory::plan_in_company(
            self.robot, self.stops, gait, duration, intervals, at,
        )?)
    }

    /// By how much a turn moves each joint at the end of the pull, rad; 0 for the joints that the
    /// steering names, which go back with the first waypoint.
    fn aside(
        &self,
        pull: &CheckedTrajectory,
        duration: PhaseDuration,
        turn: f64,
    ) -> Result<Vec<f64>, CycleError> {
        if turn == 0.0 {
            return Ok(vec![0.0; self.robot.joints.len()]);
        }
        let straight = self.pull(duration, 0.0)?;
        let pairs = last(pull).pairs(last(&straight));
        let mut aside: Vec<f64> = pairs.map(|(turned, straight)| turned - straight).collect();
        if let Some(steering) = &self.cycle.steering {
            for name in steering.joints.keys() {
                aside[self.joint("steering", name)?.0] = 0.0;
            }
        }
        Ok(aside)
    }

    fn waypoints(
        &self,
        scale: TimeScale,
        clamps: &mut Vec<Clamp>,
    ) -> Result<Vec<Stretch>, CycleError> {
        let mut stretches = Vec::with_capacity(self.cycle.recovery.len() + 1);
        for (index, waypoint) in self.cycle.recovery.iter().enumerate() {
            let place = format!("waypoint {}", waypoint.name);
            let mut targets = vec![None; self.robot.joints.len()];
            if let (0, Some(steering)) = (index, &self.cycle.steering) {
                // A turn's joints go back.
                for name in steering.joints.keys() {
                    targets[self.joint("steering", name)?.0] = Some(0.0);
                }
            }
            for (joint, sign, &angle) in self.with_twins(&place, &waypoint.joints)? {
                targets[joint.0] = Some(self.within_stop(&place, joint, sign * angle, clamps)?);
            }
            stretches.push(Stretch {
                name: waypoint.name.clone(),
                approach: self.scaled(&place, waypoint.approach, scale)?,
                targets,
            });
        }
        Ok(stretches)
    }

    fn within_stop(
        &self,
        place: &str,
        id: JointId,
        angle: f64,
        clamps: &mut Vec<Clamp>,
    ) -> Result<f64, CycleError> {
        let stop = self.stops[id.0];
        if stop.contains(angle) {
            return Ok(angle);
        }
        let excess = stop.excess(angle);
        if self.cycle.pull.limits == LimitsPolicy::Refuse || excess.is_nan() {
            return Err(CycleError::Limit {
                cycle: self.cycle.pull.name.clone(),
                place: place.to_owned(),
                joint: self.robot.joints[id.0].name.clone(),
                angle,
                lower: stop.lower,
                upper: stop.upper,
                excess: excess.abs(),
            });
        }
        note(clamps, id, excess, 1.0);
        Ok(angle.clamp(stop.lower, stop.upper))
    }

    fn scaled(
        &self,
        place: &str,
        approach: Approach,
        scale: TimeScale,
    ) -> Result<Approach, CycleError> {
        let (least, most) = Cycle::STRETCH_SECONDS;
        if !(least..=most).contains(&approach.seconds) {
            return Err(CycleError::Seconds {
                cycle: self.cycle.pull.name.clone(),
                place: place.to_owned(),
                seconds: approach.seconds,
            });
        }
        Ok(Approach {
            seconds: approach.seconds * scale.value(),
            ..approach
        })
    }

    /// The named joints, and the twins of those whose twin is not named, with their sign.
    fn with_twins<'v, V>(
        &self,
        place: &str,
        named: &'v BTreeMap<String, V>,
    ) -> Result<Vec<(JointId, f64, &'v V)>, CycleError> {
        let mut joints = Vec::with_capacity(2 * named.len());
        for (name, value) in named {
            let id = self.joint(place, name)?;
            joints.push((id, 1.0, value));
            let twin = self.mirror.twin(id);
            let twin = twin.filter(|twin| {
                twin.joint != id && !named.contains_key(&self.robot.joints[twin.joint.0].name)
            });
            joints.extend(twin.map(|twin| (twin.joint, twin.sign, value)));
        }
        Ok(joints)
    }

    fn joint(&self, place: &str, name: &str) -> Result<JointId, CycleError> {
        let unknown = || CycleError::UnknownJoint {
            cycle: self.cycle.pull.name.clone(),
            place: place.to_owned(),
            robot: self.robot.name.clone(),
            joint: name.to_owned(),
        };
        self.robot.joint(name).ok_or_else(unknown)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a phase lasts 0.1 to 600 s, so this is 20 to 120,000"
)]
fn intervals(duration: PhaseDuration) -> usize {
    (duration.seconds() / SAMPLE_STEP).round() as usize
}
