//! Reading the record folder of a crawl: `run.json`, `model.json`, `rows.csv`, `contacts.csv`.
//!
//! What is read is SI and radians, whatever the columns have. A table that was cut off is read up
//! to its last complete row; rows and contacts then end at the same instant, and [`Recorded::cuts`]
//! says so.

mod table;

use std::fs;
use std::path::Path;

use glam::{DQuat, DVec3};
use serde::Deserialize;
use serde::de::DeserializeOwned;

use prone::frames::{Ground, Link, Point, Root, Transform};
use prone::robot::{ContactGroup, JointAngles};

use crate::output::RUN_FILE;
use table::Table;

/// The files of a record, beside `run.json`.
const MODEL_FILE: &str = "model.json";
const ROWS_FILE: &str = "rows.csv";
const CONTACTS_FILE: &str = "contacts.csv";

/// The command whose records are read here.
const COMMAND: &str = "crawl run";

/// The record of a crawl.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// Under which conditions it was made.
    pub run: RecordedRun,
    /// Parents before children; the first one is the root.
    pub bodies: Vec<RecordedBody>,
    /// Names of the joints, in the order of every row.
    pub joints: Vec<String>,
    /// The underside's height and the length of the first plate, m, where there is one.
    pub plate: Option<(f64, f64)>,
    /// In the order of time; at least one.
    pub rows: Vec<RecordedRow>,
    /// In the order of time.
    pub contacts: Vec<RecordedContact>,
    /// Tables that were cut off.
    pub cuts: Vec<Cut>,
}

/// What is needed of `run.json`.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct RecordedRun {
    /// Of the program that wrote it.
    pub version: String,
    /// From which that was built.
    pub commit: String,
    /// What crawled.
    pub robot: RecordedRobot,
    /// With which cycle.
    pub gait: RecordedGait,
    /// Where.
    pub scene: RecordedScene,
    /// What was asked for beside them.
    pub options: RecordedOptions,
}

/// Which robot it was.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct RecordedRobot {
    /// The maker's name.
    pub name: String,
    /// Its folder, as the user named it.
    pub folder: String,
    /// Of its files.
    pub sha256: String,
}

/// Which cycle it was.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct RecordedGait {
    /// Its name.
    pub name: String,
    /// Its file, as the user named it.
    pub file: String,
    /// The text of that file.
    pub text: String,
}

/// Which scene it was.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct RecordedScene {
    /// Its name.
    pub name: String,
}

/// Options that an export needs.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct RecordedOptions {
    /// What durations were multiplied by.
    pub time_scale: f64,
    /// Text of the scene's file, where there is one.
    pub scene_text: Option<String>,
}

/// A body of the robot.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedBody {
    /// Its name in the model.
    pub name: String,
    /// Its place among the bodies; `None` for the root.
    pub parent: Option<usize>,
    /// Pose in the parent with all joints at zero.
    pub parent_from_body: Transform<Link, Link>,
    /// What moves it in its parent.
    pub hinge: Option<Hinge>,
}

/// A hinge of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge {
    /// Its place in [`Recorded::joints`].
    pub joint: usize,
    /// Unit axis in the body's frame.
    pub axis: DVec3,
    /// A point of the axis in the body's frame.
    pub anchor: Point<Link>,
}

/// One instant.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedRow {
    /// Since the first pull began, s.
    pub time_s: f64,
    /// From 1.
    pub cycle: usize,
    /// Pose of the root.
    pub ground_from_root: Transform<Ground, Root>,
    /// What was commanded.
    pub command: JointAngles,
    /// What was reached.
    pub angles: JointAngles,
    /// Torque of the motors about the joints' axes, N·m.
    pub actuator_torque_nm: Vec<f64>,
    /// Normal force of the ground by [`ContactGroup::ALL`], both sides together, N.
    pub ground_n: [f64; 4],
}

/// A point of contact at one instant.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedContact {
    /// Since the first pull began, s.
    pub time_s: f64,
    /// Which body touches, by its place among the bodies.
    pub body: usize,
    /// What it touches: `floor`, or an obstacle's name.
    pub with: String,
    /// Where.
    pub at: Point<Ground>,
    /// On the robot, N, in the ground frame.
    pub force_n: DVec3,
}

/// A table that was cut off.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file} is cut off or damaged at line {line}")]
pub struct Cut {
    /// The file's path.
    pub file: String,
    /// The first line that cannot be used, from 1.
    pub line: usize,
}

