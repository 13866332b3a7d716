//! `prone cost`.

use std::io::Write;

use prone_files::robot_folder::RobotFiles;
use prone_record::cycle_cost::{CycleCost, SettingCost};
use prone_record::experiment::{CostExperiment, CycleCostExperiment, Experiment, RobotText};
use prone_record::gait_search::Broken;
use prone_record::resumption::Opening;
use prone_study::run::CostOutcome;

use crate::Failure;
use crate::args::optimize::CostArgs;
use crate::cells::{number, trimmed};
use crate::outputs::Files;
use crate::plan::{OnContact, Plan, Work};
use crate::{cycle_search, pull_terms};

pub(crate) fn plan(args: &CostArgs) -> Result<Plan, Failure> {
    let files = crate::robot::files(args.terms.robot.name())?;
    let is_cycle = if let Some(source) = args.terms.source.as_deref() {
        source == "cycle"
    } else {
        let named = files.gaits.named(args.gait.name());
        named.map_err(Failure::input)?.is_cycle()
    };
    let experiment = if is_cycle {
        Experiment::CycleCost(Box::new(cycle(args, &files)?))
    } else {
        Experiment::Cost(Box::new(pull(args, &files)?))
    };
    Ok(Plan {
        work: Work::Study(experiment),
        files: Files::default(),
        opening: Opening::Restart,
        threads: None,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

/// The cost of a whole cycle.
fn cycle(args: &CostArgs, files: &RobotFiles) -> Result<CycleCostExperiment, Failure> {
    let terms = &args.terms;
    cycle_search::refuse_options_of_pulls(terms)?;
    let from = terms.from.as_ref();
    Ok(CycleCostExperiment {
        robot: RobotText::from_files(files),
        gait: cycle_search::text(files, args.gait.name())?,
        from: from
            .map(|name| cycle_search::text(files, name))
            .transpose()?,
        objective: cycle_search::objective(terms)?,
        steerable: args.cycle.steerable,
        ideal: args.cycle.ideal,
        rules: cycle_search::rules(&args.cycle),
        worst_over: cycle_search::worst_over(&args.cycle, files)?,
    })
}

/// The cost of a pull.
fn pull(args: &CostArgs, files: &RobotFiles) -> Result<CostExperiment, Failure> {
    Failure::if_given(&args.cycle.given(), "goes with whole cycles only")?;
    let costed = crate::gait::find(&files.gaits, args.gait.name())?;
    Ok(CostExperiment {
        robot: RobotText::from_files(files),
        terms: pull_terms::choice(&args.terms, files, Some(&costed))?,
        gait: costed.1,
    })
}

/// The cost of a cycle, what it breaks, and what it does in each setting.
pub(crate) fn print_cycle(cost: &CycleCost, out: &mut dyn Write) -> std::io::Result<()> {
    let value = cost.sentence.as_deref().unwrap_or("not known");
    writeln!(
        out,
        "{}\n  value       {value}\n  violations  {}",
        cost.gait,
        trimmed(cost.violations)
    )?;
    print_broken(&cost.broken, out)?;
    if let Some(reason) = &cost.refused {
        writeln!(out, "  not crawled in every setting: {reason}")?;
    }
    if cost.settings.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "\n{:>30}{:>14}{:>9}{:>9}{:>10}{:>7}{:>8}  breaks",
        "setting", "mm per cycle", "mm/s", "top mm", "heat s/m", "duty", "head N"
    )?;
    for SettingCost { row, broken } in &cost.settings {
        let broken = broken.iter();
        let broken: Vec<String> = broken
            .map(|it| format!("{} by {}", it.rule, trimmed(it.sum)))
            .collect();
        let broken = match broken[..] {
            [] => "nothing".to_owned(),
            _ => broken.join(", "),
        };
        writeln!(
            out,
            "{:>30}{:>14}{:>9}{:>9}{:>10}{:>7}{:>8}  {broken}",
            row.setting.to_string(),
            number(row.mm_per_cycle, 1),
            number(row.mm_per_s, 1),
            number(row.top_mm, 1),
            number(row.heat_per_metre_s, 1),
            number(row.duty, 2),
            number(row.head_n, 1),
        )?;
    }
    Ok(())
}

/// The cost of a pull, and what it breaks.
pub(crate) fn print(outcome: &CostOutcome, out: &mut dyn Write) -> std::io::Result<()> {
    let CostOutcome { gait, cost, unit } = outcome;
    let number = |value: Option<f64>| {
        value.map_or_else(|| "not known".to_owned(), |value| format!("{value:.4}"))
    };
    writeln!(
        out,
        "{}
  cost        {}
  torque      {} {unit}
  violations  {}",
        gait.name,
        number(cost.cost),
        number(cost.torque),
        trimmed(cost.violations)
    )?;
    print_broken(&cost.broken, out)
}

fn print_broken(broken: &[Broken], out: &mut dyn Write) -> std::io::Result<()> {
    for broken in broken {
        writeln!(
            out,
            "    {:<12}{} times, {} in all",
            broken.rule,
            broken.count,
            trimmed(broken.sum)
        )?;
    }
    Ok(())
}
