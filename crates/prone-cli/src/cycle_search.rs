//! Searches of whole cycles: `prone crawl frontier`, and `prone optimize --source cycle`.

mod files;

use std::io::Write as _;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

use anyhow::anyhow;
use serde_json::{Value, json};

use prone::gait::cycle::Cycle;
use prone_sim::{LoadedRobot, Regime};
use prone_study::cycle_search::frontier::{self, Hunt};
use prone_study::cycle_search::passage::too_low;
use prone_study::cycle_search::price::{Aim, CycleObjective, CycleRules, Merge};
use prone_study::cycle_search::record::{Compared, Found, Frontier};
use prone_study::cycle_search::settings;
use prone_study::cycle_search::trial::Setting;
use prone_study::optimize::search::{Search, SearchEnd};
use prone_study::output;

use crate::args::optimize::{OptimizeArgs, SolverName};
use crate::args::passage::{AgainstName, FrontierArgs};
use crate::args::pricing::ObjectiveName;
use crate::checkpoint::Checkpoint;
use crate::progress::SearchProgress;
use crate::{Failure, interrupt, passage};
use files::pretty;

/// Cycles about which is searched where none are named.
const FROM: [&str; 2] = ["low-175", "low-165"];
/// The cycle that a found one is compared with, where the robot can crawl it.
const COMPARED: &str = "thesis-nominal";
/// Most evaluations of a run of `prone optimize` where none are asked for.
const BUDGET: u64 = 1600;

