//! `prone crawl under`: can the robot get under this, how, and how fast?

use std::io::Write as _;

use anyhow::anyhow;

use prone::gait::cycle::Cycle;
use prone_files::cycle_file;
use prone_record::single_file;
use prone_sim::LoadedRobot;
use prone_study::search::passage::{Passage, PassageError, PassageSearch};
use prone_study::search::run::SearchError;
use prone_study::search::settings;

use crate::args::passage::UnderArgs;
use crate::gait::find_cycle;
use crate::progress::Progress;
use crate::{Failure, interrupt, search};

/// A cycle by name, or the cycle of a file.
pub(crate) fn find(robot: &LoadedRobot, name: &str) -> Result<Cycle, Failure> {
    Ok(find_cycle(&robot.files().gaits, name)?.cycle)
}

/// Cycles by name.
pub(crate) fn cycles(robot: &LoadedRobot, names: &[String]) -> Result<Vec<Cycle>, Failure> {
    names.iter().map(|name| find(robot, name)).collect()
}

/// Cycles by name, or those that the robot's `[defaults]` name, each with where it comes from.
fn sources(robot: &LoadedRobot, names: &[String]) -> Result<Vec<(Cycle, &'static str)>, Failure> {
    let files = robot.files();
    let usual = files.defaults().map_err(Failure::input)?.cycle.under;
    let names = if names.is_empty() { &usual } else { names };
    let sources = names.iter().map(|name| {
        let source = find_cycle(&files.gaits, name)?;
        let origin = if source.is_shipped() {
            "shipped"
        } else {
            "file"
        };
        Ok((source.cycle, origin))
    });
    sources.collect()
}

pub(crate) fn run(args: &UnderArgs) -> Result<(), Failure> {
    let robot = crate::robot::load(args.robot.name())?;
    let sources = sources(&robot, args.gaits.names())?;
    let settings = settings::for_advance(&robot).map_err(Failure::input)?;
    let (ceiling, margin) = (args.ceiling_mm * 1e-3, args.margin_mm * 1e-3);
    if margin >= ceiling {
        return Err(no_room("--ceiling-mm", args.ceiling_mm, args.margin_mm));
    }
    interrupt::listen()?;
    let tried = sources.iter().map(|(cycle, origin)| (cycle, *origin));
    let mut passage = Passage::try_all(robot.robot(), &settings[0], tried, ceiling, margin);
    let mut cycles: Vec<Cycle> = sources.into_iter().map(|(cycle, _)| cycle).collect();
    if let (Some(seed), true) = (args.seed, passage.may_be_searched()) {
        let search = PassageSearch {
            seed,
            budget: args.budget,
        };
        let (mm, height) = (args.ceiling_mm, ceiling - margin);
        let progress = Progress::searching()?;
        let found = search::pool(args.threads)?
            .install(|| search.run(&robot, &cycles, &mut passage, mm, height, &progress));
        progress.finish();
        cycles.extend(found.map_err(|error| match error {
            PassageError::Result(SearchError::Stopped) => Failure::Stopped,
            PassageError::Result(error) => Failure::work(error),
            PassageError::Search(error) => Failure::input(error),
        })?);
    }
    if interrupt::requested() {
        return Err(Failure::Stopped);
    }
    if let (Some(path), Some(best)) = (&args.gait_out, &passage.best) {
        let cycle = cycles
            .iter()
            .rev()
            .find(|cycle| cycle.pull.name == best.gait);
        let header = format!(
            "Passes {} mm with {:.1} mm to spare, {:.1} mm per cycle (prone crawl under).",
            args.ceiling_mm, best.left_mm, best.mm_per_cycle
        );
        if let Some(cycle) = cycle {
            let text = cycle_file::write(cycle, &header);
            single_file::write(path, text.as_bytes()).map_err(Failure::input)?;
        }
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
