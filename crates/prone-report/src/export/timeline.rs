//! One commanded cycle as a Choregraphe project (`behavior.xar`, version 3): one box with a motion
//! timeline.
//!
//! Angles are degrees (`unit="0"`), interpolation is linear, the rate is Choregraphe's own. The
//! first posture has its keys two seconds after the timeline begins, as it is reached from wherever
//! the robot lies; play the box in a loop from there on to crawl more than one cycle. No schema of
//! the format is published; its structure is that of projects which Choregraphe 2 saves.

use std::fmt::Write as _;

use prone::robot::Robot;

use super::key_frames::KeyFrames;
use super::lag::Lags;
use crate::markup::escaped;

/// Frames per second of a timeline unless one changes it.
pub const FRAME_RATE: f64 = 25.0;

/// The frame of the first posture.
pub const FIRST_FRAME: usize = 50;

/// The hinges that Choregraphe knows: those of a NAO with 25 motors. Hands are none of them: a timeline
/// says how far they are open.
const HINGES: [&str; 24] = [
    "HeadYaw",
    "HeadPitch",
    "LShoulderPitch",
    "LShoulderRoll",
    "LElbowYaw",
    "LElbowRoll",
    "LWristYaw",
    "LHipYawPitch",
    "LHipRoll",
    "LHipPitch",
    "LKneePitch",
    "LAnklePitch",
    "LAnkleRoll",
    "RHipYawPitch",
    "RHipRoll",
    "RHipPitch",
    "RKneePitch",
    "RAnklePitch",
    "RAnkleRoll",
    "RShoulderPitch",
    "RShoulderRoll",
    "RElbowYaw",
    "RElbowRoll",
    "RWristYaw",
];

/// A robot that is none of Choregraphe's.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error(
    "Choregraphe moves the hinges of a NAO, and has no joint {joint:?} of {robot}: export keyframes \
     instead"
)]
pub struct UnknownJoint {
    /// The first joint that Choregraphe does not know.
    pub joint: String,
    /// Name of the robot.
    pub robot: String,
}

/// Checks that Choregraphe knows all joints of a robot by their names.
pub fn check_robot(robot: &Robot) -> Result<(), UnknownJoint> {
    let mut joints = robot.joints.iter();
    match joints.find(|joint| !HINGES.contains(&joint.name.as_str())) {
        None => Ok(()),
        Some(joint) => Err(UnknownJoint {
            joint: joint.name.clone(),
            robot: robot.name.clone(),
        }),
    }
}

/// The fixed ports of a box.
const PORTS: &str = r#"<bitmap>media/images/box/movement/move.png</bitmap>
<script language="4"><content><![CDATA[]]></content></script>
<Input name="onLoad" type="1" type_size="1" nature="0" inner="1" tooltip="Signal sent when diagram is loaded." id="1"/>
<Input name="onStart" type="1" type_size="1" nature="2" inner="0" tooltip="Box behavior starts when a signal is received on this input." id="2"/>
<Input name="onStop" type="1" type_size="1" nature="3" inner="0" tooltip="Box behavior stops when a signal is received on this input." id="3"/>
<Output name="onStopped" type="1" type_size="1" nature="1" inner="0" tooltip="Signal sent when box behavior is finished." id="4"/>
"#;

