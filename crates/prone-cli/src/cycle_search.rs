//! Searches of whole cycles: `prone crawl frontier`, and `prone optimize --source cycle`.

use std::io::Write;

use anyhow::anyhow;

use prone::motor::HEAD_CARRIES;
use prone_files::robot_folder::RobotFiles;
use prone_record::experiment::{
    CycleRulesChoice, CycleSearchExperiment, Experiment, GaitText, LeastVerdict, NamedGait,
    RobotText, Runs, Under,
};
use prone_record::frontier::{CycleObjective, Frontier, Quantity, SettingKind};
use prone_record::measure::broken_sentence;

use crate::Failure;
use crate::args::cycle_rules::{CycleRulesArgs, VerdictName};
use crate::args::optimize::{OptimizeArgs, SolverName};
use crate::args::passage::{AgainstName, FrontierArgs};
use crate::args::pull_terms::{ObjectiveName, PullTermsArgs};
use crate::cells::number;
use crate::gait::find_cycle;
use crate::outputs::{Files, Kind};
use crate::plan::{self, OnContact, Plan, Work};

/// Ceilings, mm, where none are asked for.
const CEILINGS_MM: [f64; 3] = [165.0, 183.0, 200.0];
/// Distance kept from them, mm, where none is asked for.
const MARGIN_MM: f64 = 1.0;

