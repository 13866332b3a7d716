//! Reading `run.json` of a record.

use std::collections::BTreeSet;
use std::path::Path;

use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use super::ReadError;
use super::model::MODEL_FILE;
use crate::head::Head;
use crate::output::RUN_FILE;
use crate::record_columns::{CONTACTS, Meaning, meaning};
use crate::record_info::{Command, Extent, FORMAT, Kind, Options, Part, RecordInfo};

/// Longest time between two rows, s: a record of a robot that is slower is none.
const LONGEST_STEP_S: f64 = 10.0;

impl RecordInfo {
    /// Reads `run.json` of a record that this version of the program has written.
    pub fn read(folder: &Path) -> Result<Self, ReadError> {
        let (head, run) = Head::read(folder)?;
        Self::from_json(folder, head, &run)
    }

    fn from_json(folder: &Path, head: Head, run: &Value) -> Result<Self, ReadError> {
        let file = folder.join(RUN_FILE).display().to_string();
        let mut commands = Command::ALL.into_iter();
        let Some(command) = commands.find(|known| head.command == known.name()) else {
            return Err(ReadError::Command {
                folder: folder.display().to_string(),
                found: format!("`prone {}`", head.command),
                inside: inside(folder, run),
            });
        };
        let format = run.pointer("/record/format").and_then(Value::as_u64);
        let found = format.unwrap_or(1);
        if found != FORMAT {
            let (version, commit) = (&head.version, &head.commit);
            let problem = format!(
                "the record has format {found}, written by prone {version} of commit {commit}; this \
                 build of prone reads format {FORMAT}: record it anew"
            );
            return Err(ReadError::Content { file, problem });
        }
        let info = Self::of_command(command, head, run);
        let checked = info.and_then(|info| check_extent(&info.record).map(|()| info));
        checked.map_err(|problem| ReadError::Content { file, problem })
    }

    /// Reads all keys behind the head; an error says which one is wrong.
    fn of_command(command: Command, head: Head, run: &Value) -> Result<Self, String> {
        Ok(Self {
            head: head.with(command),
            robot: value(run, "robot")?,
            gait: value(run, "gait")?,
            scene: value(run, "scene")?,
            origin: value(run, "origin")?,
            options: match command.kind() {
                Kind::Pull => Options::Pull(value(run, "options")?),
                Kind::Crawl | Kind::Driven => Options::Crawl(value(run, "options")?),
            },
            record: value(run, "record")?,
        })
    }
}

/// The value of a key of `run.json`.
fn value<T: DeserializeOwned>(run: &Value, key: &str) -> Result<T, String> {
    let found = run.get(key);
    let found = found.ok_or_else(|| format!("missing field `{key}`"))?;
    // As text: only then an error tells the line, which the key stands on.
    let text = format!("{found:#}");
    serde_json::from_str(&text).map_err(|error| {
        let message = error.to_string();
        let (line, column) = (error.line(), error.column());
        let message = message.trim_end_matches(&format!(" at line {line} column {column}"));
        let line = text.lines().nth(line.saturating_sub(1));
        let inner = line.and_then(|line| line.trim().strip_prefix('"')?.split_once("\": "));
        match inner {
            Some((inner, _)) => format!("{key}.{inner}: {message}"),
            None => format!("{key}: {message}"),
        }
    })
}

/// Checks that a record does not contradict itself, nor what its columns are.
fn check_extent(extent: &Extent) -> Result<(), String> {
    if let Some(step) = extent.row_step_s
        && !(step > 0.0 && step <= LONGEST_STEP_S)
    {
        return Err(format!(
            "row_step_s {step} is outside 0..{LONGEST_STEP_S} s"
        ));
    }
    let mut seen = BTreeSet::new();
    for channel in &extent.channels {
        for column in &channel.columns {
            let place = || format!("record.channels: {column} of {}", channel.table.file());
            if !seen.insert((channel.table.file(), column)) {
                return Err(format!("{} is listed twice", place()));
            }
            let Some(Meaning { unit, is }) = meaning(channel.table, column) else {
                continue;
            };
            if channel.unit != unit {
                return Err(format!("{} is in {unit}, not in {}", place(), channel.unit));
            }
            if !is.contains(&channel.is) {
                let [known, stated] = [is[0], channel.is].map(|kind| json!(kind));
                return Err(format!("{} is {known}, not {stated}", place()));
            }
        }
    }
    let counted = extent.columns(Part::Rows).any(|it| it == CONTACTS);
    if extent.has(Part::Contacts) && !counted {
        let missing = "record.channels lists contacts.csv without the column contacts of rows.csv";
        return Err(missing.to_owned());
    }
    Ok(())
}

/// Recorded runs in the folder of another result, by the list of its files.
fn inside(folder: &Path, run: &Value) -> Vec<String> {
    let files = run.get("artefacts").and_then(Value::as_array);
    let names = files.into_iter().flatten().filter_map(Value::as_str);
    let folders = names.filter_map(|name| name.strip_suffix(MODEL_FILE)?.strip_suffix('/'));
    folders
        .map(|inner| folder.join(inner).display().to_string())
        .collect()
}
