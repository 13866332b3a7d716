//! What is searched at each value of what is held, a ceiling in most cases: the cycle that is searched
//! about, the rules, the plan.

use std::sync::Arc;

use prone::gait::cycle::{Cycle, TimeScale};
use prone::motor::Duty;
use prone::regime::Regime;
use prone::robot::Robot;
use prone_files::cycle_file;
use prone_files::plain_name::{self, GaitNameError};
use prone_record::experiment::{
    CycleRulesChoice, CycleSearchExperiment, LeastVerdict, Limit, NamedGait, PullSearchExperiment,
    TextError, Under, check_heights,
};
use prone_record::frontier::{CycleObjective, Quantity};
use prone_record::measure::Heats;
use prone_record::program::{Program, RobotInfo};
use prone_record::search::Solver;
use prone_record::search_plan::{CyclePlan, OnePlan, SearchHead, UnderPlan};
use prone_sim::LoadedRobot;
use prone_sim::crawl::CrawlError;

use super::cycle_cost::{CycleAim, CycleCostError, CycleSearch, Merge};
use super::cycle_form::Free;
use super::cycle_rules::CycleRules;
use super::room::{NoRoom, too_low};
use super::run::Job;
use super::setting::Setting;
use super::settings::{self, SettingError};
use super::trial::{Trial, try_out};
use crate::watch::Watch;

