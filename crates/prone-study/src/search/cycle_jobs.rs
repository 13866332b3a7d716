//! What is searched at each value of what is held, a ceiling in most cases: the cycle that is searched
//! about, the rules, the plan.

mod error;
mod rules;

pub use error::CycleSearchError;
pub use rules::{asked_rules, check_rules, usual_rules};

use std::sync::Arc;

use prone::gait::cycle::Cycle;
use prone::regime::Regime;
use prone::robot::Robot;
use prone_files::cycle_file;
use prone_files::plain_name;
use prone_record::experiment::{
    CycleRulesChoice, CycleSearchExperiment, Limit, NamedGait, PullSearchExperiment, Under,
    check_heights,
};
use prone_record::frontier::{CycleObjective, Quantity};
use prone_record::measure::Heats;
use prone_record::program::{Program, RobotInfo};
use prone_record::search::Solver;
use prone_record::search_plan::{CyclePlan, OnePlan, SearchHead, UnderPlan};
use prone_sim::LoadedRobot;
use prone_sim::crawl::CrawlError;

use super::cycle_cost::{CycleAim, CycleSearch, Merge};
use super::cycle_form::Free;
use super::room::{NoRoom, too_low};
use super::run::Job;
use super::setting::Setting;
use super::settings::{self, SettingError};
use super::trial::{Trial, try_out_unless};
use crate::watch::Watch;
use rules::held_rules;

/// One search a ceiling, each with the cycle that is searched about.
pub fn jobs(
    experiment: &CycleSearchExperiment,
    robot: &LoadedRobot,
    watch: &dyn Watch,
) -> Result<Vec<(Job<CycleSearch>, Cycle)>, CycleSearchError> {
    let objective = experiment.objective;
    let from = experiment.from.iter();
    let from = from.map(|it| it.gait.parse(cycle_file::parse));
    let from: Vec<Cycle> = from.collect::<Result<_, _>>()?;
    let points = points(&experiment.under);
    check(experiment, &points, robot.robot())?;
    let held = held(&experiment.under);
    let scope = Scope {
        objective,
        held: Some(held),
        steerable: experiment.steerable,
        ideal: experiment.ideal,
    };
    let searched = searched(scope, robot)?;
    let free = Free {
        reach: experiment.reach,
        turns: experiment.steerable,
    };
    let (merge, asked) = match &experiment.under {
        Under::Across { .. } => (Merge::Mean, CycleRulesChoice::default()),
        Under::One {
            rules, worst_over, ..
        } => (merge(worst_over.as_ref(), &searched)?, **rules),
    };
    let tried = tried(robot, &searched[0], &from, watch)?;
    let job = |Point { at, height }| {
        if watch.stop() {
            return Err(CycleSearchError::Stopped);
        }
        // A search for the lowest cycle begins at the lowest one.
        let base = match objective {
            CycleObjective::Height => below(&tried, 0.0),
            _ => below(&tried, height),
        };
        let usual = usual_rules(objective, height, base, robot.robot());
        let aim = CycleAim {
            objective,
            merge: merge.clone(),
            rules: held_rules(held, at, asked_rules(&asked, usual)),
        };
        let job = Job {
            at,
            base: base.name.clone(),
            candidates: CycleSearch::new(robot.robot(), &searched, aim, base, free)?,
        };
        Ok((job, base.clone()))
    };
    points.into_iter().map(job).collect()
}

/// Settings in which cycles are searched for an objective, with those that show what is held and whether
/// a cycle can be steered.
pub fn searched(scope: Scope, robot: &LoadedRobot) -> Result<Arc<[Setting]>, SettingError> {
    let objective = scope.objective;
    let mut searched = settings::for_search(objective, robot)?;
    let with_stiff = matches!(objective, CycleObjective::Heat | CycleObjective::Peak);
    if scope.held == Some(Quantity::Heat) && !with_stiff {
        searched.extend(settings::for_held_heat(robot)?);
    }
    if scope.steerable {
        searched.extend(settings::for_steering(robot)?);
    }
    if !scope.ideal {
        searched.extend(settings::searched_corners(robot)?);
    }
    Ok(searched.into())
}

