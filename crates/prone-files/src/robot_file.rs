//! `robot.toml`: what a model file does not say about a robot.
//!
//! Which joints and sites make the crawling chain, which bodies count as toe, elbow, torso and
//! leg, the drives and their motors, postures, and how the torque study treats the robot. Names
//! refer to the MJCF file named in `model`; they keep their place in the text, so that a name
//! that the model lacks can be pointed at ([`RobotFile::error_at`]).

use std::collections::BTreeMap;

use serde::{Deserialize, Deserializer};
use toml::Spanned;

use prone::foreign_text;

use crate::defaults::DefaultsTable;
use crate::error::{FileError, Source};
use crate::exactly::{Exactly, exactly};
use crate::part_name;

/// Longest name of a robot, bytes.
pub(crate) const LONGEST_NAME: usize = 100;

/// Most tables of a kind, and lines of one: more than any robot has.
const MOST_TABLES: usize = 1_000;

/// A value with its place in the file.
pub type Placed<T> = Spanned<T>;

/// A name with its place in the file.
pub type Name = Placed<String>;

/// A number with its place in the file.
pub type Number = Placed<f64>;

/// The contents of a `robot.toml`, in the units that its keys state.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RobotFile {
    /// The manufacturer's name of the model.
    pub name: Name,
    /// The family that the robot is a version of.
    pub family: Option<Name>,
    /// The MJCF file beside this one.
    pub model: Name,
    /// How high the robot stands, mm.
    pub standing_height_mm: Option<Number>,
    /// The crawling chain.
    pub chain: ChainTable,
    /// Bodies whose contacts are recorded together; every body of the model once.
    pub contacts: ContactTable,
    /// Motor types by name.
    #[serde(default)]
    pub motors: BTreeMap<Name, MotorTable>,
    /// Joints with the same drive; every joint of the model once.
    pub drives: Vec<DriveTable>,
    /// Limits of joints that depend on the angle of another joint.
    #[serde(default)]
    pub coupled_limits: Vec<CoupledLimitTable>,
    /// Joint angles by posture and joint, rad; unlisted joints are at zero.
    #[serde(default)]
    pub postures: BTreeMap<Name, BTreeMap<Name, f64>>,
    /// The torque study.
    pub study: StudyTable,
    /// The inertial measurement unit.
    pub imu: Option<ImuTable>,
    /// How the robot is driven and steered.
    pub control: ControlTable,
    /// Within what searches look for cycles.
    pub search: SearchTable,
    /// What pictures have to know of the robot.
    pub pictures: PicturesTable,
    /// Which gaits the program uses.
    #[serde(default)]
    pub defaults: DefaultsTable,
}

/// `[chain]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ChainTable {
    /// Toe contact to elbow, mm.
    pub span_mm: Number,
    /// Shoulder to elbow in the sagittal plane, mm; the shoulder roll is solved for it.
    pub projected_upper_arm_mm: Number,
    /// Left limbs.
    pub left: SideTable,
    /// Right limbs.
    pub right: SideTable,
    /// A chain as printed in a publication.
    pub published: Option<PublishedTable>,
    /// The arm mode `fixed`, left side.
    pub fixed_arm: Option<FixedArmTable>,
}

/// `[chain.left]`, `[chain.right]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SideTable {
    /// Site of the toe contact.
    pub toe: Name,
    /// Ankle pitch joint.
    pub ankle: Name,
    /// Knee pitch joint.
    pub knee: Name,
    /// Hip pitch joint.
    pub hip: Name,
    /// Shoulder pitch joint.
    pub shoulder: Name,
    /// Joint that spreads the upper arm.
    pub shoulder_roll: Name,
    /// Site of the elbow's centre.
    pub elbow: Name,
    /// The two joints that point the forearm, upper one first.
    #[serde(deserialize_with = "exactly")]
    pub forearm: [Name; 2],
    /// Unit vector along the forearm in the frame of the body that the second one moves.
    #[serde(deserialize_with = "exactly")]
    pub forearm_direction: [f64; 3],
}

/// `[chain.published]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PublishedTable {
    /// l1 to l5, mm.
    #[serde(deserialize_with = "exactly")]
    pub links_mm: [f64; 5],
    /// Toe contact to elbow, mm.
    pub span_mm: f64,
    /// Ankle joint angle minus θ2, degrees.
    pub ankle_offset_deg: f64,
    /// Outward shoulder roll, degrees.
    pub shoulder_roll_deg: f64,
}

