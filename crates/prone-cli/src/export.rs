//! `prone export`.

mod bag;
mod cycle;
mod ffmpeg;
mod filming;
mod origin;

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::anyhow;

use prone_record::record_info::RecordInfo;
use prone_record::recorded::{Recorded, RecordedModel};
use prone_record::single_file;
use prone_report::export::ros_log::{self, RosLog};
use prone_report::export::{numpy, table, urdf};

use crate::args::{ExportArgs, Format};
use crate::outputs::{Files, Kind};
use crate::printed;
use crate::{Failure, interrupt, record_folder};

pub(crate) fn run(args: &ExportArgs) -> Result<(), Failure> {
    let is_film = matches!(args.format, Format::Mp4 | Format::Webp | Format::Gif);
    if !is_film {
        refuse_camera(args)?;
    }
    let run = RecordInfo::read(&args.run).map_err(Failure::input)?;
    let out = place(args)?;
    let mut files = Files::default();
    if args.robot.is_some() {
        // Also where the format does without: a wrong answer is not taken for none.
        files = Files::of_robot(&origin::files(args, &run)?);
    }
    let kind = match args.format {
        Format::Bag => Kind::Folder,
        _ if is_film => Kind::Lasting,
        _ => Kind::Quick,
    };
    files.writing("--out", &out, kind).check()?;
    let parts = args.format.parts();
    if parts.is_empty() {
        let (bytes, said) = of_run(args, &run)?;
        return put(&out, &bytes, &said);
    }
    let record = Recorded::read(&args.run).map_err(Failure::input)?;
    if is_film {
        let said = filming::run(args, &record, &out)?;
        say(&out, &said)?;
    } else if args.format == Format::Bag {
        let (log, said) = ros_log(args, &record)?;
        bag::put(&out, &record, log)?;
        say(&out, &said)?;
    } else {
        let (bytes, said) = of_tables(args, &record)?;
        put(&out, &bytes, &said)?;
    }
    record_folder::say_incomplete(&[(&args.run, record.shortfalls(parts))])
}

/// Writes the file, and says what it holds.
fn put(out: &Path, bytes: &[u8], said: &str) -> Result<(), Failure> {
    interrupt::publish(|| single_file::write(out, bytes).map_err(Failure::work))?;
    say(out, said)
}

fn say(out: &Path, said: &str) -> Result<(), Failure> {
    writeln!(printed::out(), "{}: {said}", out.display())?;
    Ok(())
}

/// The content of a file that is made of the record's tables, and what it holds.
fn of_tables(args: &ExportArgs, record: &Recorded) -> Result<(Vec<u8>, String), Failure> {
    match args.format {
        Format::Csv => {
            let bytes = table::csv(record).map_err(Failure::work)?;
            Ok((bytes, held(record, "")))
        }
        Format::Npz => {
            let bytes = numpy::archive(record).map_err(Failure::work)?;
            Ok((bytes, held(record, "")))
        }
        Format::Mcap => {
            let (log, said) = ros_log(args, record)?;
            Ok((log.bytes, said))
        }
        _ => unreachable!("the other formats are made elsewhere"),
    }
}

/// The messages of ROS, and what they hold. What stands in the way of a description of the robot is
/// said and no failure: the other topics do without.
fn ros_log(args: &ExportArgs, record: &Recorded) -> Result<(RosLog, String), Failure> {
    let description = description(args, record);
    let text = description.as_ref().ok().map(String::as_str);
    let log = ros_log::log(record, text).map_err(Failure::input)?;
    let mut said = held(record, &format!(", {} contacts", record.contacts.len()));
    if let Err(reason) = description {
        let _ = write!(said, "; no /robot_description: {reason}");
    }
    Ok((log, said))
}

/// The robot as URDF, whose links have the frames of the record's bodies.
fn description(args: &ExportArgs, record: &Recorded) -> anyhow::Result<String> {
    let robot = match origin::recorded_robot(args, &record.run) {
        Ok(robot) => robot,
        Err(Failure::Input(error) | Failure::Work(error)) => return Err(error),
        Err(_) => return Err(anyhow!("the robot was not read")),
    };
    if let Some(body) = urdf::shifted_link(&robot) {
        return Err(anyhow!(
            "body {} is not hinged at its own origin, where the frame of its link would be",
            body.name
        ));
    }
    let model = RecordedModel::read(&args.run)?;
    Ok(urdf::from_record(&robot, &model)?)
}

/// What the tables hold, `more` of it, and what was never recorded.
fn held(record: &Recorded, more: &str) -> String {
    let held = format!("{}, {}{more}", span(record), joints(record));
    let gaps = record.unrecorded().into_iter();
    let all: Vec<String> = std::iter::once(held).chain(gaps).collect();
    all.join("; ")
}

/// The content of a file that needs no table, and what it holds.
fn of_run(args: &ExportArgs, run: &RecordInfo) -> Result<(Vec<u8>, String), Failure> {
    match args.format {
        Format::Urdf => {
            let robot = origin::recorded_robot(args, run)?;
            let model = RecordedModel::read(&args.run).map_err(Failure::input)?;
            let text = urdf::from_record(&robot, &model).map_err(Failure::input)?;
            let (bodies, joints) = (robot.bodies.len(), robot.joints.len());
            let said = format!("{}, {bodies} links, {joints} hinges", robot.name);
            Ok((text.into_bytes(), said))
        }
        _ => cycle::export(args, run),
    }
}

/// Options of a camera go with pictures only.
fn refuse_camera(args: &ExportArgs) -> Result<(), Failure> {
    let typed = [
        ("--view", args.view.is_some()),
        ("--size", args.size.is_some()),
        ("--fps", args.fps.is_some()),
        ("--from-s", args.from_s.is_some()),
        ("--to-s", args.to_s.is_some()),
    ];
    match typed.iter().find(|(_, typed)| *typed) {
        None => Ok(()),
        Some((option, _)) => Err(Failure::Input(anyhow!(
            "{option} goes with mp4, webp and gif, not with {}",
            args.format.name()
        ))),
    }
}

/// Where the file goes: never over a file of the record, nor among them.
fn place(args: &ExportArgs) -> Result<PathBuf, Failure> {
    let out = args.out.clone().unwrap_or_else(|| default_place(args));
    match args.format {
        Format::Bag => bag::check_place(&out, &args.run)?,
        _ => record_folder::check_place(&out, &args.run)?,
    }
    Ok(out)
}

fn default_place(args: &ExportArgs) -> PathBuf {
    // `.` has a name only by its place.
    let run = args.run.canonicalize().unwrap_or_else(|_| args.run.clone());
    let name = run
        .file_name()
        .map_or("run".into(), |name| name.to_string_lossy());
    PathBuf::from(format!("{name}{}", args.format.ending()))
}

fn span(record: &Recorded) -> String {
    let (from, to) = record.span_s();
    format!(
        "{} instants from {from:.2} s to {to:.2} s",
        record.rows.len()
    )
}

fn joints(record: &Recorded) -> String {
    format!("{} joints", record.joints.len())
}
