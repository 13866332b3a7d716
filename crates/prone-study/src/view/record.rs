//! Reading a record folder of `prone crawl run`: all of it, or what of it is whole.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::pack::{self, Packed};
use super::table::{Table, number, text};
use crate::output::RUN_FILE;

const MODEL_FILE: &str = "model.json";
const ROWS_FILE: &str = "rows.csv";
const CONTACTS_FILE: &str = "contacts.csv";

/// What a folder must hold.
pub const FILES: [&str; 4] = [RUN_FILE, MODEL_FILE, ROWS_FILE, CONTACTS_FILE];

/// The only command whose records have all that is shown.
const COMMAND: &str = "crawl run";

/// Columns that hold no numbers.
const STAGE: &str = "stage";

/// The pose of the root.
const ROOT: [&str; 7] = ["x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"];

/// Columns that grow with a run, and are kept to seven digits.
const EXACT: [&str; 4] = ["time_s", "x_mm", "y_mm", "z_mm"];

const CONTACT_NUMBERS: [&str; 6] = ["x_mm", "y_mm", "z_mm", "fx_n", "fy_n", "fz_n"];

/// Two instants that differ by less are one, s: half of the last digit that is written.
const SAME_INSTANT: f64 = 0.5e-4;

/// Why nothing of a folder can be shown.
#[derive(Debug, thiserror::Error)]
pub enum ViewError {
    /// There is no record.
    #[error("{} is not a recorded run: {reason}", folder.display())]
    NotARun {
        /// The folder.
        folder: PathBuf,
        /// By what that is known.
        reason: String,
    },
    /// A record of another version of this program.
    #[error(
        "{} was recorded by prone {found}, this is prone {ours}: record it anew",
        folder.display()
    )]
    OtherVersion {
        /// The folder.
        folder: PathBuf,
        /// Of the record.
        found: String,
        /// Of this program.
        ours: &'static str,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {source}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file is not what it should be.
    #[error("{}: {reason}", file.display())]
    Damaged {
        /// The file.
        file: PathBuf,
        /// What is wrong.
        reason: String,
    },
}

