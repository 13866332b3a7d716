//! A cycle held against a robot: the only thing that a crawl commands.

use std::collections::BTreeMap;

use super::super::trajectory::{Company, note};
use super::super::{
    CheckedTrajectory, Clamp, Curve, LimitsPolicy, PhaseDuration, PhaseDurationError,
    TrajectoryError,
};
use super::{Approach, Cycle, Steering, TimeScale};
use crate::robot::{JointAngles, JointId, Mirror, Range, Robot, SideLayout};

/// Time between two samples of a planned pull, s: commands in between are interpolated.
const SAMPLE_STEP: f64 = 0.005;

/// A cycle whose every posture lies within the stops it was planned for and whose every joint
/// speed lies within the robot's limits.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckedCycle {
    name: String,
    turn: f64,
    pull: CheckedTrajectory,
    /// The recovery, waypoint by waypoint; the last is the extension.
    stretches: Vec<Stretch>,
    /// By how much the turn has moved each joint at the end of the pull, rad; 0 for those that the
    /// recovery puts back at once.
    aside: Vec<f64>,
    stops: Vec<Range>,
    clamps: Vec<Clamp>,
    fastest: FastestJoint,
    speed_limits: Vec<(String, f64)>,
}

#[derive(Debug, Clone, PartialEq)]
struct Stretch {
    name: String,
    approach: Approach,
    /// Where each joint goes, rad; `None` where it stays.
    targets: Vec<Option<f64>>,
}

/// The joint that comes nearest to its speed limit.
#[derive(Debug, Clone, PartialEq)]
pub struct FastestJoint {
    /// The maker's name.
    pub joint: String,
    /// Its largest commanded speed, rad/s.
    pub speed: f64,
    /// The maker's limit, rad/s.
    pub limit: f64,
}

/// The recovery from a given posture, over time.
#[derive(Debug, Clone, PartialEq)]
pub struct RecoveryPath {
    from: JointAngles,
    legs: Vec<(Approach, JointAngles)>,
}

