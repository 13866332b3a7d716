//! One commanded cycle as key frames: as few as let straight lines between them follow it.

use serde::Serialize;

use prone::gait::cycle::{CheckedCycle, CycleError, RecoveryPath};
use prone::robot::{JointAngles, Robot};

use prone_record::output;

use super::lag::{Lag, Lags};

/// Time between two places where a key frame of a file may be, s: that of the motor boards.
pub const TICK: f64 = 0.01;

/// How far straight lines between key frames may leave the commanded angle, rad: a quarter of a
/// degree, less than the play of a small humanoid's gears.
pub const TOLERANCE: f64 = 0.25 * std::f64::consts::PI / 180.0;

/// A cycle from extension to extension.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyFrames {
    /// Time between two ticks, s.
    pub tick_s: f64,
    /// In the order of time. The last one is the first one's posture again.
    pub frames: Vec<KeyFrame>,
}

/// A posture and when it is commanded.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyFrame {
    /// Ticks since the pull began.
    pub tick: usize,
    /// What the posture is, where it has a name.
    pub label: Option<String>,
    /// All joints, rad.
    pub angles: JointAngles,
}

/// A joint that straight lines between key frames would move faster than its manufacturer allows.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error(
    "{joint} would move at {speed:.2} rad/s from {from_s:.2} s to {to_s:.2} s of the cycle, above its \
     limit of {limit:.2} rad/s: crawl with a larger --time-scale"
)]
pub struct TooFast {
    /// Name of the joint.
    pub joint: String,
    /// Its speed along the line, rad/s.
    pub speed: f64,
    /// Its limit, rad/s.
    pub limit: f64,
    /// Where the line begins, s since the pull began.
    pub from_s: f64,
    /// Where it ends.
    pub to_s: f64,
}

impl KeyFrames {
    /// Checks straight lines between the key frames against the speed limits of their robot.
    ///
    /// # Errors
    /// [`TooFast`] with the joint that is above its limit by the largest factor.
    pub fn check_speeds(&self, robot: &Robot) -> Result<(), TooFast> {
        /// Rounding of the angles' difference.
        const ROUNDING: f64 = 1e-9;
        let seconds = |frame: &KeyFrame| frame.tick as f64 * self.tick_s;
        let lines = self.frames.windows(2).flat_map(|pair| {
            let (from_s, to_s) = (seconds(&pair[0]), seconds(&pair[1]));
            let ways = pair[0].angles.pairs(&pair[1].angles);
            let ways = robot.joints.iter().zip(ways);
            ways.map(move |(joint, (from, to))| TooFast {
                joint: joint.name.clone(),
                speed: (to - from).abs() / (to_s - from_s),
                limit: joint.speed_limit,
                from_s,
                to_s,
            })
        });
        let share = |line: &TooFast| line.speed / line.limit;
        // NaN is above all numbers.
        let fastest = lines.max_by(|a, b| share(a).abs().total_cmp(&share(b).abs()));
        match fastest {
            Some(line) if share(&line) <= 1.0 + ROUNDING => Ok(()),
            Some(line) => Err(line),
            None => Ok(()),
        }
    }
}

/// Takes key frames of a cycle at multiples of `tick_s`: the ends of its stretches, moved to the
/// nearest tick, that of the last one to the next, and what is needed between them to stay within [`TOLERANCE`].
///
/// # Errors
/// [`CycleError`] where the cycle's own recovery is too fast.
pub fn from_cycle(checked: &CheckedCycle, tick_s: f64) -> Result<KeyFrames, CycleError> {
    let course = Course {
        checked,
        recovery: checked.recovery_after(checked)?,
        pull_s: checked.pull_seconds(),
        tick_s,
    };
    let compression = course.tick(course.pull_s);
    let mut labels = vec![
        (0, "extension".to_owned()),
        (compression, "compression".to_owned()),
    ];
    for (name, end) in checked.recovery_ends() {
        labels.push((course.tick(course.pull_s + end), name.to_owned()));
    }
    let last = course.tick_after(course.pull_s + checked.recovery_seconds());
    if let Some((end, _)) = labels.last_mut() {
        *end = last;
    }
    let mut ticks: Vec<usize> = labels.iter().map(|(tick, _)| *tick).collect();
    for pair in labels.windows(2) {
        course.refine(pair[0].0, pair[1].0, &mut ticks);
    }
    ticks.sort_unstable();
    ticks.dedup();
    let frames = ticks.into_iter().map(|tick| KeyFrame {
        tick,
        label: labels
            .iter()
            .find(|(labelled, _)| *labelled == tick)
            .map(|(_, name)| name.clone()),
        // A cycle closes, wherever its end falls between two ticks.
        angles: if tick == last {
            checked.extension().clone()
        } else {
            course.at(tick)
        },
    });
    Ok(KeyFrames {
        tick_s,
        frames: frames.collect(),
    })
}

