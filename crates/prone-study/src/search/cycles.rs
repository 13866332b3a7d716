//! Searching whole cycles in the locomotion regime, under one ceiling or several.

use std::sync::Arc;

use prone::gait::cycle::{Cycle, TimeScale};
use prone::regime::Regime;
use prone::robot::Robot;
use prone_files::cycle_file;
use prone_record::experiment::{
    CycleRulesChoice, CycleSearchExperiment, NamedGait, TextError, Under,
};
use prone_record::frontier::{self, Compared, CycleObjective, Found, Frontier};
use prone_record::output::Artefacts;
use prone_record::program::{Program, RobotInfo};
use prone_record::search::{Search, SearchEnd, SeededRun, Solver};
use prone_record::search_plan::{CyclePlan, OnePlan, SearchHead, SearchPlan, UnderPlan};
use prone_record::search_result::SearchResult;
use prone_report::figures::frontier_figure;
use prone_sim::LoadedRobot;
use prone_sim::crawl::CrawlError;

use super::candidates::{Candidates as _, Depth};
use super::confirm;
use super::cycle_cost::{CycleAim, CycleCostError, CycleSearch, Merge};
use super::cycle_rules::CycleRules;
use super::room::{NoRoom, too_low};
use super::run::{Job, SearchError, SearchRun, draw};
use super::setting::Setting;
use super::settings::{self, SettingError};
use super::steering::check_steering;
use super::trial::{Trial, try_out};
use crate::watch::Watch;

/// Why cycles cannot be searched.
#[derive(Debug, thiserror::Error)]
pub enum CycleSearchError {
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

/// A search of cycles.
#[derive(Debug)]
pub struct CycleRun {
    plan: SearchPlan,
    objective: CycleObjective,
    margin_mm: f64,
    jobs: Vec<Job<CycleSearch>>,
    confirmation: Vec<Setting>,
    /// In which it shows whether a found cycle can be steered.
    steering: Vec<Setting>,
    /// What a found cycle is compared with.
    compared: Vec<Cycle>,
    /// Name of the found cycle; without one, by ceiling and seed.
    name: Option<String>,
}

impl CycleRun {
    /// Prepares a search: finds the cycle that is searched about under each ceiling.
    ///
    /// # Errors
    /// [`CycleSearchError`].
    pub fn new(
        experiment: &CycleSearchExperiment,
        robot: &LoadedRobot,
        program: &Program,
        watch: &dyn Watch,
    ) -> Result<Self, CycleSearchError> {
        let objective = experiment.objective;
        let from = experiment
            .from
            .iter()
            .map(|it| it.gait.parse(cycle_file::parse));
        let from: Vec<Cycle> = from.collect::<Result<_, _>>()?;
        let compared = experiment
            .compared
            .iter()
            .map(|it| it.parse(cycle_file::parse));
        let compared: Vec<Cycle> = compared.collect::<Result<_, _>>()?;
        let ceilings = ceilings(&experiment.under);
        check(experiment, &ceilings, robot.robot())?;
        let mut searched = settings::for_search(objective, robot)?;
        let mut confirmation = settings::for_confirmation_of(objective, robot)?;
        let steering = settings::for_steering_confirmation(robot)?;
        if experiment.steerable {
            searched.extend(settings::for_steering(robot)?);
            confirmation.extend(steering.iter().cloned());
        }
        let searched: Arc<[Setting]> = searched.into();
        let (merge, asked) = match &experiment.under {
            Under::Ceilings { .. } => (Merge::Mean, CycleRulesChoice::default()),
            Under::One {
                rules, worst_over, ..
            } => (merge(worst_over.as_ref(), &searched)?, *rules),
        };
        let (command, margin_mm) = match &experiment.under {
            Under::Ceilings { margin_mm, .. } => ("crawl frontier", *margin_mm),
            Under::One { .. } => ("optimize", 0.0),
        };
        let mut head = SearchHead::new(
            program,
            command,
            prone_sim::engine_version(),
            Solver::AboutTheMiddle,
            experiment.runs,
        );
        let mut jobs = Vec::with_capacity(ceilings.len());
        for Ceiling { mm, height } in ceilings {
            if watch.stop() {
                return Err(CycleSearchError::Stopped);
            }
            let base = base(robot, &searched[0], &from, height)?;
            let rules = usual_rules(objective, height, base, robot.robot());
            let aim = CycleAim {
                objective,
                merge: merge.clone(),
                rules: asked_rules(&asked, rules),
            };
            head.add_base(&base.pull.name, &cycle_file::write(base, ""));
            jobs.push(Job {
                ceiling_mm: mm,
                base: base.pull.name.clone(),
                candidates: CycleSearch::new(robot.robot(), &searched, aim, base)?,
            });
        }
        let name = match &experiment.under {
            Under::Ceilings { .. } => None,
            Under::One { name, .. } => {
                let usual = || format!("best-{}", objective.name());
                Some(name.clone().unwrap_or_else(usual))
            }
        };
        let plan = CyclePlan {
            head,
            objective,
            steerable: experiment.steerable,
            under: under_plan(experiment, &jobs),
            bases: jobs.iter().map(|job| job.base.clone()).collect(),
            regime: Regime::LOCOMOTION.name.to_owned(),
            robot: RobotInfo::of(robot.robot(), robot.files()),
        };
        Ok(Self {
            plan: SearchPlan::Cycle(Box::new(plan)),
            objective,
            margin_mm,
            jobs,
            confirmation,
            steering,
            compared,
            name,
        })
    }

