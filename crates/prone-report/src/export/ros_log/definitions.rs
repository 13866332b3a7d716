//! Definitions of the messages of ROS 2 (`common_interfaces`, `geometry2`), without comments.

/// Between the definition of a message and those that it uses.
const RULE: &str =
    "================================================================================\n";

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
const JOINT_STATE_FIELDS: &str = "std_msgs/Header header\nstring[] name\n\
    float64[] position\nfloat64[] velocity\nfloat64[] effort\n";
const TF_MESSAGE_FIELDS: &str = "geometry_msgs/TransformStamped[] transforms\n";
const WRENCH_STAMPED_FIELDS: &str = "std_msgs/Header header\ngeometry_msgs/Wrench wrench\n";
const STRING_FIELDS: &str = "string data\n";

/// A kind of message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Definition {
    /// Its name, with package and `msg`.
    pub(super) name: &'static str,
    /// Its own fields, then what they are made of.
    parts: &'static [&'static str],
}

pub(super) const JOINT_STATE: Definition = Definition {
    name: "sensor_msgs/msg/JointState",
    parts: &[JOINT_STATE_FIELDS, HEADER, TIME],
};
pub(super) const TF_MESSAGE: Definition = Definition {
    name: "tf2_msgs/msg/TFMessage",
    parts: &[
        TF_MESSAGE_FIELDS,
        TRANSFORM_STAMPED,
        HEADER,
        TIME,
        TRANSFORM,
        VECTOR,
        QUATERNION,
    ],
};
pub(super) const WRENCH_STAMPED: Definition = Definition {
    name: "geometry_msgs/msg/WrenchStamped",
    parts: &[WRENCH_STAMPED_FIELDS, HEADER, TIME, WRENCH, VECTOR],
};
pub(super) const STRING: Definition = Definition {
    name: "std_msgs/msg/String",
    parts: &[STRING_FIELDS],
};

impl Definition {
    /// The text of the schema, encoding `ros2msg`.
    pub(super) fn text(&self) -> String {
        self.parts.join(RULE)
    }
}
