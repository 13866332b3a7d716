//! Searches of whole cycles: `prone crawl frontier`, and `prone optimize --source cycle`.

use std::io::Write;

use anyhow::anyhow;

use prone::regime::Regime;
use prone_files::defaults::CycleDefaults;
use prone_record::frontier::{CycleObjective, Frontier, SettingKind};
use prone_record::program::RobotInfo;
use prone_record::search_plan::{CyclePlan, OnePlan, SearchHead, SearchSolver, UnderPlan};
use prone_sim::LoadedRobot;
use prone_study::search::cycles::{CycleGaits, CycleRun, CycleSearchError};
use prone_study::search::passage::too_low;

use crate::args::optimize::{OptimizeArgs, SolverName};
use crate::args::passage::{AgainstName, FrontierArgs};
use crate::args::pricing::ObjectiveName;
use crate::search::{self, Carried};
use crate::{Failure, passage};

/// Most evaluations of a run of `prone optimize` where none are asked for.
const BUDGET: u64 = 1600;

/// `prone crawl frontier`.
pub(crate) fn frontier(args: &FrontierArgs) -> Result<(), Failure> {
    let robot = crate::robot::load(args.robot.name())?;
    let defaults = robot.files().defaults().map_err(Failure::input)?.cycle;
    let from = names(&args.from, &defaults);
    for (index, &mm) in args.ceilings_mm.iter().enumerate() {
        let same = |other: &f64| other.total_cmp(&mm).is_eq();
        if args.ceilings_mm[..index].iter().any(same) {
            return Err(Failure::Input(anyhow!("--ceilings-mm has {mm} twice")));
        }
        if args.margin_mm >= mm {
            return Err(passage::no_room("--ceilings-mm", mm, args.margin_mm));
        }
        refuse_too_low(&robot, "--ceilings-mm", mm, (mm - args.margin_mm) * 1e-3)?;
    }
    let head = head("crawl frontier", args.seed, args.runs, args.budget);
    let plan = CyclePlan {
        objective: match args.against {
            AgainstName::Advance => CycleObjective::Advance,
            AgainstName::Heat => CycleObjective::Heat,
        },
        steerable: args.steerable,
        under: UnderPlan::Frontier {
            ceilings_mm: args.ceilings_mm.clone(),
            margin_mm: args.margin_mm,
            from: from.clone(),
        },
        ..plan(head, &robot)
    };
    let gaits = CycleGaits {
        from: passage::cycles(&robot, &from)?,
        compared: passage::cycles(&robot, &defaults.compared)?,
        worst_over: None,
    };
    let carried = Carried {
        out: &args.out,
        threads: args.threads,
        resume: args.resume,
        time_budget: None,
        json: args.json,
    };
    carry_out(&robot, plan, gaits, &carried)
}

/// `prone optimize --source cycle`.
pub(crate) fn optimize(args: &OptimizeArgs) -> Result<(), Failure> {
    refuse_options_of_pulls(args)?;
    let objective = match args.pricing.objective {
        ObjectiveName::Heat => CycleObjective::Heat,
        ObjectiveName::Advance => CycleObjective::Advance,
        ObjectiveName::Speed => CycleObjective::Speed,
        ObjectiveName::Peak => CycleObjective::Peak,
        ObjectiveName::Published | ObjectiveName::Torque => {
            return Err(Failure::Input(anyhow!(
                "--source cycle searches --objective heat, peak, advance or speed"
            )));
        }
    };
    let robot = crate::robot::load(args.pricing.robot.name())?;
    let defaults = robot.files().defaults().map_err(Failure::input)?.cycle;
    let from = names(args.pricing.from.as_slice(), &defaults);
    let from = passage::cycles(&robot, &from)?;
    if let Some(mm) = args.ceiling_mm {
        refuse_too_low(&robot, "--ceiling-mm", mm, mm * 1e-3)?;
    }
    refuse_heats(args, objective)?;
    let worst_over = args.worst_over.as_ref();
    let gaits = CycleGaits {
        from,
        compared: passage::cycles(&robot, &defaults.compared)?,
        worst_over: worst_over
            .map(|name| passage::find(&robot, name))
            .transpose()?,
    };
    let budget = args.budget.unwrap_or(BUDGET);
    let plan = CyclePlan {
        objective,
        steerable: args.steerable,
        under: UnderPlan::One(Box::new(OnePlan {
            source: args.pricing.source.clone(),
            ceiling_mm: args.ceiling_mm,
            least_advance_mm: args.least_advance_mm,
            demanded_shoulder_nm: args.demanded_shoulder_nm,
            body_share_percent: args.body_share_percent,
            worst_over: args.worst_over.clone(),
            most_heat: args.most_heat,
            from: String::new(),
            name: args.name.clone(),
        })),
        ..plan(head("optimize", args.seed, args.runs, budget), &robot)
    };
    let carried = Carried {
        out: &args.out,
        threads: args.threads,
        resume: args.resume,
        time_budget: None,
        json: args.json,
    };
    carry_out(&robot, plan, gaits, &carried)
}

fn head(command: &str, seed: u64, runs: u64, budget: u64) -> SearchHead {
    search::head(command, SearchSolver::AboutTheMiddle, seed, runs, budget)
}

/// A plan that asks for nothing yet.
fn plan(head: SearchHead, robot: &LoadedRobot) -> CyclePlan {
    CyclePlan {
        head,
        objective: CycleObjective::Advance,
        steerable: false,
        under: UnderPlan::Frontier {
            ceilings_mm: Vec::new(),
            margin_mm: 0.0,
            from: Vec::new(),
        },
        bases: Vec::new(),
        regime: Regime::LOCOMOTION.name.to_owned(),
        robot: RobotInfo::of(robot.robot(), robot.files()),
    }
}

