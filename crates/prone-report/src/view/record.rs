//! A record, packed for the page: all of it, or what of it is whole.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;
use serde_json::Value;

use prone::foreign_text;

use super::pack::{self, Packed};
use prone_record::origin::Origin;
use prone_record::record_info::{Options, RecordInfo};
use prone_record::recorded::{Part, ReadError, Recorded, RecordedContact};

/// Columns that grow with a run, and are kept to seven digits.
const EXACT: [&str; 4] = ["time_s", "x_mm", "y_mm", "z_mm"];

/// A recorded run, ready for the page.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Run {
    title: String,
    /// Name and value.
    facts: Vec<(&'static str, String)>,
    notes: Vec<String>,
    /// How many of the notes, from the first on, are of tables that break off.
    #[serde(skip)]
    cuts: usize,
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

    /// What of the record is missing because a table breaks off, one sentence each.
    pub fn shortfalls(&self) -> &[String] {
        &self.notes[..self.cuts]
    }

    /// What was never recorded, and what that means for the replay, one sentence each.
    pub fn gaps(&self) -> &[String] {
        &self.notes[self.cuts..]
    }

    /// How many instants there are.
    pub const fn rows(&self) -> usize {
        self.rows
    }

    /// Adds to the title what tells this run from another of the same gait and scene.
    pub fn set_apart(&mut self, by: &str) {
        self.title = format!("{} ({})", self.title, shown(by));
    }
}

/// Reads a record folder. Where a table breaks off, what stands before is taken, and a note says so.
///
/// # Errors
/// [`ReadError`] where nothing can be shown.
pub fn read(folder: &Path) -> Result<Run, ReadError> {
    Ok(from_record(&Recorded::read(folder)?))
}

/// Packs a record.
pub fn from_record(record: &Recorded) -> Run {
    let mut model = record.model.clone();
    strip_inertia(&mut model);
    shorten(&mut model);
    let channels = record.columns.iter().map(|(name, values)| {
        let packed = if EXACT.contains(&name.as_str()) {
            pack::floats(values)
        } else {
            pack::wholes(values)
        };
        (shown(name), packed)
    });
    let mut channels: BTreeMap<String, Packed> = channels.collect();
    if record.rows.iter().all(|row| row.ground_from_root.is_none()) {
        for place in ["x_mm", "y_mm", "z_mm"] {
            let at_origin = || pack::floats(&vec![0.0; record.rows.len()]);
            channels.entry(place.to_owned()).or_insert_with(at_origin);
        }
    }
    let run = &record.run;
    let mut notes = record.shortfalls(&[Part::Rows, Part::Contacts]);
    let cuts = notes.len();
    notes.extend(gaps(record));
    Run {
        title: shown(&format!("{} · {}", run.gait.name, run.scene.name)),
        facts: facts(run),
        notes: notes.iter().map(|note| shown(note)).collect(),
        cuts,
        model,
        rows: record.rows.len(),
        stages: record
            .stages
            .iter()
            .map(|(row, name)| (*row, shown(name)))
            .collect(),
        channels,
        contacts: contacts(record),
    }
}

/// What *About* says; what a record does not say is left out.
fn facts(run: &RecordInfo) -> Vec<(&'static str, String)> {
    let (robot, gait, head) = (&run.robot, &run.gait, &run.head);
    let (steering, pull_s) = match &run.options {
        Options::Crawl(crawl) => (crawl.steering.clone(), None),
        Options::Pull(pull) => (None, Some(pull.duration_s)),
    };
    let about = gait.description.as_ref();
    let version = robot.version.as_ref().map(|_| robot.version_name());
    let (mut contacts, mut time_step) = (None, None);
    if let Some(regime) = run.origin.regime() {
        contacts = Some(format!("{}, friction {:?}", regime.name, regime.friction));
        time_step = Some(format!("{:?} s", regime.time_step_s));
    }
    let (program, commit, command) = (&head.version, &head.commit, head.command.name());
    let facts = [
        ("gait", about.map(|text| format!("{}: {text}", gait.name))),
        ("robot", Some(robot.name.clone())),
        ("robot's version", version),
        ("scene", Some(run.scene.name.clone())),
        ("regime", contacts),
        ("steering", steering),
        ("pull", pull_s.map(|seconds| format!("{seconds:?} s"))),
        ("engine", head.engine.clone()),
        ("recorded on", not_simulated(&run.origin)),
        (
            "recorded by",
            Some(format!("prone {program}, commit {commit}, {command}")),
        ),
        ("time step", time_step),
    ];
    let known = facts.into_iter();
    known
        .filter_map(|(name, value)| Some((name, shown(&value?))))
        .collect()
}

/// Where a record comes from that was not simulated.
pub(crate) fn not_simulated(origin: &Origin) -> Option<String> {
    match origin {
        Origin::Simulated(_) => None,
        Origin::Robot(robot) => Some(format!("the robot {}", robot.host)),
        Origin::Imported(imported) => Some(format!("imported from {}", imported.from)),
    }
}

/// What a replay cannot show of a record, one sentence each.
fn gaps(record: &Recorded) -> Vec<String> {
    let mut gaps = record.unrecorded();
    if record.rows.iter().all(|row| row.ground_from_root.is_none()) {
        gaps.push("the replay leaves the robot's root where it is, at the origin".to_owned());
    }
    if !record.has_all_angles() {
        gaps.push(
            "joints without an angle cannot be replayed: the page draws them at zero".to_owned(),
        );
    }
    gaps
}

/// A replay turns nothing by torques.
fn strip_inertia(model: &mut Value) {
    let bodies = model.get_mut("bodies").and_then(Value::as_array_mut);
    for body in bodies.into_iter().flatten() {
        if let Some(body) = body.as_object_mut() {
            body.remove("inertia");
        }
    }
}

/// A text of the record as a page shows it.
fn shown(text: &str) -> String {
    foreign_text::escaped(text).into_owned()
}

/// Micrometres are enough for the eye, and letters that it does not see are shown.
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
        Value::String(text) => *text = shown(text),
        _ => {}
    }
}

/// A number of a contact.
type Number = fn(&RecordedContact) -> f64;

/// The contacts of all rows, as far as they are known; nothing where none are.
fn contacts(record: &Recorded) -> Option<Contacts> {
    if record.contact_counts.is_empty() {
        return None;
    }
    let mut names: Vec<String> = Vec::new();
    let mut others = Vec::with_capacity(record.contacts.len());
    for contact in &record.contacts {
        let known = names.iter().position(|name| *name == shown(&contact.with));
        others.push(known.unwrap_or_else(|| {
            names.push(shown(&contact.with));
            names.len() - 1
        }));
    }
    let mut counts = record.contact_counts.clone();
    counts.resize(record.rows.len(), 0);
    let bodies = record.contacts.iter().map(|contact| contact.body);
    let numbers: [(&'static str, Number); 6] = [
        ("x_mm", |contact| contact.at.metres().x * 1e3),
        ("y_mm", |contact| contact.at.metres().y * 1e3),
        ("z_mm", |contact| contact.at.metres().z * 1e3),
        ("fx_n", |contact| contact.force_n.x),
        ("fy_n", |contact| contact.force_n.y),
        ("fz_n", |contact| contact.force_n.z),
    ];
    let channels = numbers.into_iter().map(|(name, of)| {
        let values: Vec<f64> = record.contacts.iter().map(of).collect();
        (name, pack::wholes(&values))
    });
    Some(Contacts {
        counts: pack::counts(counts),
        bodies: pack::counts(bodies),
        others: pack::counts(others),
        names,
        channels: channels.collect(),
    })
}

#[cfg(test)]
mod tests;
