//! `run.json` of the record of a crawl or a pull: the one type that is written and read.
//!
//! What a record does not say is `None`, and reports say `unknown`.

use serde::{Deserialize, Serialize, Serializer};

use crate::head::Head;
use crate::origin::{Origin, RegimeInfo};
use crate::program::RobotInfo;

/// The format of records that is written and read; records before it have no number.
pub const FORMAT: u64 = 3;

/// The table of instants.
pub const ROWS_FILE: &str = "rows.csv";
/// The table of contacts.
pub const CONTACTS_FILE: &str = "contacts.csv";

/// What `run.json` says of a record.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RecordInfo {
    /// What wrote it.
    #[serde(flatten)]
    pub head: Head<Command>,
    /// What crawled.
    pub robot: RobotInfo,
    /// With which cycle or gait.
    pub gait: GaitInfo,
    /// Where.
    pub scene: SceneInfo,
    /// Simulated, driven or imported.
    #[serde(flatten, serialize_with = "regime_and_origin")]
    pub origin: Origin,
    /// What was asked for beside robot, gait and scene.
    pub options: Options,
    /// What the tables hold.
    pub record: Extent,
}

/// The regime of a simulation also stands by itself, for scripts.
fn regime_and_origin<S: Serializer>(origin: &Origin, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Keys<'a> {
        #[serde(skip_serializing_if = "Option::is_none")]
        regime: Option<&'a RegimeInfo>,
        origin: &'a Origin,
    }
    let regime = origin.regime();
    Keys { regime, origin }.serialize(serializer)
}

impl RecordInfo {
    /// What kind of thing was recorded.
    pub const fn kind(&self) -> Kind {
        self.head.command.kind()
    }
}

/// Which cycle or gait it was.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct GaitInfo {
    /// Its name.
    pub name: String,
    /// What it is, in words.
    pub description: Option<String>,
    /// Its file, as the user named it.
    pub file: Option<String>,
    /// Name of the mapping from chain angles to joints.
    pub mapping: Option<String>,
    /// Name of the arms' form.
    pub arm: Option<String>,
    /// Text of the gait's file.
    pub text: Option<String>,
}

/// Which scene it was.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneInfo {
    /// Its name.
    pub name: String,
    /// How many obstacles it has.
    pub obstacles: Option<usize>,
    /// Sliding friction at the robot's left.
    pub friction_left: Option<f64>,
    /// Sliding friction at the robot's right.
    pub friction_right: Option<f64>,
    /// Slope of the floor, degrees, uphill positive.
    pub slope_deg: Option<f64>,
    /// Whether the floor is rough.
    pub rough: Option<bool>,
}

/// What was asked for, beside robot, gait and scene; the [`Kind`] of the record says of what.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Options {
    /// Of a pull.
    Pull(PullOptions),
    /// Of a crawl, or of a robot that was driven.
    Crawl(Box<CrawlOptions>),
}

impl Options {
    /// What durations were multiplied by.
    pub const fn time_scale(&self) -> Option<f64> {
        match self {
            Self::Pull(pull) => pull.time_scale,
            Self::Crawl(crawl) => crawl.time_scale,
        }
    }

    /// Text of the scene's file, where there is one.
    pub fn scene_text(&self) -> Option<&str> {
        match self {
            Self::Pull(pull) => pull.scene_text.as_deref(),
            Self::Crawl(crawl) => crawl.scene_text.as_deref(),
        }
    }

    /// What only crawls have.
    pub const fn crawl(&self) -> Option<&CrawlOptions> {
        match self {
            Self::Pull(_) => None,
            Self::Crawl(crawl) => Some(crawl),
        }
    }
}

/// Options of a pull.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PullOptions {
    /// What durations were multiplied by.
    pub time_scale: Option<f64>,
    /// Text of the scene's file, where there is one.
    pub scene_text: Option<String>,
    /// How long the pull lasts, s.
    pub duration_s: f64,
    /// Posture that the pull begins from, in words.
    pub start_posture: Option<String>,
}

