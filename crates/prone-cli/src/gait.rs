//! `prone gait show`, and finding a gait by name or file.

mod cycle;

use std::io::Write as _;
use std::path::Path;

use prone::foreign_text;
use prone::gait::{Gait, PhaseDuration};
use prone::robot::Robot;
use prone_files::gait_text::{GaitKind, GaitText};
use prone_files::gaits::Gaits;
use prone_files::{cycle_file, gait_file};
use prone_record::experiment::TextFile;
use prone_record::single_file;
use prone_study::crawl::GaitSource;
use prone_study::gait_sheet::{self, GaitSheet};

use crate::args::GaitShowArgs;
use crate::outputs::{Files, Kind};
use crate::printed;
use crate::{Failure, interrupt};

/// Every how many of the 101 instants one is printed.
const PRINTED_EVERY: usize = 10;

/// A pull by name, of the robot's own or of what ships, or the pull of a file; with its text.
pub(crate) fn find(gaits: &Gaits, name: &str) -> Result<(Gait, TextFile), Failure> {
    let gait = gaits.of_kind(GaitKind::Pull, name);
    parse(&gait.map_err(Failure::input)?)
}

/// The pull of a gait's text.
fn parse(gait: &GaitText) -> Result<(Gait, TextFile), Failure> {
    let text = TextFile::new(&gait.file, &gait.text);
    let gait = gait_file::parse(&gait.file, &gait.text).map_err(Failure::input)?;
    Ok((gait, text))
}

/// A cycle by name, of the robot's own or of what ships, or the cycle of a file; with the text of its
/// file.
pub(crate) fn find_cycle(gaits: &Gaits, name: &str) -> Result<GaitSource, Failure> {
    let gait = gaits.of_kind(GaitKind::Cycle, name);
    parse_cycle(gait.map_err(Failure::input)?)
}

/// The cycle of a gait's text.
fn parse_cycle(gait: GaitText) -> Result<GaitSource, Failure> {
    Ok(GaitSource {
        cycle: cycle_file::parse(&gait.file, &gait.text).map_err(Failure::input)?,
        file: gait.file,
        text: gait.text.into_owned(),
    })
}

/// A pull's duration where none is asked for, s.
const DURATION_S: f64 = 5.0;