/// Why a cycle cannot be crawled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CycleError {
    /// The pull has no trajectory.
    #[error(transparent)]
    Pull(#[from] TrajectoryError),
    /// The pull would be too short or too long at this time scale.
    #[error("cycle {cycle}: {source}")]
    Duration {
        /// The cycle's name.
        cycle: String,
        /// What is wrong.
        source: PhaseDurationError,
    },
    /// A joint that the robot does not have.
    #[error("cycle {cycle}, {place}: robot {robot} has no joint {joint}")]
    UnknownJoint {
        /// The cycle's name.
        cycle: String,
        /// Pull, steering or a waypoint.
        place: String,
        /// The robot's name.
        robot: String,
        /// The joint's name.
        joint: String,
    },
    /// A joint that the chain commands already.
    #[error("cycle {cycle}, {place}: {joint} belongs to the chain, which moves it")]
    ChainJoint {
        /// The cycle's name.
        cycle: String,
        /// Pull or steering.
        place: String,
        /// The joint's name.
        joint: String,
    },
    /// A stretch of the recovery that takes no time, or ages.
    #[error("cycle {cycle}, {place}: {seconds} s is outside {}..{} s", Cycle::STRETCH_SECONDS.0, Cycle::STRETCH_SECONDS.1)]
    Seconds {
        /// The cycle's name.
        cycle: String,
        /// The waypoint.
        place: String,
        /// What was asked for.
        seconds: f64,
    },
    /// A turn that the cycle has no steering for.
    #[error("cycle {cycle}: a turn of {turn_deg:.2}° is more than its steering's {limit_deg:.2}°")]
    Turn {
        /// The cycle's name.
        cycle: String,
        /// What was asked for, degrees.
        turn_deg: f64,
        /// The largest, degrees; 0 without steering.
        limit_deg: f64,
    },
    /// A joint of a waypoint passes its limit and the policy is to refuse.
    #[error(
        "cycle {cycle}, {place}: {joint} {angle:.4} rad is outside {lower:.4}..{upper:.4}, by {excess:.4} rad; \
         `limits = \"clamp\"` in the file would stop it there"
    )]
    Limit {
        /// The cycle's name.
        cycle: String,
        /// The waypoint.
        place: String,
        /// The joint's name.
        joint: String,
        /// What is asked for, rad.
        angle: f64,
        /// The lower stop, rad.
        lower: f64,
        /// The upper stop, rad.
        upper: f64,
        /// How far outside, rad.
        excess: f64,
    },
    /// A joint would have to be faster than it is.
    #[error(
        "cycle {cycle}, {place}: {joint} would need {speed:.2} rad/s, above its limit of {limit:.2} rad/s"
    )]
    Speed {
        /// The cycle's name.
        cycle: String,
        /// The pull or the waypoint that it goes to.
        place: String,
        /// The joint's name.
        joint: String,
        /// The largest speed, rad/s.
        speed: f64,
        /// The maker's limit, rad/s.
        limit: f64,
    },
}

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

    /// The cycle's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The turn command, rad.
    pub const fn turn(&self) -> f64 {
        self.turn
    }

    /// The posture in which the pull begins.
    pub fn extension(&self) -> &JointAngles {
        &self.pull.samples()[0].joints
    }

    /// The posture in which the pull ends.
    pub fn compression(&self) -> &JointAngles {
        last(&self.pull)
    }

    /// The closed-chain phase.
    pub const fn pull(&self) -> &CheckedTrajectory {
        &self.pull
    }

    /// Joint angles at a time since the pull began, s.
    pub fn pull_at(&self, seconds: f64) -> JointAngles {
        self.pull.at(seconds / self.pull.duration().seconds())
    }

    /// How long the recovery lasts, s.
    pub fn recovery_seconds(&self) -> f64 {
        let times = self
            .stretches
            .iter()
            .map(|stretch| stretch.approach.seconds);
        times.sum()
    }

    /// Names of the recovery's stretches, each with the time at which it ends, s.
    pub fn recovery_ends(&self) -> Vec<(&str, f64)> {
        let mut end = 0.0;
        let stretches = self.stretches.iter().map(|stretch| {
            end += stretch.approach.seconds;
            (stretch.name.as_str(), end)
        });
        stretches.collect()
    }

    /// The way to this cycle's extension from where the pull of `previous`, planned for the same
    /// robot and stops, has ended.
    ///
    /// # Errors
    /// [`CycleError::Speed`] where a joint would have to be too fast.
    pub fn recovery_after(&self, previous: &Self) -> Result<RecoveryPath, CycleError> {
        let path = self.path(previous);
        self.recovery_speed(&path)?;
        Ok(path)
    }

    fn path(&self, previous: &Self) -> RecoveryPath {
        let from = previous.compression().clone();
        let mut posture = from.clone();
        let legs = self.stretches.iter().enumerate().map(|(index, stretch)| {
            let angles = stretch
                .targets
                .iter()
                .enumerate()
                .map(|(joint, to)| match to {
                    None => posture.as_slice()[joint],
                    // At the first waypoint the arms are still planted where the last turn has put them.
                    Some(to) if index == 0 && self.stretches.len() > 1 => {
                        let stop = self.stops[joint];
                        (to + previous.aside[joint]).clamp(stop.lower, stop.upper)
                    }
                    Some(to) => *to,
                });
            posture = JointAngles::from_vec(angles.collect());
            (stretch.approach, posture.clone())
        });
        let legs = legs.collect();
        RecoveryPath { from, legs }
    }

    /// What was clamped, by joint; a waypoint counts as a sample at phase 1.
    pub fn clamps(&self) -> &[Clamp] {
        &self.clamps
    }

    /// The joint that comes nearest to its speed limit.
    pub const fn fastest(&self) -> &FastestJoint {
        &self.fastest
    }

    fn pull_speed(&self) -> Result<FastestJoint, CycleError> {
        let samples = self.pull.samples();
        let step = self.pull.duration().seconds() / (samples.len() - 1) as f64;
        let mut fastest = vec![0.0_f64; self.speed_limits.len()];
        for pair in samples.windows(2) {
            let (from, to) = (pair[0].joints.as_slice(), pair[1].joints.as_slice());
            for ((fastest, from), to) in fastest.iter_mut().zip(from).zip(to) {
                *fastest = fastest.max((to - from).abs() / step);
            }
        }
        self.within_speeds("pull", &fastest)
    }

    fn recovery_speed(&self, path: &RecoveryPath) -> Result<FastestJoint, CycleError> {
        let mut nearest = self.fastest.clone();
        let mut from = &path.from;
        for (stretch, (approach, to)) in self.stretches.iter().zip(&path.legs) {
            let mean = approach.easing.peak_speed() / approach.seconds;
            let ways = from.as_slice().iter().zip(to.as_slice());
            let speeds: Vec<f64> = ways.map(|(from, to)| mean * (to - from).abs()).collect();
            let fastest = self.within_speeds(&stretch.name, &speeds)?;
            if fastest.share() > nearest.share() {
                nearest = fastest;
            }
            from = to;
        }
        Ok(nearest)
    }

    /// The joint of largest speed over limit; an error where it is over.
    fn within_speeds(&self, place: &str, speeds: &[f64]) -> Result<FastestJoint, CycleError> {
        let joints = self.speed_limits.iter().zip(speeds);
        let fastest = joints
            .map(|((joint, limit), &speed)| FastestJoint {
                joint: joint.clone(),
                speed,
                limit: *limit,
            })
            .max_by(|a, b| a.share().total_cmp(&b.share()));
        let fastest = fastest.unwrap_or_else(|| self.fastest.clone());
        if fastest.share() > 1.0 {
            return Err(CycleError::Speed {
                cycle: self.name.clone(),
                place: place.to_owned(),
                joint: fastest.joint,
                speed: fastest.speed,
                limit: fastest.limit,
            });
        }
        Ok(fastest)
    }
}

impl FastestJoint {
    /// Speed over limit.
    pub fn share(&self) -> f64 {
        self.speed / self.limit
    }
}

impl RecoveryPath {
    /// Joint angles at a time since the recovery began, s.
    pub fn at(&self, seconds: f64) -> JointAngles {
        let mut begin = 0.0;
        let mut from = &self.from;
        for (approach, to) in &self.legs {
            let share = (seconds - begin) / approach.seconds;
            if share < 1.0 {
                return from.towards(to, approach.easing.share(share));
            }
            begin += approach.seconds;
            from = to;
        }
        from.clone()
    }
}

fn last(pull: &CheckedTrajectory) -> &JointAngles {
    let samples = pull.samples();
    &samples[samples.len() - 1].joints
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
        let mut aside = vec![0.0; self.robot.joints.len()];
        if turn == 0.0 {
            return Ok(aside);
        }
        let straight = self.pull(duration, 0.0)?;
        let pairs = last(pull).as_slice().iter().zip(last(&straight).as_slice());
        for (aside, (turned, straight)) in aside.iter_mut().zip(pairs) {
            *aside = turned - straight;
        }
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
