//! Whole cycles as boxes of numbers.
//!
//! The box lies about a cycle that crawls already, its middle: knee, hip, upper arm and the other
//! joints of the pull at their ends and in the middle of the phase, then the waypoints' joints and
//! the times. A waypoint's joints are those that a cycle's recovery moves at all; a joint that the
//! middle's waypoint does not name is free there too, about where it stays.

use std::collections::BTreeMap;
use std::fmt;

use prone::gait::cycle::{CheckedCycle, Cycle, CycleError, Pull, Steering, TimeScale};
use prone::gait::{Curve, CurveError, PhaseDuration};
use prone::robot::{Mirror, Range, Robot};
use prone_optim::{Interval, IntervalError};

use super::candidates::PointError;

/// How far the curves of the pull may move from the middle, rad, of a box of full reach.
const CURVE_REACH: f64 = 0.35;
/// How far a waypoint's joints may, rad.
const JOINT_REACH: f64 = 0.5;
/// By which factor times may.
const TIME_REACH: f64 = 1.4;
/// How far the factors of a waypoint's turn and shift may.
const TURN_REACH: f64 = 1.0;

/// What of a cycle is free, and how far.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Free {
    /// Share of the full reach: a search about a good cycle finds more with a smaller box.
    pub reach: f64,
    /// Whether the factors of the waypoints' turns are free too.
    pub turns: bool,
}

impl Free {
    /// All but the turns, as far as it goes.
    pub const FULL: Self = Self {
        reach: 1.0,
        turns: false,
    };
}

/// Cycles about one.
#[derive(Debug, Clone)]
pub struct CycleForm {
    middle: Cycle,
    free: Free,
    variables: Vec<Variable>,
    bounds: Vec<Interval>,
    /// The point of the middle; stops keep it off the middle of its bounds.
    known: Vec<f64>,
}

/// What a number of a point is.
#[derive(Debug, Clone, PartialEq)]
enum Variable {
    /// A curve of the pull at a phase.
    Curve(PullCurve, usize),
    /// A waypoint's joint.
    Joint(usize, String),
    /// The factor of a waypoint's turn of a joint.
    Turn(usize, String),
    /// The factor of a waypoint's shift of a joint.
    Shift(usize, String),
    /// The pull's time.
    PullTime,
    /// The time of the way to a waypoint, or, beyond the last one, to the pull's first posture.
    Time(usize),
}

#[derive(Debug, Clone, PartialEq)]
enum PullCurve {
    Knee,
    Hip,
    UpperArm,
    Company(String),
}

impl fmt::Display for Variable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Curve(curve, control) => {
                let name = match curve {
                    PullCurve::Knee => "knee",
                    PullCurve::Hip => "hip",
                    PullCurve::UpperArm => "upper arm",
                    PullCurve::Company(joint) => joint,
                };
                write!(f, "the pull's {name}, control point {}", control + 1)
            }
            Self::Joint(index, joint) => write!(f, "waypoint {}, {joint}", index + 1),
            Self::Turn(index, joint) => write!(f, "waypoint {}, turn of {joint}", index + 1),
            Self::Shift(index, joint) => write!(f, "waypoint {}, shift of {joint}", index + 1),
            Self::PullTime => f.write_str("the pull's time"),
            Self::Time(index) => write!(f, "time of way {}", index + 1),
        }
    }
}

/// Phases at which a curve is free: a quadratic B-spline of three control points passes the first
/// and the last and is drawn towards the second.
const CONTROLS: usize = 3;

/// Control points of the quadratic B-spline that meets a curve at its ends and in its middle: the
/// curve itself, where it is one of these or straight.
fn controls(curve: &Curve) -> [f64; CONTROLS] {
    let [begin, middle, end] = [0.0, 0.5, 1.0].map(|s| curve.value(s));
    [begin, 2.0 * middle - 0.5 * (begin + end), end]
}

