//! Searches of whole cycles: `prone crawl frontier`, and `prone optimize --source cycle`.

mod files;
mod pursuit;

use std::path::Path;

use anyhow::anyhow;
use serde_json::{Value, json};

use prone::gait::cycle::Cycle;
use prone_files::defaults::CycleDefaults;
use prone_record::frontier::CycleObjective;
use prone_sim::LoadedRobot;
use prone_study::cycle_search::frontier::{self, Hunt};
use prone_study::cycle_search::passage::too_low;
use prone_study::cycle_search::price::{Aim, Merge};
use prone_study::cycle_search::rules::CycleRules;
use prone_study::cycle_search::setting::Setting;
use prone_study::cycle_search::settings;

use crate::args::optimize::{OptimizeArgs, SolverName};
use crate::args::passage::{AgainstName, FrontierArgs};
use crate::args::pricing::ObjectiveName;
use crate::{Failure, passage};
use pursuit::pursue;

/// Most evaluations of a run of `prone optimize` where none are asked for.
const BUDGET: u64 = 1600;

/// What is searched, how, and where it goes.
struct Quest<'a> {
    robot: &'a LoadedRobot,
    objective: CycleObjective,
    margin_mm: f64,
    jobs: Vec<Job<'a>>,
    confirmation: Vec<Setting>,
    /// In which it shows whether a found cycle can be steered.
    steering: Vec<Setting>,
    /// What a found cycle is compared with.
    compared: Vec<Cycle>,
    seed: u64,
    runs: u64,
    budget: u64,
    /// Name of the found cycle; without one, by ceiling and seed.
    name: Option<String>,
    resume: bool,
    out: &'a Path,
    threads: Option<u16>,
    json: bool,
    /// For `run.json`, and what a checkpoint must agree with.
    plan: Value,
}

/// One box of cycles.
struct Job<'a> {
    ceiling_mm: Option<f64>,
    base: String,
    hunt: Hunt<'a>,
}

/// `prone crawl frontier`.
pub(crate) fn frontier(args: &FrontierArgs) -> Result<(), Failure> {
    let robot = crate::robot::load(args.robot.name())?;
    let defaults = robot.files().defaults().map_err(Failure::input)?.cycle;
    let from = names(&args.from, &defaults);
    let cycles = passage::cycles(&robot, &from)?;
    let objective = match args.against {
        AgainstName::Advance => CycleObjective::Advance,
        AgainstName::Heat => CycleObjective::Heat,
    };
    let wanted = if args.steerable {
        Wanted::Steerable
    } else {
        Wanted::All
    };
    let settings = settings_for(objective, wanted, &robot)?;
    let mut jobs: Vec<Job<'_>> = Vec::with_capacity(args.ceilings_mm.len());
    for &mm in &args.ceilings_mm {
        let same = |job: &Job<'_>| {
            job.ceiling_mm
                .is_some_and(|other| other.total_cmp(&mm).is_eq())
        };
        if jobs.iter().any(same) {
            return Err(Failure::Input(anyhow!("--ceilings-mm has {mm} twice")));
        }
        let height = below(mm, args.margin_mm)?;
        refuse_too_low(&robot, "--ceilings-mm", mm, height)?;
        let base = frontier::base(&robot, &settings[0], &cycles, height).map_err(Failure::input)?;
        let aim = Aim {
            objective,
            merge: Merge::Mean,
            rules: rules_for(objective, height, base, &robot),
        };
        jobs.push(job(&robot, &settings, aim, base, Some(mm))?);
    }
    let plan = json!({
        "command": "crawl frontier",
        "ceilings_mm": args.ceilings_mm,
        "objective": objective.name(),
        "margin_mm": args.margin_mm,
        "steerable": args.steerable,
        "from": from,
        "seed": args.seed,
        "runs": args.runs,
    });
    pursue(&mut Quest {
        robot: &robot,
        objective,
        margin_mm: args.margin_mm,
        jobs,
        confirmation: confirmation_for(objective, wanted, &robot)?,
        steering: settings::for_steering_confirmation(&robot).map_err(Failure::input)?,
        compared: passage::cycles(&robot, &defaults.compared)?,
        seed: args.seed,
        runs: args.runs,
        budget: args.budget,
        name: None,
        resume: args.resume,
        out: &args.out,
        threads: args.threads,
        json: args.json,
        plan,
    })
}

