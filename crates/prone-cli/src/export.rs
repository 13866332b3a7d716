//! `prone export`.

mod ffmpeg;
mod filming;
mod origin;

use std::io::Write as _;
use std::path::{Path, PathBuf};

use anyhow::anyhow;

use prone::gait::cycle::{CheckedCycle, TimeScale};
use prone_files::cycle_file;
use prone_sim::{Regime, World};
use prone_study::export::{key_frames, numpy, ros_log, table, timeline, urdf};
use prone_study::recorded::{Cut, Recorded};

use crate::args::{ExportArgs, Format};
use crate::{Failure, interrupt, table_file};

pub(crate) fn run(args: &ExportArgs) -> Result<(), Failure> {
    let is_film = matches!(args.format, Format::Mp4 | Format::Webp | Format::Gif);
    if !is_film {
        refuse_camera(args)?;
    }
    let record = Recorded::read(&args.run).map_err(Failure::input)?;
    let out = place(args)?;
    interrupt::listen()?;
    let said = if is_film {
        filming::run(args, &record, &out)?
    } else {
        let (bytes, said) = bytes(args, &record)?;
        interrupt::publish(|| {
            table_file::write(&out, &bytes).map_err(|error| cannot_write(&out, &error))
        })?;
        said
    };
    let mut stdout = std::io::stdout().lock();
    writeln!(stdout, "{}: {said}", out.display())?;
    drop(stdout);
    cut_off(&record)
}

/// The file's content, and what it holds.
fn bytes(args: &ExportArgs, record: &Recorded) -> Result<(Vec<u8>, String), Failure> {
    let held = format!("{}, {}", span(record), joints(record));
    match args.format {
        Format::Csv => Ok((table::of(record).map_err(Failure::work)?, held)),
        Format::Npz => Ok((numpy::of(record).map_err(Failure::work)?, held)),
        Format::Mcap => {
            let said = format!("{held}, {} contacts", record.contacts.len());
            Ok((ros_log::of(record).map_err(Failure::work)?, said))
        }
        Format::Urdf => {
            let robot = origin::robot(args, record)?;
            let world = World::new(&robot, Regime::LOCOMOTION).map_err(Failure::input)?;
            let (bodies, joints) = (robot.robot().bodies.len(), robot.robot().joints.len());
            let said = format!("{}, {bodies} links, {joints} hinges", robot.robot().name);
            Ok((urdf::of(&world).into_bytes(), said))
        }
        Format::Xar | Format::Keyframes => cycle(args, record),
        Format::Mp4 | Format::Webp | Format::Gif => unreachable!("films are made elsewhere"),
    }
}

/// One commanded cycle.
fn cycle(args: &ExportArgs, record: &Recorded) -> Result<(Vec<u8>, String), Failure> {
    let loaded = origin::robot(args, record)?;
    let robot = loaded.robot();
    let gait = &record.run.gait;
    let cycle = cycle_file::parse(&gait.file, &gait.text).map_err(Failure::input)?;
    let scale = TimeScale::new(record.run.options.time_scale).map_err(Failure::input)?;
    let checked =
        CheckedCycle::plan(robot, &robot.stops(), &cycle, 0.0, scale).map_err(Failure::input)?;
    let is_xar = args.format == Format::Xar;
    let tick = if is_xar {
        1.0 / timeline::FRAME_RATE
    } else {
        key_frames::TICK
    };
    let frames = key_frames::of(&checked, tick).map_err(Failure::input)?;
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
    let folder = match out.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let folder = folder
        .canonicalize()
        .map_err(|error| Failure::Input(anyhow!("cannot write {}: {error}", out.display())))?;
    // A record with other files in it would not be replaced by the next one.
    if args
        .run
        .canonicalize()
        .is_ok_and(|run| folder.starts_with(run))
    {
        return Err(Failure::Input(anyhow!(
            "{} is inside the record {}, which keeps its own files only",
            out.display(),
            args.run.display()
        )));
    }
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

fn cannot_write(out: &Path, error: &std::io::Error) -> Failure {
    Failure::Work(anyhow!("cannot write {}: {error}", out.display()))
}

/// What could not be read is said after what could be is written.
fn cut_off(record: &Recorded) -> Result<(), Failure> {
    if record.cuts.is_empty() {
        return Ok(());
    }
    let cuts: Vec<String> = record.cuts.iter().map(Cut::to_string).collect();
    Err(Failure::Input(anyhow!(
        "{}; exported is what can be read: {}",
        cuts.join(", "),
        span(record)
    )))
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
