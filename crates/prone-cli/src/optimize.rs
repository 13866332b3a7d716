//! `prone optimize`.

use std::io::Write as _;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use serde_json::{Value, json};

use prone::gait::{CheckedTrajectory, Gait};
use prone_files::gait_file;
use prone_sim::{Regime, World};
use prone_study::figures::{Scores, search_figures};
use prone_study::optimize::confirm::{self, ConfirmError, ConfirmPlan, Confirmation};
use prone_study::optimize::form::{Ends, GaitForm, Parametrisation};
use prone_study::optimize::outcome::{self, Hunt, Outcome};
use prone_study::optimize::pricer::{self, Aim};
use prone_study::optimize::pricing::INTERVALS;
use prone_study::optimize::search::{Search, SearchEnd, Solver};
use prone_study::output::{self, Artefacts};

use crate::args::optimize::{EndsName, OptimizeArgs, SolverName};
use crate::checkpoint::Checkpoint;
use crate::pricing::Pricing;
use crate::progress::{Progress, SearchProgress};
use crate::{Failure, interrupt};

/// Evaluations of a run where none are asked for.
const BUDGET: u64 = 100_000;
/// The same where each is a simulation.
const DYNAMIC_BUDGET: u64 = 3_000;

/// The gaits that a found one is compared with, where the robot can follow them.
const COMPARED: [&str; 2] = ["nominal", "optimal"];

/// Pixels per unit of an SVG figure in its PNG.
const PNG_SCALE: f32 = 2.0;

pub(crate) fn run(args: &OptimizeArgs) -> Result<(), Failure> {
    let pricing = Pricing::new(&args.pricing, None)?;
    check_form(args, &pricing)?;
    check_name(args, &pricing)?;
    let pricer = pricer::pricer(&pricing.world, &pricing.terms()).map_err(Failure::input)?;
    let ends = match args.ends {
        EndsName::Fixed => Ends::Fixed,
        EndsName::Free => Ends::Free,
    };
    let forms =
        Parametrisation::new(args.gait_form, ends, &pricing.base).map_err(Failure::input)?;
    let hunt = Hunt {
        pricer: &pricer,
        forms: &forms,
    };
    interrupt::listen()?;
    output::check(&args.out).map_err(Failure::input)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))?;

    let mut plan = plan(args, &pricing, &forms);
    let mut checkpoint = Checkpoint::beside(&args.out, plan.clone());
    // Not part of what a checkpoint must agree with: a search may be given more.
    plan["budget"] = json!(budget(args, &pricing));
    let mut search = begin(args, &pricing, &checkpoint)?;
    let started = Instant::now();
    let before = search.evaluations();
    let end = pool.install(|| hunt_down(args, &hunt, &mut search, &mut checkpoint))?;
    let searched = started.elapsed();

    let gait = found_gait(args, &hunt, &search, &pricing)?;
    let mut gaits = compared(&pricing);
    gaits.push(gait);
    let confirmation = pool
        .install(|| confirmed(args, &pricing, &gaits))
        .map_err(|failure| match failure {
            Failure::Stopped => suspended(&checkpoint),
            other => other,
        })?;
    let (gait, others) = gaits
        .split_last()
        .map_or((&pricing.base, &[][..]), |(g, o)| (g, o));
    let unit = pricing.objective().unit();
    let outcome = outcome::of(&hunt, &search, end, gait, unit, others, &confirmation)
        .map_err(Failure::work)?;

    let mut artefacts = artefacts(&search, gait, &outcome, &confirmation, &pricing)?;
    artefacts.insert("run.json".into(), pretty(&plan)?);
    let timing = json!({
        "wall_s": started.elapsed().as_secs_f64(),
        "search_s": searched.as_secs_f64(),
        "evaluations": search.evaluations() - before,
        "threads": pool.current_num_threads(),
    });
    artefacts.insert("timing.json".into(), pretty(&timing)?);
    interrupt::publish(|| {
        output::publish(&args.out, &artefacts).map_err(Failure::work)?;
        // One that a time budget ended can still go on.
        match end {
            SearchEnd::Finished => checkpoint.remove(),
            SearchEnd::Interrupted => checkpoint.write(&search),
        }
    })?;
    report(args, &outcome, &confirmation)
}

