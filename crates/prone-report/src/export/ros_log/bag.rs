//! `metadata.yaml`, which makes a folder with a log a bag of rosbag2.
//!
//! Its version is 5, that of Humble: every later release reads it, and Humble reads no later one. The
//! profiles of the topics are a text in it, the same as in the log.

use std::fmt::Write as _;

use super::qos::Qos;
use super::{RosLog, Topic};

/// The file in a bag's folder.
pub const METADATA_FILE: &str = "metadata.yaml";

const VERSION: u8 = 5;

/// Name of a bag's log, from the name of its folder, as `ros2 bag record` gives it.
pub fn log_name(folder: &str) -> String {
    format!("{folder}_0.mcap")
}

impl RosLog {
    /// The description of a bag whose only file is this log, under this name.
    pub fn metadata(&self, log_name: &str) -> String {
        let log_name = quoted(log_name);
        let (begin, duration) = (self.begin_ns, self.end_ns - self.begin_ns);
        let messages: u64 = self.topics.iter().map(|topic| topic.messages).sum();
        let mut topics = String::new();
        for Topic {
            name,
            kind,
            qos,
            messages,
        } in &self.topics
        {
            let qos = profile(*qos);
            // Writing to a text does not fail.
            let _ = write!(
                topics,
                "    - topic_metadata:\n        name: {name}\n        type: {kind}\n        \
                 serialization_format: cdr\n        offered_qos_profiles: {qos}\n      \
                 message_count: {messages}\n"
            );
        }
        format!(
            r#"rosbag2_bagfile_information:
  version: {VERSION}
  storage_identifier: mcap
  duration:
    nanoseconds: {duration}
  starting_time:
    nanoseconds_since_epoch: {begin}
  message_count: {messages}
  topics_with_message_count:
{topics}  compression_format: ""
  compression_mode: ""
  relative_file_paths:
    - {log_name}
  files:
    - path: {log_name}
      starting_time:
        nanoseconds_since_epoch: {begin}
      duration:
        nanoseconds: {duration}
      message_count: {messages}
"#
        )
    }
}

fn profile(qos: Qos) -> String {
    quoted(&qos.yaml())
}

/// A text as YAML's double quotes hold it: JSON is YAML.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