/// A recorded run, ready for the page.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Run {
    title: String,
    /// Name and value.
    facts: Vec<(&'static str, String)>,
    notes: Vec<String>,
    model: Value,
    rows: usize,
    /// From which row on, by name.
    stages: Vec<(usize, String)>,
    channels: BTreeMap<String, Packed>,
    contacts: Option<Contacts>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
struct Contacts {
    counts: String,
    bodies: String,
    others: String,
    names: Vec<String>,
    channels: BTreeMap<&'static str, Packed>,
}

impl Run {
    /// Gait and scene.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// What of the record is missing, one sentence each.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// How many instants there are.
    pub const fn rows(&self) -> usize {
        self.rows
    }

    /// Adds to the title what tells this run from another of the same gait and scene.
    pub fn set_apart(&mut self, by: &str) {
        self.title = format!("{} ({by})", self.title);
    }
}

/// What of a model is looked at here; the script gets all of it.
#[derive(Deserialize)]
struct Model {
    bodies: Vec<Body>,
    #[serde(rename = "shapes")]
    _shapes: Vec<Value>,
    #[serde(rename = "chain")]
    _chain: Value,
    #[serde(rename = "obstacles")]
    _obstacles: Vec<Value>,
}

#[derive(Deserialize)]
struct Body {
    name: String,
    parent: Option<usize>,
    joint: Option<Joint>,
}

#[derive(Deserialize)]
struct Joint {
    name: String,
}

/// Reads a record folder. Where a table breaks off, what stands before is taken, and a note says so.
///
/// # Errors
/// [`ViewError`] where nothing can be shown.
pub fn read(folder: &Path) -> Result<Run, ViewError> {
    let run = run_file(folder)?;
    let (shown, model) = model_file(folder)?;
    let mut notes = Vec::new();
    let rows = rows_file(folder, &model, &mut notes)?;
    let contacts = contacts_file(folder, &model, &rows.times, &mut notes);
    let word = |pointer: &str| word(&run, pointer);
    Ok(Run {
        title: format!("{} · {}", word("/gait/name"), word("/scene/name")),
        facts: vec![
            (
                "gait",
                format!("{}: {}", word("/gait/name"), word("/gait/description")),
            ),
            ("robot", word("/robot/name")),
            ("scene", word("/scene/name")),
            (
                "regime",
                format!(
                    "{}, friction {}",
                    word("/regime/name"),
                    word("/regime/friction")
                ),
            ),
            ("steering", word("/options/steering")),
            ("engine", word("/engine")),
            (
                "recorded by",
                format!("prone {}, commit {}", word("/version"), word("/commit")),
            ),
            ("time step", format!("{} s", word("/regime/time_step_s"))),
        ],
        notes,
        model: shown,
        rows: rows.times.len(),
        stages: rows.stages,
        channels: rows.channels,
        contacts,
    })
}

/// A word or number of `run.json`.
fn word(run: &Value, pointer: &str) -> String {
    match run.pointer(pointer) {
        Some(Value::String(text)) => text.clone(),
        None | Some(Value::Null) => "not said".to_owned(),
        Some(other) => other.to_string(),
    }
}

fn run_file(folder: &Path) -> Result<Value, ViewError> {
    let not_a_run = |reason: String| ViewError::NotARun {
        folder: folder.to_owned(),
        reason,
    };
    if !folder.is_dir() {
        let there = folder.exists();
        return Err(not_a_run(
            if there {
                "it is not a folder"
            } else {
                "there is no such folder"
            }
            .to_owned(),
        ));
    }
    let path = folder.join(RUN_FILE);
    if !path.exists() {
        return Err(not_a_run(format!("it holds no {RUN_FILE}")));
    }
    let run: Value = serde_json::from_str(&text(&path)?)
        .map_err(|_| not_a_run(format!("its {RUN_FILE} is not JSON")))?;
    let said = |key: &str| run.get(key).and_then(Value::as_str);
    if said("program") != Some("prone") {
        return Err(not_a_run(format!(
            "its {RUN_FILE} does not say that prone wrote it"
        )));
    }
    if said("command") != Some(COMMAND) {
        return Err(not_a_run(format!(
            "it holds no crawl; `prone {COMMAND} --record` makes one"
        )));
    }
    let ours = env!("CARGO_PKG_VERSION");
    match said("version") {
        Some(version) if version == ours => Ok(run),
        found => Err(ViewError::OtherVersion {
            folder: folder.to_owned(),
            found: found.unwrap_or("of unknown version").to_owned(),
            ours,
        }),
    }
}

/// The model as the page gets it, and as it is looked at here.
fn model_file(folder: &Path) -> Result<(Value, Model), ViewError> {
    let path = folder.join(MODEL_FILE);
    let damaged = |reason: String| ViewError::Damaged {
        file: path.clone(),
        reason,
    };
    let mut shown: Value =
        serde_json::from_str(&text(&path)?).map_err(|error| damaged(error.to_string()))?;
    let model =
        Model::deserialize(&shown).map_err(|error| damaged(format!("not a model: {error}")))?;
    for (index, body) in model.bodies.iter().enumerate() {
        // The root has no parent; every other has one before it.
        if body.parent.is_none() != (index == 0) || body.parent.is_some_and(|above| above >= index)
        {
            return Err(damaged(format!(
                "body {} does not follow its parent",
                body.name
            )));
        }
    }
    shorten(&mut shown);
    Ok((shown, model))
}

/// Micrometres are enough for the eye.
fn shorten(value: &mut Value) {
    match value {
        Value::Array(values) => values.iter_mut().for_each(shorten),
        Value::Object(entries) => entries.values_mut().for_each(shorten),
        Value::Number(number) if number.is_f64() => {
            let short = number.as_f64().map(|exact| (exact * 1e6).round() / 1e6);
            // Zero has no sign to the eye.
            if let Some(short) = short.and_then(|short| serde_json::Number::from_f64(short + 0.0)) {
                *number = short;
            }
        }
        _ => {}
    }
}

struct Rows {
    times: Vec<f64>,
    stages: Vec<(usize, String)>,
    channels: BTreeMap<String, Packed>,
}

fn rows_file(folder: &Path, model: &Model, notes: &mut Vec<String>) -> Result<Rows, ViewError> {
    let path = folder.join(ROWS_FILE);
    let table = Table::read(&path)?;
    let damaged = |reason: String| ViewError::Damaged {
        file: path.clone(),
        reason,
    };
    let joints = model.bodies.iter().filter_map(|body| body.joint.as_ref());
    let angles = joints.map(|joint| format!("{}_rad", joint.name));
    let needed = ["time_s"].into_iter().chain(ROOT).map(str::to_owned);
    for column in needed.chain(angles) {
        if table.column(&column).is_none() {
            return Err(damaged(format!("there is no column {column}")));
        }
    }
    let numbers: Vec<usize> = (0..table.header.len())
        .filter(|&column| &table.header[column] != STAGE)
        .collect();
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); numbers.len()];
    let time = numbers
        .iter()
        .position(|&column| &table.header[column] == "time_s")
        .unwrap_or_default();
    let stage = table.column(STAGE);
    let mut stages: Vec<(usize, String)> = Vec::new();
    let mut broken = table.broken;
    for (index, record) in table.records.iter().enumerate() {
        let row: Option<Vec<f64>> = numbers
            .iter()
            .map(|&column| number(&record[column]))
            .collect();
        let last = columns[time].last().copied().unwrap_or(f64::NEG_INFINITY);
        let Some(row) = row.filter(|row| row[time] > last) else {
            broken = Some(index);
            break;
        };
        for (values, value) in columns.iter_mut().zip(row) {
            values.push(value);
        }
        if let Some(name) = stage.map(|column| &record[column])
            && stages.last().is_none_or(|(_, last)| last != name)
        {
            stages.push((index, name.to_owned()));
        }
    }
    let times = columns[time].clone();
    let Some(end) = times.last() else {
        return Err(damaged("it holds no whole row".to_owned()));
    };
    if let Some(row) = broken {
        notes.push(format!(
            "{ROWS_FILE} breaks off in line {}: the run is shown up to {end:.2} s.",
            row + 2
        ));
    }
    let channels = numbers.iter().zip(&columns).map(|(&column, values)| {
        let name = table.header[column].to_owned();
        let exact = EXACT.contains(&name.as_str());
        let packed = if exact {
            pack::floats(values)
        } else {
            pack::wholes(values)
        };
        (name, packed)
    });
    Ok(Rows {
        channels: channels.collect(),
        times,
        stages,
    })
}

