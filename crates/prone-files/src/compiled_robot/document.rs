//! A robot as JSON: mirrors of the types in [`prone::robot`], whose keys say the units.
//!
//! Bodies and joints are referred to by name. Every key has to be there, those of optional parts
//! with `null`, and no other.

use serde::{Deserialize, Deserializer, Serialize};

/// A robot as it stands in a JSON text: in a compiled robot, and in whatever else will hold one.
///
/// [`RobotDocument::from_robot`] and [`RobotDocument::robot`] convert; in between it is text that
/// nobody has checked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotDocument {
    pub(super) name: String,
    #[serde(deserialize_with = "stated")]
    pub(super) standing_height_m: Option<f64>,
    pub(super) bodies: Vec<BodyDocument>,
    pub(super) joints: Vec<JointDocument>,
    pub(super) shapes: Vec<ShapeDocument>,
    pub(super) chain: ChainDocument,
    pub(super) postures: Vec<PostureDocument>,
    pub(super) study: StudyDocument,
    #[serde(deserialize_with = "stated")]
    pub(super) imu: Option<ImuDocument>,
    pub(super) control: ControlDocument,
    pub(super) search: SearchDocument,
    pub(super) lying_length_m: f64,
}

/// A rigid motion: where the source's origin is, and its rotation with the real part first.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoseDocument {
    pub(super) position_m: [f64; 3],
    pub(super) quaternion_wxyz: [f64; 4],
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyDocument {
    pub(super) name: String,
    #[serde(deserialize_with = "stated")]
    pub(super) parent: Option<String>,
    pub(super) parent_from_body: PoseDocument,
    #[serde(deserialize_with = "stated")]
    pub(super) joint: Option<String>,
    pub(super) mass_kg: f64,
    pub(super) centre_of_mass_m: [f64; 3],
    pub(super) contact_group: ContactGroupName,
    pub(super) is_head: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum ContactGroupName {
    Toe,
    Elbow,
    Torso,
    Leg,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct JointDocument {
    pub(super) name: String,
    pub(super) body: String,
    pub(super) axis: [f64; 3],
    pub(super) anchor_m: [f64; 3],
    pub(super) range_rad: [f64; 2],
    pub(super) effort_limit_nm: f64,
    pub(super) speed_limit_rad_s: f64,
    pub(super) servo_gain_nms: f64,
    #[serde(deserialize_with = "stated")]
    pub(super) motor: Option<MotorDocument>,
}

/// A geared motor; torques and speed are those at the joint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MotorDocument {
    pub(super) ratio: f64,
    pub(super) nominal_nm: f64,
    pub(super) stall_nm: f64,
    #[serde(deserialize_with = "stated")]
    pub(super) no_load_speed_rad_s: Option<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ShapeDocument {
    pub(super) name: String,
    pub(super) body: String,
    pub(super) link_from_geom: PoseDocument,
    pub(super) solid: SolidDocument,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub(super) enum SolidDocument {
    Sphere { radius_m: f64 },
    Capsule { radius_m: f64, half_length_m: f64 },
    Ellipsoid { half_axes_m: [f64; 3] },
    Cylinder { radius_m: f64, half_length_m: f64 },
    Cuboid { half_edges_m: [f64; 3] },
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChainDocument {
    pub(super) left: SideDocument,
    pub(super) right: SideDocument,
    pub(super) span_m: f64,
    pub(super) projected_upper_arm_m: f64,
    #[serde(deserialize_with = "stated")]
    pub(super) published: Option<PublishedDocument>,
    #[serde(deserialize_with = "stated")]
    pub(super) fixed_arm: Option<FixedArmDocument>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SideDocument {
    pub(super) toe: PointDocument,
    pub(super) ankle: String,
    pub(super) knee: String,
    pub(super) hip: String,
    pub(super) shoulder: String,
    pub(super) shoulder_roll: String,
    pub(super) elbow: PointDocument,
    pub(super) forearm: [String; 2],
    pub(super) forearm_direction: [f64; 3],
}

/// A point of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PointDocument {
    pub(super) body: String,
    pub(super) position_m: [f64; 3],
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PublishedDocument {
    /// l1 to l5.
    pub(super) links_m: [f64; 5],
    pub(super) span_m: f64,
    pub(super) ankle_offset_rad: f64,
    pub(super) shoulder_roll_rad: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FixedArmDocument {
    pub(super) shoulder_roll_rad: f64,
    pub(super) forearm_rad: [f64; 2],
}

/// A posture, one angle for each joint in their order. Postures are a list, not an object: of two
/// keys with one name JSON's readers take the last one in silence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PostureDocument {
    pub(super) name: String,
    pub(super) angles_rad: Vec<f64>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StudyDocument {
    pub(super) start_posture: String,
    pub(super) stops: Vec<StopDocument>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct StopDocument {
    pub(super) joint: String,
    pub(super) range_rad: [f64; 2],
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ImuDocument {
    pub(super) site: String,
    pub(super) root_from_sensor: PoseDocument,
    pub(super) accelerometer_m_s2: NoiseDocument,
    pub(super) gyroscope_rad_s: NoiseDocument,
}

/// What a sensor adds to the truth, in its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NoiseDocument {
    pub(super) standard_deviation: f64,
    pub(super) bias_bound: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ControlDocument {
    pub(super) command_step_s: f64,
    pub(super) servo_rate_per_s: f64,
    pub(super) servo_speed_rad_s: f64,
    pub(super) stiff_servo_gain_nms: f64,
    pub(super) steering: SteeringDocument,
    pub(super) uphill_rad: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SteeringDocument {
    pub(super) yaw: f64,
    pub(super) lateral_rad_m: f64,
    pub(super) lateral_sum_rad_m: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SearchDocument {
    pub(super) least_advance_m: f64,
    pub(super) upper_arm_rad: [f64; 2],
}

/// An optional part whose key must be there: one that is left out is a text that was cut, not a
/// robot without the part.
pub(super) fn stated<'de, D, T>(deserializer: D) -> Result<Option<T>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    Option::deserialize(deserializer)
}
