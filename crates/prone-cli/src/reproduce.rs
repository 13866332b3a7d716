//! `prone reproduce`.

use std::io::Write;

use prone_record::experiment::RobotText;
use prone_record::program::RobotInfo;
use prone_record::resumption::Opening;
use prone_thesis::published;
use prone_thesis::reproduce::ReproduceExperiment;
use prone_thesis::summary::{CostRow, RatioRow, Summary};

use crate::Failure;
use crate::args::ReproduceArgs;
use crate::outputs::{Files, Kind};
use crate::plan::{OnContact, Plan, Work};

pub(crate) fn plan(args: &ReproduceArgs) -> Result<Plan, Failure> {
    let files = crate::robot::files(args.robot.name())?;
    let robot = RobotText::from_files(&files);
    let recorded = files.recorded().map_err(Failure::input)?;
    let read = recorded.iter().flat_map(|it| &it.read);
    let read = read.fold(Files::of_robot(&files), Files::reading);
    let recorded = recorded.as_ref().map(RobotText::from_files);
    let experiment = ReproduceExperiment::new(robot, recorded, args.durations.clone());
    Ok(Plan {
        work: Work::Reproduction(Box::new(experiment)),
        files: read.writing("--out", &args.out, Kind::Folder),
        opening: Opening::Restart,
        threads: args.threads,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

/// Costs and crawls, ours beside the published ones.
pub(crate) fn print(summary: &Summary, out: &mut dyn Write) -> std::io::Result<()> {
    let name = |robot: &RobotInfo| robot.name.clone();
    let study_of = summary.study_of.as_ref().map(name).unwrap_or_default();
    print_costs(&study_of, &summary.costs, &summary.ratios, out)?;
    if let Some(beside) = &summary.beside {
        writeln!(out)?;
        print_costs(&name(&beside.robot), &beside.costs, &beside.ratios, out)?;
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

/// Costs of a robot's pulls and their ratios, by duration.
fn print_costs(
    robot: &str,
    costs: &[CostRow],
    ratios: &[RatioRow],
    out: &mut dyn Write,
) -> std::io::Result<()> {
    writeln!(out, "cost of a pull, N²·m²·s: ours / published; {robot}")?;
    writeln!(
        out,
        "{:>8}{:>18}{:>18}{:>18}",
        "duration",
        published::NOMINAL,
        published::OPTIMAL,
        "ratio"
    )?;
    for row in ratios {
        let cell = |gait: &str| {
            let cost = costs
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
    Ok(())
}

/// Ours, then theirs where there is one.
fn beside(ours: f64, theirs: Option<f64>) -> String {
    let theirs = theirs.map_or_else(|| "–".to_owned(), |theirs| format!("{theirs:.3}"));
    format!("{ours:.3} / {theirs}")
}
