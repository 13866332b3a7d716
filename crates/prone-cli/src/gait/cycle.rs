//! `prone gait show` of a whole cycle: its pull, then the way back.

use std::io::Write;

use anyhow::anyhow;
use serde_json::json;

use prone::gait::cycle::{CheckedCycle, Cycle, TimeScale};
use prone::robot::Robot;
use prone_sim::LoadedRobot;
use prone_study::crawl::GaitSource;
use prone_study::gait_sheet::{self, GaitSheet};

use crate::Failure;
use crate::args::GaitShowArgs;
use crate::printed;

/// Shows a cycle on a robot.
pub(super) fn show(
    args: &GaitShowArgs,
    loaded: &LoadedRobot,
    source: &GaitSource,
) -> Result<(), Failure> {
    let cycle = &source.cycle;
    let robot = loaded.robot();
    let checked = CheckedCycle::plan(robot, &robot.stops(), cycle, 0.0, TimeScale::ONE)
        .map_err(|error| Failure::input(source.refused(&error)))?;
    let sheet = sheet(args, cycle, robot)?;
    match (&args.csv, &sheet) {
        (Some(path), Some(sheet)) => super::write_csv(sheet, path)?,
        (Some(_), None) => {
            return Err(Failure::Input(anyhow!(
                "{} has no pull: --csv writes the table of one",
                cycle.name
            )));
        }
        (None, _) => {}
    }
    let mut out = printed::out();
    if args.json {
        let waypoints = cycle.waypoints.iter().map(|waypoint| {
            let degrees = waypoint.joints.iter();
            json!({
                "name": waypoint.name,
                "time_s": waypoint.approach.seconds,
                "easing": waypoint.approach.easing.name(),
                "joints_deg": degrees
                    .map(|(joint, angle)| (joint.clone(), json!(angle.to_degrees())))
                    .collect::<serde_json::Map<_, _>>(),
                "turn": waypoint.turn,
            })
        });
        let fastest = checked.fastest();
        let shown = json!({
            "pull": sheet,
            "recovery": waypoints.collect::<Vec<_>>(),
            "approach_s": cycle.pull.as_ref().map(|pull| pull.approach.seconds),
            "cycle_s": cycle.duration(TimeScale::ONE),
            "fastest": {
                "joint": fastest.joint,
                "rad_s": fastest.speed,
                "limit_rad_s": fastest.limit,
            },
            "turn_limit_deg": cycle.steering.as_ref().map(|steering| steering.limit.to_degrees()),
        });
        let text = prone_record::output::json_text(&shown).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
    if let Some(sheet) = &sheet {
        super::print(sheet, robot, &mut out)?;
    }
    print(cycle, &checked, robot, &mut out)?;
    Ok(())
}

/// The table of the cycle's pull, where it has one.
fn sheet(args: &GaitShowArgs, cycle: &Cycle, robot: &Robot) -> Result<Option<GaitSheet>, Failure> {
    let (Some(pull), Some(gait)) = (&cycle.pull, cycle.gait()) else {
        return Ok(None);
    };
    let duration = args.duration.unwrap_or(pull.duration);
    let sheet = gait_sheet::of(robot, &gait, duration).map_err(Failure::input)?;
    Ok(Some(sheet))
}

fn print(
    cycle: &Cycle,
    checked: &CheckedCycle,
    robot: &Robot,
    out: &mut impl Write,
) -> std::io::Result<()> {
    let (pull_s, cycle_s) = (cycle.pull_seconds(), cycle.duration(TimeScale::ONE));
    match cycle.pull {
        Some(_) => writeln!(
            out,
            "\nwhole cycle: {cycle_s:.2} s, of which {pull_s:.2} s are the pull"
        )?,
        None => writeln!(out, "{}: {cycle_s:.2} s, waypoints alone", cycle.name)?,
    }
    for (waypoint, (name, end)) in cycle.waypoints.iter().zip(checked.recovery_ends()) {
        let degrees: Vec<_> = waypoint
            .joints
            .iter()
            .map(|(joint, angle)| format!("{joint} {:.0}°", angle.to_degrees()))
            .collect();
        writeln!(
            out,
            "  {:.2} s  {name}: {}",
            pull_s + end,
            degrees.join(", ")
        )?;
    }
    if cycle.pull.is_some() {
        writeln!(
            out,
            "  {:.2} s  extension: the first posture of the next pull",
            pull_s + checked.recovery_seconds()
        )?;
    }
    let fastest = checked.fastest();
    writeln!(
        out,
        "  nearest to its speed limit: {}, {:.2} of {:.2} rad/s",
        fastest.joint, fastest.speed, fastest.limit
    )?;
    for clamp in checked.clamps() {
        writeln!(
            out,
            "  {} is stopped at its limit: {:+.2}° cut off at most",
            robot.joints[clamp.joint.0].name,
            clamp.largest.to_degrees()
        )?;
    }
    match &cycle.steering {
        Some(steering) => writeln!(
            out,
            "  turns by commands of up to ±{:.0}°",
            steering.limit.to_degrees()
        ),
        None => writeln!(out, "  cannot turn"),
    }
}
