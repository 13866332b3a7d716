//! `prone gait show` of a whole cycle: its pull, then the way back.

use std::io::Write;

use serde_json::json;

use prone::gait::cycle::{CheckedCycle, Cycle, TimeScale};
use prone::robot::Robot;
use prone_sim::LoadedRobot;
use prone_study::gait_sheet;

use super::find_cycle;
use crate::Failure;
use crate::args::GaitShowArgs;

pub(super) fn show(args: &GaitShowArgs, loaded: &LoadedRobot) -> Result<(), Failure> {
    let source = find_cycle(&loaded.files().gaits, args.gait.name())?;
    let cycle = &source.cycle;
    let robot = loaded.robot();
    let checked = CheckedCycle::plan(robot, &robot.stops(), cycle, 0.0, TimeScale::ONE)
        .map_err(|error| Failure::input(source.refused(&error)))?;
    let duration = args.duration.unwrap_or(cycle.pull_duration);
    let sheet = gait_sheet::of(robot, &cycle.pull, duration).map_err(Failure::input)?;
    if let Some(path) = &args.csv {
        super::write_csv(&sheet, path, &super::inputs(args, loaded)?)?;
    }
    let mut out = std::io::stdout().lock();
    if args.json {
        let waypoints = cycle.recovery.iter().map(|waypoint| {
            let degrees = waypoint.joints.iter();
            json!({
                "name": waypoint.name,
                "time_s": waypoint.approach.seconds,
                "easing": waypoint.approach.easing.name(),
                "joints_deg": degrees
                    .map(|(joint, angle)| (joint.clone(), json!(angle.to_degrees())))
                    .collect::<serde_json::Map<_, _>>(),
            })
        });
        let fastest = checked.fastest();
        let shown = json!({
            "pull": sheet,
            "recovery": waypoints.collect::<Vec<_>>(),
            "approach_s": cycle.approach.seconds,
            "cycle_s": cycle.duration(TimeScale::ONE),
            "fastest": {
                "joint": fastest.joint,
                "rad_s": fastest.speed,
                "limit_rad_s": fastest.limit,
            },
            "turn_limit_deg": cycle.steering.as_ref().map(|steering| steering.limit.to_degrees()),
        });
        let text = serde_json::to_string_pretty(&shown).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
    super::print(&sheet, robot, &mut out)?;
    print(cycle, &checked, robot, &mut out)?;
    Ok(())
}

fn print(
    cycle: &Cycle,
    checked: &CheckedCycle,
    robot: &Robot,
    out: &mut impl Write,
) -> std::io::Result<()> {
    let pull_s = cycle.pull_duration.seconds();
    writeln!(
        out,
        "\nwhole cycle: {:.2} s, of which {pull_s:.2} s are the pull",
        cycle.duration(TimeScale::ONE)
    )?;
    for (waypoint, (name, end)) in cycle.recovery.iter().zip(checked.recovery_ends()) {
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
    writeln!(
        out,
        "  {:.2} s  extension: the first posture of the next pull",
        pull_s + checked.recovery_seconds()
    )?;
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
