//! `run.json` of the record of a crawl or a pull: the one type that is written and read.
//!
//! What a record does not say is `None`, and reports say `unknown`.

use serde::{Deserialize, Serialize};

use crate::head::Head;
use crate::origin::{Origin, RegimeInfo};
use crate::program::RobotInfo;

/// The format of records that is written and read; records before it have no number.
pub const FORMAT: u64 = 2;

/// The table of instants.
pub const ROWS_FILE: &str = "rows.csv";
/// The table of contacts.
pub const CONTACTS_FILE: &str = "contacts.csv";

/// What `run.json` says of a record.
#[derive(Debug, Clone, PartialEq, Deserialize)]
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
    pub origin: Origin,
    /// What was asked for beside robot, gait and scene.
    pub options: Options,
    /// What the tables hold.
    pub record: Extent,
}

/// The file as it is written: the regime of a simulation also stands by itself, for scripts.
#[derive(Serialize)]
struct Written<'a> {
    #[serde(flatten)]
    head: &'a Head<Command>,
    robot: &'a RobotInfo,
    gait: &'a GaitInfo,
    scene: &'a SceneInfo,
    #[serde(skip_serializing_if = "Option::is_none")]
    regime: Option<&'a RegimeInfo>,
    origin: &'a Origin,
    options: &'a Options,
    record: &'a Extent,
}

impl Serialize for RecordInfo {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let written = Written {
            head: &self.head,
            robot: &self.robot,
            gait: &self.gait,
            scene: &self.scene,
            regime: self.origin.regime(),
            origin: &self.origin,
            options: &self.options,
            record: &self.record,
        };
        written.serialize(serializer)
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

/// What was asked for, beside robot, gait and scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, from = "StatedOptions")]
pub enum Options {
    /// Of a pull.
    Pull(PullOptions),
    /// Of a crawl.
    Crawl(CrawlOptions),
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
#[derive(Debug, Clone, PartialEq, Serialize)]
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
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct CrawlOptions {
    /// After how many cycles it was to end, or at most.
    pub most_cycles: Option<usize>,
    /// Where it was to end, mm, if past the obstacles.
    pub until_past_mm: Option<f64>,
    /// What durations were multiplied by.
    pub time_scale: Option<f64>,
    /// `none`, `constant`, `heading` or `heading-hold`.
    pub steering: Option<String>,
    /// The constant turn command, degrees.
    pub turn_command_deg: Option<f64>,
    /// The heading that was turned to, degrees.
    pub heading_deg: Option<f64>,
    /// Largest calibration error of a joint, degrees.
    pub joint_offset_deg: Option<f64>,
    /// Seed of those errors.
    pub seed: Option<u64>,
    /// The errors themselves, rad, by joint; those of the other joints are zero.
    pub joint_offsets_rad: Vec<(String, f64)>,
    /// Text of the scene's file, where there is one.
    pub scene_text: Option<String>,
    /// File and text of the cycle that is taken uphill, where there is one.
    pub uphill: Option<(String, String)>,
}

/// The options as they stand in the file; a pull is known by its duration.
#[derive(Deserialize)]
struct StatedOptions {
    duration_s: Option<f64>,
    start_posture: Option<String>,
    most_cycles: Option<usize>,
    until_past_mm: Option<f64>,
    time_scale: Option<f64>,
    steering: Option<String>,
    turn_command_deg: Option<f64>,
    heading_deg: Option<f64>,
    joint_offset_deg: Option<f64>,
    seed: Option<u64>,
    #[serde(default)]
    joint_offsets_rad: Vec<(String, f64)>,
    scene_text: Option<String>,
    uphill: Option<(String, String)>,
}

impl From<StatedOptions> for Options {
    fn from(stated: StatedOptions) -> Self {
        if let Some(duration_s) = stated.duration_s {
            return Self::Pull(PullOptions {
                time_scale: stated.time_scale,
                scene_text: stated.scene_text,
                duration_s,
                start_posture: stated.start_posture,
            });
        }
        Self::Crawl(CrawlOptions {
            most_cycles: stated.most_cycles,
            until_past_mm: stated.until_past_mm,
            time_scale: stated.time_scale,
            steering: stated.steering,
            turn_command_deg: stated.turn_command_deg,
            heading_deg: stated.heading_deg,
            joint_offset_deg: stated.joint_offset_deg,
            seed: stated.seed,
            joint_offsets_rad: stated.joint_offsets_rad,
            scene_text: stated.scene_text,
            uphill: stated.uphill,
        })
    }
}

/// Which command has written a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Command {
    /// A crawl.
    #[serde(rename = "crawl run")]
    Crawl,
    /// A pull of the published study: no cycle, no way back.
    #[serde(rename = "reproduce pull")]
    ReproducePull,
    /// A crawl under the published table.
    #[serde(rename = "reproduce crawl")]
    ReproduceCrawl,
}

impl Command {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Crawl, Self::ReproducePull, Self::ReproduceCrawl];

    /// Its name in `run.json`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Crawl => "crawl run",
            Self::ReproducePull => "reproduce pull",
            Self::ReproduceCrawl => "reproduce crawl",
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
    /// Time between two rows, and of the first one, s; `None` where rows are unevenly spaced.
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
        let of_table = self
            .channels
            .iter()
            .filter(move |channel| channel.table == table);
        of_table
            .flat_map(|channel| &channel.columns)
            .map(String::as_str)
    }
}