/// `[chain.fixed_arm]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FixedArmTable {
    /// Left shoulder roll, degrees.
    pub shoulder_roll_deg: f64,
    /// The left forearm's two joints, degrees.
    #[serde(deserialize_with = "exactly")]
    pub forearm_deg: [f64; 2],
}

/// `[contacts]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContactTable {
    /// Bodies that count as toe.
    pub toe: Vec<Name>,
    /// Bodies that count as elbow.
    pub elbow: Vec<Name>,
    /// Bodies that count as torso.
    pub torso: Vec<Name>,
    /// Bodies that count as leg.
    pub leg: Vec<Name>,
    /// Bodies that count as head, whose height is recorded apart.
    #[serde(default)]
    pub head: Vec<Name>,
    /// Bodies that count as hand.
    #[serde(default)]
    pub hand: Vec<Name>,
}

/// `[motors.<type>]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MotorTable {
    /// Continuous torque at the motor shaft, mN·m.
    pub nominal_mnm: Number,
    /// Stall torque at the motor shaft, mN·m.
    pub stall_mnm: Number,
    /// Speed of the motor shaft without load, turns per minute.
    pub no_load_rpm: Option<Number>,
}

/// `[[drives]]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DriveTable {
    /// The joints that have this drive.
    pub joints: Vec<Name>,
    /// Effort limit, N·m.
    pub effort_nm: Number,
    /// Speed limit, rad/s.
    pub speed_rad_s: Number,
    /// Torque that the servo asks for per position error, N·m/rad.
    pub servo_stiffness_nm_rad: Number,
    /// Whether one motor turns all joints of this drive together; the model ties them by equalities.
    #[serde(default)]
    pub one_motor: bool,
    /// Motor type, a key of `[motors]`.
    pub motor: Option<Name>,
    /// Gear ratio; needed where a motor is named.
    pub ratio: Option<Number>,
}

/// `[[coupled_limits]]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CoupledLimitTable {
    /// The joint that is limited.
    pub joint: Name,
    /// The joint by whose angle.
    pub by: Name,
    /// Angle of `by`, then lower and upper limit of `joint` there, degrees; angles of `by` rise.
    #[serde(deserialize_with = "lines")]
    pub table_deg: Vec<[f64; 3]>,
}

/// `[study]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyTable {
    /// The posture before the first command.
    pub start_posture: Name,
    /// Joint ranges that replace the manufacturer's, rad.
    #[serde(default, deserialize_with = "ranges")]
    pub stops_rad: BTreeMap<Name, [f64; 2]>,
}

/// `[imu]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImuTable {
    /// Site of the model's accelerometer and gyro.
    pub site: Name,
    /// Standard deviation of a sample, m/s².
    pub accelerometer_noise_m_s2: f64,
    /// Largest constant bias of an axis, m/s².
    pub accelerometer_bias_m_s2: f64,
    /// Standard deviation of a sample, rad/s.
    pub gyroscope_noise_rad_s: f64,
    /// Largest constant bias of an axis, rad/s.
    pub gyroscope_bias_rad_s: f64,
}

/// `[control]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ControlTable {
    /// Time between two commands, ms.
    pub command_step_ms: Number,
    /// Share of a motor's torque that its gear passes on.
    pub gear_efficiency: Number,
    /// Slope above which a cycle for going uphill is taken, degrees.
    pub uphill_deg: Number,
    /// How the robot is kept on its line.
    pub steering: SteeringTable,
}

/// `[control.steering]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SteeringTable {
    /// Turn commanded per heading error.
    pub yaw: Number,
    /// Heading error per lateral offset, rad/m.
    pub lateral_rad_m: Number,
    /// Heading error per sum of lateral offsets, rad/m.
    pub lateral_sum_rad_m: Number,
    /// Heading error per lateral offset of cycles that can be shifted, rad/m.
    pub aside_rad_m: Number,
    /// Turn commanded per sum of heading errors, of cycles that can be shifted.
    pub yaw_sum: Number,
    /// How far ahead of the root the point lies about which a turn turns cycles that can be shifted, m.
    pub ahead_m: Number,
}

/// `[search]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SearchTable {
    /// Least advance of a cycle, mm.
    pub least_advance_mm: Number,
    /// Least and greatest angle of the upper arm in a pull, rad.
    #[serde(deserialize_with = "exactly")]
    pub upper_arm_rad: [Number; 2],
}

/// `[pictures]`
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PicturesTable {
    /// How long the robot lies, stretched out, mm.
    pub lying_length_mm: Number,
}

