//! From a cycle to a [`CheckedCycle`]: turn, twins, stops.

use std::collections::BTreeMap;

use super::super::trajectory::{Company, note};
use super::super::{CheckedTrajectory, Clamp, LimitsPolicy, PhaseDuration};
use super::checked::Stretch;
use super::{Approach, CheckedCycle, Cycle, CycleError, Easing, FastestJoint, TimeScale};
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
            targets: pull
                .first()
                .joints
                .as_slice()
                .iter()
                .copied()
                .map(Some)
                .collect(),
        });
        if cycle.rest > 0.0 {
            stretches.push(Stretch {
                name: "rest".to_owned(),
                approach: Approach {
                    seconds: cycle.rest,
                    easing: Easing::Linear,
                },
                targets: vec![None; robot.joints.len()],
            });
        }
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
        checked.fastest = checked.recovery_speed(&checked.path(&checked))?;
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
        let steering = self.cycle.steering.as_ref();
        let limit = steering.map_or(0.0, |steering| steering.limit);
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
        let company = self.with_twins("pull", &self.cycle.company)?;
        for &(joint, ..) in &company {
            self.check_outside_chain("pull", joint)?;
        }
        let swing = self.swing()?;
        let steering = self.cycle.steering.as_ref();
        let spread = steering.map_or(0.0, |steering| steering.spread);
        let at = |s: f64| {
            let asymmetry = turn * (1.0 - 2.0 * s);
            let along = company.iter();
            let along = along.map(|&(joint, sign, curve)| (joint, sign * curve.value(s)));
            let swing = swing.iter();
            let swing = swing.map(|&(joint, factor)| (joint, factor * asymmetry));
            Company {
                spread: [spread * asymmetry, -spread * asymmetry],
                joints: along.chain(swing).collect(),
            }
        };
        let gait = &self.cycle.pull;
        let intervals = intervals(duration);
        Ok(CheckedTrajectory::plan_in_company(
            self.robot, self.stops, gait, duration, intervals, at,
        )?)
    }

    /// The joints that the steering moves, with their factors of the turn.
    fn swing(&self) -> Result<Vec<(JointId, f64)>, CycleError> {
        let named = self.cycle.steering.iter().flat_map(|it| &it.joints);
        let swing = named.map(|(name, &factor)| {
            let joint = self.joint("steering", name)?;
            self.check_outside_chain("steering", joint)?;
            Ok((joint, factor))
        });
        swing.collect()
    }

    fn check_outside_chain(&self, place: &str, joint: JointId) -> Result<(), CycleError> {
        let chain = self.robot.chain.sides().map(SideLayout::commanded_joints);
        if !chain.iter().flatten().any(|&id| id == joint) {
            return Ok(());
        }
        Err(CycleError::ChainJoint {
            cycle: self.cycle.pull.name.clone(),
            place: place.to_owned(),
            joint: self.robot.joints[joint.0].name.clone(),
        })
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
        let pairs = pull.last().joints.pairs(&straight.last().joints);
        let mut aside: Vec<f64> = pairs.map(|(turned, straight)| turned - straight).collect();
        for (joint, _) in self.swing()? {
            aside[joint.0] = 0.0;
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
            if index == 0 {
                // A turn's joints go back.
                for (joint, _) in self.swing()? {
                    targets[joint.0] = Some(0.0);
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
        Ok(stop.clamp(angle))
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