/// `prone crawl frontier`.
pub(crate) fn frontier(args: &FrontierArgs) -> Result<Plan, Failure> {
    let files = crate::robot::files(args.robot.name())?;
    let (held, searched) = quantities(args);
    let experiment = CycleSearchExperiment {
        objective: searched.objective(),
        steerable: args.steerable,
        ideal: args.ideal,
        reach: args.reach,
        under: Under::Across {
            held,
            at: values(args, held)?,
            margin_mm: args.margin_mm.unwrap_or(MARGIN_MM),
        },
        runs: Runs {
            seed: args.seed,
            runs: args.runs,
            budget: args.budget,
        },
        time_budget_s: args.time_budget,
        ..asked(&files, &args.from)?
    };
    let read = read(&files, &args.from, None)?;
    Ok(Plan {
        work: Work::Study(Experiment::CycleSearch(Box::new(experiment))),
        files: read.writing("--out", &args.out, Kind::Folder),
        opening: plan::searching(args.resume),
        threads: args.threads,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

/// What is held, and what is searched.
const fn quantities(args: &FrontierArgs) -> (Quantity, Quantity) {
    match args.against {
        Some(AgainstName::Advance) => (Quantity::Ceiling, Quantity::Advance),
        Some(AgainstName::Heat) => (Quantity::Ceiling, Quantity::Heat),
        None => args.of,
    }
}

/// Where it is held.
fn values(args: &FrontierArgs, held: Quantity) -> Result<Vec<f64>, Failure> {
    if held == Quantity::Ceiling {
        return Ok(match (&*args.ceilings_mm, &*args.at) {
            ([], []) => CEILINGS_MM.to_vec(),
            ([], at) => at.to_vec(),
            (ceilings, _) => ceilings.to_vec(),
        });
    }
    let name = held.name();
    Failure::if_given(
        &[
            ("--ceilings-mm", !args.ceilings_mm.is_empty()),
            ("--margin-mm", args.margin_mm.is_some()),
        ],
        &format!("goes with --of ceiling,… only: here the {name} is held"),
    )?;
    if args.at.is_empty() {
        return Err(Failure::Input(anyhow!(
            "--of {name},… needs --at, a list of values in {}",
            held.unit()
        )));
    }
    let (least, most) = held.bounds();
    let outside = |value: &&f64| !(least..=most).contains(*value);
    match args.at.iter().find(outside) {
        Some(value) => Err(Failure::Input(anyhow!(
            "--at {value} is outside {least} to {most} {}",
            held.unit()
        ))),
        None => Ok(args.at.clone()),
    }
}

/// `prone optimize --source cycle`.
pub(crate) fn experiment(args: &OptimizeArgs) -> Result<(CycleSearchExperiment, Files), Failure> {
    refuse_options_of_pulls(&args.terms)?;
    refuse_options_of_searches_of_pulls(args)?;
    let files = crate::robot::files(args.terms.robot.name())?;
    let experiment = CycleSearchExperiment {
        objective: objective(&args.terms)?,
        steerable: args.cycle.steerable,
        ideal: args.cycle.ideal,
        reach: args.reach.unwrap_or(1.0),
        under: Under::One {
            rules: Box::new(rules(&args.cycle)),
            worst_over: worst_over(&args.cycle, &files)?,
            name: args.name.clone(),
        },
        runs: Runs {
            seed: args.seed,
            runs: args.runs,
            budget: args.budget.unwrap_or(CycleSearchExperiment::BUDGET),
        },
        time_budget_s: args.time_budget,
        ..asked(&files, args.terms.from.as_slice())?
    };
    let worst_over = args.cycle.worst_over.as_ref();
    let read = read(&files, args.terms.from.as_slice(), worst_over)?;
    Ok((experiment, read))
}

/// The files that a search about cycles reads.
fn read(
    files: &RobotFiles,
    from: &[String],
    worst_over: Option<&String>,
) -> Result<Files, Failure> {
    let defaults = files.defaults().map_err(Failure::input)?.cycle;
    let usual = defaults.from.iter().chain(&defaults.compared);
    let all = usual.chain(from).chain(worst_over);
    Ok(Files::of_robot(files).reading_gaits(&files.gaits, all))
}

/// What is minimised of cycles.
pub(crate) fn objective(terms: &PullTermsArgs) -> Result<CycleObjective, Failure> {
    match terms.objective {
        ObjectiveName::Heat => Ok(CycleObjective::Heat),
        ObjectiveName::HeatRate => Ok(CycleObjective::HeatRate),
        ObjectiveName::Advance => Ok(CycleObjective::Advance),
        ObjectiveName::Speed => Ok(CycleObjective::Speed),
        ObjectiveName::Peak => Ok(CycleObjective::Peak),
        ObjectiveName::Duty => Ok(CycleObjective::Duty),
        ObjectiveName::Height => Ok(CycleObjective::Height),
        ObjectiveName::Published | ObjectiveName::Torque => Err(Failure::Input(anyhow!(
            "a cycle has --objective {}",
            CycleObjective::ALL.map(CycleObjective::name).join(", ")
        ))),
    }
}

/// The rules that were typed.
pub(crate) fn rules(args: &CycleRulesArgs) -> CycleRulesChoice {
    CycleRulesChoice {
        ceiling_mm: args.ceiling_mm,
        least_advance_mm: args.least_advance_mm,
        demanded_shoulder_nm: args.demanded_shoulder_nm,
        body_share_percent: args.body_share_percent,
        most_heat: args.most_heat,
        most_head_n: Some(args.most_head_n.unwrap_or(HEAD_CARRIES)),
        least_speed_mm_s: args.least_speed_mm_s,
        most_duty: args.most_duty,
        most_drift_mm: args.most_drift_mm,
        verdict: args.verdict.map(|verdict| match verdict {
            VerdictName::Continuous => LeastVerdict::Continuous,
            VerdictName::Limited => LeastVerdict::Limited,
        }),
    }
}

/// The cycle over whose heats others are.
pub(crate) fn worst_over(
    args: &CycleRulesArgs,
    files: &RobotFiles,
) -> Result<Option<NamedGait>, Failure> {
    let name = args.worst_over.as_ref();
    name.map(|name| named(files, name)).transpose()
}

/// A search about cycles, those of the robot's `[defaults]` where none are named.
fn asked(files: &RobotFiles, from: &[String]) -> Result<CycleSearchExperiment, Failure> {
    let defaults = files.defaults().map_err(Failure::input)?.cycle;
    let from = if from.is_empty() {
        &defaults.from
    } else {
        from
    };
    let from = from.iter().map(|name| named(files, name));
    let compared = defaults.compared.iter().map(|name| text(files, name));
    Ok(CycleSearchExperiment {
        robot: RobotText::from_files(files),
        objective: CycleObjective::Advance,
        steerable: false,
        ideal: false,
        reach: 1.0,
        under: Under::Across {
            held: Quantity::Ceiling,
            at: Vec::new(),
            margin_mm: 0.0,
        },
        from: from.collect::<Result<_, _>>()?,
        compared: compared.collect::<Result<_, _>>()?,
        runs: Runs {
            seed: 0,
            runs: 1,
            budget: CycleSearchExperiment::BUDGET,
        },
        time_budget_s: None,
    })
}

fn named(files: &RobotFiles, name: &str) -> Result<NamedGait, Failure> {
    Ok(NamedGait {
        called: name.to_owned(),
        gait: text(files, name)?,
    })
}

/// The text of a cycle.
pub(crate) fn text(files: &RobotFiles, name: &str) -> Result<GaitText, Failure> {
    let source = find_cycle(&files.gaits, name)?;
    Ok(GaitText::new(&source.file, &source.text))
}

/// Options that say how pulls are costed are refused: the cost of a cycle has no use for them.
pub(crate) fn refuse_options_of_pulls(terms: &PullTermsArgs) -> Result<(), Failure> {
    let given = [
        ("--weights", terms.weights.is_some()),
        ("--per", terms.per.is_some()),
        ("--duration", terms.duration.is_some()),
        ("--rate-deg-per-phase", terms.rate_deg_per_phase.is_some()),
        ("--clearance", terms.clearance.is_some()),
        ("--limits", terms.limits.is_some()),
        ("--body-share-of", terms.body_share_of.is_some()),
        ("--hip-threshold-mm", terms.hip_threshold_mm.is_some()),
        ("--limit-tolerance-rad", terms.limit_tolerance_rad.is_some()),
    ];
    Failure::if_given(
        &given,
        "says how pulls are costed, and does not go with whole cycles",
    )
}

/// The same of options that say how pulls are searched.
fn refuse_options_of_searches_of_pulls(args: &OptimizeArgs) -> Result<(), Failure> {
    let given = [
        ("--gait-form", args.gait_form.is_some()),
        ("--ends", args.ends.is_some()),
        ("--confirm-durations", args.confirm_durations.is_some()),
    ];
    let reason = "says how pulls are searched, and does not go with --source cycle";
    Failure::if_given(&given, reason)?;
    let other = !matches!(args.solver, None | Some(SolverName::CmaEs));
    let reason = "names a solver of pulls: with --source cycle it is cma-es, which begins about the cycle of --from";
    Failure::if_given(&[("--solver", other)], reason)
}

/// What was found at each value of what is held, and the best of it.
pub(crate) fn print(frontier: &Frontier, out: &mut dyn Write) -> std::io::Result<()> {
    let held = frontier.held;
    writeln!(
        out,
        "{:>16}{:>6}{:>14}{:>9}{:>10}{:>12}{:>12}{:>7}{:>9}  standing",
        held.name(),
        "seed",
        "mm per cycle",
        "mm/s",
        "top mm",
        "heat s/m",
        "stiff s/m",
        "duty",
        "breaks"
    )?;
    let rows = frontier.found.iter().map(|found| {
        let at = found
            .at
            .map_or_else(|| "–".to_owned(), |at| format!("{at} {}", held.unit()));
        let standing = found.standing(held).name();
        let violation = Some(found.violation);
        (
            at,
            found.seed.to_string(),
            &found.confirmed,
            violation,
            standing,
        )
    });
    let compared = frontier.compared.iter();
    let others = compared.map(|other| {
        let standing = if other.confirmed.holds {
            "robust"
        } else {
            "not robust"
        };
        (
            other.gait.clone(),
            String::new(),
            &other.confirmed,
            None,
            standing,
        )
    });
    for (name, seed, confirmed, violation, standing) in rows.chain(others) {
        let first = confirmed.settings.first();
        let stiff = confirmed
            .settings
            .iter()
            .find(|row| row.setting == SettingKind::StiffServos);
        writeln!(
            out,
            "{name:>16}{seed:>6}{:>14}{:>9}{:>10}{:>12}{:>12}{:>7}{:>9}  {standing}",
            number(first.and_then(|row| row.mm_per_cycle), 1),
            number(first.and_then(|row| row.mm_per_s), 1),
            number(first.and_then(|row| row.top_mm), 1),
            number(first.and_then(|row| row.heat_per_metre_s), 1),
            number(stiff.and_then(|row| row.heat_per_metre_s), 1),
            number(first.and_then(|row| row.duty), 2),
            number(violation, 4),
        )?;
    }
    print_best(frontier, out)
}

/// The best at each value, in the unit of what was searched, with the rules that it breaks.
fn print_best(frontier: &Frontier, out: &mut dyn Write) -> std::io::Result<()> {
    let measure = frontier.measure();
    let mut values: Vec<Option<f64>> = frontier.found.iter().map(|found| found.at).collect();
    values.dedup();
    writeln!(out)?;
    for at in values {
        let Some(best) = frontier.best_at(at) else {
            continue;
        };
        let value = best
            .value
            .map_or_else(|| "unknown".to_owned(), |it| measure.sentence(it));
        let place = at.map_or_else(String::new, |at| format!(" {}", frontier.held.held_at(at)));
        let broken = broken_sentence(best.violation, &best.broken);
        let broken = broken.map_or_else(String::new, |it| format!(", {it}"));
        let (standing, seed) = (best.standing(frontier.held).name(), best.seed);
        writeln!(
            out,
            "best{place}: {value}{broken} ({standing}, seed {seed})"
        )?;
    }
    if !frontier.complete {
        writeln!(out, "stopped by the time budget; --resume goes on")?;
    }
    Ok(())
}
