//! `prone optimize`.

use std::io::Write;

use anyhow::anyhow;

use prone::gait::Gait;
use prone::regime::Regime;
use prone_record::gait_search::Outcome;
use prone_record::search_plan::SearchSolver;
use prone_study::search::pull_cost::{PullAim, PullCosts, Source};
use prone_study::search::pull_form::{Ends, GaitForm, PullForm};
use prone_study::search::pulls::{PullConfirmation, PullRun};

use crate::Failure;
use crate::args::optimize::{EndsName, OptimizeArgs, SolverName};
use crate::pricing::Pricing;
use crate::search::{self, Carried};

/// Evaluations of a run where none are asked for.
const BUDGET: u64 = 100_000;
/// The same where each is a simulation.
const DYNAMIC_BUDGET: u64 = 3_000;

pub(crate) fn run(args: &OptimizeArgs) -> Result<(), Failure> {
    if args.pricing.source == "cycle" {
        return crate::cycle_search::optimize(args);
    }
    refuse_cycle_options(args)?;
    let robot = crate::robot::load(args.pricing.robot.name())?;
    let Pricing {
        robot,
        world,
        terms,
    } = Pricing::new(&args.pricing, robot, None)?;
    check_form(args, terms.aim)?;
    let defaults = robot.files().defaults().map_err(Failure::input)?.pull;
    let name = gait_name(args);
    check_name(&name, &terms.base, &defaults.compared)?;
    // The base gait first, then those that the robot's `[defaults]` name and it can follow.
    let mut compared = vec![terms.base.clone()];
    for name in &defaults.compared {
        let gait = crate::gait::find(&robot.files().gaits, name)?;
        let twice = compared.iter().any(|other| other.name == gait.name);
        if !twice && crate::gait::can_follow(robot.robot(), &gait) {
            compared.push(gait);
        }
    }
    let budget = match terms.source {
        Source::Dynamics => DYNAMIC_BUDGET,
        Source::Statics | Source::Map { .. } => BUDGET,
    };
    let ends = match args.ends {
        EndsName::Fixed => Ends::Fixed,
        EndsName::Free => Ends::Free,
    };
    let solver = match args.solver {
        SolverName::De => SearchSolver::DifferentialEvolution,
        SolverName::CmaEs => SearchSolver::CovarianceMatrix,
        SolverName::Ga => SearchSolver::Genetic,
    };
    let budget = args.budget.unwrap_or(budget);
    let costs = PullCosts::new(&world, terms).map_err(Failure::input)?;
    let form = PullForm::new(args.gait_form, ends, &costs.terms().base).map_err(Failure::input)?;
    let confirmation = PullConfirmation {
        name,
        compared,
        durations: args.confirm_durations.clone(),
    };
    let head = search::head("optimize", solver, args.seed, args.runs, budget);
    let run = PullRun::new(&robot, costs, form, confirmation, head).map_err(Failure::input)?;
    let carried = Carried {
        out: &args.out,
        threads: args.threads,
        resume: args.resume,
        time_budget: args.time_budget,
        json: args.json,
    };
    carried.carry_out(&run, |outcome, out| {
        print(outcome, out)?;
        writeln!(out, "\ngait: {}", args.out.join("gait.toml").display())
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
    ];
    match given.iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((option, _)) => Err(Failure::Input(anyhow!(
            "{option} goes with --source cycle only"
        ))),
    }
}

/// The published problem is one of six coefficients.
fn check_form(args: &OptimizeArgs, aim: PullAim) -> Result<(), Failure> {
    let published = matches!(aim, PullAim::Published(_));
    if published && (args.gait_form != GaitForm::Cubic || args.ends == EndsName::Free) {
        return Err(Failure::Input(anyhow!(
            "--objective published prices cubics with fixed ends only: leave out --gait-form and --ends"
        )));
    }
    Ok(())
}

/// The confirmation tells gaits apart by their names.
fn check_name(name: &str, base: &Gait, compared: &[String]) -> Result<(), Failure> {
    if name == base.name || compared.iter().any(|other| other == name) {
        return Err(Failure::Input(anyhow!(
            "the found gait would be called {name:?}, like one that it is compared with: give it another --name"
        )));
    }
    Ok(())
}

fn gait_name(args: &OptimizeArgs) -> String {
    let default = || format!("best-{}", args.pricing.objective.name());
    args.name.clone().unwrap_or_else(default)
}

/// A table of the runs, what was found beside others, and what simulation says.
fn print(outcome: &Outcome, out: &mut dyn Write) -> std::io::Result<()> {
    let number = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.4}"));
    writeln!(
        out,
        "{:>8}{:>14}{:>14}{:>12}{:>13}",
        "seed", "cost", "torque", "violations", "evaluations"
    )?;
    for run in &outcome.runs {
        let price = run.price.as_ref();
        writeln!(
            out,
            "{:>8}{:>14}{:>14}{:>12}{:>13}",
            run.seed,
            number(price.and_then(|price| price.cost)),
            number(price.and_then(|price| price.torque)),
            number(price.map(|price| price.violations)),
            run.evaluations
        )?;
    }
    writeln!(
        out,
        "\n{}: cost {} ({})",
        outcome.gait,
        number(outcome.price.cost),
        outcome.unit
    )?;
    for other in &outcome.compared {
        writeln!(
            out,
            "  {:<10} cost {}, violations {:.4}; torque part found / {}: {}",
            other.gait,
            number(other.price.cost),
            other.price.violations,
            other.gait,
            number(other.torque_ratio)
        )?;
    }
    if !outcome.complete {
        writeln!(out, "  stopped by the time budget; --resume goes on")?;
    }
    if outcome.price.violations > 0.0 {
        writeln!(
            out,
            "\nwhat was found breaks rules of the search, by {:.4}: what it saves is partly that",
            outcome.price.violations
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