/// The published problem is one of six coefficients.
fn check_form(args: &OptimizeArgs, pricing: &Pricing) -> Result<(), Failure> {
    let published = matches!(pricing.aim, Aim::Published(_));
    if published && (args.gait_form != GaitForm::Cubic || args.ends == EndsName::Free) {
        return Err(Failure::Input(anyhow!(
            "--objective published prices cubics with fixed ends only: leave out --gait-form and --ends"
        )));
    }
    Ok(())
}

/// The confirmation tells gaits apart by their names.
fn check_name(args: &OptimizeArgs, pricing: &Pricing) -> Result<(), Failure> {
    let name = gait_name(args);
    if name == pricing.base.name || COMPARED.contains(&name.as_str()) {
        return Err(Failure::Input(anyhow!(
            "the found gait would be called {name:?}, like one that it is compared with: give it another --name"
        )));
    }
    Ok(())
}

fn solver(args: &OptimizeArgs) -> Solver {
    match args.solver {
        SolverName::De => Solver::DifferentialEvolution,
        SolverName::CmaEs => Solver::CovarianceMatrix,
        SolverName::Ga => Solver::Genetic,
    }
}

fn budget(args: &OptimizeArgs, pricing: &Pricing) -> u64 {
    let default = if pricing.is_dynamic() {
        DYNAMIC_BUDGET
    } else {
        BUDGET
    };
    args.budget.unwrap_or(default)
}

/// What is searched, by whom: `run.json`, and what a checkpoint must agree with.
fn plan(args: &OptimizeArgs, pricing: &Pricing, forms: &Parametrisation) -> Value {
    json!({
        "program": "prone",
        "version": env!("CARGO_PKG_VERSION"),
        "commit": env!("PRONE_COMMIT"),
        "engine": prone_sim::engine_version(),
        "command": "optimize",
        "pricing": pricing.record,
        "form": forms.form().to_string(),
        "ends": forms.ends().name(),
        "solver": solver(args).name(),
        "seed": args.seed,
        "runs": args.runs,
        "name": gait_name(args),
        "confirm_durations_s": args.confirm_durations.iter().map(|d| d.seconds()).collect::<Vec<_>>(),
    })
}

fn gait_name(args: &OptimizeArgs) -> String {
    let objective = match args.pricing.objective {
        crate::args::pricing::ObjectiveName::Published => "published",
        crate::args::pricing::ObjectiveName::Torque => "torque",
        crate::args::pricing::ObjectiveName::Peak => "peak",
        crate::args::pricing::ObjectiveName::Heat => "heat",
    };
    let default = || format!("best-{objective}");
    args.name.clone().unwrap_or_else(default)
}

/// A new search, or the one that was interrupted.
fn begin(
    args: &OptimizeArgs,
    pricing: &Pricing,
    checkpoint: &Checkpoint,
) -> Result<Search, Failure> {
    let fresh = || Search::new(solver(args), args.seed, args.runs, budget(args, pricing));
    if !args.resume {
        return Ok(fresh());
    }
    let Some(mut search) = checkpoint.read()? else {
        eprintln!(
            "no checkpoint at {}: beginning anew",
            checkpoint.path().display()
        );
        return Ok(fresh());
    };
    search
        .allow(budget(args, pricing))
        .map_err(Failure::input)?;
    eprintln!("going on after {} evaluations", search.evaluations());
    Ok(search)
}

