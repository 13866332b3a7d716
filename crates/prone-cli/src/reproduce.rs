//! `prone reproduce`.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::time::Instant;

use anyhow::anyhow;
use serde_json::json;

use prone::gait::cycle::{CheckedCycle, CycleError, TimeScale};
use prone::regime::Regime;
use prone::robot::Robot;
use prone_files::gaits::Gaits;
use prone_files::shipped;
use prone_record::output;
use prone_sim::World;
use prone_sim::crawl::CrawlError;
use prone_thesis::published;
use prone_thesis::reproduce::{self, ReproduceError, Reproduction, Study};
use prone_thesis::summary::Summary;
use prone_thesis::table_crawl::{TableError, TableStudy};
use prone_thesis::torque_study::{Plan, StudyError};

use crate::args::ReproduceArgs;
use crate::progress::Progress;
use crate::{Failure, interrupt};

pub(crate) fn run(args: &ReproduceArgs) -> Result<(), Failure> {
    // Those that ship, also for a robot with gaits of its own of these names.
    let gaits = published::GAITS.map(|name| crate::gait::find(&Gaits::None, name));
    let plan = Plan::new(
        gaits.into_iter().collect::<Result<_, _>>()?,
        &args.durations,
    )
    .map_err(Failure::input)?;
    let robot = crate::robot::load(args.robot.name())?;
    let world = World::new(&robot, Regime::TORQUE_STUDY).map_err(Failure::input)?;
    plan.check(&world).map_err(Failure::input)?;
    let table = table_study(world.robot())?;
    interrupt::listen()?;
    output::check(&args.out).map_err(Failure::input)?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))?;
    let program = crate::program();

    let gait_files = gait_files();
    let study = Study {
        robot: &robot,
        plan: &plan,
        gait_files: &gait_files,
        table: table.as_ref(),
    };
    let crawls = table.as_ref().map_or(0, |_| published::TABLE_CRAWLS.len());
    let progress = Progress::simulating(plan.phases() + crawls)?;
    let started = Instant::now();
    let reproduction = pool.install(|| reproduce::run(&study, &program, &progress));
    progress.finish();
    let mut reproduction = reproduction.map_err(failure)?;
    let timing = timing(&reproduction, started, pool.current_num_threads())?;
    reproduction.artefacts.insert("timing.json".into(), timing);
    interrupt::publish(|| {
        output::publish(&args.out, &reproduction.artefacts).map_err(Failure::work)
    })?;

    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string_pretty(&reproduction.summary).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
    } else {
        print(&reproduction.summary, &mut out)?;
        writeln!(out, "\nreport: {}", args.out.join("report.html").display())?;
    }
    Ok(())
}

/// The crawl under the table, for a robot that has the joints which its cycle names.
fn table_study(robot: &Robot) -> Result<Option<TableStudy>, Failure> {
    let gait = crate::gait::find_cycle(&Gaits::None, published::TABLE_CYCLE)?;
    let Some((scene, text)) =
        shipped::scene(published::TABLE_SCENE).zip(shipped::scene_text(published::TABLE_SCENE))
    else {
        return Ok(None);
    };
    let scene = scene.map_err(Failure::input)?;
    match CheckedCycle::plan(robot, &robot.stops(), &gait.cycle, 0.0, TimeScale::ONE) {
        Ok(_) => Ok(Some(TableStudy {
            gait,
            scene,
            scene_text: text.to_owned(),
        })),
        Err(CycleError::UnknownJoint { .. }) => Ok(None),
        Err(error) => Err(Failure::input(error)),
    }
}

/// Path and text of the gaits' files, by name.
fn gait_files() -> BTreeMap<String, (String, String)> {
    let files = published::GAITS.into_iter().filter_map(|name| {
        let gait = shipped::gait_file(name)?;
        Some((name.to_owned(), (gait.file, gait.text.into_owned())))
    });
    files.collect()
}

fn timing(
    reproduction: &Reproduction,
    started: Instant,
    threads: usize,
) -> Result<Vec<u8>, Failure> {
    let wall_s = started.elapsed().as_secs_f64();
    let timing = json!({
        "wall_s": wall_s,
        "threads": threads,
        "engine_steps": reproduction.engine_steps,
    });
    serde_json::to_vec_pretty(&timing).map_err(Failure::work)
}

/// A gait that the robot cannot follow is wrong input, a diverging simulation is not.
fn failure(error: ReproduceError) -> Failure {
    use prone_sim::pull::PullError;
    match error {
        ReproduceError::Study(StudyError::Stopped)
        | ReproduceError::Table(TableError::Crawl(CrawlError::Stopped)) => Failure::Stopped,
        ReproduceError::World(_)
        | ReproduceError::Study(
            StudyError::Trajectory(_)
            | StudyError::Pull(PullError::Trajectory(_) | PullError::StartPosture { .. }),
        ) => Failure::input(error),
        _ => Failure::work(error),
    }
}

fn print(summary: &Summary, out: &mut impl std::io::Write) -> std::io::Result<()> {
    writeln!(out, "cost of a pull, N²·m²·s: ours / published")?;
    writeln!(
        out,
        "{:>8}{:>18}{:>18}{:>18}",
        "duration",
        published::NOMINAL,
        published::OPTIMAL,
        "ratio"
    )?;
    for row in &summary.ratios {
        let cell = |gait: &str| {
            let cost = summary
                .costs
                .iter()
                .find(|cost| cost.gait == gait && (cost.duration_s - row.duration_s).abs() < 1e-9);
            cost.map_or_else(String::new, |cost| {
                beside(cost.cost_n2m2s, cost.published_n2m2s)
            })
        };
        writeln!(
            out,
            "{:>6} s{:>18}{:>18}{:>18}",
            row.duration_s,
            cell(published::NOMINAL),
            cell(published::OPTIMAL),
            beside(row.ours, row.published)
        )?;
    }
    if !summary.table.is_empty() {
        writeln!(
            out,
            "\ncrawl under the table: ours in simulation / published on the robot"
        )?;
    }
    for row in &summary.table {
        let (ours, theirs) = (&row.ours, &row.published);
        writeln!(
            out,
            "{:>6} cycles: {:.1} / {:.1} mm in {:.1} / {:.0} s; ours {}",
            theirs.cycles,
            ours.distance_mm,
            theirs.distance_mm,
            ours.time_s,
            theirs.time_s,
            row.touched()
        )?;
    }
    Ok(())
}

/// Ours, then theirs where there is one.
fn beside(ours: f64, theirs: Option<f64>) -> String {
    let theirs = theirs.map_or_else(|| "–".to_owned(), |theirs| format!("{theirs:.3}"));
    format!("{ours:.3} / {theirs}")
}