pub(crate) fn show(args: &GaitShowArgs) -> Result<(), Failure> {
    let loaded = crate::robot::load(args.robot.name())?;
    let gaits = &loaded.files().gaits;
    let named = gaits.named(args.gait.name()).map_err(Failure::input)?;
    let read = named.read.iter();
    let files = read.fold(Files::of_robot(loaded.files()), Files::reading);
    let files = files.maybe_writing("--csv", args.csv.as_ref(), Kind::Quick);
    files.check()?;
    if named.is_cycle() {
        return cycle::show(args, &loaded, &parse_cycle(named)?);
    }
    let (gait, _) = parse(&named)?;
    let duration = match args.duration {
        Some(duration) => duration,
        None => PhaseDuration::new(DURATION_S).map_err(Failure::input)?,
    };
    let sheet = gait_sheet::of(loaded.robot(), &gait, duration).map_err(Failure::input)?;
    if let Some(path) = &args.csv {
        write_csv(&sheet, path)?;
    }
    let mut out = printed::out();
    if args.json {
        let text = prone_record::output::json_text(&sheet).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
    print(&sheet, loaded.robot(), &mut out)?;
    Ok(())
}

fn write_csv(sheet: &GaitSheet, path: &Path) -> Result<(), Failure> {
    let table = sheet.csv().map_err(Failure::work)?;
    interrupt::publish(|| Ok(single_file::write(path, &table)?))
}

fn print(sheet: &GaitSheet, robot: &Robot, out: &mut impl std::io::Write) -> std::io::Result<()> {
    print_table(sheet, out)?;
    print_limits(sheet, out)?;
    print_speeds(sheet, robot, out)?;
    print_heights(sheet, out)
}

fn print_table(sheet: &GaitSheet, out: &mut impl std::io::Write) -> std::io::Result<()> {
    let description = foreign_text::escaped(&sheet.description);
    writeln!(out, "{}: {description}", sheet.gait)?;
    writeln!(
        out,
        "on {}, {} s, mapping {}, arms {}\n",
        sheet.robot, sheet.duration_s, sheet.mapping, sheet.arm
    )?;
    let left = &sheet.joints[..sheet.joints.len() / 2];
    writeln!(out, "chain and left joints, degrees; heights, mm")?;
    write!(out, "{:>6}", "phase")?;
    for name in ["θ1", "θ2", "θ3", "θ4", "θ5", "α"] {
        write!(out, "{name:>8}")?;
    }
    for name in left {
        write!(out, "{name:>16}")?;
    }
    writeln!(out, "{:>9}{:>7}{:>7}", "ankle z", "hip z", "top")?;
    for row in sheet.rows.iter().step_by(PRINTED_EVERY) {
        write!(out, "{:>4.0} %", row.cycle_percent)?;
        for angle in row.chain_rad {
            write!(out, "{:>8.1}", angle.to_degrees())?;
        }
        for angle in &row.joints_rad[..left.len()] {
            write!(out, "{:>16.1}", angle.to_degrees())?;
        }
        let [ankle, _, hip, _] = row.centres_mm;
        writeln!(out, "{ankle:>9.1}{hip:>7.1}{:>7.1}", row.top_mm)?;
    }
    Ok(())
}

fn print_limits(sheet: &GaitSheet, out: &mut impl std::io::Write) -> std::io::Result<()> {
    writeln!(out, "\nlimits")?;
    if sheet.clamps.is_empty() {
        writeln!(out, "  all joints stay inside theirs")?;
    }
    for clamp in &sheet.clamps {
        writeln!(
            out,
            "  {} is stopped at its limit in {} of {} samples, {:.0} to {:.0} % of the phase; {:+.2}° cut off at most",
            clamp.joint,
            clamp.samples,
            sheet.rows.len(),
            clamp.from_percent,
            clamp.to_percent,
            clamp.largest_deg
        )?;
    }
    Ok(())
}

fn print_speeds(
    sheet: &GaitSheet,
    robot: &Robot,
    out: &mut impl std::io::Write,
) -> std::io::Result<()> {
    let limit = |name: &str| {
        let joint = robot.joints.iter().find(|joint| joint.name == name);
        joint.map_or(f64::NAN, |joint| joint.speed_limit)
    };
    let (fastest, speed) = &sheet.fastest;
    if !fastest.is_empty() {
        let limit = limit(fastest);
        writeln!(
            out,
            "  fastest: {fastest}, {speed:.2} rad/s; its limit is {limit:.2} rad/s"
        )?;
    }
    // Limits differ, so that it need not be the fastest that passes its own.
    for (index, joint) in sheet.joints.iter().enumerate() {
        let (speed, limit) = (top_speed(sheet, index), limit(joint));
        if speed > limit {
            writeln!(
                out,
                "    {joint} would need {speed:.2} rad/s, above its limit of {limit:.2} rad/s: it will lag behind"
            )?;
        }
    }
    Ok(())
}

/// Largest speed asked of a joint between two instants, rad/s.
fn top_speed(sheet: &GaitSheet, joint: usize) -> f64 {
    let speeds = sheet.rows.windows(2).map(|pair| {
        let turned = pair[1].joints_rad[joint] - pair[0].joints_rad[joint];
        turned.abs() / (pair[1].time_s - pair[0].time_s)
    });
    speeds.fold(0.0, f64::max)
}

fn print_heights(sheet: &GaitSheet, out: &mut impl std::io::Write) -> std::io::Result<()> {
    writeln!(
        out,
        "
heights and stride of the planned chain
  ankle's highest point (joint centre)  {:>7.1} mm
  highest point of the body             {:>7.1} mm
  lowest point of trunk, head and legs  {:>7.1} mm",
        sheet.ankle_peak_mm, sheet.top_mm, sheet.body_bottom_mm
    )?;
    if sheet.body_bottom_mm < 0.0 {
        writeln!(
            out,
            "    below the floor: there the body rests on it and cannot follow the chain"
        )?;
    }
    let stride_mm = sheet.stride_mm;
    writeln!(
        out,
        "  advance of the shoulder               {stride_mm:>7.1} mm"
    )
}
