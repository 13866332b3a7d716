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
use crate::plan::{self, OnContact, Plan, Work};
use crate::{Failure, cycle_search, pull_terms};

/// Evaluations of a run where none are asked for.
const BUDGET: u64 = 100_000;
/// The same where each is a simulation.
const DYNAMIC_BUDGET: u64 = 3_000;

pub(crate) fn plan(args: &OptimizeArgs) -> Result<Plan, Failure> {
    let experiment = if args.terms.source == "cycle" {
        Experiment::CycleSearch(Box::new(cycle_search::experiment(args)?))
    } else {
        Experiment::PullSearch(Box::new(experiment(args)?))
    };
    Ok(Plan {
        work: Work::Study(experiment),
        out: Some(args.out.clone()),
        opening: plan::searching(args.resume),
        threads: args.threads,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

fn experiment(args: &OptimizeArgs) -> Result<PullSearchExperiment, Failure> {
    refuse_cycle_options(args)?;
    let files = crate::robot::files(args.terms.robot.name())?;
    let terms = pull_terms::choice(&args.terms, &files, None)?;
    let compared = files.defaults().map_err(Failure::input)?.pull.compared;
    let compared = compared.iter();
    let compared = compared.map(|name| Ok(crate::gait::find(&files.gaits, name)?.1));
    let budget = match terms.source {
        TorqueChoice::Dynamics { .. } => DYNAMIC_BUDGET,
        TorqueChoice::Statics | TorqueChoice::Map(_) => BUDGET,
    };
    Ok(PullSearchExperiment {
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
    })
}

/// What belongs to whole cycles is refused, not ignored.
fn refuse_cycle_options(args: &OptimizeArgs) -> Result<(), Failure> {
    let given = [
        ("--ceiling-mm", args.ceiling_mm.is_some()),
        ("--steerable", args.steerable),
        ("--least-advance-mm", args.least_advance_mm.is_some()),
        (
            "--demanded-shoulder-nm",
            args.demanded_shoulder_nm.is_some(),
        ),
        ("--body-share-percent", args.body_share_percent.is_some()),
        ("--worst-over", args.worst_over.is_some()),
        ("--most-heat", args.most_heat.is_some()),
        ("--most-head-n", args.most_head_n.is_some()),
    ];
    Failure::if_given(&given, "goes with --source cycle only")
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