    /// The best cycle of a run under its name, with what a record says of it.
    fn found(
        &self,
        job: &Job<CycleSearch>,
        run: &SeededRun,
    ) -> Result<Option<(Cycle, Found)>, SearchError> {
        let Some(best) = run.best() else {
            return Ok(None);
        };
        let mut cycle = job.candidates.gait(&best.point)?;
        let cost = job.candidates.cost(&cycle, Depth::Everything);
        let stem = match (&self.name, job.ceiling_mm) {
            (Some(name), _) => name.clone(),
            (None, Some(mm)) => format!("under-{}", mm.to_string().replace('.', "-")),
            (None, None) => "open".to_owned(),
        };
        cycle.pull.name = format!("{stem}-seed-{}", run.seed);
        let steering = match cycle.steering {
            None => Ok(()),
            Some(_) => check_steering(&self.steering, &cycle),
        };
        if steering.is_err() {
            cycle.steering = None;
        }
        let under = job
            .ceiling_mm
            .map_or_else(String::new, |mm| format!(" under {mm} mm"));
        cycle.pull.description = format!(
            "searched{under} about {} for {}, seed {}, {} evaluations",
            job.base,
            self.objective.name(),
            run.seed,
            run.evaluations()
        );
        let found = Found {
            ceiling_mm: job.ceiling_mm,
            seed: run.seed,
            evaluations: run.evaluations(),
            gait: cycle.pull.name.clone(),
            value: Some(cost.value).filter(|value| value.is_finite()),
            violation: cost.violation,
            broken: cost.broken,
            refused: cost.refusal.as_ref().map(ToString::to_string),
            unsteered: steering.err().map(|reason| reason.to_string()),
            confirmed: frontier::Confirmed::default(),
        };
        Ok(Some((cycle, found)))
    }

    fn header(&self, cycle: &Cycle, found: &Found) -> String {
        let head = self.plan.head();
        format!(
            "Found by prone {} ({}): {}.\nBreaks {:.4} of the rules of its search. Crawled in other settings:\n{}",
            head.version,
            head.commit,
            cycle.pull.description,
            found.violation,
            found.sentence()
        )
    }

