//! `prone torque-map compare`.

use std::io::Write as _;

use anyhow::anyhow;

use prone_study::torque_map::compare::{self, Comparison, MaskCounts, WorstRow};

use crate::Failure;
use crate::args::CompareArgs;
use crate::printed;

pub(crate) fn run(args: &CompareArgs) -> Result<(), Failure> {
    let (a, b) = (super::read(&args.a)?, super::read(&args.b)?);
    let comparison = compare::compare(&a, &b, usize::from(args.worst)).map_err(|error| {
        let (a, b) = (args.a.display(), args.b.display());
        Failure::Input(anyhow!("{a} and {b}: {error}"))
    })?;
    let mut out = printed::out();
    if args.json {
        let text = prone_record::output::json_text(&comparison).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
    } else {
        print(&comparison, args, &mut out)?;
    }
    Ok(())
}

fn print(
    comparison: &Comparison,
    args: &CompareArgs,
    out: &mut impl std::io::Write,
) -> std::io::Result<()> {
    let Comparison {
        rows,
        common_nodes,
        compared,
        masked,
        ..
    } = comparison;
    for (name, path, rows, masked) in [
        ("A", &args.a, rows.a, &masked.a),
        ("B", &args.b, rows.b, &masked.b),
    ] {
        writeln!(out, "{name}: {}, {rows} rows", path.display())?;
        if rows > *common_nodes {
            let alone = rows - common_nodes;
            writeln!(out, "   {alone:>6} at nodes that the other does not have")?;
        }
        print_masked(masked, out)?;
    }
    writeln!(out, "{compared} rows compared, those with torques in both")?;
    print_joints(comparison, out)?;
    if let Some(modes) = &comparison.modes {
        let (same, known) = (modes.same, modes.known);
        writeln!(out, "\nthe same parts carry in {same} of {known} rows")?;
    }
    if !comparison.worst.is_empty() {
        print_worst(&comparison.worst, out)?;
    }
    Ok(())
}

fn print_masked(masked: &MaskCounts, out: &mut impl std::io::Write) -> std::io::Result<()> {
    for (mask, count) in masked.by_mask() {
        if count > 0 {
            writeln!(out, "   {count:>6} left out: {mask}")?;
        }
    }
    Ok(())
}

fn print_joints(comparison: &Comparison, out: &mut impl std::io::Write) -> std::io::Result<()> {
    writeln!(
        out,
        "\n{:<10}{:>12}{:>10}{:>16}{:>16}",
        "A - B, N·m", "correlation", "RMS", "median |A-B|", "90 % of |A-B|"
    )?;
    for joint in &comparison.joints {
        let correlation = joint
            .correlation
            .map_or_else(|| "–".to_owned(), |value| format!("{value:.3}"));
        writeln!(
            out,
            "{:<10}{correlation:>12}{:>10.4}{:>16.4}{:>16.4}",
            joint.joint, joint.rms_nm, joint.median_nm, joint.percentile_90_nm
        )?;
    }
    Ok(())
}

fn print_worst(worst: &[WorstRow], out: &mut impl std::io::Write) -> std::io::Result<()> {
    writeln!(
        out,
        "\nrows that differ most: degrees, N·m, and what carries"
    )?;
    writeln!(
        out,
        "{:>7}{:>8}{:>8}  {:<9}{:>9}{:>9}{:>9}  {:<16}in B",
        "theta3", "theta4", "alpha", "joint", "A", "B", "A - B", "in A"
    )?;
    for row in worst {
        let [a, b] = [row.torques_nm.a, row.torques_nm.b].map(|torques| torque(row, torques));
        let carrying = [&row.carrying.a, &row.carrying.b];
        let [in_a, in_b] = carrying.map(|mode| mode.as_deref().unwrap_or("–"));
        writeln!(
            out,
            "{:>7.1}{:>8.1}{:>8.1}  {:<9}{a:>9.4}{b:>9.4}{:>9.4}  {in_a:<16}{in_b}",
            row.theta3_deg, row.theta4_deg, row.alpha_deg, row.joint, row.difference_nm
        )?;
    }
    Ok(())
}

/// Torque of the joint that the row is listed for.
fn torque(row: &WorstRow, torques: [f64; 4]) -> f64 {
    let mut joints = prone_record::pulls::JOINTS.into_iter().zip(torques);
    joints
        .find(|(joint, _)| *joint == row.joint)
        .map_or(f64::NAN, |(_, torque)| torque)
}
