//! From a cycle to a [`CheckedCycle`]: pull, waypoints, twins, stops.

mod coupled;
mod steering;

use std::collections::BTreeMap;

use super::super::trajectory::{Company, note};
use super::super::{CheckedTrajectory, Clamp, LimitsPolicy, PhaseDuration};
use super::checked::Stretch;
use super::{Approach, CheckedCycle, Cycle, CycleError, Easing, FastestJoint, Steer, TimeScale};
use crate::robot::{JointAngles, JointId, Mirror, Range, Robot, SideLayout};

/// Time between two samples of a planned pull, s: commands in between are interpolated.
const SAMPLE_STEP: f64 = 0.005;

/// A cycle without a pull that has fewer waypoints goes nowhere.
const FEWEST_WITHOUT_A_PULL: usize = 2;

/// Turn of the root about +y with which a trunk lies flat on its belly, rad: its top points forward.
const FLAT_ON_THE_BELLY: f64 = std::f64::consts::FRAC_PI_2;

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
        let steer = Steer { turn, shift: 0.0 };
        Self::plan_steered(robot, stops, cycle, steer, scale)
    }

    /// The same with a shift beside the turn.
    ///
    /// # Errors
    /// [`CycleError`], naming cycle, place, joint and amount.
    pub fn plan_steered(
        robot: &Robot,
        stops: &[Range],
        cycle: &Cycle,
        steer: Steer,
        scale: TimeScale,
    ) -> Result<Self, CycleError> {
        let turn = steer.turn;
        let planner = Planner {
            robot,
            stops,
            cycle,
            mirror: Mirror::of(robot),
        };
        planner.check_stops()?;
        planner.check_steer(steer)?;
        let pull = planner.pull(turn, scale)?;
        let mut clamps = match &pull {
            Some(pull) => pull.clamps().to_vec(),
            None => Vec::new(),
        };
        let mut stretches = planner.waypoints(steer, scale, &mut clamps)?;
        let (extension, root_pitch) = match (&pull, &cycle.pull) {
            (Some(planned), Some(pull)) => {
                let first = planned.first();
                stretches.push(Stretch {
                    name: "extension".to_owned(),
                    approach: planner.scaled("extension", pull.approach, scale)?,
                    targets: first.joints.as_slice().iter().copied().map(Some).collect(),
                });
                (first.joints.clone(), first.root_pitch)
            }
            _ => (planner.last_posture(&stretches), FLAT_ON_THE_BELLY),
        };
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
        let aside = planner.aside(pull.as_ref(), turn, scale)?;
        let mut checked = Self {
            name: cycle.name.clone(),
            steer,
            pull,
            extension,
            root_pitch,
            stretches,
            aside,
            stops: stops.to_vec(),
            clamps: Vec::new(),
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
            coupled: robot.coupled_limits.as_slice().into(),
        };
        checked.fastest = checked.pull_speed()?;
        let path = checked.path(&checked);
        checked.fastest = checked.recovery_speed(&path)?;
        planner.check_coupled(&checked, &path, &mut clamps)?;
        clamps.sort_by_key(|clamp| clamp.joint);
        checked.clamps = clamps;
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
    /// Of a pull the trajectory says the same.
    fn check_stops(&self) -> Result<(), CycleError> {
        let (stops, joints) = (self.stops.len(), self.robot.joints.len());
        if stops == joints || self.cycle.pull.is_some() {
            return Ok(());
        }
        Err(CycleError::Stops {
            cycle: self.cycle.name.clone(),
            stops,
            robot: self.robot.name.clone(),
            joints,
        })
    }

    fn pull(&self, turn: f64, scale: TimeScale) -> Result<Option<CheckedTrajectory>, CycleError> {
        let (Some(pull), Some(gait)) = (&self.cycle.pull, self.cycle.gait()) else {
            return Ok(None);
        };
        let seconds = pull.duration.seconds() * scale.value();
        let duration = PhaseDuration::new(seconds).map_err(|source| CycleError::Duration {
            cycle: self.cycle.name.clone(),
            source,
        })?;
        let company = self.with_twins("pull", &pull.company)?;
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
        let intervals = intervals(duration);
        let planned = CheckedTrajectory::plan_in_company(
            self.robot, self.stops, &gait, duration, intervals, at,
        )?;
        Ok(Some(planned))
    }

    fn check_outside_chain(&self, place: &str, joint: JointId) -> Result<(), CycleError> {
        let chain = self.robot.chain.sides().map(SideLayout::commanded_joints);
        if !chain.iter().flatten().any(|&id| id == joint) {
            return Ok(());
        }
        Err(CycleError::ChainJoint {
            cycle: self.cycle.name.clone(),
            place: place.to_owned(),
            joint: self.robot.joints[joint.0].name.clone(),
        })
    }

    fn waypoints(
        &self,
        steer: Steer,
        scale: TimeScale,
        clamps: &mut Vec<Clamp>,
    ) -> Result<Vec<Stretch>, CycleError> {
        if self.cycle.pull.is_none() && self.cycle.waypoints.len() < FEWEST_WITHOUT_A_PULL {
            return Err(CycleError::FewWaypoints {
                cycle: self.cycle.name.clone(),
                waypoints: self.cycle.waypoints.len(),
            });
        }
        let mut stretches = Vec::with_capacity(self.cycle.waypoints.len() + 2);
        for (index, waypoint) in self.cycle.waypoints.iter().enumerate() {
            let place = format!("waypoint {}", waypoint.name);
            let mut targets = vec![None; self.robot.joints.len()];
            if index == 0 && self.cycle.pull.is_some() {
                // A turn's joints go back.
                for (joint, _) in self.swing()? {
                    targets[joint.0] = Some(0.0);
                }
            }
            let added = self.added(&place, waypoint, steer)?;
            for (joint, sign, &angle) in self.with_twins(&place, &waypoint.joints)? {
                let angle = sign * angle + added.get(&joint).copied().unwrap_or_default();
                targets[joint.0] = Some(self.within_stop(&place, joint, angle, clamps)?);
            }
            if let Some((joint, _)) = added.iter().find(|(joint, _)| targets[joint.0].is_none()) {
                return Err(CycleError::NothingToTurn {
                    cycle: self.cycle.name.clone(),
                    place,
                    joint: self.robot.joints[joint.0].name.clone(),
                });
            }
            stretches.push(Stretch {
                name: waypoint.name.clone(),
                approach: self.scaled(&place, waypoint.approach, scale)?,
                targets,
            });
        }
        Ok(stretches)
    }

    /// The posture at the end of the waypoints, which a cycle without a pull begins with: joints
    /// that none of them names are at zero, or at the stop that is next to it.
    fn last_posture(&self, stretches: &[Stretch]) -> JointAngles {
        let mut posture = JointAngles::zero(self.robot).within(self.stops);
        for stretch in stretches {
            posture = posture.map(|joint, now| stretch.targets[joint.0].unwrap_or(now));
        }
        for limit in &self.robot.coupled_limits {
            limit.clamp(&mut posture);
        }
        posture
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
        if self.cycle.limits == LimitsPolicy::Refuse || excess.is_nan() {
            return Err(CycleError::Limit {
                cycle: self.cycle.name.clone(),
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
                cycle: self.cycle.name.clone(),
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
            cycle: self.cycle.name.clone(),
            place: place.to_owned(),
            robot: self.robot.name.clone(),
            joint: name.to_owned(),
            known: self.robot.joints.iter().map(|it| it.name.clone()).collect(),
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

#[cfg(test)]
mod tests;
