//! The way to the first posture.

use crate::gait::cycle::Easing;
use crate::robot::{JointAngles, Range, Robot};

use super::course::Course;
use super::error::CrawlerError;
use super::program::Begin;

/// Shortest way, s: nothing begins with a jerk.
const SHORTEST: f64 = 0.5;

/// The way to a posture from where the joints are measured, none of which may be so far beyond its
/// stop that it cannot be there: as long as all need together where none passes a share of its speed
/// limit.
pub(super) fn plan(
    robot: &Robot,
    stops: &[Range],
    measured: &JointAngles,
    to: &JointAngles,
    speed: f64,
) -> Result<Course, CrawlerError> {
    let mut joints = robot.joints.iter().zip(stops).zip(measured.as_slice());
    let beyond = joints.find(|((_, stop), angle)| stop.excess(**angle).abs() > Begin::BEYOND_STOP);
    if let Some(((joint, stop), &angle)) = beyond {
        return Err(CrawlerError::BeyondStop {
            joint: joint.name.clone(),
            angle,
            lower: stop.lower,
            upper: stop.upper,
            most: Begin::BEYOND_STOP,
        });
    }
    let joints = robot.joints.iter().zip(measured.pairs(to));
    let times = joints.map(|(joint, (from, to))| {
        Easing::Smoothstep.peak_speed() * (to - from).abs() / (speed * joint.speed_limit)
    });
    Ok(Course::Way {
        from: measured.within(stops),
        to: to.clone(),
        seconds: times.fold(SHORTEST, f64::max),
    })
}