fn carry_out(
    robot: &LoadedRobot,
    plan: CyclePlan,
    gaits: CycleGaits,
    carried: &Carried<'_>,
) -> Result<(), Failure> {
    let worst_over = match &plan.under {
        UnderPlan::One(one) => one.worst_over.clone(),
        UnderPlan::Frontier { .. } => None,
    };
    let run = CycleRun::new(robot, plan, gaits).map_err(|error| match (error, worst_over) {
        (CycleSearchError::WorstOver(error), Some(name)) => {
            Failure::Input(anyhow!("--worst-over {name}: {error}"))
        }
        (error, _) => Failure::input(error),
    })?;
    carried.carry_out(&run, |frontier, out| {
        print(frontier, out)?;
        writeln!(out, "\nresult: {}", carried.out.display())
    })
}

/// Heats with several servos are looked at by two objectives only.
fn refuse_heats(args: &OptimizeArgs, objective: CycleObjective) -> Result<(), Failure> {
    let several = matches!(objective, CycleObjective::Heat | CycleObjective::Peak);
    let given = [
        ("--worst-over", args.worst_over.is_some()),
        ("--most-heat", args.most_heat.is_some()),
    ];
    match given.iter().find(|(_, given)| *given) {
        Some((option, _)) if !several => Err(Failure::Input(anyhow!(
            "{option} goes with --objective heat and peak, which alone look at several servos"
        ))),
        _ => Ok(()),
    }
}

/// What says how pulls are priced says nothing of cycles.
fn refuse_options_of_pulls(args: &OptimizeArgs) -> Result<(), Failure> {
    let pricing = &args.pricing;
    let given = [
        ("--weights", pricing.weights.is_some()),
        ("--per", pricing.per.is_some()),
        ("--duration", pricing.duration.is_some()),
        ("--rate-deg-per-phase", pricing.rate_deg_per_phase.is_some()),
        ("--clearance", pricing.clearance.is_some()),
        ("--limits", pricing.limits.is_some()),
        ("--body-share-of", pricing.body_share_of.is_some()),
        ("--hip-threshold-mm", pricing.hip_threshold_mm.is_some()),
        (
            "--limit-tolerance-rad",
            pricing.limit_tolerance_rad.is_some(),
        ),
        ("--time-budget", args.time_budget.is_some()),
        (
            "--solver",
            args.solver != SolverName::De && args.solver != SolverName::CmaEs,
        ),
    ];
    match given.iter().find(|(_, given)| *given) {
        None => Ok(()),
        Some((option, _)) => Err(Failure::Input(anyhow!(
            "{option} does not go with --source cycle, which searches whole cycles by CMA-ES"
        ))),
    }
}

fn names<T: AsRef<[String]>>(given: T, defaults: &CycleDefaults) -> Vec<String> {
    match given.as_ref() {
        [] => defaults.from.clone(),
        given => given.to_vec(),
    }
}

/// A search under a ceiling that no gait of the robot fits under would find nothing.
fn refuse_too_low(
    robot: &LoadedRobot,
    option: &str,
    ceiling_mm: f64,
    height: f64,
) -> Result<(), Failure> {
    match too_low(robot.robot(), height) {
        None => Ok(()),
        Some(reason) => Err(Failure::Input(anyhow!(
            "{option} {ceiling_mm} is too low for {}: {reason}",
            robot.robot().name
        ))),
    }
}

fn print(frontier: &Frontier, out: &mut dyn Write) -> std::io::Result<()> {
    if frontier.found.is_empty() {
        writeln!(
            out,
            "no cycle was found that can be crawled: --budget is too small"
        )?;
    }
    writeln!(
        out,
        "{:>10}{:>6}{:>14}{:>9}{:>10}{:>12}{:>12}{:>11}  holds",
        "ceiling", "seed", "mm per cycle", "mm/s", "top mm", "heat s/m", "stiff s/m", "violation"
    )?;
    let number = |value: Option<f64>, decimals: usize| {
        value.map_or_else(|| "–".to_owned(), |value| format!("{value:.decimals$}"))
    };
    let rows = frontier.found.iter().map(|found| {
        let ceiling = found
            .ceiling_mm
            .map_or_else(|| "–".to_owned(), |mm| format!("{mm} mm"));
        (
            ceiling,
            found.seed.to_string(),
            &found.confirmed,
            Some(found.violation),
        )
    });
    let compared = frontier.compared.iter();
    let others = compared.map(|other| (other.gait.clone(), String::new(), &other.confirmed, None));
    for (name, seed, confirmed, violation) in rows.chain(others) {
        let first = confirmed.settings.first();
        let stiff = confirmed
            .settings
            .iter()
            .find(|row| row.setting == SettingKind::StiffServos);
        writeln!(
            out,
            "{name:>10}{seed:>6}{:>14}{:>9}{:>10}{:>12}{:>12}{:>11}  {}",
            number(first.and_then(|row| row.mm_per_cycle), 1),
            number(first.and_then(|row| row.mm_per_s), 1),
            number(first.and_then(|row| row.top_mm), 1),
            number(first.and_then(|row| row.heat_per_metre_s), 1),
            number(stiff.and_then(|row| row.heat_per_metre_s), 1),
            number(violation, 4),
            if confirmed.holds { "yes" } else { "no" }
        )?;
    }
    Ok(())
}