/// Why there is no box about a cycle.
#[derive(Debug, thiserror::Error)]
pub enum CycleFormError {
    /// The cycle itself cannot be crawled.
    #[error(transparent)]
    Cycle(#[from] CycleError),
    /// It has an angle outside the box.
    #[error("{variable}: {source}")]
    Interval {
        /// What it is.
        variable: String,
        /// Why it has no limits.
        source: IntervalError,
    },
    /// It makes no curve.
    #[error(transparent)]
    Curve(#[from] CurveError),
}

impl CycleForm {
    /// The box about a cycle that a robot can crawl.
    pub fn about(robot: &Robot, middle: &Cycle, free: Free) -> Result<Self, CycleFormError> {
        let middle = completed(robot, middle)?;
        let mut form = Self {
            middle,
            free,
            variables: Vec::new(),
            bounds: Vec::new(),
            known: Vec::new(),
        };
        let middle = form.middle.clone();
        if let Some(pull) = &middle.pull {
            form.pull(robot, pull)?;
        }
        for (index, waypoint) in middle.waypoints.iter().enumerate() {
            for (joint, &angle) in &waypoint.joints {
                let range = robot.joint(joint).map(|id| robot.joints[id.0].range);
                let range = range.unwrap_or(ANY);
                form.add(
                    Variable::Joint(index, joint.clone()),
                    angle,
                    JOINT_REACH,
                    range,
                )?;
            }
        }
        if free.turns {
            form.turns(&middle)?;
        }
        for (variable, seconds) in times(&middle) {
            let name = variable.to_string();
            form.variables.push(variable);
            form.known.push(seconds);
            let factor = TIME_REACH.powf(free.reach);
            let interval = Interval::new(seconds / factor, seconds * factor);
            form.bounds
                .push(interval.map_err(|source| CycleFormError::Interval {
                    variable: name,
                    source,
                })?);
        }
        Ok(form)
    }

    fn turns(&mut self, middle: &Cycle) -> Result<(), CycleFormError> {
        for (index, waypoint) in middle.waypoints.iter().enumerate() {
            for (joint, &factor) in &waypoint.turn {
                let variable = Variable::Turn(index, joint.clone());
                self.add(variable, factor, TURN_REACH, FACTORS)?;
            }
            for (joint, &factor) in &waypoint.shift {
                let variable = Variable::Shift(index, joint.clone());
                self.add(variable, factor, TURN_REACH, FACTORS)?;
            }
        }
        Ok(())
    }

    fn pull(&mut self, robot: &Robot, pull: &Pull) -> Result<(), CycleFormError> {
        for (which, curve, within) in [
            (PullCurve::Knee, &pull.knee, None),
            (PullCurve::Hip, &pull.hip, None),
            (
                PullCurve::UpperArm,
                &pull.upper_arm,
                Some(robot.search.upper_arm),
            ),
        ] {
            self.curve(&which, curve, within)?;
        }
        for (joint, curve) in &pull.company {
            let within = robot.joint(joint).map(|id| robot.joints[id.0].range);
            self.curve(&PullCurve::Company(joint.clone()), curve, within)?;
        }
        Ok(())
    }

    fn curve(
        &mut self,
        which: &PullCurve,
        curve: &Curve,
        within: Option<Range>,
    ) -> Result<(), CycleFormError> {
        for (control, value) in controls(curve).into_iter().enumerate() {
            let variable = Variable::Curve(which.clone(), control);
            self.add(variable, value, CURVE_REACH, within.unwrap_or(ANY))?;
        }
        Ok(())
    }

    fn add(
        &mut self,
        variable: Variable,
        middle: f64,
        reach: f64,
        within: Range,
    ) -> Result<(), CycleFormError> {
        let reach = reach * self.free.reach;
        let low = (middle - reach).max(within.lower);
        let high = (middle + reach).min(within.upper);
        let interval = Interval::new(low, high).map_err(|source| CycleFormError::Interval {
            variable: variable.to_string(),
            source,
        })?;
        self.variables.push(variable);
        self.bounds.push(interval);
        self.known.push(middle.clamp(low, high));
        Ok(())
    }

    /// The point of the middle.
    pub fn known(&self) -> &[f64] {
        &self.known
    }

    /// Limits of each number.
    pub fn bounds(&self) -> &[Interval] {
        &self.bounds
    }

    /// The cycle of a point.
    ///
    /// # Errors
    /// [`PointError`]; points within the bounds make curves, but the bounds about a pull that is next
    /// to as short or as long as it can be reach further than that.
    pub fn cycle(&self, point: &[f64]) -> Result<Cycle, PointError> {
        if point.len() != self.variables.len() {
            return Err(PointError::Numbers {
                numbers: point.len(),
                variables: self.variables.len(),
            });
        }
        let mut cycle = self.middle.clone();
        let mut controls: Vec<(PullCurve, Vec<f64>)> = Vec::new();
        for (variable, &value) in self.variables.iter().zip(point) {
            match variable {
                Variable::Curve(which, 0) => controls.push((which.clone(), vec![value])),
                Variable::Curve(..) => {
                    if let Some((_, values)) = controls.last_mut() {
                        values.push(value);
                    }
                }
                Variable::Joint(index, joint) => {
                    cycle.waypoints[*index].joints.insert(joint.clone(), value);
                }
                Variable::Turn(index, joint) => {
                    cycle.waypoints[*index].turn.insert(joint.clone(), value);
                }
                Variable::Shift(index, joint) => {
                    cycle.waypoints[*index].shift.insert(joint.clone(), value);
                }
                Variable::PullTime => {
                    if let Some(pull) = &mut cycle.pull {
                        pull.duration = PhaseDuration::new(value)?;
                    }
                }
                Variable::Time(index) => {
                    let waypoint = cycle.waypoints.get_mut(*index).map(|it| &mut it.approach);
                    let approach = cycle.pull.as_mut().map(|pull| &mut pull.approach);
                    if let Some(approach) = waypoint.or(approach) {
                        approach.seconds = value;
                    }
                }
            }
        }
        let Some(pull) = &mut cycle.pull else {
            return Ok(cycle);
        };
        for (which, values) in controls {
            let curve = Curve::b_spline(CONTROLS - 1, values)?;
            match which {
                PullCurve::Knee => pull.knee = curve,
                PullCurve::Hip => pull.hip = curve,
                PullCurve::UpperArm => pull.upper_arm = curve,
                PullCurve::Company(joint) => {
                    pull.company.insert(joint, curve);
                }
            }
        }
        Ok(cycle)
    }
}

/// Factors of commands that a file may have.
const FACTORS: Range = Range {
    lower: -Steering::LARGEST_FACTOR,
    upper: Steering::LARGEST_FACTOR,
};

const ANY: Range = Range {
    lower: -std::f64::consts::PI,
    upper: std::f64::consts::PI,
};

/// What of a cycle takes how long, s.
fn times(cycle: &Cycle) -> Vec<(Variable, f64)> {
    let pull = cycle.pull.as_ref();
    let own = pull.map(|pull| (Variable::PullTime, pull.duration.seconds()));
    let ways = cycle.waypoints.iter().map(|waypoint| waypoint.approach);
    let ways = ways.chain(pull.map(|pull| pull.approach)).enumerate();
    let ways = ways.map(|(index, way)| (Variable::Time(index), way.seconds));
    own.into_iter().chain(ways).collect()
}

/// The cycle with every joint that its recovery moves named at every waypoint.
fn completed(robot: &Robot, cycle: &Cycle) -> Result<Cycle, CycleError> {
    let stops = robot.stops();
    let checked = CheckedCycle::plan(robot, &stops, cycle, 0.0, TimeScale::ONE)?;
    let path = checked.recovery_after(&checked)?;
    let named: Vec<&String> = cycle
        .waypoints
        .iter()
        .flat_map(|w| w.joints.keys())
        .collect();
    let mirror = Mirror::of(robot);
    // Of two twins the one that is named; both, where both are.
    let mut joints: Vec<String> = named.iter().map(|name| (*name).clone()).collect();
    joints.sort_unstable();
    joints.dedup();
    let twins_named = |name: &str| {
        let id = robot.joint(name)?;
        let twin = mirror.twin(id)?.joint;
        (twin < id && joints.contains(&robot.joints[twin.0].name)).then_some(())
    };
    let joints: Vec<&String> = joints
        .iter()
        .filter(|name| twins_named(name).is_none())
        .collect();
    let mut completed = cycle.clone();
    let ends = checked.recovery_ends();
    for (waypoint, (_, end)) in completed.waypoints.iter_mut().zip(ends) {
        let posture = path.at(end);
        let all: BTreeMap<String, f64> = joints
            .iter()
            .filter_map(|name| {
                let id = robot.joint(name)?;
                // What the cycle asks for: a limit by another joint holds on the way there too, and
                // stops it elsewhere than at the waypoint.
                let stop = robot.joints[id.0].range;
                let asked = waypoint.joints.get(*name);
                let angle = asked.map(|angle| angle.clamp(stop.lower, stop.upper));
                Some(((*name).clone(), angle.unwrap_or(posture[id])))
            })
            .collect();
        waypoint.joints = all;
    }
    Ok(completed)
}

#[cfg(test)]
mod tests {
    use prone::gait::PhaseDurationError;
    use prone_files::shipped;
    use prone_sim::{LoadedRobot, RobotFiles};

    use super::*;

    /// The middle of the box crawls the middle's cycle, straight curves or found ones: the same
    /// postures, named everywhere.
    #[test]
    fn the_middle_of_the_box_is_the_cycle() {
        let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let robot = loaded.robot();
        // A pull of a cubic has a spline near it, and none that is it.
        for name in shipped::cycle_names().filter(|name| *name != "thesis-optimal") {
            let cycle = shipped::cycle(name).unwrap().unwrap();
            let form = CycleForm::about(robot, &cycle, Free::FULL).unwrap();
            let point = form.point(&form.middle);
            assert_eq!(point, form.known());
            let again = form.cycle(&point).unwrap();
            let stops = robot.stops();
            let plan = |cycle: &Cycle| {
                CheckedCycle::plan(robot, &stops, cycle, 0.0, TimeScale::ONE).unwrap()
            };
            let (one, other) = (plan(&cycle), plan(&again));
            let path = |checked: &CheckedCycle| checked.recovery_after(checked).unwrap();
            let (back, forth) = (path(&one), path(&other));
            for k in 0..=20 {
                let t = f64::from(k) / 20.0;
                let seconds = t * one.recovery_seconds();
                for (one, other) in [
                    (one.pull_at(t), other.pull_at(t)),
                    (back.at(seconds), forth.at(seconds)),
                ] {
                    let pairs = one.as_slice().iter().zip(other.as_slice());
                    for (a, b) in pairs {
                        assert!((a - b).abs() < 1e-9, "{name} at {t}: {a} and {b}");
                    }
                }
            }
        }
    }

    /// No other cycle stands in for one whose pull no phase can have.
    #[test]
    fn limit_a_time_that_no_pull_has_makes_no_cycle() {
        let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let form = |cycle: &Cycle| CycleForm::about(loaded.robot(), cycle, Free::FULL).unwrap();
        let cycle = shipped::cycle("hip-10").unwrap().unwrap();
        let mut long = cycle.clone();
        long.pull.as_mut().unwrap().duration = PhaseDuration::new(500.0).unwrap();
        let form = form(&long);
        let mut point = form.point(&form.middle);
        let time = form
            .variables
            .iter()
            .position(|it| *it == Variable::PullTime);
        let time = time.unwrap();
        assert!(form.bounds[time].high() > PhaseDuration::LONGEST);
        point[time] = 650.0;
        let seconds = 650.0;
        let refused = form.cycle(&point).unwrap_err();
        assert_eq!(
            refused,
            PointError::Duration(PhaseDurationError { seconds })
        );
        let message = "the pull: a phase of 650 s is outside 0.1..600 s";
        assert_eq!(refused.to_string(), message);
        point[time] = 600.0;
        let found = form.cycle(&point).unwrap().pull_seconds();
        assert!((found - 600.0).abs() < f64::EPSILON, "{found} s");
        let short = form.cycle(&point[1..]).unwrap_err();
        let (numbers, variables) = (point.len() - 1, point.len());
        assert_eq!(short, PointError::Numbers { numbers, variables });
    }

    impl CycleForm {
        /// The numbers of a cycle.
        fn point(&self, cycle: &Cycle) -> Vec<f64> {
            let at = |curve: &Curve, control: usize| controls(curve)[control];
            let times = times(cycle);
            let time = |of: &Variable| times.iter().find(|(it, _)| it == of).unwrap().1;
            let pull = || cycle.pull.as_ref().unwrap();
            let numbers = self.variables.iter().map(|variable| match variable {
                Variable::Curve(PullCurve::Knee, control) => at(&pull().knee, *control),
                Variable::Curve(PullCurve::Hip, control) => at(&pull().hip, *control),
                Variable::Curve(PullCurve::UpperArm, c) => at(&pull().upper_arm, *c),
                Variable::Curve(PullCurve::Company(joint), c) => at(&pull().company[joint], *c),
                Variable::Joint(index, joint) => cycle.waypoints[*index].joints[joint],
                Variable::Turn(index, joint) => cycle.waypoints[*index].turn[joint],
                Variable::Shift(index, joint) => cycle.waypoints[*index].shift[joint],
                Variable::PullTime | Variable::Time(_) => time(variable),
            });
            numbers.collect()
        }
    }
}
