//! `prone crawl frontier`: the ceiling against what can be reached below it.

use std::io::Write as _;
use std::ops::ControlFlow;
use std::time::Instant;

use anyhow::anyhow;
use serde_json::{Value, json};

use prone::gait::cycle::Cycle;
use prone_files::cycle_file;
use prone_sim::LoadedRobot;
use prone_study::cycle_search::frontier::{self, Against, Ceiling};
use prone_study::cycle_search::price::Setting;
use prone_study::cycle_search::record::{self, Found, Frontier};
use prone_study::cycle_search::settings;
use prone_study::optimize::search::{Search, SearchEnd};
use prone_study::output::{self, Artefacts};

use crate::args::passage::{AgainstName, FrontierArgs};
use crate::checkpoint::Checkpoint;
use crate::progress::SearchProgress;
use crate::{Failure, interrupt, passage};

/// Cycles about which is searched where none are named.
const FROM: [&str; 2] = ["low-175", "low-165"];

pub(crate) fn run(args: &FrontierArgs) -> Result<(), Failure> {
    let robot = crate::robot::load(args.robot.as_deref())?;
    let from = if args.from.is_empty() {
        FROM.map(str::to_owned).to_vec()
    } else {
        args.from.clone()
    };
    let cycles = passage::cycles(&from)?;
    let against = match args.against {
        AgainstName::Advance => Against::Advance,
        AgainstName::Heat => Against::Heat,
    };
    let settings = match against {
        Against::Advance => settings::for_advance(&robot),
        Against::Heat => settings::for_heat(&robot),
    };
    let settings = settings.map_err(Failure::input)?;
    let ceilings = ceilings(args, &robot, &settings, &cycles, against)?;
    interrupt::listen()?;
    output::check(&args.out).map_err(Failure::input)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))?;

    let mut plan = plan(args, &robot, &from);
    let mut checkpoint = Checkpoint::beside(&args.out, plan.clone());
    plan["budget"] = json!(args.budget);
    let _lock = checkpoint.lock()?;
    let mut searches = begin(args, &checkpoint)?;
    let started = Instant::now();
    pool.install(|| search(&ceilings, &mut searches, &mut checkpoint))?;
    let confirmation = settings::for_confirmation(&robot).map_err(Failure::input)?;
    let found = pool.install(|| found(args, &ceilings, &searches, &confirmation));
    if interrupt::requested() {
        return Err(suspended(&checkpoint));
    }
    let (frontier, gaits) = found;
    let mut artefacts = artefacts(args, &frontier, &gaits, &searches)?;
    artefacts.insert("run.json".into(), pretty(&plan)?);
    let timing = json!({
        "wall_s": started.elapsed().as_secs_f64(),
        "threads": pool.current_num_threads(),
    });
    artefacts.insert("timing.json".into(), pretty(&timing)?);
    interrupt::publish(|| {
        output::publish(&args.out, &artefacts).map_err(Failure::work)?;
        checkpoint.remove()
    })?;
    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string_pretty(&frontier).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
    print(&frontier, &mut out)?;
    writeln!(out, "\nresult: {}", args.out.display())?;
    Ok(())
}

fn ceilings<'a>(
    args: &FrontierArgs,
    robot: &LoadedRobot,
    settings: &'a [Setting],
    cycles: &[Cycle],
    against: Against,
) -> Result<Vec<(f64, String, Ceiling<'a>)>, Failure> {
    let mut ceilings = Vec::with_capacity(args.ceilings_mm.len());
    for &mm in &args.ceilings_mm {
        if mm <= args.margin_mm {
            return Err(Failure::Input(anyhow!(
                "a margin of {} mm leaves nothing of a ceiling of {mm} mm",
                args.margin_mm
            )));
        }
        if ceilings
            .iter()
            .any(|(other, _, _): &(f64, _, _)| other.total_cmp(&mm).is_eq())
        {
            return Err(Failure::Input(anyhow!("--ceilings-mm has {mm} twice")));
        }
        let height = (mm - args.margin_mm) * 1e-3;
        let base = frontier::base(robot, &settings[0], cycles, height).map_err(Failure::input)?;
        let ceiling =
            Ceiling::new(robot.robot(), settings, against, base, height).map_err(Failure::input)?;
        ceilings.push((mm, base.pull.name.clone(), ceiling));
    }
    Ok(ceilings)
}

/// What is searched: `run.json`, and what a checkpoint must agree with.
fn plan(args: &FrontierArgs, robot: &LoadedRobot, from: &[String]) -> Value {
    json!({
        "program": "prone",
        "version": env!("CARGO_PKG_VERSION"),
        "commit": env!("PRONE_COMMIT"),
        "engine": prone_sim::engine_version(),
        "command": "crawl frontier",
        "ceilings_mm": args.ceilings_mm,
        "against": match args.against {
            AgainstName::Advance => "advance",
            AgainstName::Heat => "heat",
        },
        "margin_mm": args.margin_mm,
        "from": from,
        "solver": "cma-es",
        "seed": args.seed,
        "runs": args.runs,
        "robot": {
            "name": robot.robot().name,
            "folder": robot.files().folder,
            "sha256": robot.files().hash(),
        },
        "regime": prone_sim::Regime::LOCOMOTION.name,
    })
}

/// New searches, one a ceiling, or those that were interrupted.
fn begin(args: &FrontierArgs, checkpoint: &Checkpoint) -> Result<Vec<Search>, Failure> {
    if args.resume {
        if let Some(mut searches) = checkpoint.read::<Vec<Search>>()? {
            for search in &mut searches {
                search.allow(args.budget).map_err(Failure::input)?;
            }
            return Ok(searches);
        }
        // Where nobody listens, the work goes on.
        let _ = writeln!(
            std::io::stderr(),
            "there is no {}: starting from the beginning",
            checkpoint.path().display()
        );
    }
    let fresh = |_: &f64| Search::about_the_middle(args.seed, args.runs, args.budget);
    Ok(args.ceilings_mm.iter().map(fresh).collect())
}