/// Why cycles cannot be searched.
#[derive(Debug, thiserror::Error)]
pub enum CycleSearchError {
    /// A number that no search can have.
    #[error(transparent)]
    Limit(#[from] Limit),
    /// A name that is none of a file.
    #[error(transparent)]
    Name(#[from] GaitNameError),
    /// A cycle cannot be read.
    #[error(transparent)]
    Text(#[from] TextError),
    /// A value stands twice in the list.
    #[error("{value} {} is there twice", held.unit())]
    Twice {
        /// What is held.
        held: Quantity,
        /// At which value, in its unit.
        value: f64,
    },
    /// A frontier is between two quantities.
    #[error("a frontier is between two quantities, not between {0} and {0}", quantity.name())]
    Same {
        /// The one that was given twice.
        quantity: Quantity,
    },
    /// The other cycle's heats would not be looked at.
    #[error("worst_over changes nothing of the objective peak without most_heat")]
    WorstOverUnused,
    /// The margin leaves nothing of a ceiling.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// No gait of the robot fits under a ceiling.
    #[error("{ceiling_mm} mm is too low for {robot}: {reason}")]
    TooLow {
        /// The ceiling, mm.
        ceiling_mm: f64,
        /// The robot's name.
        robot: String,
        /// What does not fit.
        reason: String,
    },
    /// Only the objectives of heat and peak look at heats with several servos.
    #[error("{what} goes with the objectives heat and peak only")]
    HeatUnused {
        /// `worst_over` or `most_heat`.
        what: &'static str,
    },
    /// [`Watch::stop`] said so.
    #[error("stopped")]
    Stopped,
    /// A setting cannot be made.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// Cycles have no costs.
    #[error(transparent)]
    Costs(#[from] CycleCostError),
    /// The cycle that heats are compared with cannot be crawled.
    #[error("{gait}: {source}")]
    WorstOver {
        /// As it was called.
        gait: String,
        /// Why.
        source: CrawlError,
    },
    /// No cycle to begin with.
    #[error(
        "there is no cycle that {robot} can crawl to begin with{}",
        listed(refused)
    )]
    NoCycle {
        /// The robot's name.
        robot: String,
        /// Names of the cycles that were tried, and why they cannot be crawled.
        refused: Vec<(String, CrawlError)>,
    },
}

/// One line a cycle.
fn listed(refused: &[(String, CrawlError)]) -> String {
    let lines = refused.iter();
    let lines: Vec<String> = lines
        .map(|(cycle, error)| format!("\n  {cycle}: {error}"))
        .collect();
    lines.concat()
}

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
    Limit::check(
        "a reach",
        "",
        experiment.reach,
        CycleSearchExperiment::REACH,
    )?;
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
    let job = |Point { at, height }| {
        if watch.stop() {
            return Err(CycleSearchError::Stopped);
        }
        // A search for the lowest cycle begins at the lowest one.
        let below = match objective {
            CycleObjective::Height => 0.0,
            _ => height,
        };
        let base = base(robot, &searched[0], &from, below)?;
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

/// Rules with a quantity held at a value, in its unit; a ceiling is the height of the rules already.
/// Where the speed is held, a cycle may be as short as it likes.
fn held_rules(held: Quantity, at: Option<f64>, rules: CycleRules) -> CycleRules {
    let Some(at) = at else {
        return rules;
    };
    match held {
        Quantity::Ceiling => rules,
        Quantity::Advance => CycleRules {
            advance: at * 1e-3,
            ..rules
        },
        Quantity::Speed => CycleRules {
            least_speed: at * 1e-3,
            advance: CycleRules::FREE.advance,
            ..rules
        },
        Quantity::Heat => CycleRules { heat: at, ..rules },
        Quantity::Duty => CycleRules {
            most_duty: at,
            ..rules
        },
    }
}

/// What can be said of a search before anything is crawled.
fn check(
    experiment: &CycleSearchExperiment,
    points: &[Point],
    robot: &Robot,
) -> Result<(), CycleSearchError> {
    experiment.runs.check()?;
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
            check_one(experiment.objective, rules, worst_over.as_ref())?;
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

/// Checks rules that were asked for: each is one, and counts.
pub fn check_one(
    objective: CycleObjective,
    rules: &CycleRulesChoice,
    worst_over: Option<&NamedGait>,
) -> Result<(), CycleSearchError> {
    rules.check()?;
    let several = matches!(objective, CycleObjective::Heat | CycleObjective::Peak);
    let heats = [
        ("worst_over", worst_over.is_some()),
        ("most_heat", rules.most_heat.is_some()),
    ];
    let unused = heats.iter().find(|(_, asked)| *asked && !several);
    if let Some((what, _)) = unused {
        return Err(CycleSearchError::HeatUnused { what });
    }
    let unread = objective == CycleObjective::Peak && rules.most_heat.is_none();
    if worst_over.is_some() && unread {
        return Err(CycleSearchError::WorstOverUnused);
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

/// The rules that were asked for, and the usual ones where none was.
pub fn asked_rules(asked: &CycleRulesChoice, usual: CycleRules) -> CycleRules {
    let millimetres = asked.least_advance_mm.map(|mm| mm * 1e-3);
    let share = asked.body_share_percent.map(|percent| percent / 100.0);
    let demanded = asked.demanded_shoulder_nm;
    CycleRules {
        advance: millimetres.unwrap_or(usual.advance),
        demanded_shoulder: demanded.unwrap_or(usual.demanded_shoulder),
        body_share: share.unwrap_or(usual.body_share),
        heat: asked.most_heat.unwrap_or(usual.heat),
        drift: asked.most_drift_mm.map_or(usual.drift, |mm| mm * 1e-3),
        head: asked.most_head_n.unwrap_or(usual.head),
        verdict: match asked.verdict {
            None => usual.verdict,
            Some(LeastVerdict::Continuous) => Duty::Continuous,
            Some(LeastVerdict::Limited) => Duty::Limited,
        },
        least_speed: asked
            .least_speed_mm_s
            .map_or(usual.least_speed, |it| it * 1e-3),
        most_duty: asked.most_duty.unwrap_or(usual.most_duty),
        ..usual
    }
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

/// The usual rules of a search below a height, m: for all but advance and speed the robot's least
/// advance; for advance, speed and duty a cycle no longer than the one that it is searched about, as
/// whoever takes more time advances farther, and with less torque.
pub fn usual_rules(
    objective: CycleObjective,
    height: f64,
    base: &Cycle,
    robot: &Robot,
) -> CycleRules {
    let free = CycleRules {
        ceiling: height,
        ..CycleRules::FREE
    };
    match objective {
        CycleObjective::Heat
        | CycleObjective::HeatRate
        | CycleObjective::Peak
        | CycleObjective::Height => CycleRules {
            advance: robot.search.least_advance,
            ..free
        },
        CycleObjective::Duty => CycleRules {
            advance: robot.search.least_advance,
            seconds: base.duration(TimeScale::ONE),
            ..free
        },
        CycleObjective::Advance | CycleObjective::Speed => CycleRules {
            seconds: base.duration(TimeScale::ONE),
            ..free
        },
    }
}

/// The base of a search under a height, m: of the cycles that stay below it, the one that advances
/// most in the first of the settings; where none does, the lowest.
///
/// # Errors
/// [`CycleSearchError::NoCycle`].
pub fn base<'c>(
    robot: &LoadedRobot,
    setting: &Setting,
    cycles: &'c [Cycle],
    height: f64,
) -> Result<&'c Cycle, CycleSearchError> {
    let mut tried: Vec<(&Cycle, Trial)> = Vec::with_capacity(cycles.len());
    let mut refused = Vec::new();
    for cycle in cycles {
        match try_out(setting, cycle) {
            Ok(trial) => tried.push((cycle, trial)),
            Err(error) => refused.push((cycle.name.clone(), error)),
        }
    }
    let below = tried.iter().filter(|(_, trial)| trial.top.0 <= height);
    let farthest = below.max_by(|a, b| a.1.advance.total_cmp(&b.1.advance));
    let lowest = || tried.iter().min_by(|a, b| a.1.top.0.total_cmp(&b.1.top.0));
    let chosen = farthest.or_else(lowest).map(|(cycle, _)| *cycle);
    chosen.ok_or_else(|| CycleSearchError::NoCycle {
        robot: robot.robot().name.clone(),
        refused,
    })
}
