//! `prone export`.

mod ffmpeg;
mod filming;
mod origin;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::anyhow;

use prone::gait::cycle::{CheckedCycle, TimeScale};
use prone_files::cycle_file;
use prone_record::record_info::{Kind, RecordInfo};
use prone_record::recorded::{Recorded, RecordedModel};
use prone_record::single_file;
use prone_report::export::{key_frames, numpy, ros_log, table, timeline, urdf};

use crate::args::{ExportArgs, Format};
use crate::printed;
use crate::{Failure, interrupt, record_folder};

pub(crate) fn run(args: &ExportArgs) -> Result<(), Failure> {
    let is_film = matches!(args.format, Format::Mp4 | Format::Webp | Format::Gif);
    if !is_film {
        refuse_camera(args)?;
    }
    let run = RecordInfo::read(&args.run).map_err(Failure::input)?;
    let out = place(args)?;
    if args.robot.is_some() {
        // Also where the format does without: a wrong answer is not taken for none.
        origin::files(args, &run)?;
    }
    interrupt::listen()?;
    let parts = args.format.parts();
    if parts.is_empty() {
        let (bytes, said) = of_run(args, &run)?;
        return put(&out, &bytes, &said);
    }
    let record = Recorded::read(&args.run).map_err(Failure::input)?;
    if is_film {
        let said = filming::run(args, &record, &out)?;
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
    let said = |held: String| {
        let gaps = record.unrecorded().into_iter();
        let all: Vec<String> = std::iter::once(held).chain(gaps).collect();
        all.join("; ")
    };
    let held = format!("{}, {}", span(record), joints(record));
    match args.format {
        Format::Csv => {
            let bytes = table::csv(record).map_err(Failure::work)?;
            Ok((bytes, said(held)))
        }
        Format::Npz => {
            let bytes = numpy::archive(record).map_err(Failure::work)?;
            Ok((bytes, said(held)))
        }
        Format::Mcap => {
            let held = format!("{held}, {} contacts", record.contacts.len());
            Ok((ros_log::log(record).map_err(Failure::work)?, said(held)))
        }
        _ => unreachable!("the other formats are made elsewhere"),
    }
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
        _ => cycle(args, run),
    }
}

/// One commanded cycle.
fn cycle(args: &ExportArgs, run: &RecordInfo) -> Result<(Vec<u8>, String), Failure> {
    let gait = &run.gait;
    if run.kind() == Kind::Pull {
        return Err(Failure::Input(anyhow!(
            "{} is a pull alone: xar and keyframes are a whole cycle, with its way back",
            args.run.display()
        )));
    }
    let robot = &origin::recorded_robot(args, run)?;
    let unsaid = |what: &str| {
        let run = args.run.display();
        Failure::Input(anyhow!(
            "{run} does not say {what}: there is no cycle to export"
        ))
    };
    let text = gait.text.as_deref().ok_or_else(|| unsaid("its gait"))?;
    let file = gait.file.as_deref().unwrap_or(&gait.name);
    let cycle = cycle_file::parse(file, text).map_err(Failure::input)?;
    let scale = run.options.time_scale();
    let scale = scale.ok_or_else(|| unsaid("its time scale"))?;
    let scale = TimeScale::new(scale).map_err(Failure::input)?;
    let checked =
        CheckedCycle::plan(robot, &robot.stops(), &cycle, 0.0, scale).map_err(Failure::input)?;
    let is_xar = args.format == Format::Xar;
    let tick = if is_xar {
        1.0 / timeline::FRAME_RATE
    } else {
        key_frames::TICK
    };
    let frames = key_frames::from_cycle(&checked, tick).map_err(Failure::input)?;
    let bytes = if is_xar {
        timeline::xar(robot, checked.name(), &frames).into_bytes()
    } else {
        key_frames::json(robot, &checked, &frames).map_err(Failure::work)?
    };
    let said = format!(
        "one cycle of {}, {:.2} s, {} key frames of {} joints",
        checked.name(),
        cycle.duration(scale),
        frames.frames.len(),
        robot.joints.len()
    );
    Ok((bytes, said))
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
            args.format.ending()
        ))),
    }
}

/// Where the file goes: never over a file of the record, nor among them.
fn place(args: &ExportArgs) -> Result<PathBuf, Failure> {
    let out = args.out.clone().unwrap_or_else(|| default_place(args));
    record_folder::check_place(&out, &args.run)?;
    Ok(out)
}

fn default_place(args: &ExportArgs) -> PathBuf {
    // `.` has a name only by its place.
    let run = args.run.canonicalize().unwrap_or_else(|_| args.run.clone());
    let name = run
        .file_name()
        .map_or("run".into(), |name| name.to_string_lossy());
    PathBuf::from(format!("{name}.{}", args.format.ending()))
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
