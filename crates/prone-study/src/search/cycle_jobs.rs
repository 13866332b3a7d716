//! What is searched under each ceiling: the cycle that is searched about, the rules, the plan.

use std::sync::Arc;

use prone::gait::cycle::{Cycle, TimeScale};
use prone::motor::Duty;
use prone::regime::Regime;
use prone::robot::Robot;
use prone_files::cycle_file;
use prone_files::plain_name::{self, GaitNameError};
use prone_record::experiment::{
    CycleRulesChoice, CycleSearchExperiment, LeastDuty, Limit, NamedGait, TextError, Under,
    check_heights,
};
use prone_record::frontier::CycleObjective;
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
    /// A ceiling stands twice in the list.
    #[error("{mm} mm is there twice")]
    CeilingTwice {
        /// The ceiling, mm.
        mm: f64,
    },
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
    let ceilings = ceilings(&experiment.under);
    check(experiment, &ceilings, robot.robot())?;
    let mut searched = settings::for_search(objective, robot)?;
    let (least, most) = CycleSearchExperiment::REACH;
    Limit::check("a reach", "", experiment.reach, (least, most))?;
    let free = Free {
        reach: experiment.reach,
        turns: experiment.steerable,
    };
    if experiment.steerable {
        searched.extend(settings::for_steering(robot)?);
    }
    if !experiment.ideal {
        searched.extend(settings::searched_corners(robot)?);
    }
    let searched: Arc<[Setting]> = searched.into();
    let (merge, asked) = match &experiment.under {
        Under::Ceilings { .. } => (Merge::Mean, CycleRulesChoice::default()),
        Under::One {
            rules, worst_over, ..
        } => (merge(worst_over.as_ref(), &searched)?, *rules),
    };
    let job = |Ceiling { mm, height }| {
        if watch.stop() {
            return Err(CycleSearchError::Stopped);
        }
        let base = base(robot, &searched[0], &from, height)?;
        let aim = CycleAim {
            objective,
            merge: merge.clone(),
            rules: asked_rules(&asked, usual_rules(objective, height, base, robot.robot())),
        };
        let job = Job {
            ceiling_mm: mm,
            base: base.name.clone(),
            candidates: CycleSearch::new(robot.robot(), &searched, aim, base, free)?,
        };
        Ok((job, base.clone()))
    };
    ceilings.into_iter().map(job).collect()
}

/// What `run.json` says of a search.
pub fn plan(
    experiment: &CycleSearchExperiment,
    robot: &LoadedRobot,
    jobs: &[(Job<CycleSearch>, Cycle)],
    program: &Program,
) -> CyclePlan {
    let command = match &experiment.under {
        Under::Ceilings { .. } => "crawl frontier",
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

/// A ceiling, mm, where there is one, and the height below which everything stays, m.
#[derive(Debug, Clone, Copy)]
struct Ceiling {
    mm: Option<f64>,
    height: f64,
}

fn ceilings(under: &Under) -> Vec<Ceiling> {
    match under {
        Under::Ceilings {
            ceilings_mm,
            margin_mm,
        } => {
            let ceiling = |&mm: &f64| Ceiling {
                mm: Some(mm),
                height: (mm - margin_mm) * 1e-3,
            };
            ceilings_mm.iter().map(ceiling).collect()
        }
        Under::One { rules, .. } => vec![Ceiling {
            mm: rules.ceiling_mm,
            height: rules.ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3),
        }],
    }
}

/// What can be said of a search before anything is crawled.
fn check(
    experiment: &CycleSearchExperiment,
    ceilings: &[Ceiling],
    robot: &Robot,
) -> Result<(), CycleSearchError> {
    experiment.runs.check()?;
    match &experiment.under {
        Under::Ceilings {
            ceilings_mm,
            margin_mm,
        } => {
            for (index, mm) in ceilings_mm.iter().enumerate() {
                let same = |other: &f64| other.total_cmp(mm).is_eq();
                if ceilings_mm[..index].iter().any(same) {
                    return Err(CycleSearchError::CeilingTwice { mm: *mm });
                }
                check_heights(*mm, *margin_mm)?;
                NoRoom::check(*mm, *margin_mm)?;
            }
        }
        Under::One {
            rules,
            worst_over,
            name,
        } => {
            name.as_deref().map_or(Ok(()), plain_name::check_gait)?;
            rules.check()?;
            let objective = experiment.objective;
            let several = matches!(
                objective,
                CycleObjective::Heat | CycleObjective::HeatRate | CycleObjective::Peak
            );
            let heats = [
                ("worst_over", worst_over.is_some()),
                ("most_heat", rules.most_heat.is_some()),
            ];
            let unused = heats.iter().find(|(_, asked)| *asked && !several);
            if let Some((what, _)) = unused {
                return Err(CycleSearchError::HeatUnused { what });
            }
        }
    }
    for ceiling in ceilings {
        let reason = ceiling.mm.and_then(|mm| too_low(robot, mm * 1e-3));
        if let (Some(ceiling_mm), Some(reason)) = (ceiling.mm, reason) {
            return Err(CycleSearchError::TooLow {
                ceiling_mm,
                robot: robot.name.clone(),
                reason,
            });
        }
    }
    Ok(())
}

fn merge(worst_over: Option<&NamedGait>, searched: &[Setting]) -> Result<Merge, CycleSearchError> {
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
fn asked_rules(asked: &CycleRulesChoice, usual: CycleRules) -> CycleRules {
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
        duty: match asked.duty {
            None => usual.duty,
            Some(LeastDuty::Continuous) => Duty::Continuous,
            Some(LeastDuty::Limited) => Duty::Limited,
        },
        ..usual
    }
}

fn under_plan(experiment: &CycleSearchExperiment, job: Option<&Job<CycleSearch>>) -> UnderPlan {
    match &experiment.under {
        Under::Ceilings {
            ceilings_mm,
            margin_mm,
        } => UnderPlan::Frontier {
            ceilings_mm: ceilings_mm.clone(),
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
                    ..*rules
                },
                worst_over: worst_over.as_ref().map(|it| it.called.clone()),
                from: job.map_or_else(String::new, |job| job.base.clone()),
                name: name.clone(),
            }))
        }
    }
}

/// The usual rules of a search below a height, m: for heat and peak the robot's least advance, else
/// no slower than the cycle that it is searched about.
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
        CycleObjective::Heat | CycleObjective::HeatRate | CycleObjective::Peak => CycleRules {
            advance: robot.search.least_advance,
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