/// Writes the project; `key_frames` were taken with a tick of 1 / [`FRAME_RATE`]. The box says how far the
/// record's joints were behind, in the words of `lags` and of the sentence `behind`.
pub fn xar(
    robot: &Robot,
    gait: &str,
    key_frames: &KeyFrames,
    lags: &Lags<'_>,
    behind: &str,
) -> String {
    let postures = &key_frames.frames;
    let frames = postures.iter().map(|frame| FIRST_FRAME + frame.tick);
    let frames: Vec<usize> = frames.collect();
    let size = frames.last().copied().unwrap_or(FIRST_FRAME);
    let mut curves = String::new();
    for (index, joint) in robot.joints.iter().enumerate() {
        let angles = postures.iter().map(|frame| frame.angles.as_slice()[index]);
        let degrees: Vec<f64> = angles.map(f64::to_degrees).collect();
        let needed = (0..frames.len()).filter(|place| is_needed(&degrees, *place));
        let keys: String = needed
            .map(|place| key(&frames, place, degrees[place]))
            .collect();
        let name = escaped(&joint.name);
        // Writing to a text does not fail.
        let _ = write!(
            curves,
            "<ActuatorCurve name=\"value\" actuator=\"{name}\" recordable=\"1\" mute=\"0\" \
             unit=\"0\">\n{keys}</ActuatorCurve>\n"
        );
    }
    let (gait, name) = (escaped(gait), escaped(&robot.name));
    let mut behind = escaped(behind);
    let list = lags.list();
    if !list.is_empty() {
        let _ = write!(behind, "; largest lags: {}", escaped(&list));
    }
    format!(
        r#"<?xml version="1.0" encoding="UTF-8" ?>
<ChoregrapheProject xmlns="http://www.aldebaran-robotics.com/schema/choregraphe/project.xsd" xar_version="3">
<Box name="root" id="-1" localization="8" tooltip="One crawl cycle of {name}: {gait}" x="0" y="0">
{PORTS}<Timeline enable="0">
<BehaviorLayer name="behavior_layer1">
<BehaviorKeyframe name="keyframe1" index="1">
<Diagram scale="100">
<Box name="{gait}" id="2" localization="8" tooltip="From extension to extension; the first posture is reached at frame {FIRST_FRAME}. {behind}." x="300" y="100">
{PORTS}<Timeline enable="1" fps="{FRAME_RATE}" start_frame="1" end_frame="-1" size="{size}">
<ActuatorList model="">
{curves}</ActuatorList>
</Timeline>
</Box>
<Link inputowner="2" indexofinput="2" outputowner="0" indexofoutput="2"/>
<Link inputowner="0" indexofinput="4" outputowner="2" indexofoutput="4"/>
</Diagram>
</BehaviorKeyframe>
</BehaviorLayer>
</Timeline>
</Box>
</ChoregrapheProject>
"#
    )
}

/// A joint that stays where it is needs no key between two that say so.
fn is_needed(degrees: &[f64], place: usize) -> bool {
    /// Less than what is written.
    const SAME: f64 = 5e-5;
    let same = |other: Option<&f64>| other.is_some_and(|it| (it - degrees[place]).abs() < SAME);
    let before = place.checked_sub(1).and_then(|before| degrees.get(before));
    !(same(before) && same(degrees.get(place + 1)))
}

/// A key with straight tangents; their handles reach a third of the way to the neighbours.
fn key(frames: &[usize], place: usize, degrees: f64) -> String {
    let frame = frames[place];
    let third = |gap: usize| gap as f64 / 3.0;
    let mut tangents = String::new();
    if let Some(before) = place.checked_sub(1) {
        tangents += &tangent("left", -third(frame - frames[before]));
    }
    if let Some(after) = frames.get(place + 1) {
        tangents += &tangent("right", third(after - frame));
    }
    // 0 has no sign.
    let degrees = (degrees * 1e4).round() / 1e4 + 0.0;
    format!("<Key frame=\"{frame}\" value=\"{degrees}\">{tangents}</Key>\n")
}

fn tangent(side: &str, handle: f64) -> String {
    format!(
        "<Tangent side=\"{side}\" interpType=\"linear\" abscissaParam=\"{handle:.4}\" \
         ordinateParam=\"0\"/>"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_joint_at_rest_keeps_the_keys_at_its_ends() {
        let degrees = [0.0, 0.0, 0.0, 1.0, 1.0];
        let needed: Vec<bool> = (0..5).map(|place| is_needed(&degrees, place)).collect();
        assert_eq!(needed, [true, false, true, true, true]);
    }
}