impl RobotFile {
    /// Reads a `robot.toml`; `file` is the name that errors carry.
    ///
    /// # Errors
    /// [`FileError`] with line and column. Of a section or key that is missing or unknown it says where
    /// they are described: an older robot lacks those that came since, and has those that went.
    pub fn parse(file: &str, text: &str) -> Result<Self, FileError> {
        let source = Source { file, text };
        let robot: Self = source.parse().map_err(|error| {
            let of_another_time = ["missing field", "unknown field"];
            if !of_another_time
                .iter()
                .any(|it| error.message.starts_with(it))
            {
                return error;
            }
            let message = format!(
                "{}; docs/robot.md describes every section and key",
                error.message
            );
            FileError { message, ..error }
        })?;
        robot.check_names(source)?;
        robot.defaults.check(source)?;
        Ok(robot)
    }

    /// The names that it gives: to the robot, to motors and to postures.
    fn check_names(&self, source: Source<'_>) -> Result<(), FileError> {
        let bytes = self.name.get_ref().len();
        if !(1..=LONGEST_NAME).contains(&bytes) {
            let message = format!("the name of a robot has 1 to {LONGEST_NAME} bytes, not {bytes}");
            return Err(source.error(self.name.span(), message));
        }
        if self.name.get_ref().contains(foreign_text::is_hidden) {
            let name = foreign_text::Quoted(self.name.get_ref());
            let message = format!("the name of a robot has no letter that is not seen, not {name}");
            return Err(source.error(self.name.span(), message));
        }
        let motors = self.motors.keys().map(|name| ("motor", name));
        let postures = self.postures.keys().map(|name| ("posture", name));
        for (kind, name) in motors.chain(postures) {
            part_name::check(kind, name.get_ref())
                .map_err(|error| source.error(name.span(), error))?;
        }
        let lines = self
            .coupled_limits
            .iter()
            .map(|limit| limit.table_deg.len());
        let counts = [
            ("[[drives]]", self.drives.len(), MOST_TABLES),
            ("[[coupled_limits]]", self.coupled_limits.len(), MOST_TABLES),
            ("table_deg", lines.max().unwrap_or(0), MOST_TABLES),
            ("postures", self.postures.len(), MOST_TABLES),
        ];
        match counts.into_iter().find(|(_, count, most)| count > most) {
            None => Ok(()),
            Some((what, count, most)) => {
                let message = format!("{count} {what} are more than {most}");
                Err(source.error(self.name.span(), message))
            }
        }
    }

    /// An error at a name of this file; `file` and `text` as given to [`RobotFile::parse`].
    pub fn error_at<T>(file: &str, text: &str, place: &Spanned<T>, message: &str) -> FileError {
        Source { file, text }.error(place.span(), message)
    }
}

fn lines<'de, D: Deserializer<'de>>(table: D) -> Result<Vec<[f64; 3]>, D::Error> {
    let lines = Vec::<Exactly<f64, 3>>::deserialize(table)?;
    Ok(lines.into_iter().map(|Exactly(line)| line).collect())
}

fn ranges<'de, D: Deserializer<'de>>(table: D) -> Result<BTreeMap<Name, [f64; 2]>, D::Error> {
    let ranges = BTreeMap::<Name, Exactly<f64, 2>>::deserialize(table)?;
    Ok(ranges
        .into_iter()
        .map(|(joint, Exactly(range))| (joint, range))
        .collect())
}

#[cfg(test)]
mod tests {
    use crate::shipped::NAO;

    use super::*;

    #[test]
    fn arrays_of_another_length_are_refused_at_their_place() {
        for (from, to) in [
            ("[1.0, 0.0, 0.0]", "[1.0, 0.0, 0.0, 0.0]"),
            ("[\"LElbowYaw\", \"LElbowRoll\"]", "[\"LElbowYaw\"]"),
            ("188.5, 89.75]", "188.5, 89.75, 1]"),
            ("[-90.0, -87.0]", "[-90.0, -87.0, 0.0]"),
            (
                "LHipPitch = [-1.5359, 0.8]",
                "LHipPitch = [-1.5359, 0.8, 1.0]",
            ),
        ] {
            assert!(NAO.toml.contains(from), "{from}");
            let text = NAO.toml.replacen(from, to, 1);
            let error = RobotFile::parse("robot.toml", &text).unwrap_err();
            let line = text.lines().nth(error.line - 1).unwrap();
            assert!(line.contains(to), "{error} is not about {to}");
            assert!(
                error.message.contains("expected an array of exactly"),
                "{error}"
            );
            assert!(line[error.column - 1..].starts_with('['), "{error}");
        }
    }
}
