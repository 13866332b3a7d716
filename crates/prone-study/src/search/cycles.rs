//! Searching whole cycles in the locomotion regime, under one ceiling or several.

use std::sync::Arc;

use prone::gait::cycle::{Cycle, TimeScale};
use prone::robot::Robot;
use prone_files::{cycle_file, text_file};
use prone_record::frontier::{self, Compared, CycleObjective, Found, Frontier};
use prone_record::output::Artefacts;
use prone_record::search::{Search, SearchEnd, SeededRun};
use prone_record::search_plan::{CyclePlan, OnePlan, SearchPlan, UnderPlan};
use prone_report::figures::frontier_figure;
use prone_sim::LoadedRobot;
use prone_sim::crawl::CrawlError;

use super::candidates::{Candidates as _, Depth};
use super::confirm;
use super::cycle_cost::{CycleAim, CycleCostError, CycleSearch, Merge};
use super::cycle_rules::CycleRules;
use super::run::{Job, SearchError, SearchRun, draw};
use super::setting::Setting;
use super::settings::{self, SettingError};
use super::steering::check_steering;
use super::trial::{Trial, try_out};
use crate::watch::Watch;

/// The cycles that a plan names.
#[derive(Debug, Clone)]
pub struct CycleGaits {
    /// Those of which one is searched about under each ceiling.
    pub from: Vec<Cycle>,
    /// Others in the same confirmation.
    pub compared: Vec<Cycle>,
    /// The one over whose heats those found are.
    pub worst_over: Option<Cycle>,
}

/// Why cycles cannot be searched.
#[derive(Debug, thiserror::Error)]
pub enum CycleSearchError {
    /// A setting cannot be made.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// Cycles have no costs.
    #[error(transparent)]
    Costs(#[from] CycleCostError),
    /// The cycle that heats are compared with cannot be crawled.
    #[error(transparent)]
    WorstOver(CrawlError),
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
    /// Prepares a search; the plan is completed by what is found out about its cycles.
    ///
    /// # Errors
    /// [`CycleSearchError`].
    pub fn new(
        robot: &LoadedRobot,
        mut plan: CyclePlan,
        gaits: CycleGaits,
    ) -> Result<Self, CycleSearchError> {
        let objective = plan.objective;
        let mut searched = settings::for_search(objective, robot)?;
        let mut confirmation = settings::for_confirmation_of(objective, robot)?;
        let steering = settings::for_steering_confirmation(robot)?;
        if plan.steerable {
            searched.extend(settings::for_steering(robot)?);
            confirmation.extend(steering.iter().cloned());
        }
        let searched: Arc<[Setting]> = searched.into();
        let merge = match gaits.worst_over {
            None => Merge::Mean,
            Some(cycle) => {
                let merge = Merge::worst_over(&searched, &cycle);
                merge.map_err(CycleSearchError::WorstOver)?
            }
        };
        // The ceiling, mm, and what has to stay below which height, m.
        let (ceilings, margin_mm): (Vec<(Option<f64>, f64)>, f64) = match &plan.under {
            UnderPlan::Frontier {
                ceilings_mm,
                margin_mm,
                ..
            } => {
                let height = |mm: &f64| (Some(*mm), (mm - margin_mm) * 1e-3);
                (ceilings_mm.iter().map(height).collect(), *margin_mm)
            }
            UnderPlan::One(one) => {
                let height = one.ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3);
                (vec![(one.ceiling_mm, height)], 0.0)
            }
        };
        let mut jobs = Vec::with_capacity(ceilings.len());
        for (ceiling_mm, height) in ceilings {
            let base = base(robot, &searched[0], &gaits.from, height)?;
            let mut rules = usual_rules(objective, height, base, robot.robot());
            if let UnderPlan::One(one) = &mut plan.under {
                ask(one, &mut rules);
                one.from.clone_from(&base.pull.name);
            }
            let hash = text_file::sha256(&[&cycle_file::write(base, "")]);
            plan.head.base_sha256.insert(base.pull.name.clone(), hash);
            plan.bases.push(base.pull.name.clone());
            let aim = CycleAim {
                objective,
                merge: merge.clone(),
                rules,
            };
            jobs.push(Job {
                ceiling_mm,
                base: base.pull.name.clone(),
                candidates: CycleSearch::new(robot.robot(), &searched, aim, base)?,
            });
        }
        let name = match &plan.under {
            UnderPlan::Frontier { .. } => None,
            UnderPlan::One(one) => Some(one.name.clone()),
        };
        let usual = || format!("best-{}", objective.name());
        Ok(Self {
            plan: SearchPlan::Cycle(Box::new(plan)),
            objective,
            margin_mm,
            jobs,
            confirmation,
            steering,
            compared: gaits.compared,
            name: name.map(|name| name.unwrap_or_else(usual)),
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
    type Outcome = Frontier;

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
    ) -> Result<(Frontier, Artefacts), SearchError> {
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
        Ok((frontier, artefacts))
    }
}

/// Puts what is asked for in place of the usual rules.
fn ask(one: &mut OnePlan, rules: &mut CycleRules) {
    let set = |rule: &mut f64, asked: Option<f64>| *rule = asked.unwrap_or(*rule);
    set(&mut rules.advance, one.least_advance_mm.map(|mm| mm * 1e-3));
    set(&mut rules.demanded_shoulder, one.demanded_shoulder_nm);
    let share = one.body_share_percent.map(|percent| percent / 100.0);
    set(&mut rules.body_share, share);
    set(&mut rules.heat, one.most_heat);
    one.least_advance_mm = Some(rules.advance * 1e3);
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
