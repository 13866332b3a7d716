//! `prone reproduce`.

use std::io::Write;

use prone_record::experiment::RobotText;
use prone_record::resumption::Opening;
use prone_thesis::published;
use prone_thesis::reproduce::ReproduceExperiment;
use prone_thesis::summary::Summary;

use crate::Failure;
use crate::args::ReproduceArgs;
use crate::plan::{Plan, Work};

pub(crate) fn plan(args: &ReproduceArgs) -> Result<Plan, Failure> {
    let files = crate::robot::files(args.robot.name())?;
    let robot = RobotText::from_files(&files);
    let experiment = ReproduceExperiment::new(robot, args.durations.clone());
    Ok(Plan {
        work: Work::Reproduction(Box::new(experiment)),
        out: Some(args.out.clone()),
        opening: Opening::Restart,
        threads: args.threads,
        json: args.json,
    })
}

/// Costs and crawls, ours beside the published ones.
pub(crate) fn print(summary: &Summary, out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(out, "cost of a pull, N²·m²·s: ours / published")?;
    writeln!(
        out,
        "{:>8}{:>18}{:>18}{:>18}",
        "duration",
        published::NOMINAL,
        published::OPTIMAL,
        "ratio"
    )?;
    for row in &summary.ratios {
        let cell = |gait: &str| {
            let cost = summary
                .costs
                .iter()
                .find(|cost| cost.gait == gait && (cost.duration_s - row.duration_s).abs() < 1e-9);
            cost.map_or_else(String::new, |cost| {
                beside(cost.cost_n2m2s, cost.published_n2m2s)
            })
        };
        writeln!(
            out,
            "{:>6} s{:>18}{:>18}{:>18}",
            row.duration_s,
            cell(published::NOMINAL),
            cell(published::OPTIMAL),
            beside(row.ours, row.published)
        )?;
    }
    if !summary.table.is_empty() {
        writeln!(
            out,
            "\ncrawl under the table: ours in simulation / published on the robot"
        )?;
    }
    for row in &summary.table {
        let (ours, theirs) = (&row.ours, &row.published);
        writeln!(
            out,
            "{:>6} cycles: {:.1} / {:.1} mm in {:.1} / {:.0} s; ours {}",
            theirs.cycles,
            ours.distance_mm,
            theirs.distance_mm,
            ours.time_s,
            theirs.time_s,
            row.touched()
        )?;
    }
    Ok(())
}

/// Ours, then theirs where there is one.
fn beside(ours: f64, theirs: Option<f64>) -> String {
    let theirs = theirs.map_or_else(|| "–".to_owned(), |theirs| format!("{theirs:.3}"));
    format!("{ours:.3} / {theirs}")
}