fn search(
    ceilings: &[(f64, String, Ceiling<'_>)],
    searches: &mut Vec<Search>,
    checkpoint: &mut Checkpoint,
) -> Result<(), Failure> {
    for (index, (_, _, ceiling)) in ceilings.iter().enumerate() {
        let mut search = searches[index].clone();
        let progress = SearchProgress::new(&search)?;
        let mut kept = Ok(());
        let end = ceiling.proceed(&mut search, |search| {
            progress.show(search);
            searches[index].clone_from(search);
            kept = checkpoint.keep(&searches);
            if kept.is_err() || interrupt::requested() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        });
        progress.finish();
        kept?;
        searches[index] = search;
        checkpoint.write(&searches)?;
        if end == SearchEnd::Interrupted {
            return Err(suspended(checkpoint));
        }
    }
    Ok(())
}

fn suspended(checkpoint: &Checkpoint) -> Failure {
    Failure::Paused(format!(
        "the searches are kept in {}, and --resume goes on from there",
        checkpoint.path().display()
    ))
}

/// What each run found, confirmed, and the cycles under their names.
fn found(
    args: &FrontierArgs,
    ceilings: &[(f64, String, Ceiling<'_>)],
    searches: &[Search],
    confirmation: &[Setting],
) -> (Frontier, Vec<Cycle>) {
    let mut frontier = Frontier {
        against: match args.against {
            AgainstName::Advance => "advance",
            AgainstName::Heat => "heat",
        },
        margin_mm: args.margin_mm,
        found: Vec::new(),
    };
    let mut gaits = Vec::new();
    for ((mm, base, ceiling), search) in ceilings.iter().zip(searches) {
        for run in search.runs() {
            let Some(best) = run.best() else {
                continue;
            };
            let Some((mut cycle, price)) = ceiling.quote(&best.point) else {
                continue;
            };
            let height = mm.to_string().replace('.', "-");
            cycle.pull.name = format!("under-{height}-seed-{}", run.seed);
            cycle.pull.description = format!(
                "found under {mm} mm about {base}, seed {}, {} evaluations",
                run.seed,
                run.evaluations()
            );
            let confirmed = frontier::confirm(confirmation, &cycle, mm * 1e-3);
            frontier.found.push(Found::new(
                *mm,
                run.seed,
                run.evaluations(),
                &cycle,
                &price,
                confirmed,
            ));
            gaits.push(cycle);
        }
    }
    (frontier, gaits)
}

fn artefacts(
    args: &FrontierArgs,
    frontier: &Frontier,
    gaits: &[Cycle],
    searches: &[Search],
) -> Result<Artefacts, Failure> {
    let mut artefacts = Artefacts::new();
    artefacts.insert("result.json".into(), pretty(frontier)?);
    artefacts.insert(
        "frontier.csv".into(),
        record::csv(frontier).map_err(Failure::work)?,
    );
    artefacts.insert(
        "history.csv".into(),
        record::history_csv(&args.ceilings_mm, searches).map_err(Failure::work)?,
    );
    for (cycle, found) in gaits.iter().zip(&frontier.found) {
        let header = format!(
            "Found by prone {} ({}), crawl frontier, {}.\n{}",
            env!("CARGO_PKG_VERSION"),
            env!("PRONE_COMMIT"),
            cycle.pull.description,
            found.sentence()
        );
        let text = cycle_file::write(cycle, &header);
        artefacts.insert(format!("gaits/{}.toml", cycle.pull.name), text.into_bytes());
    }
    if let Some(figure) = record::figure(frontier) {
        let png = figure.png(PNG_SCALE).map_err(Failure::work)?;
        artefacts.insert(format!("figures/{}.png", figure.stem), png);
        artefacts.insert(
            format!("figures/{}.svg", figure.stem),
            figure.svg.into_bytes(),
        );
    }
    Ok(artefacts)
}

/// Pixels per unit of an SVG figure in its PNG.
const PNG_SCALE: f32 = 2.0;

fn pretty(value: &impl serde::Serialize) -> Result<Vec<u8>, Failure> {
    serde_json::to_vec_pretty(value).map_err(Failure::work)
}

fn print(frontier: &Frontier, out: &mut impl std::io::Write) -> std::io::Result<()> {
    writeln!(
        out,
        "{:>10}{:>6}{:>14}{:>9}{:>10}{:>12}{:>11}  holds",
        "ceiling", "seed", "mm per cycle", "mm/s", "top mm", "heat s/m", "violation"
    )?;
    for found in &frontier.found {
        let first = found.confirmed.settings.first();
        let number = |value: Option<f64>, decimals: usize| {
            value.map_or_else(|| "–".to_owned(), |value| format!("{value:.decimals$}"))
        };
        writeln!(
            out,
            "{:>7} mm{:>6}{:>14}{:>9}{:>10}{:>12}{:>11.4}  {}",
            found.ceiling_mm,
            found.seed,
            number(first.and_then(|row| row.mm_per_cycle), 1),
            number(first.and_then(|row| row.mm_per_s), 1),
            number(first.and_then(|row| row.top_mm), 1),
            number(first.and_then(|row| row.heat_per_metre_s), 1),
            found.violation,
            if found.confirmed.holds { "yes" } else { "no" }
        )?;
    }
    Ok(())
}
