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
//!
//! The wrench is the sum over the points in which the body touches that thing at that instant, its
//! moment taken about the origin of the body's frame, both in that frame: what a sensor there would
//! measure. It is zero while they do not touch; where `contacts.csv` breaks off, it ends. Times count
//! from the beginning of the first pull.
//!
//! A field of `JointState` that was never recorded is empty, a joint of it that was not is NaN; a topic
//! of which nothing was recorded is left out, and so are a transform and a wrench of a body whose pose
//! is not known.

mod cdr;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::io::Cursor;

use glam::DVec3;
use mcap::records::MessageHeader;
use mcap::{McapError, WriteOptions, Writer};

use cdr::Cdr;
use prone_record::recorded::{Recorded, RecordedRow};

/// The frame in which the root moves.
const WORLD: &str = "world";

/// Between the definition of a message and those that it uses.
const RULE: &str =
    "================================================================================";

/// Definitions of the messages of ROS 2 (`common_interfaces`, `geometry2`), without comments.
const TIME: &str = "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
const HEADER: &str = "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n";
const VECTOR: &str = "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";
const QUATERNION: &str =
    "MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n";
const TRANSFORM: &str = "MSG: geometry_msgs/Transform\n\
    geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n";
const TRANSFORM_STAMPED: &str = "MSG: geometry_msgs/TransformStamped\n\
    std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n";
const WRENCH: &str =
    "MSG: geometry_msgs/Wrench\ngeometry_msgs/Vector3 force\ngeometry_msgs/Vector3 torque\n";
const JOINT_STATE: &str = "std_msgs/Header header\nstring[] name\n\
    float64[] position\nfloat64[] velocity\nfloat64[] effort\n";
const TF_MESSAGE: &str = "geometry_msgs/TransformStamped[] transforms\n";
const WRENCH_STAMPED: &str = "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n";

/// A body and what it touches, in the order of the topics.
type Pair<'a> = (usize, &'a str);

/// Force and moment.
type Wrench = (DVec3, DVec3);

/// Makes the file, with chunks, indices and checksums, not compressed.
pub fn log(record: &Recorded) -> Result<Vec<u8>, McapError> {
    let options = WriteOptions::new()
        .profile("ros2")
        .library(concat!("prone ", env!("CARGO_PKG_VERSION")))
        .compression(None);
    let mut log = Log {
        writer: options.create(Cursor::new(Vec::new()))?,
        sequences: BTreeMap::new(),
    };
    log.say_what(record)?;
    let joint_state = log.schema("sensor_msgs/msg/JointState", &[JOINT_STATE, HEADER, TIME])?;
    let wrench = [WRENCH_STAMPED, HEADER, TIME, WRENCH, VECTOR];
    let wrench = log.schema("geometry_msgs/msg/WrenchStamped", &wrench)?;
    let transform = [
        TRANSFORM_STAMPED,
        HEADER,
        TIME,
        TRANSFORM,
        VECTOR,
        QUATERNION,
    ];
    let tf = [&[TF_MESSAGE][..], &transform].concat();
    let tf = log.schema("tf2_msgs/msg/TFMessage", &tf)?;
    let states = log.channel(joint_state, "/joint_states")?;
    let angles = known(record, |row| row.angles.as_slice());
    let torques = known(record, |row| &row.motor_torque_nm);
    let commands = known(record, |row| row.command.as_slice());
    let commands = commands.map(|_| log.channel(joint_state, "/joint_commands"));
    let commands = commands.transpose()?;
    let poses = has_poses(record).then(|| log.channel(tf, "/tf"));
    let poses = poses.transpose()?;
    let mut pairs: BTreeMap<Pair<'_>, u16> = BTreeMap::new();
    for contact in &record.contacts {
        let pair = (contact.body, contact.with.as_str());
        if let Entry::Vacant(place) = pairs.entry(pair) {
            place.insert(log.channel(wrench, &contact_topic(record, pair))?);
        }
    }
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
    Ok(log.writer.into_inner().into_inner())
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

/// Letters, digits and underscores between slashes, as ROS wants it.
fn contact_topic(record: &Recorded, (body, with): Pair<'_>) -> String {
    let token = |name: &str| name.replace(|letter: char| !letter.is_ascii_alphanumeric(), "_");
    let body = token(&record.bodies[body].name);
    format!("/contacts/{body}/{}", token(with))
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
    /// How many messages each channel has.
    sequences: BTreeMap<u16, u32>,
}

impl Log {
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

    fn schema(&mut self, name: &str, definitions: &[&str]) -> Result<u16, McapError> {
        let text = definitions.join(&format!("{RULE}\n"));
        self.writer.add_schema(name, "ros2msg", text.as_bytes())
    }

    fn channel(&mut self, schema: u16, topic: &str) -> Result<u16, McapError> {
        self.writer
            .add_channel(schema, topic, "cdr", &BTreeMap::new())
    }

    fn write(&mut self, channel: u16, stamp: Stamp, message: &[u8]) -> Result<(), McapError> {
        let sequence = self.sequences.entry(channel).or_default();
        *sequence += 1;
        let Stamp(nanoseconds) = stamp;
        let header = MessageHeader {
            channel_id: channel,
            sequence: *sequence,
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
