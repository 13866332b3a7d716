//! One commanded cycle, as key frames or as a timeline.

use anyhow::anyhow;

use prone::gait::cycle::{CheckedCycle, TimeScale};
use prone::robot::Robot;
use prone_files::cycle_file;
use prone_record::record_info::{Kind, RecordInfo};
use prone_record::recorded::Recorded;
use prone_report::export::lag::Lags;
use prone_report::export::{key_frames, timeline};

use super::origin;
use crate::Failure;
use crate::args::{ExportArgs, Format};

/// The content of the file, and what it holds.
pub(super) fn export(args: &ExportArgs, run: &RecordInfo) -> Result<(Vec<u8>, String), Failure> {
    if run.kind() == Kind::Pull {
        return Err(Failure::Input(anyhow!(
            "{} is a pull alone: xar and keyframes are a whole cycle, with its way back",
            args.run.display()
        )));
    }
    let robot = &origin::recorded_robot(args, run)?;
    let is_xar = args.format == Format::Xar;
    if is_xar {
        timeline::check_robot(robot).map_err(Failure::input)?;
    }
    let (checked, seconds) = plan(args, run, robot)?;
    let tick = if is_xar {
        1.0 / timeline::FRAME_RATE
    } else {
        key_frames::TICK
    };
    let frames = key_frames::from_cycle(&checked, tick).map_err(Failure::input)?;
    frames.check_speeds(robot).map_err(Failure::input)?;
    let (lags, behind) = lags(args, run, robot);
    let bytes = if is_xar {
        timeline::xar(robot, checked.name(), &frames, &lags, &behind).into_bytes()
    } else {
        key_frames::json(robot, &checked, &frames, &lags).map_err(Failure::work)?
    };
    let said = format!(
        "one cycle of {}, {seconds:.2} s, {} key frames of {} joints; {behind}",
        checked.name(),
        frames.frames.len(),
        robot.joints.len()
    );
    Ok((bytes, said))
}

/// The run's cycle, and how long it lasts, s.
fn plan(
    args: &ExportArgs,
    run: &RecordInfo,
    robot: &Robot,
) -> Result<(CheckedCycle, f64), Failure> {
    let gait = &run.gait;
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
    Ok((checked, cycle.duration(scale)))
}

/// How far the record's joints were behind, and a sentence on it. A cycle needs no table: without
/// whole rows it is unknown, which is no failure.
fn lags<'a>(args: &ExportArgs, run: &RecordInfo, robot: &'a Robot) -> (Lags<'a>, String) {
    let unknown = "how far the joints were behind their commands is unknown";
    let record = match Recorded::read(&args.run) {
        Ok(record) => record,
        Err(error) => return (Lags::unknown(robot), format!("{unknown}: {error}")),
    };
    let lags = Lags::of(robot, &record);
    let place = match run.origin.regime() {
        Some(_) => "the simulation",
        None => "the record",
    };
    let behind = lags.sentence(place).unwrap_or_else(|| unknown.to_owned());
    (lags, behind)
}