/// What a search looks at.
#[derive(Debug, Clone, Copy)]
pub struct Scope {
    /// What is minimised.
    pub objective: CycleObjective,
    /// What is held, of a frontier.
    pub held: Option<Quantity>,
    /// Whether only cycles that can be steered count.
    pub steerable: bool,
    /// Whether the corners are left out.
    pub ideal: bool,
}

/// What is held.
pub const fn held(under: &Under) -> Quantity {
    match under {
        Under::Across { held, .. } => *held,
        Under::One { .. } => Quantity::Ceiling,
    }
}

/// What the heats of a search are.
pub const fn heats(under: &Under) -> Heats {
    match under {
        Under::One {
            worst_over: Some(_),
            ..
        } => Heats::OverAnother,
        Under::Across { .. } | Under::One { .. } => Heats::PerMetre,
    }
}

/// What `run.json` says of a search.
pub fn plan(
    experiment: &CycleSearchExperiment,
    robot: &LoadedRobot,
    jobs: &[(Job<CycleSearch>, Cycle)],
    program: &Program,
) -> CyclePlan {
    let command = match &experiment.under {
        Under::Across { .. } => "crawl frontier",
        Under::One { .. } => "optimize",
    };
    let engine = prone_sim::engine_version();
    let solver = Solver::AboutTheMiddle;
    let mut head = SearchHead::new(program, command, engine, solver, experiment.runs);
    if let Under::One {
        worst_over: Some(other),
        ..
    } = &experiment.under
    {
        head.add_base(&other.called, &other.gait.text);
    }
    for (_, base) in jobs {
        head.add_base(&base.name, &cycle_file::write(base, ""));
    }
    CyclePlan {
        head,
        objective: experiment.objective,
        steerable: experiment.steerable,
        ideal: experiment.ideal,
        reach: experiment.reach,
        under: under_plan(experiment, jobs.first().map(|(job, _)| job)),
        bases: jobs.iter().map(|(job, _)| job.base.clone()).collect(),
        regime: Regime::LOCOMOTION.name.to_owned(),
        robot: RobotInfo::of(robot.robot(), robot.files()),
    }
}

/// Where something is held, in its unit, if it is; and the height below which everything stays, m.
#[derive(Debug, Clone, Copy)]
struct Point {
    at: Option<f64>,
    height: f64,
}

fn points(under: &Under) -> Vec<Point> {
    match under {
        Under::Across {
            held,
            at,
            margin_mm,
        } => {
            let point = |&at: &f64| Point {
                at: Some(at),
                height: match held {
                    Quantity::Ceiling => (at - margin_mm) * 1e-3,
                    _ => f64::INFINITY,
                },
            };
            at.iter().map(point).collect()
        }
        Under::One { rules, .. } => vec![Point {
            at: rules.ceiling_mm,
            height: rules.ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3),
        }],
    }
}

/// What can be said of a search before anything is crawled.
fn check(
    experiment: &CycleSearchExperiment,
    points: &[Point],
    robot: &Robot,
) -> Result<(), CycleSearchError> {
    experiment.runs.check()?;
    let (reach, bounds) = (experiment.reach, CycleSearchExperiment::REACH);
    Limit::check("a reach", "", reach, bounds)?;
    if let Some(seconds) = experiment.time_budget_s {
        let bounds = (0.0, PullSearchExperiment::LONGEST_S);
        Limit::check("a time budget", " s", seconds, bounds)?;
    }
    match &experiment.under {
        Under::Across {
            held,
            at,
            margin_mm,
        } => {
            let held = *held;
            if Quantity::of_objective(experiment.objective) == Some(held) {
                return Err(CycleSearchError::Same { quantity: held });
            }
            for (index, &value) in at.iter().enumerate() {
                let same = |other: &f64| other.total_cmp(&value).is_eq();
                if at[..index].iter().any(same) {
                    return Err(CycleSearchError::Twice { held, value });
                }
                if held == Quantity::Ceiling {
                    check_heights(value, *margin_mm)?;
                    NoRoom::check(value, *margin_mm)?;
                } else {
                    Limit::check(held.held_axis(), "", value, held.bounds())?;
                }
            }
        }
        Under::One {
            rules,
            worst_over,
            name,
        } => {
            name.as_deref().map_or(Ok(()), plain_name::check_gait)?;
            check_rules(experiment.objective, rules, worst_over.as_ref())?;
            if experiment.ideal && rules.most_drift_mm.is_some() {
                return Err(CycleSearchError::DriftUnused);
            }
        }
    }
    for point in points {
        // What else is held is no height.
        let ceiling_mm = point.at.filter(|_| point.height.is_finite());
        let reason = ceiling_mm.and_then(|mm| too_low(robot, mm * 1e-3));
        if let (Some(ceiling_mm), Some(reason)) = (ceiling_mm, reason) {
            return Err(CycleSearchError::TooLow {
                ceiling_mm,
                robot: robot.name.clone(),
                reason,
            });
        }
    }
    Ok(())
}