/// Options of a crawl.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CrawlOptions {
    /// After how many cycles it was to end, or at most.
    pub most_cycles: Option<usize>,
    /// Where it was to end, mm, if past the obstacles.
    pub until_past_mm: Option<f64>,
    /// What durations were multiplied by.
    pub time_scale: Option<f64>,
    /// How long it rested after each cycle, s.
    pub rest_s: Option<f64>,
    /// `none`, `constant`, `heading` or `heading-hold`.
    pub steering: Option<String>,
    /// The constant turn command, degrees.
    pub turn_command_deg: Option<f64>,
    /// The heading that was turned to, degrees.
    pub heading_deg: Option<f64>,
    /// Largest calibration error of a joint, degrees.
    pub joint_offset_deg: Option<f64>,
    /// Seed of those errors, of the noise of the inertial unit and of late commands.
    pub seed: Option<u64>,
    /// The errors themselves, rad, by joint; those of the other joints are zero.
    #[serde(default)]
    pub joint_offsets_rad: Vec<(String, f64)>,
    /// What masses and moments of inertia of the robot were multiplied by, where it did not weigh what
    /// its model says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_factor: Option<f64>,
    /// What the stiffness of the servos was multiplied by, where a factor was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness_factor: Option<f64>,
    /// Play of every gear, degrees, where there was any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backlash_deg: Option<f64>,
    /// Longest delay of late commands, ms, where they were late; the record has them as they reached the
    /// servos.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub late_commands_ms: Option<f64>,
    /// Text of the scene's file, where there is one.
    pub scene_text: Option<String>,
    /// File and text of the cycle that is taken uphill, where there is one.
    pub uphill: Option<(String, String)>,
}

/// Which command has written a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub enum Command {
    /// A crawl.
    #[serde(rename = "crawl run")]
    Crawl,
    /// A pull that was run by itself.
    #[serde(rename = "pull run")]
    Pull,
    /// A pull of the published study: no cycle, no way back.
    #[serde(rename = "reproduce pull")]
    ReproducePull,
    /// A crawl under the published table.
    #[serde(rename = "reproduce crawl")]
    ReproduceCrawl,
    /// What a driver recorded of a robot.
    #[serde(rename = "robot record")]
    Robot,
}

/// What kind of thing was recorded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// One pull: no cycle, no way back.
    Pull,
    /// A crawl of whole cycles.
    Crawl,
    /// Whatever a driver made a robot do.
    Driven,
}

impl Command {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Crawl,
        Self::Pull,
        Self::ReproducePull,
        Self::ReproduceCrawl,
        Self::Robot,
    ];

    /// Its name in `run.json`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Crawl => "crawl run",
            Self::Pull => "pull run",
            Self::ReproducePull => "reproduce pull",
            Self::ReproduceCrawl => "reproduce crawl",
            Self::Robot => "robot record",
        }
    }

    /// What kind of thing it records.
    pub const fn kind(self) -> Kind {
        match self {
            Self::Pull | Self::ReproducePull => Kind::Pull,
            Self::Crawl | Self::ReproduceCrawl => Kind::Crawl,
            Self::Robot => Kind::Driven,
        }
    }
}

/// A table of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Part {
    /// `rows.csv`.
    #[serde(rename = "rows.csv")]
    Rows,
    /// `contacts.csv`.
    #[serde(rename = "contacts.csv")]
    Contacts,
}

impl Part {
    /// Its file in the record folder.
    pub const fn file(self) -> &'static str {
        match self {
            Self::Rows => ROWS_FILE,
            Self::Contacts => CONTACTS_FILE,
        }
    }
}

/// What the tables of a record hold.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Extent {
    /// [`FORMAT`].
    pub format: u64,
    /// Rows of `rows.csv`.
    pub rows: usize,
    /// Time between two rows, and of the first one, s; `None` where rows are unevenly spaced. The last
    /// row ends with the record and may be shorter.
    #[serde(deserialize_with = "Option::deserialize")]
    pub row_step_s: Option<f64>,
    /// What was recorded. A column that is not listed was not.
    pub channels: Vec<Channel>,
}

/// Columns of one kind.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Channel {
    /// The file that holds them.
    pub table: Part,
    /// Names of the columns.
    pub columns: Vec<String>,
    /// What a value is.
    pub is: ChannelKind,
    /// Unit of the values; `1` for numbers without one.
    pub unit: String,
}

/// What a value of a row is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum ChannelKind {
    /// The mean since the row before.
    #[serde(rename = "mean over the row")]
    Mean,
    /// The sum since the row before.
    #[serde(rename = "sum over the row")]
    Sum,
    /// The value at the row's time.
    #[serde(rename = "instant")]
    Instant,
    /// What was commanded up to the row's time.
    #[serde(rename = "command")]
    Command,
}

impl Extent {
    /// Tables of [`FORMAT`].
    pub const fn new(rows: usize, row_step_s: Option<f64>, channels: Vec<Channel>) -> Self {
        Self {
            format: FORMAT,
            rows,
            row_step_s,
            channels,
        }
    }

    /// Whether a table was recorded.
    pub fn has(&self, table: Part) -> bool {
        self.channels.iter().any(|channel| channel.table == table)
    }

    /// Names of the recorded columns of a table.
    pub fn columns(&self, table: Part) -> impl Iterator<Item = &str> {
        let channels = self.channels.iter();
        let of_table = channels.filter(move |channel| channel.table == table);
        of_table.flat_map(|channel| channel.columns.iter().map(String::as_str))
    }
}
