//! Hands a text to the readers of its format, within this process.
//!
//! What is found is a sentence. A panic and a signal are found by who calls: a fuzzer, or a campaign,
//! which does it in a child.

use std::fs;
use std::io;

use prone::gait::Gait;
use prone_files::compiled_robot::CompiledRobot;
use prone_files::robot_folder::RobotFiles;
use prone_files::shipped::NAO;
use prone_files::{cycle_file, gait_file, scene_file};
use prone_record::recorded::Recorded;
use prone_record::resumption::{Earlier, Opening, Snapshot, Work};
use prone_report::report::{Arrangement, Report, Source, Unpublished};
use prone_report::{export, view};
use prone_sim::LoadedRobot;
use serde_json::Value;

use crate::format::Format;
use crate::sane;
use crate::seeds::{Bed, Seeds, alone};

/// What a reader made of a text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Answer {
    /// It was read.
    Read,
    /// It was refused, with this message.
    Refused(String),
}

/// What must not be.
#[derive(Debug, thiserror::Error)]
pub enum Finding {
    /// The harness itself.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The program.
    #[error("{0}")]
    Wrong(String),
}

/// Reads texts of one format.
pub struct Reader {
    format: Format,
    seeds: Vec<String>,
    bed: Bed,
}

impl Reader {
    /// Makes the folder that texts of the format lie in.
    ///
    /// # Errors
    /// [`io::Error`].
    pub fn new(format: Format) -> io::Result<Self> {
        let seeds = Seeds::of_repository();
        Ok(Self {
            format,
            seeds: seeds.texts(format)?,
            bed: seeds.bed()?,
        })
    }

    /// The mutant of a number.
    pub fn mutant(&self, seed: u64) -> String {
        let seeds: Vec<&str> = self.seeds.iter().map(String::as_str).collect();
        crate::mutant(self.format, &seeds, seed)
    }

    /// Reads a text.
    ///
    /// # Errors
    /// [`Finding`] where what is made of it cannot be right.
    pub fn read(&self, text: &str) -> Result<Answer, Finding> {
        let answer = self.answer(text)?;
        match &answer {
            Answer::Refused(message) if message.trim().is_empty() => {
                Err(Finding::Wrong("refused without a word".to_owned()))
            }
            _ => Ok(answer),
        }
    }

    fn answer(&self, text: &str) -> Result<Answer, Finding> {
        let shipped = RobotFiles::shipped(&NAO);
        match self.format {
            Format::RobotXml => robot(RobotFiles {
                mjcf: text.to_owned(),
                ..shipped
            }),
            Format::RobotToml => robot(RobotFiles {
                toml: text.to_owned(),
                version: None,
                family_toml: None,
                ..shipped
            }),
            Format::Family => {
                self.bed.put(self.format, text)?;
                let family = self.bed.path().join("family");
                Ok(refused(
                    RobotFiles::read(&family).and_then(|files| files.defaults()),
                ))
            }
            Format::Pull => match gait_file::parse("gait.toml", text) {
                Err(error) => Ok(Answer::Refused(error.to_string())),
                Ok(gait) => pull(&gait),
            },
            Format::Cycle => match cycle_file::parse("cycle.toml", text) {
                Err(error) => Ok(Answer::Refused(error.to_string())),
                Ok(cycle) => {
                    let again = cycle_file::parse("written.toml", &cycle_file::write(&cycle, ""));
                    same("cycle", Ok(cycle), again.map_err(|error| error.to_string()))
                }
            },
            Format::Scene => Ok(refused(scene_file::parse("scene.toml", text))),
            Format::CompiledRobot => match CompiledRobot::parse("robot.compiled.json", text) {
                Err(error) => Ok(Answer::Refused(error.to_string())),
                Ok(robot) => {
                    let again = CompiledRobot::parse("written.json", &robot.text());
                    same(
                        "compiled robot",
                        Ok(robot),
                        again.map_err(|error| error.to_string()),
                    )
                }
            },
            Format::TorqueMap => Ok(refused(prone::torque_map::parse_recorded(text))),
            Format::Rows | Format::Contacts | Format::Run | Format::Model => {
                self.bed.put(self.format, text)?;
                self.record()
            }
            Format::Summary => self.report("record", text),
            Format::SearchResult | Format::History => self.report("search", text),
            Format::Checkpoint => self.resumed(text),
        }
    }