/// Why a folder cannot be read as the record of a crawl.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// A file is missing.
    #[error("{folder} is not the record of a crawl: it has no {file}")]
    Missing {
        /// The folder.
        folder: String,
        /// What it does not have.
        file: &'static str,
    },
    /// A file cannot be read.
    #[error("cannot read {file}: {source}")]
    File {
        /// The file's path.
        file: String,
        /// Why.
        source: std::io::Error,
    },
    /// It is the result of another command.
    #[error("{folder} holds a result of {found}, not the record of `prone {COMMAND}`")]
    Command {
        /// The folder.
        folder: String,
        /// What wrote it.
        found: String,
    },
    /// It is the result of another version.
    #[error(
        "{folder} was written by prone {found}; this is prone {ours}, which reads its own only"
    )]
    Version {
        /// The folder.
        folder: String,
        /// What wrote it.
        found: String,
        /// What reads it.
        ours: &'static str,
    },
    /// A JSON file is not what it should be.
    #[error("{file}: {source}")]
    Json {
        /// The file's path.
        file: String,
        /// Where and why.
        source: serde_json::Error,
    },
    /// The model contradicts itself or the tables.
    #[error("{file}: {problem}")]
    Model {
        /// The file's path.
        file: String,
        /// What is wrong.
        problem: String,
    },
    /// A table lacks a column.
    #[error("{file} has no column {column}")]
    Column {
        /// The file's path.
        file: String,
        /// Its name.
        column: String,
    },
    /// A table has nothing to show.
    #[error("{file} has no complete row")]
    NoRows {
        /// The file's path.
        file: String,
    },
}

impl Recorded {
    /// Reads a record folder that this version of the program has written.
    ///
    /// # Errors
    /// [`ReadError`].
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let run = run(folder)?;
        let model: ModelFile = json(folder, MODEL_FILE)?;
        let (rows_at, rows_text) = text(folder, ROWS_FILE)?;
        let (contacts_at, contacts_text) = text(folder, CONTACTS_FILE)?;
        let rows_table = Table::new(&rows_at, &rows_text);
        let joints = rows_table.joints();
        let bodies = model.bodies(folder, &joints)?;
        let (mut rows, rows_cut) = rows_table.rows(&joints)?;
        let contacts_table = Table::new(&contacts_at, &contacts_text);
        let (mut contacts, contacts_cut) = contacts_table.contacts(&bodies)?;
        if contacts_cut.is_some() {
            // Of the last instant some contacts may be missing.
            let end = contacts
                .last()
                .map_or(f64::NEG_INFINITY, |last| last.time_s);
            rows.retain(|row| row.time_s < end);
        }
        let Some(last) = rows.last() else {
            let cut = contacts_cut.map_or(rows_at, |cut: Cut| cut.file);
            return Err(ReadError::NoRows { file: cut });
        };
        // Times have four decimals in both tables.
        let end = last.time_s + 1e-5;
        contacts.retain(|contact| contact.time_s <= end);
        Ok(Self {
            run,
            plate: model.plate(),
            bodies,
            joints,
            rows,
            contacts,
            cuts: rows_cut.into_iter().chain(contacts_cut).collect(),
        })
    }

    /// Time of the first and of the last row, s.
    pub fn span_s(&self) -> (f64, f64) {
        let time = |row: Option<&RecordedRow>| row.map_or(0.0, |row| row.time_s);
        (time(self.rows.first()), time(self.rows.last()))
    }

    /// Speed of each joint at each row, rad/s: the difference of the neighbouring rows' angles over
    /// the time between them.
    pub fn joint_speeds(&self) -> Vec<Vec<f64>> {
        let last = self.rows.len().saturating_sub(1);
        let speeds = (0..self.rows.len()).map(|index| {
            let before = &self.rows[index.saturating_sub(1)];
            let after = &self.rows[(index + 1).min(last)];
            let seconds = after.time_s - before.time_s;
            let pairs = before.angles.as_slice().iter().zip(after.angles.as_slice());
            let speed = |(from, to): (&f64, &f64)| {
                // A record of one row does not tell a speed.
                if seconds > 0.0 {
                    (to - from) / seconds
                } else {
                    0.0
                }
            };
            pairs.map(speed).collect()
        });
        speeds.collect()
    }

    /// Pose of each body in its parent at a row; the root's is that in the ground.
    pub fn parent_from_bodies(&self, row: &RecordedRow) -> Vec<Transform<Link, Link>> {
        let poses = self.bodies.iter().map(|body| {
            let rest = match body.parent {
                Some(_) => body.parent_from_body,
                None => Transform::new(
                    row.ground_from_root.rotation(),
                    row.ground_from_root.origin().metres(),
                ),
            };
            body.hinge.map_or(rest, |hinge| {
                let angle = row.angles.as_slice()[hinge.joint];
                let turn = DQuat::from_axis_angle(hinge.axis, angle);
                let anchor = hinge.anchor.metres();
                rest * Transform::new(turn, anchor - turn * anchor)
            })
        });
        poses.collect()
    }

    /// Pose of each body in the ground at a row.
    pub fn ground_from_bodies(&self, row: &RecordedRow) -> Vec<Transform<Ground, Link>> {
        let mut poses: Vec<Transform<Ground, Link>> = Vec::with_capacity(self.bodies.len());
        for (body, parent_from_body) in self.bodies.iter().zip(self.parent_from_bodies(row)) {
            let pose = match body.parent {
                Some(parent) => poses[parent] * parent_from_body,
                None => Transform::new(
                    parent_from_body.rotation(),
                    parent_from_body.origin().metres(),
                ),
            };
            poses.push(pose);
        }
        poses
    }
}