fn hunt_down(
    args: &OptimizeArgs,
    hunt: &Hunt<'_>,
    search: &mut Search,
    checkpoint: &mut Checkpoint,
) -> Result<SearchEnd, Failure> {
    let progress = SearchProgress::new(search)?;
    let started = Instant::now();
    let time_budget = args.time_budget.map(Duration::from_secs_f64);
    let mut kept = Ok(());
    let end = hunt.proceed(search, |search| {
        progress.show(search);
        // A budget too small for one generation leaves nothing to keep.
        if search.best().is_some() {
            kept = checkpoint.keep(search);
        }
        let spent = time_budget.is_some_and(|budget| started.elapsed() >= budget);
        if kept.is_err() || spent || interrupt::requested() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    progress.finish();
    kept?;
    if interrupt::requested() {
        checkpoint.write(search)?;
        return Err(suspended(checkpoint));
    }
    if search.best().is_some() {
        // The confirmation may still be interrupted.
        checkpoint.write(search)?;
    }
    Ok(end)
}

fn suspended(checkpoint: &Checkpoint) -> Failure {
    Failure::Paused(format!(
        "the search is kept in {}, and --resume goes on from there",
        checkpoint.path().display()
    ))
}

fn found_gait(
    args: &OptimizeArgs,
    hunt: &Hunt<'_>,
    search: &Search,
    pricing: &Pricing,
) -> Result<Gait, Failure> {
    let name = gait_name(args);
    let gait = outcome::best(hunt, search, &name).map_err(|error| match error {
        outcome::OutcomeError::Nothing { .. } => Failure::input(error),
        other => Failure::work(other),
    })?;
    let objective = match pricing.aim {
        Aim::Published(_) => "the published cost".to_owned(),
        Aim::Graded(objective) => objective.name().to_owned(),
    };
    Ok(Gait {
        description: format!(
            "found by {}, seed {}: least {objective}, source {}",
            solver(args).name(),
            search.best().map_or(args.seed, |(run, _)| run.seed),
            Pricing::source_name(&args.pricing.source)
        ),
        ..gait
    })
}

/// The published gaits, and the base gait first, each once.
fn compared(pricing: &Pricing) -> Vec<Gait> {
    let mut gaits = vec![pricing.base.clone()];
    if pricing.world.robot().chain.published.is_some() {
        let published = COMPARED
            .into_iter()
            .filter_map(|name| crate::gait::find(name).ok());
        gaits.extend(published.filter(|gait| gait.name != pricing.base.name));
    }
    gaits
}

fn confirmed(
    args: &OptimizeArgs,
    pricing: &Pricing,
    gaits: &[Gait],
) -> Result<Confirmation, Failure> {
    let locomotion = World::new(&pricing.robot, Regime::LOCOMOTION).map_err(Failure::input)?;
    let plan = ConfirmPlan {
        gaits,
        worlds: &[&pricing.world, &locomotion],
        durations: &args.confirm_durations,
        objective: &pricing.objective(),
    };
    let phases = plan.gaits.len() * plan.worlds.len() * plan.durations.len();
    let progress = Progress::new(phases)?;
    let confirmation = confirm::run(&plan, &progress);
    progress.finish();
    confirmation.map_err(|error| match error {
        ConfirmError::Stopped => Failure::Stopped,
        other => Failure::work(other),
    })
}

fn artefacts(
    search: &Search,
    gait: &Gait,
    outcome: &Outcome,
    confirmation: &Confirmation,
    pricing: &Pricing,
) -> Result<Artefacts, Failure> {
    let mut artefacts = Artefacts::new();
    let header = header(gait, outcome, pricing);
    artefacts.insert(
        "gait.toml".into(),
        gait_file::write(gait, &header).into_bytes(),
    );
    artefacts.insert("result.json".into(), pretty(outcome)?);
    let history = outcome::history_csv(search).map_err(Failure::work)?;
    artefacts.insert("history.csv".into(), history);
    let confirmation_csv = outcome::confirmation_csv(confirmation).map_err(Failure::work)?;
    artefacts.insert("confirmation.csv".into(), confirmation_csv);
    let scores = match pricing.aim {
        Aim::Published(_) => Scores::Published,
        Aim::Graded(_) => Scores::Graded,
    };
    let figures = search_figures(search, confirmation, &pricing.objective(), scores)
        .map_err(Failure::work)?;
    for figure in figures {
        let png = figure.png(PNG_SCALE).map_err(Failure::work)?;
        artefacts.insert(format!("figures/{}.png", figure.stem), png);
        artefacts.insert(
            format!("figures/{}.svg", figure.stem),
            figure.svg.into_bytes(),
        );
    }
    Ok(artefacts)
}

/// How the gait was found and what it does, for whoever reads its file.
fn header(gait: &Gait, outcome: &Outcome, pricing: &Pricing) -> String {
    let mut lines = vec![format!(
        "Found by prone {} ({}), seed {}, {} evaluations in {} runs, on robot {}.",
        env!("CARGO_PKG_VERSION"),
        env!("PRONE_COMMIT"),
        outcome.seed,
        outcome.evaluations,
        outcome.runs.len(),
        pricing.robot.robot().name
    )];
    if let Some(cost) = outcome.price.cost {
        lines.push(format!(
            "Cost {cost:.4} ({}), violations {:.4}.",
            outcome.unit, outcome.price.violations
        ));
    }
    lines.push(
        "Simulated from its own first pose at several durations, cost over another gait's:".into(),
    );
    lines.extend(outcome.verdicts.iter().map(sentence));
    let refused = outcome.refused.iter().map(|refused| {
        let confirm::Refusal {
            regime,
            gait,
            reason,
        } = refused;
        format!("{regime}: {gait} cannot be simulated: {reason}.")
    });
    lines.extend(refused);
    lines.extend(clamps(gait, pricing));
    lines.join("\n")
}

/// Which joints the gait asks past their stops, where it asks any.
fn clamps(gait: &Gait, pricing: &Pricing) -> Option<String> {
    let robot = pricing.robot.robot();
    // The maker's: a regime may have moved them.
    let stops = robot.stops();
    let trajectory =
        CheckedTrajectory::plan(robot, &stops, gait, pricing.duration, INTERVALS).ok()?;
    let clamped = trajectory.clamps().iter().map(|clamp| {
        let by = clamp.largest.abs().to_degrees();
        format!("{} by up to {by:.1}°", robot.joints[clamp.joint.0].name)
    });
    let clamped: Vec<_> = clamped.collect();
    (!clamped.is_empty()).then(|| format!("Clamped at its limit: {}.", clamped.join(", ")))
}

fn sentence(verdict: &confirm::Verdict) -> String {
    let confirm::Verdict {
        regime,
        against,
        cheaper_at,
        of,
        best_ratio,
        worst_ratio,
    } = verdict;
    if *of == 0 {
        return format!("{regime}: not compared with {against}.");
    }
    format!(
        "{regime}: {best_ratio:.3} to {worst_ratio:.3} of {against}, cheaper at {cheaper_at} of {of} durations."
    )
}

fn pretty(value: &impl serde::Serialize) -> Result<Vec<u8>, Failure> {
    serde_json::to_vec_pretty(value).map_err(Failure::work)
}

fn report(
    args: &OptimizeArgs,
    outcome: &Outcome,
    confirmation: &Confirmation,
) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string_pretty(outcome).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
        return Ok(());
    }
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
    writeln!(out, "\nconfirmed by simulation, found over other")?;
    for verdict in &outcome.verdicts {
        writeln!(out, "  {}", sentence(verdict))?;
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
            if !confirmation.holds(regime, &base.gait) {
                writeln!(
                    out,
                    "  the gain over {} does not hold in {regime}",
                    base.gait
                )?;
            }
        }
    }
    writeln!(out, "\ngait: {}", args.out.join("gait.toml").display())?;
    Ok(())
}
