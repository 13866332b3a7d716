//! `prone crawl under`: can the robot get under this, how, and how fast?

use std::io::Write;

use prone_record::experiment::{
    Experiment, GaitText, PassageCycle, PassageExperiment, PassageSearch, RobotText,
};
use prone_record::resumption::Opening;
use prone_study::search::passage::{Candidate, Passage};

use crate::args::passage::UnderArgs;
use crate::gait::find_cycle;
use crate::outputs::{Files, Kind};
use crate::plan::{OnContact, Plan, Work};
use crate::{Failure, record_folder};

/// What was typed, with the texts of the cycles: those that are named, or else those that the robot's
/// `[defaults]` name; and the files that are read.
fn experiment(args: &UnderArgs) -> Result<(PassageExperiment, Files), Failure> {
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
            called: name.clone(),
            origin: origin.to_owned(),
        })
    });
    let read = Files::of_robot(&files).reading_gaits(&files.gaits, names);
    let experiment = PassageExperiment {
        cycles: cycles.collect::<Result<_, Failure>>()?,
        robot: RobotText::from_files(&files),
        ceiling_mm: args.ceiling_mm,
        length_m: args.length_m,
        margin_mm: args.margin_mm,
        search: args.seed.map(|seed| PassageSearch {
            seed,
            budget: args.budget,
        }),
    };
    Ok((experiment, read))
}

pub(crate) fn plan(args: &UnderArgs) -> Result<Plan, Failure> {
    let (experiment, read) = experiment(args)?;
    if let Some(path) = &args.gait_out {
        record_folder::check_outside("--gait-out", path)?;
    }
    Ok(Plan {
        work: Work::Study(Experiment::Passage(Box::new(experiment))),
        files: read.maybe_writing("--gait-out", args.gait_out.as_ref(), Kind::Lasting),
        opening: Opening::Restart,
        threads: args.threads,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

/// The answer, what limits it, and every cycle that was tried.
pub(crate) fn print(passage: &Passage, searched: bool, out: &mut dyn Write) -> std::io::Result<()> {
    let (ceiling, length) = (passage.ceiling_mm, passage.length_m);
    let under = format!("{ceiling} mm over {length} m");
    match (&passage.gait, passage.robust) {
        (Some(gait), true) => writeln!(
            out,
            "{under}: crawl with {gait}; it gets through in all {} corners",
            passage.corners
        )?,
        (Some(gait), false) => writeln!(
            out,
            "{under}: only as in the model, with {gait}; no cycle gets through in all {} corners",
            passage.corners
        )?,
        (None, _) if passage.impossible => writeln!(out, "{under}: impossible")?,
        (None, _) => writeln!(out, "{under}: none found")?,
    }
    if let Some(named) = passage.named() {
        print_named(passage, named, out)?;
    }
    writeln!(out, "  limited by {}", passage.limited_by)?;
    print_candidates(passage, out)?;
    for (gait, reason) in &passage.refused {
        writeln!(out, "    {gait}: cannot be crawled: {reason}")?;
    }
    if !searched && passage.may_be_searched() {
        writeln!(out, "  --seed 1 searches for one")?;
    }
    Ok(())
}

fn print_named(passage: &Passage, named: &Candidate, out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(
        out,
        "  {:.1} s, {:.1} mm/s, {:.1} mm per cycle ({:.1} in the worst run), {:.1} mm to spare (in the worst run)",
        named.time_s, named.mm_per_s, named.mm_per_cycle, named.worst_mm_per_cycle, named.margin_mm
    )?;
    let steers = if named.steers {
        "steered"
    } else {
        "cannot be steered"
    };
    let verdict = named.verdict.as_deref().unwrap_or("unknown");
    let worst = match &named.worst_verdict {
        Some(worst) if worst != verdict => format!(" ({worst} in the worst run)"),
        _ => String::new(),
    };
    writeln!(
        out,
        "  {:.0} mm wide; {steers}; at most {:.0} mm off the line; on a robot's motors: {verdict}{worst}",
        named.width_mm, named.drift_mm
    )?;
    let steering = if named.steers { " --heading-hold" } else { "" };
    writeln!(
        out,
        "  prone crawl run {} --ceiling-mm {} --length-m {} --until-past{steering}",
        named.gait, passage.ceiling_mm, passage.length_m
    )
}

fn print_candidates(passage: &Passage, out: &mut dyn Write) -> std::io::Result<()> {
    if passage.candidates.is_empty() {
        return Ok(());
    }
    writeln!(
        out,
        "\n  {:<18}{:>8}{:>9}{:>8}{:>8}  {:<15}{:>8}  corners",
        "cycle", "s", "mm/cycle", "mm/s", "top mm", "motors", "head N"
    )?;
    for it in &passage.candidates {
        let corners = match (&it.obstructed, &it.failed, it.robust) {
            (Some(reason), _, _) => format!("not tried: {reason}"),
            (None, Some(failed), _) => format!("{}: {}", failed.corner, failed.reason),
            (None, None, Some(_)) => format!("all {}", it.corners_passed),
            (None, None, None) => "not tried: a faster one gets through".to_owned(),
        };
        let time = if it.passes {
            format!("{:.1}", it.time_s)
        } else {
            "–".to_owned()
        };
        writeln!(
            out,
            "  {:<18}{time:>8}{:>9.1}{:>8.1}{:>8.1}  {:<15}{:>8.0}  {corners}",
            it.gait,
            it.mm_per_cycle,
            it.mm_per_s,
            it.open_top_mm,
            it.verdict.as_deref().unwrap_or("unknown"),
            it.head_n
        )?;
    }
    Ok(())
}
