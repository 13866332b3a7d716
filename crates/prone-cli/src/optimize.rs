//! `prone optimize`.

mod files;
mod report;

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use anyhow::anyhow;
use serde_json::{Value, json};

use prone::gait::Gait;
use prone::regime::Regime;
use prone_record::gait_search::Confirmation;
use prone_record::output;
use prone_record::resumption::Snapshot;
use prone_record::search::{Search, SearchEnd, Solver};
use prone_sim::World;
use prone_study::optimize::confirm::{self, ConfirmError, ConfirmPlan};
use prone_study::optimize::form::{Ends, GaitForm, Parametrisation};
use prone_study::optimize::outcome::{self, Hunt};
use prone_study::optimize::pricer::{self, Aim};

use self::files::pretty;
use crate::args::optimize::{EndsName, OptimizeArgs, SolverName};
use crate::checkpoint::{self, suspended, unwritten};
use crate::pricing::Pricing;
use crate::progress::{Progress, SearchProgress};
use crate::{Failure, interrupt};

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
    let pricing = Pricing::new(&args.pricing, robot, None)?;
    check_form(args, &pricing)?;
    check_name(args, &pricing)?;
    let compared = compared(&pricing)?;
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
    let (mut checkpoint, earlier) = checkpoint::open(&args.out, &plan, args.resume)?;
    // Not part of what a checkpoint must agree with: a search may be given more.
    plan["budget"] = json!(budget(args, &pricing));
    let mut search = begin(args, &pricing, earlier)?;
    let started = Instant::now();
    let before = search.evaluations();
    let end = pool.install(|| hunt_down(args, &hunt, &mut search, &mut checkpoint))?;
    let searched = started.elapsed();

    let gait = found_gait(args, &hunt, &search, &pricing)?;
    let mut gaits = compared;
    gaits.push(gait);
    // From here on a search that is stopped is kept.
    let place = checkpoint.path().to_owned();
    let kept = |failure| match failure {
        Failure::Stopped => suspended(&place),
        other => other,
    };
    let confirmation = pool
        .install(|| confirmed(args, &pricing, &gaits))
        .map_err(kept)?;
    let (gait, others) = gaits
        .split_last()
        .map_or((&pricing.base, &[][..]), |(g, o)| (g, o));
    let unit = pricing.objective().unit();
    let outcome = outcome::of(&hunt, &search, end, gait, unit, others, &confirmation)
        .map_err(Failure::work)?;

    let mut artefacts = files::artefacts(&search, gait, others, &outcome, &confirmation, &pricing)?;
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
        .map_err(unwritten)
    })
    .map_err(kept)?;
    report::report(args, &outcome, &confirmation)
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
    let defaults = pricing.robot.files().defaults().map_err(Failure::input)?;
    if name == pricing.base.name || defaults.pull.compared.contains(&name) {
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
        crate::args::pricing::ObjectiveName::Advance => "advance",
        crate::args::pricing::ObjectiveName::Speed => "speed",
    };
    let default = || format!("best-{objective}");
    args.name.clone().unwrap_or_else(default)
}

/// A new search, or the one that was interrupted.
fn begin(
    args: &OptimizeArgs,
    pricing: &Pricing,
    earlier: Option<Search>,
) -> Result<Search, Failure> {
    let budget = budget(args, pricing);
    let Some(mut search) = earlier else {
        return Ok(Search::new(solver(args), args.seed, args.runs, budget));
    };
    search.allow(budget).map_err(Failure::input)?;
    eprintln!("going on after {} evaluations", search.evaluations());
    Ok(search)
}

fn hunt_down(
    args: &OptimizeArgs,
    hunt: &Hunt<'_>,
    search: &mut Search,
    checkpoint: &mut Snapshot<Search>,
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
    kept.map_err(unwritten)?;
    if interrupt::requested() {
        checkpoint.write(search).map_err(unwritten)?;
        return Err(suspended(checkpoint.path()));
    }
    if search.best().is_some() {
        // The confirmation may still be interrupted.
        checkpoint.write(search).map_err(unwritten)?;
    }
    Ok(end)
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

/// The base gait first, then those that the robot's `[defaults]` name and it can follow, each once.
fn compared(pricing: &Pricing) -> Result<Vec<Gait>, Failure> {
    let files = pricing.robot.files();
    let defaults = files.defaults().map_err(Failure::input)?;
    let mut gaits = vec![pricing.base.clone()];
    for name in &defaults.pull.compared {
        let gait = crate::gait::find(&files.gaits, name)?;
        let twice = gaits.iter().any(|other| other.name == gait.name);
        if !twice && crate::gait::can_follow(pricing.robot.robot(), &gait) {
            gaits.push(gait);
        }
    }
    Ok(gaits)
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