/// `prone optimize --source cycle`.
pub(crate) fn optimize(args: &OptimizeArgs) -> Result<(), Failure> {
    refuse_options_of_pulls(args)?;
    let objective = match args.pricing.objective {
        ObjectiveName::Heat => CycleObjective::Heat,
        ObjectiveName::Advance => CycleObjective::Advance,
        ObjectiveName::Speed => CycleObjective::Speed,
        ObjectiveName::Peak => CycleObjective::Peak,
        _ => {
            return Err(Failure::Input(anyhow!(
                "--source cycle searches --objective heat, peak, advance or speed"
            )));
        }
    };
    let robot = crate::robot::load(args.pricing.robot.name())?;
    let defaults = robot.files().defaults().map_err(Failure::input)?.cycle;
    let from = names(args.pricing.from.as_slice(), &defaults);
    let cycles = passage::cycles(&robot, &from)?;
    let wanted = if args.steerable {
        Wanted::Steerable
    } else {
        Wanted::All
    };
    let settings = settings_for(objective, wanted, &robot)?;
    let height = args.ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3);
    if let Some(mm) = args.ceiling_mm {
        refuse_too_low(&robot, "--ceiling-mm", mm, height)?;
    }
    let base = frontier::base(&robot, &settings[0], &cycles, height).map_err(Failure::input)?;
    let usual = rules_for(objective, height, base, &robot);
    let rules = CycleRules {
        advance: args.least_advance_mm.map_or(usual.advance, |mm| mm * 1e-3),
        demanded_shoulder: args.demanded_shoulder_nm.unwrap_or(usual.demanded_shoulder),
        body_share: args
            .body_share_percent
            .map_or(usual.body_share, |percent| percent / 100.0),
        heat: args.most_heat.unwrap_or(usual.heat),
        ..usual
    };
    let plan = json!({
        "command": "optimize",
        "source": "cycle",
        "objective": objective.name(),
        "ceiling_mm": args.ceiling_mm,
        "steerable": args.steerable,
        "least_advance_mm": rules.advance * 1e3,
        "demanded_shoulder_nm": args.demanded_shoulder_nm,
        "body_share_percent": args.body_share_percent,
        "worst_over": args.worst_over,
        "most_heat": args.most_heat,
        "from": base.pull.name,
        "seed": args.seed,
        "runs": args.runs,
        "name": args.name,
    });
    let aim = Aim {
        objective,
        merge: merge(args, &robot, &settings, objective)?,
        rules,
    };
    let jobs = vec![job(&robot, &settings, aim, base, args.ceiling_mm)?];
    pursue(&mut Quest {
        robot: &robot,
        objective,
        margin_mm: 0.0,
        jobs,
        confirmation: confirmation_for(objective, wanted, &robot)?,
        steering: settings::for_steering_confirmation(&robot).map_err(Failure::input)?,
        compared: passage::cycles(&robot, &defaults.compared)?,
        seed: args.seed,
        runs: args.runs,
        budget: args.budget.unwrap_or(BUDGET),
        name: Some(
            args.name
                .clone()
                .unwrap_or_else(|| format!("best-{}", objective.name())),
        ),
        resume: args.resume,
        out: &args.out,
        threads: args.threads,
        json: args.json,
        plan,
    })
}

/// The mean over settings, or the worst over another cycle's values.
fn merge(
    args: &OptimizeArgs,
    robot: &LoadedRobot,
    settings: &[Setting],
    objective: CycleObjective,
) -> Result<Merge, Failure> {
    let several = matches!(objective, CycleObjective::Heat | CycleObjective::Peak);
    let given = [
        ("--worst-over", args.worst_over.is_some()),
        ("--most-heat", args.most_heat.is_some()),
    ];
    if let (false, Some((option, _))) = (several, given.iter().find(|(_, given)| *given)) {
        return Err(Failure::Input(anyhow!(
            "{option} goes with --objective heat and peak, which alone look at several servos"
        )));
    }
    let Some(name) = &args.worst_over else {
        return Ok(Merge::Mean);
    };
    let cycle = passage::find(robot, name)?;
    Merge::worst_over(settings, &cycle)
        .map_err(|error| Failure::Input(anyhow!("--worst-over {name}: {error}")))
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

/// A ceiling less its margin, m.
fn below(ceiling_mm: f64, margin_mm: f64) -> Result<f64, Failure> {
    if margin_mm < ceiling_mm {
        return Ok((ceiling_mm - margin_mm) * 1e-3);
    }
    Err(Failure::Input(anyhow!(
        "a margin of {margin_mm} mm leaves nothing of a ceiling of {ceiling_mm} mm"
    )))
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

/// Which cycles are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Wanted {
    /// Any.
    All,
    /// Those that can be steered.
    Steerable,
}

fn settings_for(
    objective: CycleObjective,
    wanted: Wanted,
    robot: &LoadedRobot,
) -> Result<Vec<Setting>, Failure> {
    let settings = match objective {
        CycleObjective::Heat | CycleObjective::Peak => settings::for_heat(robot),
        CycleObjective::Advance | CycleObjective::Speed => settings::for_advance(robot),
    };
    let mut settings = settings.map_err(Failure::input)?;
    if wanted == Wanted::Steerable {
        settings.extend(settings::for_steering(robot).map_err(Failure::input)?);
    }
    Ok(settings)
}

fn confirmation_for(
    objective: CycleObjective,
    wanted: Wanted,
    robot: &LoadedRobot,
) -> Result<Vec<Setting>, Failure> {
    let settings = match objective {
        CycleObjective::Heat | CycleObjective::Peak => settings::for_heat_confirmation(robot),
        CycleObjective::Advance | CycleObjective::Speed => settings::for_confirmation(robot),
    };
    let mut settings = settings.map_err(Failure::input)?;
    if wanted == Wanted::Steerable {
        let more = settings::for_steering_confirmation(robot).map_err(Failure::input)?;
        settings.extend(more);
    }
    Ok(settings)
}

fn rules_for(
    objective: CycleObjective,
    height: f64,
    base: &Cycle,
    robot: &LoadedRobot,
) -> CycleRules {
    match objective {
        CycleObjective::Heat | CycleObjective::Peak => settings::heat_rules(height, robot.robot()),
        CycleObjective::Advance | CycleObjective::Speed => settings::advance_rules(height, base),
    }
}

fn job<'a>(
    robot: &LoadedRobot,
    settings: &'a [Setting],
    aim: Aim,
    base: &Cycle,
    ceiling_mm: Option<f64>,
) -> Result<Job<'a>, Failure> {
    Ok(Job {
        ceiling_mm,
        base: base.pull.name.clone(),
        hunt: Hunt::new(robot.robot(), settings, aim, base).map_err(Failure::input)?,
    })
}