    /// The record, and what shows it.
    fn record(&self) -> Result<Answer, Finding> {
        let record = match Recorded::read(&self.bed.path().join("record")) {
            Ok(record) => record,
            Err(error) => return Ok(Answer::Refused(error.to_string())),
        };
        if record.rows.is_empty() {
            return Err(Finding::Wrong("a record without a row was read".to_owned()));
        }
        let names: std::collections::BTreeSet<&String> = record.joints.iter().collect();
        if names.len() < record.joints.len() {
            return Err(Finding::Wrong(
                "two joints of a record have one name".to_owned(),
            ));
        }
        let written = view::page(&[&view::record::from_record(&record)])
            .map(drop)
            .map_err(|error| error.to_string());
        let written = written.and_then(|()| {
            export::table::csv(&record)
                .map(drop)
                .map_err(|error| error.to_string())
        });
        let written = written.and_then(|()| {
            export::ros_log::log(&record, None)
                .map(drop)
                .map_err(|error| error.to_string())
        });
        let written = written.and_then(|()| {
            export::numpy::archive(&record)
                .map(drop)
                .map_err(|error| error.to_string())
        });
        Ok(refused(written))
    }

    fn report(&self, folder: &str, text: &str) -> Result<Answer, Finding> {
        self.bed.put(self.format, text)?;
        let source = Source {
            name: folder.to_owned(),
            folder: self.bed.path().join(folder),
        };
        Ok(refused(Report::from_folders(
            &[source],
            &Unpublished,
            Arrangement::Runs,
        )))
    }

    /// A state that is taken up is the one that was kept.
    fn resumed(&self, text: &str) -> Result<Answer, Finding> {
        let whole = &self.seeds[0];
        let head = whole.lines().next().unwrap_or_default();
        let head: Value = serde_json::from_str(head).map_err(io::Error::from)?;
        self.bed.put(self.format, text)?;
        let open = || {
            let result = self.bed.path().join("search");
            Snapshot::<Value>::open(Work::Search, &result, &head["plan"], Opening::Resume)
                .map(|(_, earlier)| earlier)
        };
        let taken = match open() {
            Err(error) => return Ok(Answer::Refused(error.to_string())),
            Ok(Earlier::State(state)) => state,
            Ok(_) => return Ok(Answer::Read),
        };
        fs::write(self.bed.file(self.format), whole)?;
        match open() {
            Ok(Earlier::State(kept)) if kept == taken => Ok(Answer::Read),
            _ => Err(Finding::Wrong(
                "a state that was changed was taken up".to_owned(),
            )),
        }
    }
}

fn refused<T, E: std::fmt::Display>(read: Result<T, E>) -> Answer {
    match read {
        Ok(_) => Answer::Read,
        Err(error) => Answer::Refused(error.to_string()),
    }
}

/// A robot that loads could be one.
fn robot(files: RobotFiles) -> Result<Answer, Finding> {
    let files = RobotFiles {
        toml: alone(&files.toml),
        version: None,
        family_toml: None,
        ..files
    };
    match LoadedRobot::load(files) {
        Err(error) => Ok(Answer::Refused(error.to_string())),
        Ok(loaded) => sane::check(&loaded)
            .map(|()| Answer::Read)
            .map_err(Finding::Wrong),
    }
}

/// A pull that is read has numbers everywhere, and is the same when it is written and read again.
fn pull(gait: &Gait) -> Result<Answer, Finding> {
    for sample in 0..=20 {
        let at = gait.parameters(f64::from(sample) / 20.0);
        let numbers = [at.knee, at.hip, at.upper_arm];
        if !numbers.iter().all(|angle| angle.is_finite()) {
            return Err(Finding::Wrong(format!(
                "a gait was read that has {numbers:?} at s = {sample}/20"
            )));
        }
    }
    let again = gait_file::parse("written.toml", &gait_file::write(gait, ""));
    same(
        "gait",
        Ok(gait.clone()),
        again.map_err(|error| error.to_string()),
    )
}

fn same<T: PartialEq>(
    what: &str,
    read: Result<T, String>,
    again: Result<T, String>,
) -> Result<Answer, Finding> {
    match (read, again) {
        (Ok(read), Ok(again)) if read == again => Ok(Answer::Read),
        (_, Err(error)) => Err(Finding::Wrong(format!(
            "a {what} that was read is refused when it is written again: {error}"
        ))),
        _ => Err(Finding::Wrong(format!(
            "a {what} that was read is another one when it is written again"
        ))),
    }
}
