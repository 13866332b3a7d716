//! A record as an MCAP file with the profile `ros2`: what `ros2 bag record` would have written.
//!
//! Topics, at every row of the record:
//!
//! | topic | message | holds |
//! |---|---|---|
//! | `/joint_states` | `sensor_msgs/msg/JointState` | angle, speed and motor torque of all joints |
//! | `/joint_commands` | `sensor_msgs/msg/JointState` | commanded angles |
//! | `/tf` | `tf2_msgs/msg/TFMessage` | root in `world`, every other body in its parent |
//! | `/contacts/<body>/<with>` | `geometry_msgs/msg/WrenchStamped` | what presses on that body |
//! | `/robot_description` | `std_msgs/msg/String` | the robot as URDF; once, latched |
//!
//! A body and a thing that are no parts of a topic's name are made such (`tokens`); a channel's
//! metadata has their own names beside the profile of its publisher, which rosbag2 asks for.
//!
//! The wrench is the sum over the points in which the body touches that thing at that instant, its
//! moment taken about the origin of the body's frame, both in that frame: what a sensor there would
//! measure. It is zero while they do not touch; where `contacts.csv` breaks off, it ends. Times count
//! from the beginning of the first pull.
//!
//! A field of `JointState` that was never recorded is empty, a joint of it that was not is NaN; a topic
//! of which nothing was recorded is left out, and so are a transform and a wrench of a body whose pose
//! is not known.

pub mod bag;
mod cdr;
mod definitions;
mod qos;
mod tokens;

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

use glam::DVec3;
use mcap::records::MessageHeader;
use mcap::{McapError, WriteOptions, Writer};

use cdr::Cdr;
use definitions::{Definition, JOINT_STATE, STRING, TF_MESSAGE, WRENCH_STAMPED};
use prone_record::recorded::{Recorded, RecordedRow};
use qos::Qos;

/// The frame in which the root moves.
const WORLD: &str = "world";

/// A body and what it touches, in the order of the topics.
type Pair<'a> = (usize, &'a str);

/// Force and moment.
type Wrench = (DVec3, DVec3);

/// A log, and what a bag says of it.
#[derive(Debug, Clone, PartialEq)]
pub struct RosLog {
    /// The file.
    pub bytes: Vec<u8>,
    /// In the order of the channels.
    topics: Vec<Topic>,
    /// Time of the first message.
    begin_ns: u64,
    /// Time of the last one.
    end_ns: u64,
}

/// A topic and how many messages it has.
#[derive(Debug, Clone, PartialEq)]
struct Topic {
    name: String,
    kind: &'static str,
    qos: Qos,
    messages: u64,
}

/// Why there is no log.
#[derive(Debug, thiserror::Error)]
pub enum LogError {
    /// Frames are known by their names.
    #[error(
        "two frames of the record are called {frame:?}: a log with /tf needs one name for each"
    )]
    SameFrame {
        /// The name.
        frame: String,
    },
    /// A frame without a name.
    #[error("body {place} of the record has no name: a log with /tf needs one")]
    NamelessFrame {
        /// Place among the bodies, from 1.
        place: usize,
    },
    /// The format cannot be written.
    #[error(transparent)]
    Format(#[from] McapError),
}

