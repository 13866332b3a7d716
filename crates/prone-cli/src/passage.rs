//! `prone crawl under`: can the robot get under this, how, and how fast?

use std::io::Write as _;
use std::ops::ControlFlow;

use anyhow::anyhow;

use prone::gait::cycle::Cycle;
use prone_files::cycle_file;
use prone_record::frontier::CycleObjective;
use prone_record::search::{Search, SearchEnd};
use prone_record::single_file;
use prone_sim::LoadedRobot;
use prone_study::cycle_search::frontier::{self, Hunt};
use prone_study::cycle_search::passage::{Passage, Tried};
use prone_study::cycle_search::price::{Aim, Merge};
use prone_study::cycle_search::setting::Setting;
use prone_study::cycle_search::settings;

use crate::args::passage::UnderArgs;
use crate::gait::find_cycle;
use crate::progress::SearchProgress;
use crate::{Failure, interrupt};

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
        return Err(Failure::Input(anyhow!(
            "--margin-mm {} must be smaller than --ceiling-mm {}",
            args.margin_mm,
            args.ceiling_mm
        )));
    }
    interrupt::listen()?;
    let tried = sources.iter().map(|(cycle, origin)| (cycle, *origin));
    let mut passage = Passage::of(robot.robot(), &settings[0], tried, ceiling, margin);
    let mut cycles: Vec<Cycle> = sources.into_iter().map(|(cycle, _)| cycle).collect();
    if let (Some(seed), true) = (args.seed, passage.may_be_searched()) {
        let found = search(args, &robot, &settings, &cycles, ceiling - margin, seed)?;
        if let Some((cycle, tried)) = found {
            passage.take(tried, "searched");
            cycles.push(cycle);
        }
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

/// Searches a cycle that fits about the lowest one there is.
fn search(
    args: &UnderArgs,
    robot: &LoadedRobot,
    settings: &[Setting],
    cycles: &[Cycle],
    height: f64,
    seed: u64,
) -> Result<Option<(Cycle, Tried)>, Failure> {
    let base = frontier::base(robot, &settings[0], cycles, height).map_err(Failure::input)?;
    let aim = Aim {
        objective: CycleObjective::Advance,
        merge: Merge::Mean,
        rules: settings::advance_rules(height, base),
    };
    let hunt = Hunt::new(robot.robot(), settings, aim, base).map_err(Failure::input)?;
    let mut search = Search::about_the_middle(seed, 1, args.budget);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(args.threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::Work(anyhow!("cannot start worker threads: {error}")))?;
    let progress = SearchProgress::new(&search)?;
    let end = pool.install(|| {
        hunt.proceed(&mut search, |search| {
            progress.show(search);
            if interrupt::requested() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        })
    });
    progress.finish();
    if end == SearchEnd::Interrupted {
        return Err(Failure::Stopped);
    }
    let Some((_, best)) = search.best() else {
        return Ok(None);
    };
    let (mut cycle, price) = hunt.quote(&best.point).map_err(Failure::work)?;
    cycle.pull.name = format!(
        "under-{}-seed-{seed}",
        args.ceiling_mm.to_string().replace('.', "-")
    );
    let Some(trial) = price.trials.first() else {
        return Ok(None);
    };
    let tried = Tried::of(&cycle, trial, args.ceiling_mm * 1e-3);
    Ok(Some((cycle, tried)))
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