/// The contacts of all rows; nothing, with a note, where there is no table of them.
fn contacts_file(
    folder: &Path,
    model: &Model,
    times: &[f64],
    notes: &mut Vec<String>,
) -> Option<Contacts> {
    let table = match Table::read(&folder.join(CONTACTS_FILE)) {
        Ok(table) => table,
        Err(error) => {
            notes.push(format!("No contact forces are shown: {error}."));
            return None;
        }
    };
    let place = |name: &str| table.column(name);
    let numbers: Option<Vec<usize>> = CONTACT_NUMBERS.iter().map(|name| place(name)).collect();
    let (Some(time), Some(body), Some(with), Some(numbers)) =
        (place("time_s"), place("body"), place("with"), numbers)
    else {
        notes.push(format!(
            "No contact forces are shown: {CONTACTS_FILE} lacks a column."
        ));
        return None;
    };
    let mut counts = vec![0_u16; times.len()];
    let (mut bodies, mut others) = (Vec::new(), Vec::new());
    let mut names: Vec<String> = Vec::new();
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); numbers.len()];
    let mut broken = table.broken;
    let mut row = 0;
    for (index, record) in table.records.iter().enumerate() {
        let values: Option<Vec<f64>> = numbers
            .iter()
            .map(|&column| number(&record[column]))
            .collect();
        let which = model
            .bodies
            .iter()
            .position(|known| known.name == record[body]);
        let (Some(at), Some(which), Some(values)) = (number(&record[time]), which, values) else {
            broken = Some(index);
            break;
        };
        while row < times.len() && times[row] < at - SAME_INSTANT {
            row += 1;
        }
        if row == times.len() {
            // The rows broke off before.
            break;
        }
        let other = names
            .iter()
            .position(|name| *name == record[with])
            .unwrap_or_else(|| {
                names.push(record[with].to_owned());
                names.len() - 1
            });
        let (Ok(which), Ok(other), Some(count)) = (
            u16::try_from(which),
            u16::try_from(other),
            counts[row].checked_add(1),
        ) else {
            broken = Some(index);
            break;
        };
        counts[row] = count;
        bodies.push(which);
        others.push(other);
        for (column, value) in columns.iter_mut().zip(values) {
            column.push(value);
        }
    }
    if let Some(line) = broken {
        notes.push(format!(
            "{CONTACTS_FILE} breaks off in line {}: later contact forces are missing.",
            line + 2
        ));
    }
    let channels = CONTACT_NUMBERS.into_iter().zip(&columns);
    Some(Contacts {
        counts: pack::counts(&counts),
        bodies: pack::counts(&bodies),
        others: pack::counts(&others),
        names,
        channels: channels
            .map(|(name, values)| (name, pack::wholes(values)))
            .collect(),
    })
}

#[cfg(test)]
mod tests;
