//! `prone crawl under`: can the robot get under this, how, and how fast?

use std::io::Write;

use prone_record::experiment::{
    Experiment, GaitText, PassageCycle, PassageExperiment, PassageSearch, RobotText,
};
use prone_record::resumption::Opening;
use prone_study::search::passage::Passage;

use crate::args::passage::UnderArgs;
use crate::gait::find_cycle;
use crate::plan::{OnContact, Plan, Work};
use crate::{Failure, record_folder};

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

pub(crate) fn plan(args: &UnderArgs) -> Result<Plan, Failure> {
    let experiment = experiment(args)?;
    if let Some(path) = &args.gait_out {
        record_folder::check_outside("--gait-out", path)?;
    }
    Ok(Plan {
        work: Work::Study(Experiment::Passage(Box::new(experiment))),
        out: args.gait_out.clone(),
        opening: Opening::Restart,
        threads: args.threads,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

/// The answer, what limits it, and every cycle that was tried.
pub(crate) fn print(passage: &Passage, searched: bool, out: &mut dyn Write) -> std::io::Result<()> {
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
    if !searched && passage.may_be_searched() {
        writeln!(out, "  --seed 1 searches for a lower one")?;
    }
    Ok(())
}
