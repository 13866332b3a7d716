//! Cycle files: a whole crawl cycle.
//!
//! ```toml
//! name = "low"
//! mapping = "original"     # these three as in a gait file; the first two belong to a pull
//! arm = "flat-forearm"
//! limits = "clamp"
//!
//! [pull]                   # the closed chain
//! duration_s = 1.0
//! [pull.knee]              # θ3, θ4 and α: curves as in a gait file
//! constant_deg = 20
//! [pull.hip]
//! constant_deg = 20
//! [pull.upper_arm]
//! linear_deg = [-30, -90]
//! [pull.joints.HeadPitch]  # joints that move beside it
//! linear_deg = [5, 28]
//!
//! [[recovery]]             # a waypoint; the other leg's and arm's joints mirror
//! name = "fold"
//! time_s = 0.5
//! easing = "smoothstep"    # or "linear"
//! joints_deg = { LHipPitch = -25, LKneePitch = 50 }
//! turn = { LHipRoll = 0.2 } # what a turn command adds, times this
//! shift = { LShoulderPitch = -0.2 } # and what a shift command adds
//!
//! [approach]               # from the last waypoint to the pull's first posture
//! time_s = 0.5
//!
//! [steering]
//! limit_deg = 12
//! shift_limit_deg = 12     # where waypoints have a shift
//! dead_band_deg = 1        # what of a command friction swallows at the waypoints
//! spread = 1.0             # in the pull
//! joints = { LHipRoll = -1, RHipRoll = -1 }
//! ```
//!
//! A cycle without a pull has `[[waypoint]]`s instead of `[[recovery]]`, and no `[approach]`: it goes
//! round through its waypoints, and the last one is where it begins. They need no name.

mod tables;
mod write;

pub use write::write;

use prone::gait::cycle::{Cycle, Waypoint};

use crate::error::{FileError, Source, line_and_column};
use crate::gait_file;

use tables::{CycleFile, usual_name};

/// Tables that a cycle file has and a gait file has not.
const OF_CYCLES: [&str; 3] = ["pull", "recovery", "waypoint"];

/// Whether a text is that of a cycle file and not of a gait file: it has a pull or waypoints.
pub fn is_cycle(text: &str) -> bool {
    let table = toml::from_str::<toml::Table>(text);
    table.is_ok_and(|table| OF_CYCLES.iter().any(|key| table.contains_key(*key)))
}

/// Reads a cycle from the text of a cycle file; `file` is the name that errors carry.
pub fn parse(file: &str, text: &str) -> Result<Cycle, FileError> {
    let source = Source { file, text };
    let table: CycleFile = source.parse()?;
    gait_file::check_name(source, &table.name)?;
    let alone = table.pull.is_none();
    let (waypoints, unused, key) = if alone {
        (table.waypoint, table.recovery, "[[recovery]]")
    } else {
        (table.recovery, table.waypoint, "[[waypoint]]")
    };
    if let Some(waypoint) = unused.first() {
        let message = if alone {
            format!(
                "{key} leads back to a pull, and there is no [pull]; a cycle without one has [[waypoint]]"
            )
        } else {
            format!("{key} is for cycles without a [pull]; the way back to one is [[recovery]]")
        };
        return Err(source.error(waypoint.time_s.span(), message));
    }
    let waypoints = waypoints.into_iter().enumerate();
    let waypoints = waypoints.map(|(index, waypoint)| source.waypoint(index, waypoint));
    let waypoints: Vec<Waypoint> = waypoints.collect::<Result<_, _>>()?;
    let steered = |it: &&Waypoint| !it.turn.is_empty() || !it.shift.is_empty();
    let turned = waypoints.iter().find(steered);
    if let (Some(waypoint), None) = (turned, &table.steering) {
        let message = format!(
            "waypoint {} is steered; [steering] with its limit_deg is missing",
            waypoint.name
        );
        return Err(source.error(table.name.span(), message));
    }
    let pull = match (table.pull, table.approach) {
        (Some(pull), Some(approach)) => {
            let approach = source.approach(&approach.time_s, approach.easing)?;
            Some(source.pull(pull, table.mapping, table.arm, approach)?)
        }
        (Some(pull), None) => {
            let message = "missing [approach]: it leads to the pull's first posture";
            return Err(source.error(pull.duration_s.span(), message));
        }
        (None, approach) => {
            let key = [
                approach.map(|it| (it.time_s.span(), "[approach]")),
                table.mapping.map(|it| (it.span(), "mapping")),
                table.arm.map(|it| (it.span(), "arm")),
            ];
            if let Some((span, key)) = key.into_iter().flatten().next() {
                let message = format!("{key} belongs to a pull, and there is no [pull]");
                return Err(source.error(span, message));
            }
            None
        }
    };
    let steering = table.steering.map(|it| source.steering(it, pull.is_some()));
    Ok(Cycle {
        name: table.name.into_inner(),
        description: table.description,
        limits: table.limits,
        pull,
        waypoints,
        rest: 0.0,
        steering: steering.transpose()?,
    })
}

/// The line, from 1, on which a part of a cycle stands in the text of its file: a waypoint's name,
/// or the table of `pull`, `steering` or `extension`, which `[approach]` leads to. Nothing where the
/// file has no such part.
pub fn line_of(text: &str, place: &str) -> Option<usize> {
    let table: CycleFile = toml::from_str(text).ok()?;
    let waypoints = table.recovery.iter().chain(&table.waypoint).enumerate();
    for (index, waypoint) in waypoints {
        let (name, span) = match &waypoint.name {
            Some(name) => (name.get_ref().clone(), name.span()),
            None => (usual_name(index), waypoint.time_s.span()),
        };
        if name == place {
            return Some(line_and_column(text, span.start).0);
        }
    }
    let header = match place {
        "extension" => "[approach",
        "pull" => "[pull",
        "steering" => "[steering",
        _ => return None,
    };
    let mut lines = text.lines();
    let index = lines.position(|line| line.trim_start().starts_with(header))?;
    Some(index + 1)
}

#[cfg(test)]
mod tests;
