//! Searching whole cycles in the locomotion regime, under one ceiling or several.

use std::sync::Arc;

use prone::gait::cycle::{Cycle, TimeScale};
use prone::regime::Regime;
use prone::robot::Robot;
use prone_files::{cycle_file, text_file};
use prone_record::frontier::{self, Compared, CycleObjective, Found, Frontier};
use prone_record::output::Artefacts;
use prone_record::program::RobotInfo;
use prone_record::search::{Search, SearchEnd, SeededRun};
use prone_record::search_plan::{CyclePlan, FrontierPlan, SearchHead, SearchPlan};
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

/// Which cycles are searched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// Any.
    All,
    /// Those that can be steered.
    Steerable,
}

impl Wanted {
    /// As a word of a plan.
    pub const fn is_steerable(self) -> bool {
        matches!(self, Self::Steerable)
    }
}

/// What is searched of cycles.
#[derive(Debug, Clone)]
pub struct CycleQuestion {
    /// What is minimised.
    pub objective: CycleObjective,
    /// Which count.
    pub wanted: Wanted,
    /// Cycles of which one is searched about under each ceiling.
    pub from: Vec<Cycle>,
    /// Under which ceilings.
    pub under: Under,
    /// Other cycles in the same confirmation.
    pub compared: Vec<Cycle>,
}

/// Under which ceilings cycles are searched, and by which rules.
#[derive(Debug, Clone)]
pub enum Under {
    /// Several, mm, by the usual rules.
    Ceilings {
        /// Heights, mm.
        ceilings_mm: Vec<f64>,
        /// Distance that has to stay between robot and ceiling, mm.
        margin_mm: f64,
        /// Names of the cycles to begin with, as the user gave them.
        from: Vec<String>,
    },
    /// One or none, by rules of one's own.
    One(Box<Asked>),
}

