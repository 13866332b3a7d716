//! Searches of whole cycles: `prone crawl frontier`, and `prone optimize --source cycle`.

use std::io::Write;

use anyhow::anyhow;

use prone::motor::HEAD_CARRIES;
use prone_files::robot_folder::RobotFiles;
use prone_record::experiment::{
    CycleRulesChoice, CycleSearchExperiment, Experiment, GaitText, NamedGait, RobotText, Runs,
    Under,
};
use prone_record::frontier::{CycleObjective, Frontier, SettingKind};

use crate::Failure;
use crate::args::optimize::{OptimizeArgs, SolverName};
use crate::args::passage::{AgainstName, FrontierArgs};
use crate::args::pull_terms::ObjectiveName;
use crate::gait::find_cycle;
use crate::plan::{self, OnContact, Plan, Work};

/// Most evaluations of a run of `prone optimize` where none are asked for.
const BUDGET: u64 = 1600;

/// `prone crawl frontier`.
pub(crate) fn frontier(args: &FrontierArgs) -> Result<Plan, Failure> {
    let files = crate::robot::files(args.robot.name())?;
    let experiment = CycleSearchExperiment {
        objective: match args.against {
            AgainstName::Advance => CycleObjective::Advance,
            AgainstName::Heat => CycleObjective::Heat,
        },
        steerable: args.steerable,
        under: Under::Ceilings {
            ceilings_mm: args.ceilings_mm.clone(),
            margin_mm: args.margin_mm,
        },
        runs: Runs {
            seed: args.seed,
            runs: args.runs,
            budget: args.budget,
        },
        ..asked(&files, &args.from)?
    };
    Ok(Plan {
        work: Work::Study(Experiment::CycleSearch(Box::new(experiment))),
        out: Some(args.out.clone()),
        opening: plan::searching(args.resume),
        threads: args.threads,
        json: args.json,
        on_contact: OnContact::Report,
    })
}

/// `prone optimize --source cycle`.
pub(crate) fn experiment(args: &OptimizeArgs) -> Result<CycleSearchExperiment, Failure> {
    refuse_options_of_pulls(args)?;
    let objective = match args.terms.objective {
        ObjectiveName::Heat => CycleObjective::Heat,
        ObjectiveName::Advance => CycleObjective::Advance,
        ObjectiveName::Speed => CycleObjective::Speed,
        ObjectiveName::Peak => CycleObjective::Peak,
        ObjectiveName::Published | ObjectiveName::Torque => {
            return Err(Failure::Input(anyhow!(
                "--source cycle searches --objective heat, peak, advance or speed"
            )));
        }
    };
    let files = crate::robot::files(args.terms.robot.name())?;
    let worst_over = args.worst_over.as_ref();
    Ok(CycleSearchExperiment {
        objective,
        steerable: args.steerable,
        under: Under::One {
            rules: CycleRulesChoice {
                ceiling_mm: args.ceiling_mm,
                least_advance_mm: args.least_advance_mm,
                demanded_shoulder_nm: args.demanded_shoulder_nm,
                body_share_percent: args.body_share_percent,
                most_heat: args.most_heat,
                most_head_n: Some(args.most_head_n.unwrap_or(HEAD_CARRIES)),
            },
            worst_over: worst_over.map(|name| named(&files, name)).transpose()?,
            name: args.name.clone(),
        },
        runs: Runs {
            seed: args.seed,
            runs: args.runs,
            budget: args.budget.unwrap_or(BUDGET),
        },
        ..asked(&files, args.terms.from.as_slice())?
    })
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
        under: Under::Ceilings {
            ceilings_mm: Vec::new(),
            margin_mm: 0.0,
        },
        from: from.collect::<Result<_, _>>()?,
        compared: compared.collect::<Result<_, _>>()?,
        runs: Runs {
            seed: 0,
            runs: 1,
            budget: BUDGET,
        },
    })
}

fn named(files: &RobotFiles, name: &str) -> Result<NamedGait, Failure> {
    Ok(NamedGait {
        called: name.to_owned(),
        gait: text(files, name)?,
    })
}

fn text(files: &RobotFiles, name: &str) -> Result<GaitText, Failure> {
    let source = find_cycle(&files.gaits, name)?;
    Ok(GaitText::new(&source.file, &source.text))
}

/// Options that say how pulls are costed are refused: the cost of a cycle has no use for them.
fn refuse_options_of_pulls(args: &OptimizeArgs) -> Result<(), Failure> {
    let terms = &args.terms;
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
        ("--time-budget", args.time_budget.is_some()),
        (
            "--solver",
            !matches!(args.solver, None | Some(SolverName::CmaEs)),
        ),
        ("--gait-form", args.gait_form.is_some()),
        ("--ends", args.ends.is_some()),
        ("--confirm-durations", args.confirm_durations.is_some()),
    ];
    let reason = "does not go with --source cycle, which searches whole cycles by CMA-ES";
    Failure::if_given(&given, reason)
}

/// What was found, under each ceiling.
pub(crate) fn print(frontier: &Frontier, out: &mut dyn Write) -> std::io::Result<()> {
    writeln!(
        out,
        "{:>10}{:>6}{:>14}{:>9}{:>10}{:>12}{:>12}{:>11}  holds",
        "ceiling", "seed", "mm per cycle", "mm/s", "top mm", "heat s/m", "stiff s/m", "violation"
    )?;
    let number = |value: Option<f64>, decimals: usize| {
        value.map_or_else(|| "–".to_owned(), |value| format!("{value:.decimals$}"))
    };
    let rows = frontier.found.iter().map(|found| {
        let ceiling = found
            .ceiling_mm
            .map_or_else(|| "–".to_owned(), |mm| format!("{mm} mm"));
        (
            ceiling,
            found.seed.to_string(),
            &found.confirmed,
            Some(found.violation),
        )
    });
    let compared = frontier.compared.iter();
    let others = compared.map(|other| (other.gait.clone(), String::new(), &other.confirmed, None));
    for (name, seed, confirmed, violation) in rows.chain(others) {
        let first = confirmed.settings.first();
        let stiff = confirmed
            .settings
            .iter()
            .find(|row| row.setting == SettingKind::StiffServos);
        writeln!(
            out,
            "{name:>10}{seed:>6}{:>14}{:>9}{:>10}{:>12}{:>12}{:>11}  {}",
            number(first.and_then(|row| row.mm_per_cycle), 1),
            number(first.and_then(|row| row.mm_per_s), 1),
            number(first.and_then(|row| row.top_mm), 1),
            number(first.and_then(|row| row.heat_per_metre_s), 1),
            number(stiff.and_then(|row| row.heat_per_metre_s), 1),
            number(violation, 4),
            if confirmed.holds { "yes" } else { "no" }
        )?;
    }
    Ok(())
}