/// Writes key frames as JSON, and how far the record's joints were behind.
pub fn json(
    robot: &Robot,
    checked: &CheckedCycle,
    key_frames: &KeyFrames,
    lags: &Lags<'_>,
) -> Result<Vec<u8>, serde_json::Error> {
    let time_s = |tick: usize| (tick as f64 * key_frames.tick_s * 1e6).round() / 1e6;
    let frames = key_frames.frames.iter().map(|frame| {
        let angles = frame.angles.as_slice().iter();
        // To the microradian, as in records; 0 without a sign.
        let angles = angles.map(|angle| (angle * 1e6).round() / 1e6 + 0.0);
        Entry {
            time_s: time_s(frame.tick),
            label: frame.label.as_deref(),
            angles_rad: angles.collect(),
        }
    });
    let joints = robot.joints.iter();
    let file = File {
        robot: &robot.name,
        gait: checked.name(),
        period_s: time_s(key_frames.frames.last().map_or(0, |last| last.tick)),
        pull_s: checked.pull_seconds(),
        interpolation: "linear",
        tolerance_rad: TOLERANCE,
        largest_lag: lags.largest().map(|(joint, lag)| LagEntry::new(joint, lag)),
        largest_lag_by_joint: lags
            .joints()
            .map(|(joint, lag)| lag.map(|lag| LagEntry::new(joint, lag)))
            .collect(),
        joints: joints.map(|joint| joint.name.as_str()).collect(),
        frames: frames.collect(),
    };
    output::json(&file)
}

#[derive(Serialize)]
struct File<'a> {
    robot: &'a str,
    gait: &'a str,
    period_s: f64,
    pull_s: f64,
    interpolation: &'static str,
    tolerance_rad: f64,
    largest_lag: Option<LagEntry<'a>>,
    largest_lag_by_joint: Vec<Option<LagEntry<'a>>>,
    joints: Vec<&'a str>,
    frames: Vec<Entry<'a>>,
}

/// How far a joint of the record was behind its command.
#[derive(Serialize)]
struct LagEntry<'a> {
    joint: &'a str,
    lag_rad: f64,
    time_s: f64,
}

impl<'a> LagEntry<'a> {
    fn new(joint: &'a str, lag: Lag) -> Self {
        Self {
            joint,
            // Records have six decimals.
            lag_rad: (lag.angle * 1e6).round() / 1e6,
            time_s: lag.time_s,
        }
    }
}

#[derive(Serialize)]
struct Entry<'a> {
    time_s: f64,
    label: Option<&'a str>,
    angles_rad: Vec<f64>,
}

/// What is commanded over a cycle.
struct Course<'a> {
    checked: &'a CheckedCycle,
    recovery: RecoveryPath,
    pull_s: f64,
    tick_s: f64,
}

impl Course<'_> {
    fn at(&self, tick: usize) -> JointAngles {
        let seconds = tick as f64 * self.tick_s;
        if seconds <= self.pull_s {
            self.checked.pull_at(seconds)
        } else {
            self.recovery.at(seconds - self.pull_s)
        }
    }

    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a time of a cycle is neither negative nor long"
    )]
    fn tick(&self, seconds: f64) -> usize {
        (seconds / self.tick_s).round() as usize
    }

    /// The tick at which the cycle has closed: where that falls between two, the later one, as a line to
    /// the earlier one would be faster than the command.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a time of a cycle is neither negative nor long"
    )]
    fn tick_after(&self, seconds: f64) -> usize {
        /// Of a tick: rounding of the sum of a cycle's times.
        const ROUNDING: f64 = 1e-6;
        (seconds / self.tick_s - ROUNDING).ceil() as usize
    }

    /// Adds the tick between two where the straight line is farthest off, and so on in both parts.
    fn refine(&self, from: usize, to: usize, ticks: &mut Vec<usize>) {
        let (first, last) = (self.at(from), self.at(to));
        let off = |tick: usize| {
            let share = (tick - from) as f64 / (to - from) as f64;
            let (line, now) = (first.towards(&last, share), self.at(tick));
            let apart = line.pairs(&now).map(|(line, now)| (line - now).abs());
            apart.fold(0.0, f64::max)
        };
        let farthest = (from + 1..to)
            .map(|tick| (off(tick), tick))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((off, tick)) = farthest
            && off > TOLERANCE
        {
            ticks.push(tick);
            self.refine(from, tick, ticks);
            self.refine(tick, to, ticks);
        }
    }
}