/// What a search under one ceiling or none asks for beside the usual rules.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Asked {
    /// The ceiling, mm.
    pub ceiling_mm: Option<f64>,
    /// Least advance per cycle, mm.
    pub least_advance_mm: Option<f64>,
    /// Largest torque that a shoulder's servo may demand, N·m.
    pub demanded_shoulder_nm: Option<f64>,
    /// Largest share of the weight on trunk and legs.
    pub body_share_percent: Option<f64>,
    /// Largest heat.
    pub most_heat: Option<f64>,
    /// The cycle over whose heats those found are, with its name as the user gave it.
    pub worst_over: Option<(String, Cycle)>,
    /// Name of the found cycle; without one it is called after the objective.
    pub name: Option<String>,
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
    #[error("--worst-over {cycle}: {source}")]
    WorstOver {
        /// Its name.
        cycle: String,
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
    /// Prepares a search; `head` says by whom, with which seeds and budget.
    ///
    /// # Errors
    /// [`CycleSearchError`].
    pub fn new(
        robot: &LoadedRobot,
        question: CycleQuestion,
        mut head: SearchHead,
    ) -> Result<Self, CycleSearchError> {
        let CycleQuestion {
            objective,
            wanted,
            from,
            under,
            compared,
        } = question;
        let settings = search_settings(objective, wanted, robot)?;
        let mut jobs = Vec::new();
        let mut search_under = |ceiling_mm: Option<f64>, height: f64, asked: &Asked| {
            let base = base(robot, &settings[0], &from, height)?;
            let aim = asked.aim(objective, height, base, robot.robot(), &settings)?;
            let least_advance_mm = aim.rules.advance * 1e3;
            head.base_sha256.insert(
                base.pull.name.clone(),
                text_file::sha256(&[&cycle_file::write(base, "")]),
            );
            jobs.push(Job {
                ceiling_mm,
                base: base.pull.name.clone(),
                candidates: CycleSearch::new(robot.robot(), &settings, aim, base)?,
            });
            Ok::<_, CycleSearchError>(least_advance_mm)
        };
        let info = RobotInfo::of(robot.robot(), robot.files());
        let regime = Regime::LOCOMOTION.name.to_owned();
        let bases = |jobs: &[Job<_>]| jobs.iter().map(|job| job.base.clone()).collect();
        let (plan, margin_mm, name) = match under {
            Under::Ceilings {
                ceilings_mm,
                margin_mm,
                from,
            } => {
                for &mm in &ceilings_mm {
                    search_under(Some(mm), (mm - margin_mm) * 1e-3, &Asked::default())?;
                }
                let plan = SearchPlan::Frontier(FrontierPlan {
                    head,
                    ceilings_mm,
                    objective,
                    margin_mm,
                    steerable: wanted.is_steerable(),
                    from,
                    bases: bases(&jobs),
                    regime,
                    robot: info,
                });
                (plan, margin_mm, None)
            }
            Under::One(asked) => {
                let height = asked.ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3);
                let least_advance_mm = search_under(asked.ceiling_mm, height, &asked)?;
                let bases: Vec<String> = bases(&jobs);
                let plan = SearchPlan::Cycle(CyclePlan {
                    head,
                    source: "cycle".to_owned(),
                    objective,
                    ceiling_mm: asked.ceiling_mm,
                    steerable: wanted.is_steerable(),
                    least_advance_mm,
                    demanded_shoulder_nm: asked.demanded_shoulder_nm,
                    body_share_percent: asked.body_share_percent,
                    worst_over: asked.worst_over.map(|(name, _)| name),
                    most_heat: asked.most_heat,
                    from: bases.concat(),
                    name: asked.name.clone(),
                    regime,
                    bases,
                    robot: info,
                });
                let usual = || format!("best-{}", objective.name());
                (plan, 0.0, Some(asked.name.unwrap_or_else(usual)))
            }
        };
        Ok(Self {
            plan,
            objective,
            margin_mm,
            jobs,
            confirmation: confirmation_settings(objective, wanted, robot)?,
            steering: settings::for_steering_confirmation(robot)?,
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
        draw(&mut artefacts, frontier_figure(frontier))?;
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

impl Asked {
    /// The aim of a search below a height, m, about a cycle: the usual rules, but for what is asked.
    fn aim(
        &self,
        objective: CycleObjective,
        height: f64,
        base: &Cycle,
        robot: &Robot,
        settings: &[Setting],
    ) -> Result<CycleAim, CycleSearchError> {
        let usual = usual_rules(objective, height, base, robot);
        let merge = match &self.worst_over {
            None => Merge::Mean,
            Some((name, cycle)) => Merge::worst_over(settings, cycle).map_err(|source| {
                CycleSearchError::WorstOver {
                    cycle: name.clone(),
                    source,
                }
            })?,
        };
        Ok(CycleAim {
            objective,
            merge,
            rules: CycleRules {
                advance: self.least_advance_mm.map_or(usual.advance, |mm| mm * 1e-3),
                demanded_shoulder: self.demanded_shoulder_nm.unwrap_or(usual.demanded_shoulder),
                body_share: self
                    .body_share_percent
                    .map_or(usual.body_share, |percent| percent / 100.0),
                heat: self.most_heat.unwrap_or(usual.heat),
                ..usual
            },
        })
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

/// Settings of a search.
///
/// # Errors
/// [`SettingError`].
pub fn search_settings(
    objective: CycleObjective,
    wanted: Wanted,
    robot: &LoadedRobot,
) -> Result<Arc<[Setting]>, SettingError> {
    let mut settings = match objective {
        CycleObjective::Heat | CycleObjective::Peak => settings::for_heat(robot)?,
        CycleObjective::Advance | CycleObjective::Speed => settings::for_advance(robot)?,
    };
    if wanted == Wanted::Steerable {
        settings.extend(settings::for_steering(robot)?);
    }
    Ok(settings.into())
}

fn confirmation_settings(
    objective: CycleObjective,
    wanted: Wanted,
    robot: &LoadedRobot,
) -> Result<Vec<Setting>, SettingError> {
    let mut settings = match objective {
        CycleObjective::Heat | CycleObjective::Peak => settings::for_heat_confirmation(robot)?,
        CycleObjective::Advance | CycleObjective::Speed => settings::for_confirmation(robot)?,
    };
    if wanted == Wanted::Steerable {
        settings.extend(settings::for_steering_confirmation(robot)?);
    }
    Ok(settings)
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