fn run(folder: &Path) -> Result<RecordedRun, ReadError> {
    let name = folder.display().to_string();
    let head: Head = json(folder, RUN_FILE)?;
    if head.command.as_deref() != Some(COMMAND) {
        let found = head.command.map(|command| format!("`prone {command}`"));
        return Err(ReadError::Command {
            folder: name,
            found: found.unwrap_or_else(|| "another command".to_owned()),
        });
    }
    let ours = env!("CARGO_PKG_VERSION");
    if head.version != ours {
        return Err(ReadError::Version {
            folder: name,
            found: head.version,
            ours,
        });
    }
    json(folder, RUN_FILE)
}

fn json<T: DeserializeOwned>(folder: &Path, file: &'static str) -> Result<T, ReadError> {
    let (at, text) = text(folder, file)?;
    serde_json::from_str(&text).map_err(|source| ReadError::Json { file: at, source })
}

/// A file's path and text.
fn text(folder: &Path, file: &'static str) -> Result<(String, String), ReadError> {
    let path = folder.join(file);
    if !path.exists() {
        return Err(ReadError::Missing {
            folder: folder.display().to_string(),
            file,
        });
    }
    let at = path.display().to_string();
    match fs::read_to_string(&path) {
        Ok(text) => Ok((at, text)),
        Err(source) => Err(ReadError::File { file: at, source }),
    }
}

/// What decides whether the rest of `run.json` can be read.
#[derive(Deserialize)]
struct Head {
    version: String,
    command: Option<String>,
}

#[derive(Deserialize)]
struct ModelFile {
    bodies: Vec<BodyEntry>,
    obstacles: Vec<ObstacleEntry>,
}

#[derive(Deserialize)]
struct BodyEntry {
    name: String,
    parent: Option<usize>,
    position: [f64; 3],
    quaternion: [f64; 4],
    joint: Option<JointEntry>,
}

#[derive(Deserialize)]
struct JointEntry {
    name: String,
    axis: [f64; 3],
    anchor: [f64; 3],
}

#[derive(Deserialize)]
struct ObstacleEntry {
    kind: String,
    half_edges: [f64; 3],
    position: [f64; 3],
}

impl ModelFile {
    fn bodies(&self, folder: &Path, joints: &[String]) -> Result<Vec<RecordedBody>, ReadError> {
        let problem = |problem: String| ReadError::Model {
            file: folder.join(MODEL_FILE).display().to_string(),
            problem,
        };
        let bodies = self.bodies.iter().enumerate().map(|(index, body)| {
            let name = &body.name;
            // Parents come first, and only the first body has none.
            if body.parent.is_none_or(|parent| parent >= index) && (index, body.parent) != (0, None)
            {
                return Err(problem(format!("body {name} has no parent before it")));
            }
            let hinge = body.joint.as_ref().map(|joint| {
                let place = joints.iter().position(|known| *known == joint.name);
                let joint_index = place
                    .ok_or_else(|| problem(format!("{ROWS_FILE} has no joint {}", joint.name)))?;
                Ok(Hinge {
                    joint: joint_index,
                    axis: DVec3::from_array(joint.axis),
                    anchor: Point::new(DVec3::from_array(joint.anchor)),
                })
            });
            let [w, x, y, z] = body.quaternion;
            Ok(RecordedBody {
                name: name.clone(),
                parent: body.parent,
                parent_from_body: Transform::new(
                    DQuat::from_xyzw(x, y, z, w),
                    DVec3::from_array(body.position),
                ),
                hinge: hinge.transpose()?,
            })
        });
        bodies.collect()
    }

    fn plate(&self) -> Option<(f64, f64)> {
        let plate = self.obstacles.iter().find(|it| it.kind == "plate")?;
        let underside = plate.position[2] - plate.half_edges[2];
        Some((underside, 2.0 * plate.half_edges[0]))
    }
}

/// The columns of [`RecordedRow::ground_n`].
fn ground_columns() -> [String; 4] {
    ContactGroup::ALL.map(|group| format!("{}_n", group.name()))
}

#[cfg(test)]
mod tests;
