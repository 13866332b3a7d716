//! Reading the record folder of a crawl or a pull: `run.json`, `model.json`, `rows.csv`,
//! `contacts.csv`, `robot.compiled.json`. Replay, exports and whatever else looks at a record read
//! it here.
//!
//! What is read is SI and radians, whatever the columns have. `run.json` says how many rows there
//! are, how far apart if they are evenly spaced, and which channels were recorded; each row says how
//! many contacts it has. A table that was cut off, also between two lines, or that lacks a line, is
//! read up to that place, and [`Recorded::cuts`] says so. The two tables are cut apart: rows do not
//! end where `contacts.csv` does. A channel that was not recorded, or a cell that is empty, is NaN,
//! and [`Recorded::unrecorded`] says so.

mod contacts;
mod cut;
mod error;
mod kinematics;
mod missing;
mod model;
mod robot;
mod rows;
mod run;
mod table;

use std::path::Path;

use prone::frames::{Ground, Point, Root, Transform};
use prone::robot::{ContactGroup, JointAngles};

pub use cut::{Cut, Damage};
pub use error::ReadError;
pub use model::{Hinge, Inertia, MODEL_FILE, RecordedBody, RecordedShape};
pub use robot::{RecordedModel, compiled_robot};

use crate::output::RUN_FILE;
use crate::record_info::RecordInfo;
pub use crate::record_info::{CONTACTS_FILE, Command, Part, ROWS_FILE};
use rows::Rows;
use table::Table;

/// The files of a record.
pub const FILES: [&str; 5] = [RUN_FILE, MODEL_FILE, ROWS_FILE, CONTACTS_FILE, ROBOT_FILE];

/// The compiled robot.
pub const ROBOT_FILE: &str = prone_files::compiled_robot::FILE_NAME;

/// The record of a crawl or a pull.
#[derive(Debug, Clone, PartialEq)]
pub struct Recorded {
    /// Under which conditions it was made.
    pub run: RecordInfo,
    /// `model.json` as it stands, for who draws.
    pub model: serde_json::Value,
    /// Parents before children; the first one is the root.
    pub bodies: Vec<RecordedBody>,
    /// Names of the joints, in the order of every row; joints of the model of which nothing was
    /// recorded stand last.
    pub joints: Vec<String>,
    /// The underside's height and the length of the first plate, m, where there is one.
    pub plate: Option<(f64, f64)>,
    /// In the order of time; at least one.
    pub rows: Vec<RecordedRow>,
    /// From which row on, by name; none where that was not recorded.
    pub stages: Vec<(usize, String)>,
    /// All columns of numbers by their names in `rows.csv`, in its units; an empty cell is NaN.
    pub columns: Vec<(String, Vec<f64>)>,
    /// In the order of time.
    pub contacts: Vec<RecordedContact>,
    /// How many of them each row has; fewer entries than rows where `contacts.csv` breaks off, none
    /// where contacts were not recorded.
    pub contact_counts: Vec<usize>,
    /// Tables of which something is missing.
    pub cuts: Vec<Cut>,
}

/// One instant. A number that was not recorded is NaN.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedRow {
    /// Since the first pull began, s.
    pub time_s: f64,
    /// From 1; 1 where cycles were not recorded.
    pub cycle: usize,
    /// Pose of the root; `None` where it was not recorded.
    pub ground_from_root: Option<Transform<Ground, Root>>,
    /// What was commanded.
    pub command: JointAngles,
    /// What was reached.
    pub angles: JointAngles,
    /// Torque of the motors about the joints' axes, N·m: of a simulation applied torque.
    pub motor_torque_nm: Vec<f64>,
    /// Normal force of the ground by [`ContactGroup::ALL`], both sides together, N.
    pub ground_n: [f64; ContactGroup::COUNT],
}

/// What a body meets, mean over a row.
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
    pub force_n: glam::DVec3,
}

impl Recorded {
    /// Reads a record folder that this version of the program has written. `contacts.csv` may be
    /// missing, which is a cut.
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let run = RecordInfo::read(folder)?;
        let model = model::Model::read(folder)?;
        let rows_text = error::text(folder, ROWS_FILE)?;
        let rows_table = Table::new(Part::Rows, &rows_text);
        let Rows {
            joints,
            instants: rows,
            stages,
            columns,
            contact_counts,
            cut: rows_cut,
        } = Rows::read(&rows_table, &run.record, &model.joints(), folder)?;
        let bodies = model.bodies(&joints)?;
        let found = if run.record.has(Part::Contacts) {
            contacts::read(
                folder,
                &run.record,
                &bodies,
                &rows,
                &contact_counts,
                rows_cut.as_ref(),
            )?
        } else {
            contacts::Contacts::default()
        };
        Ok(Self {
            run,
            plate: model.plate(),
            model: model.text,
            bodies,
            joints,
            rows,
            stages,
            columns,
            contact_counts: contact_counts[..found.rows].to_vec(),
            contacts: found.points,
            cuts: rows_cut.into_iter().chain(found.cut).collect(),
        })
    }

    /// Time of the first and of the last row, s.
    pub fn span_s(&self) -> (f64, f64) {
        let time = |row: Option<&RecordedRow>| row.map_or(0.0, |row| row.time_s);
        (time(self.rows.first()), time(self.rows.last()))
    }

    /// What is missing of some tables, and what is left of them, a sentence each.
    pub fn shortfalls(&self, parts: &[Part]) -> Vec<String> {
        let cuts = self.cuts.iter().filter(|cut| parts.contains(&cut.part));
        let sentences = cuts.map(|cut| {
            let (rows, known) = (self.rows.len(), self.contact_counts.len());
            let left = match cut.part {
                Part::Rows => {
                    let (end, all) = (self.span_s().1, self.run.record.rows);
                    format!("{rows} of {all} instants are left, up to {end:.2} s")
                }
                Part::Contacts => format!("contacts of {known} of {rows} instants are left"),
            };
            format!("{cut}; {left}")
        });
        sentences.collect()
    }
}

#[cfg(test)]
pub(crate) mod sample;
#[cfg(test)]
mod tests;