/// Makes the file, with chunks, indices and checksums, not compressed. `description` is the robot as
/// URDF, whose links must have the frames of the record's bodies.
pub fn log(record: &Recorded, description: Option<&str>) -> Result<RosLog, LogError> {
    check_frames(record)?;
    let mut log = Log::new()?;
    log.say_what(record)?;
    let (begin_s, end_s) = record.span_s();
    let [begin, end] = [begin_s, end_s].map(Stamp::from_seconds);
    if let Some(description) = description {
        let channel = log.channel(STRING, "/robot_description", Qos::Latched, &[])?;
        let mut message = Cdr::new();
        message.text(description);
        log.write(channel, begin, &message.finish())?;
    }
    let states = log.channel(JOINT_STATE, "/joint_states", Qos::Volatile, &[])?;
    let angles = known(record, |row| row.angles.as_slice());
    let torques = known(record, |row| &row.motor_torque_nm);
    let commands = known(record, |row| row.command.as_slice());
    let commands =
        commands.map(|_| log.channel(JOINT_STATE, "/joint_commands", Qos::Volatile, &[]));
    let commands = commands.transpose()?;
    let poses = has_poses(record).then(|| log.channel(TF_MESSAGE, "/tf", Qos::Volatile, &[]));
    let poses = poses.transpose()?;
    let pairs = log.contact_channels(record)?;
    let speeds = record.joint_speeds();
    let mut contacts = record.contacts.as_slice();
    let mut counts = record.contact_counts.iter();
    for (row, speeds) in record.rows.iter().zip(&speeds) {
        let stamp = Stamp::from_seconds(row.time_s);
        let state = [
            angles.map_or(&[][..], |angles| angles(row)),
            angles.map_or(&[][..], |_| speeds),
            torques.map_or(&[][..], |torques| torques(row)),
        ];
        log.write(states, stamp, &joints(record, stamp, state))?;
        if let Some(commands) = commands {
            let command = [row.command.as_slice(), &[], &[]];
            log.write(commands, stamp, &joints(record, stamp, command))?;
        }
        if let Some(poses) = poses {
            log.write(poses, stamp, &transforms(record, row, stamp))?;
        }
        // What is not known is not zero: then there is no message.
        let Some(&count) = counts.next() else {
            continue;
        };
        let (now, later) = contacts.split_at(count);
        contacts = later;
        let mut sums: BTreeMap<Pair<'_>, Wrench> = BTreeMap::new();
        let bodies = record.ground_from_bodies(row);
        for contact in now {
            let Some(ground_from_body) = bodies[contact.body] else {
                continue;
            };
            let body_from_ground = ground_from_body.rotation().inverse();
            let arm = contact.at.metres() - ground_from_body.origin().metres();
            let sum = sums.entry((contact.body, &contact.with)).or_default();
            sum.0 += body_from_ground * contact.force_n;
            sum.1 += body_from_ground * arm.cross(contact.force_n);
        }
        for (pair, &channel) in &pairs {
            if bodies[pair.0].is_none() {
                continue;
            }
            let (force, moment) = sums.get(pair).copied().unwrap_or_default();
            let mut message = Cdr::new();
            header(&mut message, stamp, &record.bodies[pair.0].name);
            message.numbers(&force.to_array());
            message.numbers(&moment.to_array());
            log.write(channel, stamp, &message.finish())?;
        }
    }
    log.writer.finish()?;
    Ok(RosLog {
        bytes: log.writer.into_inner().into_inner(),
        topics: log.topics.into_values().collect(),
        begin_ns: begin.0,
        end_ns: end.0,
    })
}

/// Checks that each frame of `/tf` has a name of its own.
fn check_frames(record: &Recorded) -> Result<(), LogError> {
    let mut frames = BTreeSet::from([WORLD]);
    for (index, body) in record.bodies.iter().enumerate() {
        if body.name.is_empty() {
            return Err(LogError::NamelessFrame { place: index + 1 });
        }
        if !frames.insert(&body.name) {
            return Err(LogError::SameFrame {
                frame: body.name.clone(),
            });
        }
    }
    Ok(())
}

/// Numbers of the joints of a row.
type Numbers = fn(&RecordedRow) -> &[f64];

/// The numbers of each row, or none where there are none at any instant and of any joint.
fn known(record: &Recorded, numbers: Numbers) -> Option<Numbers> {
    let mut all = record.rows.iter().flat_map(numbers);
    all.any(|value| !value.is_nan()).then_some(numbers)
}

/// Whether the pose of any body is known at any instant.
fn has_poses(record: &Recorded) -> bool {
    let rows = record.rows.iter();
    let mut poses = rows.flat_map(|row| record.parent_from_bodies(row));
    poses.any(|pose| pose.is_some())
}

/// What the robot may touch: the floor, the obstacles of the record's scene, and whatever its contacts
/// name beside them.
fn things(record: &Recorded) -> impl Iterator<Item = &str> {
    let obstacles = record.model["obstacles"].as_array();
    let obstacles = obstacles.into_iter().flatten();
    let obstacles = obstacles.filter_map(|obstacle| obstacle["name"].as_str());
    let touched = record.contacts.iter().map(|contact| contact.with.as_str());
    std::iter::once("floor").chain(obstacles).chain(touched)
}

/// A `JointState`; position, velocity and effort, of which any may be empty.
fn joints(record: &Recorded, stamp: Stamp, values: [&[f64]; 3]) -> Vec<u8> {
    let mut message = Cdr::new();
    header(&mut message, stamp, "");
    message.count(record.joints.len());
    for joint in &record.joints {
        message.text(joint);
    }
    for values in values {
        message.count(values.len());
        message.numbers(values);
    }
    message.finish()
}

/// A `TFMessage` of all bodies whose poses are known.
fn transforms(record: &Recorded, row: &RecordedRow, stamp: Stamp) -> Vec<u8> {
    let mut message = Cdr::new();
    let poses = record.parent_from_bodies(row);
    let poses = record.bodies.iter().zip(poses);
    let poses = poses.filter_map(|(body, pose)| Some((body, pose?)));
    let known: Vec<_> = poses.collect();
    message.count(known.len());
    for (body, pose) in known {
        let parent = body
            .parent
            .map_or(WORLD, |parent| &record.bodies[parent].name);
        header(&mut message, stamp, parent);
        message.text(&body.name);
        message.numbers(&pose.origin().metres().to_array());
        message.numbers(&pose.rotation().to_array()); // x, y, z, w
    }
    message.finish()
}

