//! Searching whole cycles in the locomotion regime: under one ceiling or none, or at several values of a
//! quantity that is held.

use prone::gait::cycle::Cycle;
use prone_files::cycle_file;
use prone_record::experiment::{CycleSearchExperiment, TextError, Under};
use prone_record::frontier::{self, Compared, CycleObjective, Found, Frontier, Quantity};
use prone_record::measure::{Heats, Measure};
use prone_record::output::Artefacts;
use prone_record::program::Program;
use prone_record::search::{Search, SearchEnd, SeededRun};
use prone_record::search_plan::SearchPlan;
use prone_record::search_result::SearchResult;
use prone_report::figures::frontier_figure;
use prone_sim::LoadedRobot;

use super::candidates::{Candidates as _, Depth};
use super::cycle_cost::CycleSearch;
use super::cycle_jobs::{self, CycleSearchError};
use super::cycle_rules::Bounds;
use super::run::{Job, SearchError, SearchRun, draw};
use super::setting::Setting;
use super::steering::check_steering_unless;
use super::{confirm, settings};
use crate::watch::Watch;

/// A search of cycles.
#[derive(Debug)]
pub struct CycleRun {
    plan: SearchPlan,
    objective: CycleObjective,
    heats: Heats,
    held: Quantity,
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
    pub fn new(
        experiment: &CycleSearchExperiment,
        robot: &LoadedRobot,
        program: &Program,
        watch: &dyn Watch,
    ) -> Result<Self, CycleSearchError> {
        let objective = experiment.objective;
        let mut confirmation = settings::for_confirmation(objective, robot)?;
        let steering = settings::for_steering_confirmation(robot)?;
        if experiment.steerable {
            confirmation.extend(steering.iter().cloned());
        }
        let compared = experiment.compared.iter();
        let compared = compared.map(|it| it.parse(cycle_file::parse));
        let jobs = cycle_jobs::jobs(experiment, robot, watch)?;
        let (margin_mm, name) = match &experiment.under {
            Under::Across { margin_mm, .. } => (*margin_mm, None),
            Under::One { name, .. } => {
                let usual = || format!("best-{}", objective.name());
                (0.0, Some(name.clone().unwrap_or_else(usual)))
            }
        };
        let plan = cycle_jobs::plan(experiment, robot, &jobs, program);
        Ok(Self {
            plan: SearchPlan::Cycle(Box::new(plan)),
            objective,
            heats: cycle_jobs::heats(&experiment.under),
            held: cycle_jobs::held(&experiment.under),
            margin_mm,
            jobs: jobs.into_iter().map(|(job, _)| job).collect(),
            confirmation,
            steering,
            compared: compared.collect::<Result<_, TextError>>()?,
            name,
        })
    }

    /// The best cycle of a run under its name, with what a record says of it.
    fn found(
        &self,
        job: &Job<CycleSearch>,
        run: &SeededRun,
        watch: &dyn Watch,
    ) -> Result<Option<(Cycle, Found)>, SearchError> {
        let Some(best) = run.best() else {
            return Ok(None);
        };
        let mut cycle = job.candidates.gait(&best.point)?;
        let stopped = || watch.stop();
        let cost = job
            .candidates
            .cost_unless(&stopped, &cycle, Depth::Everything);
        let cost = cost.ok_or(SearchError::Stopped)?;
        let stem = match (&self.name, job.at) {
            (Some(name), _) => name.clone(),
            (None, Some(at)) => self.held.stem(at),
            (None, None) => "open".to_owned(),
        };
        cycle.name = format!("{stem}-seed-{}", run.seed);
        let steering = match cycle.steering {
            None => Ok(()),
            Some(_) => check_steering_unless(&stopped, &self.steering, &cycle),
        };
        // What it says of a crawl that was stopped is no finding.
        if stopped() {
            return Err(SearchError::Stopped);
        }
        if steering.is_err() {
            cycle.forget_steering();
        }
        let under = job
            .at
            .map_or_else(String::new, |at| format!(" {}", self.held.held_at(at)));
        cycle.description = format!(
            "searched{under} about {} for {}, seed {}, {} evaluations",
            job.base,
            self.objective.name(),
            run.seed,
            run.evaluations()
        );
        let value = Some(cost.value).filter(|value| value.is_finite());
        let found = Found {
            at: job.at,
            seed: run.seed,
            evaluations: run.evaluations(),
            gait: cycle.name.clone(),
            value,
            reached: value.map(|value| self.measure().read(value)),
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
            cycle.description,
            found.violation,
            found.sentence()
        )
    }

    /// Tables, figure and cycles; of a named search the best one as `gait.toml`.
    fn files(
        &self,
        frontier: &Frontier,
        cycles: &[(Cycle, Bounds)],
        searches: &[Search],
    ) -> Result<Artefacts, SearchError> {
        let mut artefacts = Artefacts::new();
        artefacts.insert("frontier.csv".into(), frontier::csv(frontier)?);
        let values: Vec<Option<f64>> = self.jobs.iter().map(|job| job.at).collect();
        let held = (self.held, values.as_slice());
        let history = frontier::history_csv(held, self.measure(), searches)?;
        artefacts.insert("history.csv".into(), history);
        for ((cycle, _), found) in cycles.iter().zip(&frontier.found) {
            let text = cycle_file::write(cycle, &self.header(cycle, found));
            artefacts.insert(format!("gaits/{}.toml", cycle.name), text.into_bytes());
        }
        let best = frontier.best().and_then(|best| {
            let mut all = cycles.iter();
            let own = all.find(|(cycle, _)| cycle.name == best.gait);
            own.map(|(cycle, _)| (cycle, best))
        });
        if let (Some(name), Some((cycle, found))) = (&self.name, best) {
            let mut cycle = cycle.clone();
            cycle.name.clone_from(name);
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

    fn measure(&self) -> Measure {
        Measure::of_cycles(self.objective, self.heats)
    }

    fn jobs(&self) -> &[Job<CycleSearch>] {
        &self.jobs
    }

    fn conclude(
        &self,
        searches: &[Search],
        end: SearchEnd,
        watch: &dyn Watch,
    ) -> Result<(SearchResult, Artefacts), SearchError> {
        let mut found = Vec::new();
        let mut cycles = Vec::new();
        for (job, search) in self.jobs.iter().zip(searches) {
            let ceiling_mm = job.at.filter(|_| self.held == Quantity::Ceiling);
            let bounds = Bounds {
                ceiling: ceiling_mm.map_or(f64::INFINITY, |mm| mm * 1e-3),
                head: job.candidates.rules().head,
                drift: job.candidates.rules().drift,
            };
            for run in search.runs() {
                if watch.stop() {
                    return Err(SearchError::Stopped);
                }
                if let Some((cycle, record)) = self.found(job, run, watch)? {
                    cycles.push((cycle, bounds));
                    found.push(record);
                }
            }
        }
        let compared = self.compared.iter();
        let all: Vec<(Cycle, Bounds)> = cycles
            .iter()
            .cloned()
            .chain(compared.map(|cycle| (cycle.clone(), Bounds::NONE)))
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
            gait: cycle.name.clone(),
            confirmed,
        });
        let frontier = Frontier {
            objective: self.objective,
            unit: self.measure().unit.to_owned(),
            heats: self.heats,
            held: self.held,
            margin_mm: self.margin_mm,
            complete: end == SearchEnd::Finished,
            compared: compared.collect(),
            found,
        };
        let artefacts = self.files(&frontier, &cycles, searches)?;
        Ok((SearchResult::Cycles(Box::new(frontier)), artefacts))
    }
}

#[cfg(test)]
mod tests;