    /// Tables, figure and cycles; of a named search the best one as `gait.toml`.
    fn files(
        &self,
        frontier: &Frontier,
        cycles: &[(Cycle, f64)],
        searches: &[Search],
    ) -> Result<Artefacts, SearchError> {
        let mut artefacts = Artefacts::new();
        artefacts.insert("frontier.csv".into(), frontier::csv(frontier)?);
        let ceilings: Vec<Option<f64>> = self.jobs.iter().map(|job| job.ceiling_mm).collect();
        let history = frontier::history_csv(&ceilings, searches)?;
        artefacts.insert("history.csv".into(), history);
        for ((cycle, _), found) in cycles.iter().zip(&frontier.found) {
            let text = cycle_file::write(cycle, &self.header(cycle, found));
            artefacts.insert(format!("gaits/{}.toml", cycle.pull.name), text.into_bytes());
        }
        let found = cycles.iter().zip(&frontier.found);
        let order = |found: &Found| {
            let value = found.value.unwrap_or(f64::INFINITY);
            (found.violation, value)
        };
        let best = found.min_by(|(_, a), (_, b)| {
            let (a, b) = (order(a), order(b));
            a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        if let (Some(name), Some(((cycle, _), found))) = (&self.name, best) {
            let mut cycle = cycle.clone();
            cycle.pull.name.clone_from(name);
            let text = cycle_file::write(&cycle, &self.header(&cycle, found));
            artefacts.insert("gait.toml".into(), text.into_bytes());
        }
        draw(&mut artefacts, frontier_figure(frontier)?)?;
        Ok(artefacts)
    }
}

impl SearchRun for CycleRun {
    type Candidates = CycleSearch;

    fn plan(&self) -> &SearchPlan {
        &self.plan
    }

    fn jobs(&self) -> &[Job<CycleSearch>] {
        &self.jobs
    }

    fn conclude(
        &self,
        searches: &[Search],
        _: SearchEnd,
        watch: &dyn Watch,
    ) -> Result<(SearchResult, Artefacts), SearchError> {
        let mut found = Vec::new();
        let mut cycles = Vec::new();
        for (job, search) in self.jobs.iter().zip(searches) {
            let ceiling = job.ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3);
            for run in search.runs() {
                if let Some((cycle, record)) = self.found(job, run)? {
                    cycles.push((cycle, ceiling));
                    found.push(record);
                }
            }
        }
        let compared = self.compared.iter();
        let all: Vec<(Cycle, f64)> = cycles
            .iter()
            .cloned()
            .chain(compared.map(|cycle| (cycle.clone(), f64::INFINITY)))
            .collect();
        let mut confirmed = confirm::cycles(&all, &self.confirmation, watch)?.into_iter();
        for (found, confirmed) in found.iter_mut().zip(confirmed.by_ref()) {
            found.confirmed = confirmed;
        }
        let others = self.compared.iter().zip(confirmed);
        // What the robot cannot crawl is no comparison.
        let others = others.filter(|(_, confirmed)| {
            let mut rows = confirmed.settings.iter();
            rows.any(|row| row.refused.is_none())
        });
        let compared = others.map(|(cycle, confirmed)| Compared {
            gait: cycle.pull.name.clone(),
            confirmed,
        });
        let frontier = Frontier {
            objective: self.objective,
            margin_mm: self.margin_mm,
            compared: compared.collect(),
            found,
        };
        let artefacts = self.files(&frontier, &cycles, searches)?;
        Ok((SearchResult::Cycles(Box::new(frontier)), artefacts))
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
                NoRoom::check(*mm, *margin_mm)?;
            }
        }
        Under::One {
            rules, worst_over, ..
        } => {
            let objective = experiment.objective;
            let several = matches!(objective, CycleObjective::Heat | CycleObjective::Peak);
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
        if let (Some(ceiling_mm), Some(reason)) = (ceiling.mm, too_low(robot, ceiling.height)) {
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
        ..usual
    }
}

fn under_plan(experiment: &CycleSearchExperiment, jobs: &[Job<CycleSearch>]) -> UnderPlan {
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
            let job = jobs.first();
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
        CycleObjective::Heat | CycleObjective::Peak => CycleRules {
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
            Err(error) => refused.push((cycle.pull.name.clone(), error)),
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

#[cfg(test)]
mod tests;
