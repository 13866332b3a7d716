//! `prone optimize`.

use std::io::Write;

use clap::ValueEnum as _;

use prone::regime::Regime;
use prone_record::experiment::{
    Ends, Experiment, GaitForm, PullSearchExperiment, RobotText, Runs, TorqueChoice,
};
use prone_record::gait_search::Outcome;
use prone_record::search::Solver;

use crate::args::optimize::{EndsName, OptimizeArgs, SolverName};
use crate::outputs::{Files, Kind};
use crate::plan::{self, OnContact, Plan, Work};
use crate::{Failure, cycle_search, pull_terms};

pub(crate) fn plan(args: &OptimizeArgs) -> Result<Plan, Failure> {
    let (experiment, read) = if args.terms.source.as_deref() == Some("cycle") {
        let (experiment, read) = cycle_search::experiment(args)?;
        (Experiment::CycleSearch(Box::new(experiment)), read)
    } else {
        let (experiment, read) = experiment(args)?;
        (Experiment::PullSearch(Box::new(experiment)), read)
    };
    Ok(Plan {
        work: Work::Study(experiment),
        files: read.writing("--out", &args.out, Kind::Folder),
        opening: plan::searching(args.resume),
        threads: args.threads,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

fn experiment(args: &OptimizeArgs) -> Result<(PullSearchExperiment, Files), Failure> {
    refuse_cycle_options(args)?;
    let files = crate::robot::files(args.terms.robot.name())?;
    let terms = pull_terms::choice(&args.terms, &files, None)?;
    let usual = files.defaults().map_err(Failure::input)?.pull;
    let read = Files::of_robot(&files)
        .reading_gaits(&files.gaits, [&usual.from, &usual.body_share_of])
        .reading_gaits(&files.gaits, &usual.compared)
        .reading_gaits(&files.gaits, &args.terms.from)
        .reading_gaits(&files.gaits, &args.terms.body_share_of);
    let read = match &terms.source {
        TorqueChoice::Map(map) => read.reading(&map.file),
        TorqueChoice::Statics | TorqueChoice::Dynamics { .. } => read,
    };
    let compared = usual.compared.iter();
    let compared = compared.map(|name| Ok(crate::gait::find(&files.gaits, name)?.1));
    let budget = match terms.source {
        TorqueChoice::Dynamics { .. } => PullSearchExperiment::DYNAMIC_BUDGET,
        TorqueChoice::Statics | TorqueChoice::Map(_) => PullSearchExperiment::BUDGET,
    };
    let experiment = PullSearchExperiment {
        robot: RobotText::from_files(&files),
        terms,
        form: args.gait_form.unwrap_or(GaitForm::Cubic),
        ends: match args.ends {
            None | Some(EndsName::Fixed) => Ends::Fixed,
            Some(EndsName::Free) => Ends::Free,
        },
        solver: match args.solver {
            None | Some(SolverName::De) => Solver::DifferentialEvolution,
            Some(SolverName::CmaEs) => Solver::CovarianceMatrix,
            Some(SolverName::Ga) => Solver::Genetic,
        },
        runs: Runs {
            seed: args.seed,
            runs: args.runs,
            budget: args.budget.unwrap_or(budget),
        },
        time_budget_s: args.time_budget,
        name: gait_name(args),
        compared: compared.collect::<Result<_, Failure>>()?,
        confirm_durations_s: match &args.confirm_durations {
            None => (1..=10).map(f64::from).collect(),
            Some(durations) => durations.iter().map(|it| it.seconds()).collect(),
        },
    };
    Ok((experiment, read))
}

/// What belongs to whole cycles is refused, not ignored.
fn refuse_cycle_options(args: &OptimizeArgs) -> Result<(), Failure> {
    let why = "goes with --source cycle only";
    Failure::if_given(&args.cycle.given(), why)?;
    Failure::if_given(&[("--reach", args.reach.is_some())], why)
}

fn gait_name(args: &OptimizeArgs) -> String {
    let objective = args.terms.objective.to_possible_value();
    let objective = objective.map_or_else(String::new, |it| it.get_name().to_owned());
    args.name
        .clone()
        .unwrap_or_else(|| format!("best-{objective}"))
}

/// A table of the runs, what was found beside others, and what simulation says.
pub(crate) fn print(outcome: &Outcome, out: &mut dyn Write) -> std::io::Result<()> {
    let number = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.4}"));
    writeln!(
        out,
        "{:>8}{:>14}{:>14}{:>12}{:>13}",
        "seed", "cost", "torque", "violations", "evaluations"
    )?;
    for run in &outcome.runs {
        let cost = run.cost.as_ref();
        writeln!(
            out,
            "{:>8}{:>14}{:>14}{:>12}{:>13}",
            run.seed,
            number(cost.and_then(|it| it.cost)),
            number(cost.and_then(|it| it.torque)),
            number(cost.map(|it| it.violations)),
            run.evaluations
        )?;
    }
    writeln!(
        out,
        "\n{}: cost {} ({})",
        outcome.gait,
        number(outcome.cost.cost),
        outcome.unit
    )?;
    for other in &outcome.compared {
        writeln!(
            out,
            "  {:<10} cost {}, violations {:.4}; torque part found / {}: {}",
            other.gait,
            number(other.cost.cost),
            other.cost.violations,
            other.gait,
            number(other.torque_ratio)
        )?;
    }
    if !outcome.complete {
        writeln!(out, "  stopped by the time budget; --resume goes on")?;
    }
    if outcome.cost.violations > 0.0 {
        writeln!(
            out,
            "\nwhat was found breaks rules of the search, by {:.4}: what it saves is partly that",
            outcome.cost.violations
        )?;
    }
    writeln!(out, "\nconfirmed by simulation, found over other")?;
    for verdict in &outcome.verdicts {
        writeln!(out, "  {}", verdict.sentence())?;
    }
    for refused in &outcome.refused {
        writeln!(
            out,
            "  {}: {} cannot be simulated: {}",
            refused.regime, refused.gait, refused.reason
        )?;
    }
    if let Some(base) = outcome.compared.first() {
        for regime in [Regime::TORQUE_STUDY.name, Regime::LOCOMOTION.name] {
            if !outcome.holds(regime, &base.gait) {
                writeln!(
                    out,
                    "  the gain over {} does not hold in {regime}",
                    base.gait
                )?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use clap::{CommandFactory as _, Parser as _};

    use super::*;
    use crate::args::{Args, Command};

    /// The experiment of a search whose budget was not typed.
    fn planned(source: &str) -> Experiment {
        let typed = "prone optimize --objective heat --seed 1 --out never --source";
        let typed = typed.split(' ').chain([source]);
        let Command::Optimize(args) = Args::try_parse_from(typed).unwrap().command else {
            panic!("it is a search");
        };
        match plan(&args) {
            Ok(Plan {
                work: Work::Study(experiment),
                ..
            }) => experiment,
            _ => panic!("it can be planned"),
        }
    }

    #[test]
    fn the_help_of_the_budget_tells_what_is_used() {
        let budgets = ["cycle", "dynamics", "statics"].map(|source| match planned(source) {
            Experiment::CycleSearch(it) => it.runs.budget,
            Experiment::PullSearch(it) => it.runs.budget,
            _ => panic!("it is a search"),
        });
        let [cycle, dynamics, other] = budgets;
        let command = Args::command();
        let optimize = command.find_subcommand("optimize").unwrap();
        let budget = optimize.get_arguments().find(|it| it.get_id() == "budget");
        let help = budget.unwrap().get_help().unwrap().to_string();
        let said = format!("[default: {cycle} with cycle, {dynamics} with dynamics, else {other}]");
        assert!(help.ends_with(&said), "{help}");
    }
}
