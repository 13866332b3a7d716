//! `prone crawl under`: can the robot get under this, how, and how fast?

use std::io::Write as _;

use anyhow::anyhow;

use prone::gait::cycle::Cycle;
use prone_files::cycle_file;
use prone_record::experiment::{
    GaitText, PassageCycle, PassageExperiment, PassageSearch, RobotText,
};
use prone_record::single_file;
use prone_sim::LoadedRobot;
use prone_study::run::{PassageOutcome, RunError, Session};
use prone_study::search::passage::{Passage, PassageError};

use crate::args::passage::UnderArgs;
use crate::gait::find_cycle;
use crate::progress::Progress;
use crate::{Failure, interrupt, record_folder};

/// A cycle by name, or the cycle of a file.
pub(crate) fn find(robot: &LoadedRobot, name: &str) -> Result<Cycle, Failure> {
    Ok(find_cycle(&robot.files().gaits, name)?.cycle)
}

/// Cycles by name.
pub(crate) fn cycles(robot: &LoadedRobot, names: &[String]) -> Result<Vec<Cycle>, Failure> {
    names.iter().map(|name| find(robot, name)).collect()
}

/// What was typed, with the texts of the cycles: those that are named, or else those that the robot's
/// `[defaults]` name.
fn experiment(args: &UnderArgs) -> Result<PassageExperiment, Failure> {
    let files = crate::robot::files(args.robot.name())?;
    let usual = files.defaults().map_err(Failure::input)?.cycle.under;
    let names = match args.gaits.names() {
        [] => &usual,
        names => names,
    };
    let cycles = names.iter().map(|name| {
        let source = find_cycle(&files.gaits, name)?;
        let origin = if source.is_shipped() {
            "shipped"
        } else {
            "file"
        };
        Ok(PassageCycle {
            gait: GaitText::new(&source.file, &source.text),
            origin: origin.to_owned(),
        })
    });
    Ok(PassageExperiment {
        cycles: cycles.collect::<Result<_, Failure>>()?,
        robot: RobotText::from_files(&files),
        ceiling_mm: args.ceiling_mm,
        margin_mm: args.margin_mm,
        search: args.seed.map(|seed| PassageSearch {
            seed,
            budget: args.budget,
        }),
    })
}

pub(crate) fn run(args: &UnderArgs) -> Result<(), Failure> {
    let experiment = experiment(args)?;
    if let Some(path) = &args.gait_out {
        record_folder::check_outside("--gait-out", path)?;
        single_file::check_place(path).map_err(Failure::input)?;
    }
    interrupt::listen()?;
    let session = Session {
        program: crate::program(),
        threads: args.threads.map(usize::from),
        ..Session::default()
    };
    let progress = Progress::searching()?;
    let outcome = session.passage(&experiment, &progress);
    progress.finish();
    let PassageOutcome { passage, cycle } = outcome.map_err(failure)?;
    if let (Some(path), Some(best), Some(cycle)) = (&args.gait_out, &passage.best, &cycle) {
        let header = format!(
            "Passes {} mm with {:.1} mm to spare, {:.1} mm per cycle (prone crawl under).",
            args.ceiling_mm, best.left_mm, best.mm_per_cycle
        );
        let text = cycle_file::write(cycle, &header);
        single_file::write(path, text.as_bytes()).map_err(Failure::input)?;
    }
    let mut out = std::io::stdout().lock();
    if args.json {
        let text = serde_json::to_string_pretty(&passage).map_err(Failure::work)?;
        writeln!(out, "{text}")?;
    } else {
        print(&passage, args.seed, &mut out)?;
    }
    Ok(())
}

fn failure(error: RunError) -> Failure {
    match error {
        RunError::Stopped => Failure::Stopped,
        RunError::NoRoom {
            ceiling_mm,
            margin_mm,
        } => no_room("--ceiling-mm", ceiling_mm, margin_mm),
        RunError::Passage(PassageError::Result(error)) => Failure::work(error),
        RunError::Threads(_) => Failure::work(error),
        other => Failure::input(other),
    }
}

/// A margin that is as large as its ceiling.
pub(crate) fn no_room(option: &str, ceiling_mm: f64, margin_mm: f64) -> Failure {
    Failure::Input(anyhow!(
        "--margin-mm {margin_mm} must be smaller than {option} {ceiling_mm}"
    ))
}

fn print(
    passage: &Passage,
    seed: Option<u64>,
    out: &mut impl std::io::Write,
) -> std::io::Result<()> {
    let ceiling = passage.ceiling_mm;
    match &passage.best {
        Some(best) => {
            writeln!(out, "{ceiling} mm: feasible with {}", best.gait)?;
            writeln!(
                out,
                "  {:.1} mm to spare ({} mm asked), {:.1} mm per cycle, {:.1} mm/s",
                best.left_mm, passage.margin_mm, best.mm_per_cycle, best.mm_per_s
            )?;
            writeln!(
                out,
                "  largest torque {:.2} of the manufacturer's limit ({})",
                best.peak_torque_over_rated, best.peak_joint
            )?;
        }
        None => writeln!(out, "{ceiling} mm: not feasible")?,
    }
    writeln!(out, "  limited by {}", passage.limited_by)?;
    for tried in &passage.tried {
        writeln!(
            out,
            "    {:<18}{:>7.1} mm high ({}), {:>6.1} mm per cycle, {:>5.1} mm/s",
            tried.gait, tried.top_mm, tried.top_part, tried.mm_per_cycle, tried.mm_per_s
        )?;
    }
    for (gait, reason) in &passage.refused {
        writeln!(out, "    {gait}: cannot be crawled: {reason}")?;
    }
    if seed.is_none() && passage.may_be_searched() {
        writeln!(out, "  --seed 1 searches for a lower one")?;
    }
    Ok(())
}