fn header(message: &mut Cdr, stamp: Stamp, frame: &str) {
    let (seconds, nanoseconds) = stamp.parts();
    message.unsigned(seconds);
    message.unsigned(nanoseconds);
    message.text(frame);
}

/// A time of ROS, nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Stamp(u64);

impl Stamp {
    /// To the microsecond: records have four decimals.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a time of a crawl is not negative"
    )]
    fn from_seconds(time_s: f64) -> Self {
        Self((time_s * 1e6).round() as u64 * 1000)
    }

    /// Seconds, and the nanoseconds beyond them.
    #[expect(clippy::cast_possible_truncation, reason = "a crawl lasts minutes")]
    const fn parts(self) -> (u32, u32) {
        const PER_SECOND: u64 = 1_000_000_000;
        ((self.0 / PER_SECOND) as u32, (self.0 % PER_SECOND) as u32)
    }
}

struct Log {
    writer: Writer<Cursor<Vec<u8>>>,
    topics: BTreeMap<u16, Topic>,
}

impl Log {
    fn new() -> Result<Self, McapError> {
        let options = WriteOptions::new()
            .profile("ros2")
            .library(concat!("prone ", env!("CARGO_PKG_VERSION")))
            .compression(None);
        Ok(Self {
            writer: options.create(Cursor::new(Vec::new()))?,
            topics: BTreeMap::new(),
        })
    }

    /// Where the record comes from.
    fn say_what(&mut self, record: &Recorded) -> Result<(), McapError> {
        let run = &record.run;
        let metadata = [
            (
                "program",
                format!("prone {} ({})", run.head.version, run.head.commit),
            ),
            ("robot", run.robot.name.clone()),
            ("robot version", run.robot.version_name()),
            ("gait", run.gait.name.clone()),
            ("scene", run.scene.name.clone()),
        ];
        let metadata = metadata.map(|(key, value)| (key.to_owned(), value));
        self.writer.write_metadata(&mcap::records::Metadata {
            name: "prone".to_owned(),
            metadata: metadata.into(),
        })
    }

    /// A channel for each body and thing that touch in the record. Parts of topics are given to all
    /// bodies and things, so that they do not depend on what was touched.
    fn contact_channels<'a>(
        &mut self,
        record: &'a Recorded,
    ) -> Result<BTreeMap<Pair<'a>, u16>, McapError> {
        let bodies = tokens::tokens("body", record.bodies.iter().map(|body| body.name.as_str()));
        let with = tokens::tokens("thing", things(record));
        let contacts = record.contacts.iter();
        let pairs = contacts.map(|contact| (contact.body, contact.with.as_str()));
        let pairs: BTreeSet<Pair<'_>> = pairs.collect();
        let channels = pairs.into_iter().map(|(index, thing)| {
            let body = record.bodies[index].name.as_str();
            let topic = format!("/contacts/{}/{}", bodies[body], with[thing]);
            let names = [("body", body), ("with", thing)];
            let channel = self.channel(WRENCH_STAMPED, &topic, Qos::Volatile, &names)?;
            Ok(((index, thing), channel))
        });
        channels.collect()
    }

    fn channel(
        &mut self,
        definition: Definition,
        topic: &str,
        qos: Qos,
        names: &[(&str, &str)],
    ) -> Result<u16, McapError> {
        let text = definition.text();
        // The same definition gets the same number again.
        let schema = self
            .writer
            .add_schema(definition.name, "ros2msg", text.as_bytes())?;
        let names = names.iter();
        let names = names.map(|(key, name)| ((*key).to_owned(), (*name).to_owned()));
        let mut metadata: BTreeMap<String, String> = names.collect();
        metadata.insert("offered_qos_profiles".to_owned(), qos.yaml());
        let channel = self.writer.add_channel(schema, topic, "cdr", &metadata)?;
        let topic = Topic {
            name: topic.to_owned(),
            kind: definition.name,
            qos,
            messages: 0,
        };
        self.topics.insert(channel, topic);
        Ok(channel)
    }

    fn write(&mut self, channel: u16, stamp: Stamp, message: &[u8]) -> Result<(), McapError> {
        let count = self.topics.get_mut(&channel).map(|topic| {
            topic.messages += 1;
            topic.messages
        });
        let sequence = count.and_then(|count| u32::try_from(count).ok());
        let Stamp(nanoseconds) = stamp;
        let header = MessageHeader {
            channel_id: channel,
            sequence: sequence.unwrap_or_default(),
            log_time: nanoseconds,
            publish_time: nanoseconds,
        };
        self.writer.write_to_known_channel(&header, message)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_exact() {
        let stamp = Stamp::from_seconds(50.84);
        assert_eq!(stamp.parts(), (50, 840_000_000));
        assert_eq!(stamp, Stamp(50_840_000_000));
    }
}