/// What is searched, how, and where it goes.
struct Quest<'a> {
    robot: &'a LoadedRobot,
    objective: CycleObjective,
    margin_mm: f64,
    jobs: Vec<Job<'a>>,
    confirmation: Vec<Setting>,
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
    let robot = crate::robot::load(args.robot.as_deref())?;
    let from = names(&args.from);
    let cycles = passage::cycles(&from)?;
    let objective = match args.against {
        AgainstName::Advance => CycleObjective::Advance,
        AgainstName::Heat => CycleObjective::Heat,
    };
    let settings = settings_for(objective, steered(args.steerable), &robot)?;
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
            rules: rules_for(objective, height, base),
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
        confirmation: confirmation_for(objective, steered(args.steerable), &robot)?,
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
    let robot = crate::robot::load(args.pricing.robot.as_deref())?;
    let from = names(args.pricing.from.as_slice());
    let cycles = passage::cycles(&from)?;
    let settings = settings_for(objective, steered(args.steerable), &robot)?;
    let height = args.ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3);
    if let Some(mm) = args.ceiling_mm {
        refuse_too_low(&robot, "--ceiling-mm", mm, height)?;
    }
    let base = frontier::base(&robot, &settings[0], &cycles, height).map_err(Failure::input)?;
    let usual = rules_for(objective, height, base);
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
        merge: merge(args, &settings, objective)?,
        rules,
    };
    let jobs = vec![job(&robot, &settings, aim, base, args.ceiling_mm)?];
    pursue(&mut Quest {
        robot: &robot,
        objective,
        margin_mm: 0.0,
        jobs,
        confirmation: confirmation_for(objective, steered(args.steerable), &robot)?,
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
    let cycle = passage::find(name)?;
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

fn names<T: AsRef<[String]>>(given: T) -> Vec<String> {
    match given.as_ref() {
        [] => FROM.map(str::to_owned).to_vec(),
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

/// Whether a cycle has to be steered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Steered {
    Yes,
    No,
}

/// As it was typed.
const fn steered(flag: bool) -> Steered {
    if flag { Steered::Yes } else { Steered::No }
}

fn settings_for(
    objective: CycleObjective,
    steered: Steered,
    robot: &LoadedRobot,
) -> Result<Vec<Setting>, Failure> {
    let settings = match objective {
        CycleObjective::Heat | CycleObjective::Peak => settings::for_heat(robot),
        CycleObjective::Advance | CycleObjective::Speed => settings::for_advance(robot),
    };
    let mut settings = settings.map_err(Failure::input)?;
    if steered == Steered::Yes {
        settings.extend(settings::for_steering(robot).map_err(Failure::input)?);
    }
    Ok(settings)
}

fn confirmation_for(
    objective: CycleObjective,
    steered: Steered,
    robot: &LoadedRobot,
) -> Result<Vec<Setting>, Failure> {
    let settings = match objective {
        CycleObjective::Heat | CycleObjective::Peak => settings::for_heat_confirmation(robot),
        CycleObjective::Advance | CycleObjective::Speed => settings::for_confirmation(robot),
    };
    let mut settings = settings.map_err(Failure::input)?;
    if steered == Steered::Yes {
        let more = settings::for_steering_confirmation(robot).map_err(Failure::input)?;
        settings.extend(more);
    }
    Ok(settings)
}

fn rules_for(objective: CycleObjective, height: f64, base: &Cycle) -> CycleRules {
    match objective {
        CycleObjective::Heat | CycleObjective::Peak => settings::heat_rules(height),
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

fn pursue(quest: &mut Quest<'_>) -> Result<(), Failure> {
    interrupt::listen()?;
    output::check(quest.out).map_err(Failure::input)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(quest.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))?;
    complete(quest);
    let mut checkpoint = Checkpoint::beside(quest.out, quest.plan.clone());
    // Not part of what a checkpoint must agree with: a search may be given more.
    quest.plan["budget"] = json!(quest.budget);
    let _lock = checkpoint.lock()?;
    let mut searches = begin(quest, &checkpoint)?;
    let started = Instant::now();
    pool.install(|| search(quest, &mut searches, &mut checkpoint))?;
    let (frontier, gaits) = pool.install(|| found(quest, &searches));
    if interrupt::requested() {
        return Err(suspended(&checkpoint));
    }
    let mut artefacts = files::artefacts(quest, &frontier, &gaits, &searches)?;
    let timing = json!({
        "wall_s": started.elapsed().as_secs_f64(),
        "threads": pool.current_num_threads(),
    });
    artefacts.insert("timing.json".into(), pretty(&timing)?);
    interrupt::publish(|| {
        output::publish(quest.out, &artefacts).map_err(Failure::work)?;
        checkpoint.remove()
    })?;
    let mut out = std::io::stdout().lock();
    if quest.json {
        let text = serde_json::to_string_pretty(&frontier).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
    print(&frontier, &mut out)?;
    writeln!(out, "\nresult: {}", quest.out.display())?;
    Ok(())
}

/// What every plan says.
fn complete(quest: &mut Quest<'_>) {
    let files = quest.robot.files();
    quest.plan["program"] = json!("prone");
    quest.plan["version"] = json!(env!("CARGO_PKG_VERSION"));
    quest.plan["commit"] = json!(env!("PRONE_COMMIT"));
    quest.plan["engine"] = json!(prone_sim::engine_version());
    quest.plan["solver"] = json!("cma-es, about the middle");
    quest.plan["regime"] = json!(Regime::LOCOMOTION.name);
    quest.plan["bases"] = quest.jobs.iter().map(|job| job.base.as_str()).collect();
    quest.plan["robot"] = json!({
        "name": quest.robot.robot().name,
        "folder": files.folder,
        "sha256": files.hash(),
    });
}

/// New searches, one a job, or those that were interrupted.
fn begin(quest: &Quest<'_>, checkpoint: &Checkpoint) -> Result<Vec<Search>, Failure> {
    if quest.resume {
        if let Some(mut searches) = checkpoint.read::<Vec<Search>>()? {
            if searches.len() != quest.jobs.len() {
                return Err(Failure::Input(anyhow!(
                    "{} is the checkpoint of another search; without --resume it is replaced",
                    checkpoint.path().display()
                )));
            }
            for search in &mut searches {
                search.allow(quest.budget).map_err(Failure::input)?;
            }
            return Ok(searches);
        }
        // Where nobody listens, the work goes on.
        let _ = writeln!(
            std::io::stderr(),
            "there is no {}: starting from the beginning",
            checkpoint.path().display()
        );
    } else {
        checkpoint.announce_replacement();
    }
    let fresh = |_: &Job<'_>| Search::about_the_middle(quest.seed, quest.runs, quest.budget);
    Ok(quest.jobs.iter().map(fresh).collect())
}

fn search(
    quest: &Quest<'_>,
    searches: &mut Vec<Search>,
    checkpoint: &mut Checkpoint,
) -> Result<(), Failure> {
    for (index, job) in quest.jobs.iter().enumerate() {
        let mut search = searches[index].clone();
        let progress = SearchProgress::new(&search)?;
        let mut kept = Ok(());
        let end = job.hunt.proceed(&mut search, |search| {
            progress.show(search);
            searches[index].clone_from(search);
            kept = checkpoint.keep(searches);
            if kept.is_err() || interrupt::requested() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        progress.finish();
        kept?;
        searches[index] = search;
        checkpoint.write(searches)?;
        if end == SearchEnd::Interrupted {
            return Err(suspended(checkpoint));
        }
    }
    Ok(())
}

fn suspended(checkpoint: &Checkpoint) -> Failure {
    Failure::Paused(format!(
        "the search is kept in {}, and --resume goes on from there",
        checkpoint.path().display()
    ))
}

/// What each run found, confirmed, and the cycles under their names.
fn found(quest: &Quest<'_>, searches: &[Search]) -> (Frontier, Vec<Cycle>) {
    let mut frontier = Frontier {
        objective: quest.objective.name(),
        margin_mm: quest.margin_mm,
        found: Vec::new(),
        compared: Vec::new(),
    };
    let mut gaits = Vec::new();
    for (job, search) in quest.jobs.iter().zip(searches) {
        for run in search.runs() {
            let quoted = run.best().and_then(|best| job.hunt.quote(&best.point));
            let Some((mut cycle, price)) = quoted else {
                continue;
            };
            let stem = match (&quest.name, job.ceiling_mm) {
                (Some(name), _) => name.clone(),
                (None, Some(mm)) => format!("under-{}", mm.to_string().replace('.', "-")),
                (None, None) => "open".to_owned(),
            };
            cycle.pull.name = format!("{stem}-seed-{}", run.seed);
            let under = job
                .ceiling_mm
                .map_or_else(String::new, |mm| format!(" under {mm} mm"));
            cycle.pull.description = format!(
                "searched{under} about {} for {}, seed {}, {} evaluations",
                job.base,
                quest.objective.name(),
                run.seed,
                run.evaluations()
            );
            let ceiling = job.ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3);
            let confirmed = frontier::confirm(&quest.confirmation, &cycle, ceiling);
            frontier.found.push(Found::new(
                job.ceiling_mm,
                run.seed,
                run.evaluations(),
                &cycle,
                &price,
                confirmed,
            ));
            gaits.push(cycle);
        }
    }
    if let Ok(cycle) = passage::find(COMPARED) {
        let confirmed = frontier::confirm(&quest.confirmation, &cycle, f64::INFINITY);
        if confirmed.settings.iter().any(|row| row.refused.is_none()) {
            frontier.compared.push(Compared {
                gait: COMPARED.to_owned(),
                confirmed,
            });
        }
    }
    (frontier, gaits)
}

fn print(frontier: &Frontier, out: &mut impl std::io::Write) -> std::io::Result<()> {
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
            .find(|row| row.setting == "stiff servos");
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
