//! How far the joints of a record were behind their commands.
//!
//! A timeline or key frames are what was commanded. Where the recorded joints did not follow, heights
//! and advance of the record are not those of a robot that does: it swings farther, and faster.

use std::fmt::Write as _;

use prone::robot::Robot;
use prone_record::recorded::{Part, Recorded};

/// Less than this is not worth a word, rad: a degree.
const WORTH_A_WORD: f64 = std::f64::consts::PI / 180.0;

/// The largest distance between the command and the angle of a joint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lag {
    /// How far, rad.
    pub angle: f64,
    /// At which row, s since the first pull began.
    pub time_s: f64,
}

/// Of each joint of a robot, in its order.
#[derive(Debug, Clone, PartialEq)]
pub struct Lags<'a> {
    robot: &'a Robot,
    by_joint: Vec<Option<Lag>>,
}

impl<'a> Lags<'a> {
    /// Nothing is known of any joint.
    pub fn unknown(robot: &'a Robot) -> Self {
        Self {
            robot,
            by_joint: vec![None; robot.joints.len()],
        }
    }

    /// Compares command and angle in each row. A joint that lacks one of them in some row is unknown,
    /// and so are all where rows are missing: what is missing may have been larger.
    pub fn of(robot: &'a Robot, record: &Recorded) -> Self {
        if record.cuts.iter().any(|cut| cut.part == Part::Rows) {
            return Self::unknown(robot);
        }
        let lags = robot.joints.iter().map(|joint| {
            let place = record.joints.iter().position(|name| *name == joint.name)?;
            let lags = record.rows.iter().map(|row| Lag {
                angle: (row.command.as_slice()[place] - row.angles.as_slice()[place]).abs(),
                time_s: row.time_s,
            });
            // NaN is above all numbers.
            let largest = lags.max_by(|a, b| a.angle.total_cmp(&b.angle));
            largest.filter(|largest| !largest.angle.is_nan())
        });
        Self {
            robot,
            by_joint: lags.collect(),
        }
    }

    /// Name and lag of each joint, in the robot's order.
    pub fn joints(&self) -> impl Iterator<Item = (&'a str, Option<Lag>)> {
        let joints = self.robot.joints.iter();
        let joints = joints.map(|joint| joint.name.as_str());
        joints.zip(self.by_joint.iter().copied())
    }

    /// The joint that was farthest behind, of those that are known.
    pub fn largest(&self) -> Option<(&'a str, Lag)> {
        let known = self.joints().filter_map(|(joint, lag)| Some((joint, lag?)));
        known.max_by(|(_, a), (_, b)| a.angle.total_cmp(&b.angle))
    }

    /// A sentence on the joint that was farthest behind. `place` is where it was so, in words.
    pub fn sentence(&self, place: &str) -> Option<String> {
        let (joint, lag) = self.largest()?;
        let (degrees, time) = (lag.angle.to_degrees(), lag.time_s);
        Some(format!(
            "{joint} is up to {degrees:.1}° behind its command in {place} (at {time:.2} s)"
        ))
    }

    /// Joints that were behind by more than a degree, the farthest first; empty where there are none.
    pub fn list(&self) -> String {
        let known = self.joints().filter_map(|(joint, lag)| Some((joint, lag?)));
        let mut behind: Vec<(&str, Lag)> =
            known.filter(|(_, lag)| lag.angle > WORTH_A_WORD).collect();
        behind.sort_by(|(_, a), (_, b)| b.angle.total_cmp(&a.angle));
        let mut text = String::new();
        for (joint, lag) in behind {
            let comma = if text.is_empty() { "" } else { ", " };
            // Writing to a text does not fail.
            let _ = write!(text, "{comma}{joint} {:.1}°", lag.angle.to_degrees());
        }
        text
    }
}
