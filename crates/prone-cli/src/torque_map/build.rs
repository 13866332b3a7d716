//! `prone torque-map build`.

use std::io::Write as _;
use std::time::Instant;

use anyhow::anyhow;

use prone_record::resumption::{Opening, ResumptionError, Work};
use prone_record::single_file;
use prone_sim::LoadedRobot;
use prone_study::torque_map::build::{self, BuildError, Built, Summary};
use prone_study::torque_map::{Job, NodeGrid, Source};

use crate::args::{BuildArgs, SourceArg};
use crate::progress::Progress;
use crate::{Failure, interrupt};

pub(super) fn run(args: &BuildArgs) -> Result<(), Failure> {
    let grid = NodeGrid::new(args.step_deg, args.theta4_max_deg).map_err(Failure::input)?;
    let robot = crate::robot::load(args.robot.name())?;
    let source = match args.source {
        SourceArg::Statics => Source::Statics,
        SourceArg::Simulation => Source::Simulation,
    };
    let job = Job::new(&robot, source, grid, &crate::program()).map_err(Failure::input)?;
    check_place(args, &robot)?;
    interrupt::listen()?;
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))?;
    let opening = if args.restart {
        Opening::Restart
    } else {
        Opening::Resume
    };

    let journal = Work::TorqueMap.beside(&args.out);
    let progress = Progress::measuring(job.rows(), journal.clone())?;
    let started = Instant::now();
    let built = pool.install(|| build::run(&job, &args.out, opening, &progress));
    progress.finish();
    let built = built.map_err(|error| failure(error, &journal))?;
    let wall_s = started.elapsed().as_secs_f64();
    let threads = pool.current_num_threads();
    let summary = publish(args, built)?;

    let mut err = std::io::stderr();
    // Where nobody listens, nothing is lost.
    let _ = writeln!(err, "done in {wall_s:.1} s, threads: {threads}");
    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string_pretty(&summary).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
    } else {
        print(&summary, args, &mut out)?;
    }
    Ok(())
}

/// Refuses a place where the map cannot go, before the work.
fn check_place(args: &BuildArgs, robot: &LoadedRobot) -> Result<(), Failure> {
    let out = args.out.display();
    single_file::check_place(&args.out).map_err(Failure::input)?;
    match single_file::same_file(&args.out, &robot.files().read) {
        None => Ok(()),
        Some(input) => Err(Failure::Input(anyhow!(
            "--out {out} would overwrite {}, which was read",
            input.display()
        ))),
    }
}

/// Puts the map in place; only then the journal goes.
fn publish(args: &BuildArgs, built: Built) -> Result<Summary, Failure> {
    let Built {
        text,
        summary,
        journal,
    } = built;
    let rows = summary.rows;
    let kept = journal.path().to_owned();
    let done = interrupt::publish(|| {
        single_file::write(&args.out, text.as_bytes()).map_err(|error| {
            Failure::Work(anyhow!("{error}; all rows are in {}", kept.display()))
        })?;
        journal.remove().map_err(Failure::work)
    });
    match done {
        Err(Failure::Stopped) => Err(paused(rows, rows, &kept)),
        done => done.map(|()| summary),
    }
}

fn paused(done: usize, rows: usize, journal: &std::path::Path) -> Failure {
    Failure::Paused(format!(
        "{done} of {rows} rows are in {}, and are taken over by the same command",
        journal.display()
    ))
}

fn failure(error: BuildError, journal: &std::path::Path) -> Failure {
    match error {
        BuildError::Stopped { kept: 0, .. } => Failure::Stopped,
        BuildError::Stopped { kept, rows } => paused(kept, rows, journal),
        BuildError::Grid(_) | BuildError::Journal(ResumptionError::Write(_)) => {
            Failure::work(error)
        }
        BuildError::Symmetry(_) | BuildError::World(_) | BuildError::Journal(_) => {
            Failure::input(error)
        }
    }
}

fn print(
    summary: &Summary,
    args: &BuildArgs,
    out: &mut impl std::io::Write,
) -> std::io::Result<()> {
    let Summary {
        source,
        rows,
        with_torques,
        open,
        failed,
    } = summary;
    writeln!(out, "{}: torque map by {source}", args.out.display())?;
    writeln!(out, "{rows:>8} rows")?;
    writeln!(out, "{with_torques:>8} with torques")?;
    writeln!(out, "{open:>8} masked: the chain does not close")?;
    writeln!(out, "{failed:>8} masked: the source had no torques")
}
