//! `prone robot check`, and loading the robot for all commands.

pub(crate) mod compile;

use std::io::Write as _;
use std::path::Path;

use anyhow::anyhow;
use serde::Serialize;

use prone::regime::Regime;
use prone_files::compiled_robot::CompiledRobotError;
use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles, World, WorldError};
use prone_study::robot_sheet::{self, ChainSheet, RobotSheet};

use crate::Failure;
use crate::args::RobotCheckArgs;
use crate::printed;

/// The robot of a folder or a name, or the one that ships.
pub(crate) fn load(name: Option<&Path>) -> Result<LoadedRobot, Failure> {
    LoadedRobot::load(files(name)?).map_err(Failure::input)
}

/// Its files.
pub(crate) fn files(name: Option<&Path>) -> Result<RobotFiles, Failure> {
    match name {
        None => Ok(RobotFiles::shipped(
            shipped::default_robot().map_err(Failure::input)?,
        )),
        Some(name) => RobotFiles::named(name).map_err(Failure::input),
    }
}

pub(crate) fn check(args: &RobotCheckArgs) -> Result<(), Failure> {
    let loaded = load(args.robot.name())?;
    loaded.files().recorded().map_err(Failure::input)?;
    World::new(&loaded, Regime::LOCOMOTION).map_err(Failure::input)?;
    // A robot that crawls is a robot; the study's servos are not its own.
    let no_torque_study = match World::new(&loaded, Regime::TORQUE_STUDY) {
        Ok(_) => None,
        Err(WorldError::Servo { source, .. }) => Some(source.to_string()),
        Err(error) => return Err(Failure::input(error)),
    };
    let folder = &loaded.files().folder;
    let compiled = compile::beside(&loaded);
    let checked = Checked {
        sheet: robot_sheet::of(loaded.robot()).map_err(Failure::input)?,
        asymmetries: loaded
            .asymmetries()
            .iter()
            .map(ToString::to_string)
            .collect(),
        no_torque_study,
        compiled: compiled.as_ref().map(|compiled| Compiled {
            fresh: compiled.is_ok(),
            refused: compiled.as_ref().err().map(ToString::to_string),
        }),
    };
    let mut out = printed::out();
    if args.json {
        let text = prone_record::output::json_text(&checked).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
    } else {
        print(&checked.sheet, folder, &mut out)?;
        if !checked.asymmetries.is_empty() {
            writeln!(out, "\nleft and right differ")?;
        }
        for asymmetry in &checked.asymmetries {
            writeln!(out, "  {asymmetry}")?;
        }
        if let Some(why) = &checked.no_torque_study {
            writeln!(out, "\nthe torque study does not run with it: {why}")?;
        }
    }
    if let Some(Err(error)) = compiled {
        return Err(refused(folder, &error));
    }
    if !args.json {
        writeln!(out, "\nvalid")?;
    }
    Ok(())
}

/// A compiled robot that cannot be used, with the command that writes it anew.
fn refused(folder: &str, error: &CompiledRobotError) -> Failure {
    let renewal = match error {
        // It names it itself.
        CompiledRobotError::Stale { .. } => String::new(),
        CompiledRobotError::Read(_)
        | CompiledRobotError::Json(_)
        | CompiledRobotError::Content { .. } => {
            format!("; `prone robot compile {folder}` writes it anew")
        }
    };
    Failure::Work(anyhow!(
        "the robot in {folder} is valid, but not the compiled one beside it: {error}{renewal}"
    ))
}

/// What is said of a robot.
#[derive(Serialize)]
struct Checked {
    #[serde(flatten)]
    sheet: RobotSheet,
    /// In what the sides differ, a sentence each.
    asymmetries: Vec<String>,
    /// Why the regime of the torque study does not take it, where it does not.
    no_torque_study: Option<String>,
    compiled: Option<Compiled>,
}

/// What is said of the compiled robot beside its sources.
#[derive(Serialize)]
struct Compiled {
    fresh: bool,
    refused: Option<String>,
}

fn print(sheet: &RobotSheet, folder: &str, out: &mut impl std::io::Write) -> std::io::Result<()> {
    writeln!(
        out,
        "{} ({folder}): {:.3} kg, {} bodies, {} joints, {} colliding shapes",
        sheet.robot, sheet.mass_kg, sheet.bodies, sheet.joints, sheet.shapes
    )?;
    writeln!(
        out,
        "\nclosed chain, toe to elbow{:>14}{:>12}",
        "derived", "published"
    )?;
    let labels = [
        "l1 toe-ankle, mm",
        "l2 ankle-knee, mm",
        "l3 knee-hip, mm",
        "l4 hip-shoulder, mm",
        "l5 shoulder-elbow (projected), mm",
        "d_e toe to elbow, mm",
        "ankle offset, °",
        "shoulder roll, °",
    ];
    let derived = values(&sheet.derived);
    let published = sheet.published.as_ref().map(values);
    for (index, label) in labels.iter().enumerate() {
        let theirs = published.map_or_else(|| "–".to_owned(), |p| format!("{:.2}", p[index]));
        writeln!(out, "  {label:<34}{:>8.2}{theirs:>12}", derived[index])?;
    }
    writeln!(
        out,
        "
outside the planar chain
  toe edge ahead of the ankle       {:>8.2} mm
  elbow radius                      {:>8.2} mm

{:<18}{:>20}{:>12}{:>13}{:>11}{:>11}",
        sheet.toe_edge_mm,
        sheet.elbow_radius_mm,
        "joint (left)",
        "range, °",
        "effort N·m",
        "nominal N·m",
        "stall N·m",
        "rad/s"
    )?;
    for drive in &sheet.drives {
        let [lower, upper] = drive.range_deg;
        let torque = |nm: Option<f64>| nm.map_or_else(|| "–".to_owned(), |nm| format!("{nm:.2}"));
        writeln!(
            out,
            "{:<18}{:>20}{:>12.3}{:>13}{:>11}{:>11.2}",
            drive.joint,
            format!("{lower:.1} … {upper:.1}"),
            drive.effort_nm,
            torque(drive.nominal_nm),
            torque(drive.stall_nm),
            drive.speed_rad_s
        )?;
    }
    writeln!(out, "\npostures: {}", sheet.postures.join(", "))?;
    for outside in &sheet.postures_outside {
        writeln!(
            out,
            "  {}: {} is {:+.3}° outside its range, and is held at its limit",
            outside.posture, outside.joint, outside.excess_deg
        )?;
    }
    Ok(())
}

fn values(chain: &ChainSheet) -> [f64; 8] {
    let [l1, l2, l3, l4, l5] = chain.links_mm;
    [
        l1,
        l2,
        l3,
        l4,
        l5,
        chain.span_mm,
        chain.ankle_offset_deg,
        chain.shoulder_roll_deg,
    ]
}