/// How the heats of several settings become one: the worst over those of another cycle, where one is
/// named.
///
/// # Errors
/// [`CycleSearchError`] where that cycle cannot be read or crawled.
pub fn merge(
    worst_over: Option<&NamedGait>,
    searched: &[Setting],
) -> Result<Merge, CycleSearchError> {
    let Some(named) = worst_over else {
        return Ok(Merge::Mean);
    };
    let merge = Merge::worst_over(searched, &named.gait.parse(cycle_file::parse)?);
    merge.map_err(|source| CycleSearchError::WorstOver {
        gait: named.called.clone(),
        source,
    })
}

fn under_plan(experiment: &CycleSearchExperiment, job: Option<&Job<CycleSearch>>) -> UnderPlan {
    match &experiment.under {
        Under::Across {
            held,
            at,
            margin_mm,
        } => UnderPlan::Frontier {
            held: *held,
            at: at.clone(),
            margin_mm: *margin_mm,
            from: experiment.from.iter().map(|it| it.called.clone()).collect(),
        },
        Under::One {
            rules,
            worst_over,
            name,
        } => {
            let advance = job.map(|job| job.candidates.rules().advance * 1e3);
            UnderPlan::One(Box::new(OnePlan {
                source: "cycle".to_owned(),
                rules: CycleRulesChoice {
                    least_advance_mm: advance,
                    ..**rules
                },
                worst_over: worst_over.as_ref().map(|it| it.called.clone()),
                from: job.map_or_else(String::new, |job| job.base.clone()),
                name: name.clone(),
            }))
        }
    }
}

/// The base of a search under a height, m: of the cycles that stay below it, the one that advances
/// most in the first of the settings; where none does, the lowest.
///
/// # Errors
/// [`CycleSearchError::NoCycle`], [`CycleSearchError::Stopped`].
pub fn base<'c>(
    robot: &LoadedRobot,
    setting: &Setting,
    cycles: &'c [Cycle],
    height: f64,
    watch: &dyn Watch,
) -> Result<&'c Cycle, CycleSearchError> {
    Ok(below(&tried(robot, setting, cycles, watch)?, height))
}

/// Cycles with what they do in a setting; those that cannot be crawled are left out.
///
/// # Errors
/// [`CycleSearchError::NoCycle`] where none is left, [`CycleSearchError::Stopped`].
fn tried<'c>(
    robot: &LoadedRobot,
    setting: &Setting,
    cycles: &'c [Cycle],
    watch: &dyn Watch,
) -> Result<Vec<(&'c Cycle, Trial)>, CycleSearchError> {
    let stopped = || watch.stop();
    let mut tried: Vec<(&Cycle, Trial)> = Vec::with_capacity(cycles.len());
    let mut refused = Vec::new();
    for cycle in cycles {
        match try_out_unless(&stopped, setting, cycle) {
            Ok(trial) => tried.push((cycle, trial)),
            Err(CrawlError::Stopped) => return Err(CycleSearchError::Stopped),
            Err(error) => refused.push((cycle.name.clone(), error)),
        }
    }
    if tried.is_empty() {
        return Err(CycleSearchError::NoCycle {
            robot: robot.robot().name.clone(),
            refused,
        });
    }
    Ok(tried)
}

/// Of cycles that were tried, at least one, the base of a search under a height, m.
fn below<'c>(tried: &[(&'c Cycle, Trial)], height: f64) -> &'c Cycle {
    let below = tried.iter().filter(|(_, trial)| trial.top.0 <= height);
    let farthest = below.max_by(|a, b| a.1.advance.total_cmp(&b.1.advance));
    let lowest = || tried.iter().min_by(|a, b| a.1.top.0.total_cmp(&b.1.top.0));
    let (cycle, _) = farthest.or_else(lowest).unwrap_or(&tried[0]);
    cycle
}
