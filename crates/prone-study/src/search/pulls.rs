//! Searching pulls: by any of the torque sources, confirmed at other durations and in both contact
//! regimes.

use prone::gait::{CheckedTrajectory, Gait, PhaseDuration};
use prone::regime::Regime;
use prone_files::gait_file;
use prone_files::plain_name::check_gait;
use prone_optim::Candidate;
use prone_record::curves_info::CurvesInfo;
use prone_record::experiment::{Ends, GaitForm, Limit, PullSearchExperiment};
use prone_record::gait_search::{
    self, Compared, Confirmation, Outcome, PullCost, Refusal, RunOutcome, Verdict,
};
use prone_record::measure::Measure;
use prone_record::output::Artefacts;
use prone_record::program::Program;
use prone_record::search::{Search, SearchEnd, SeededRun};
use prone_record::search_plan::{PullPlan, SearchHead, SearchPlan};
use prone_record::search_result::SearchResult;
use prone_record::tables;
use prone_report::figures::{self, ConfirmedRecord, Scores, SearchRecord};
use prone_sim::{LoadedRobot, World};

use super::candidates::{Candidates as _, Depth, Refusal as NoCost};
use super::chain_rules::INTERVALS;
use super::confirm::{self, PullSetting};
use super::pull_cost::{PullCosts, PullSearch};
use super::pull_error::PullCostError;
use super::pull_form::PullForm;
use super::pull_terms::{PullAim, PullTerms, can_follow};
use super::run::{Job, SearchError, SearchRun, draw};
use crate::pulls;
use crate::watch::Watch;

/// A search of pulls.
#[derive(Debug)]
pub struct PullRun {
    plan: SearchPlan,
    /// One.
    jobs: Vec<Job<PullSearch>>,
    /// Name of the found gait.
    name: String,
    /// The base gait first.
    compared: Vec<Gait>,
    confirmation: Vec<PullSetting>,
}

impl PullRun {
    /// Prepares a search.
    pub fn new(
        experiment: &PullSearchExperiment,
        robot: &LoadedRobot,
        program: &Program,
    ) -> Result<Self, PullCostError> {
        experiment.runs.check()?;
        if let Some(seconds) = experiment.time_budget_s {
            let bounds = (0.0, PullSearchExperiment::LONGEST_S);
            Limit::check("a time budget", " s", seconds, bounds)?;
        }
        let name = experiment.name.clone();
        check_gait(&name)?;
        let world = World::new(robot, Regime::TORQUE_STUDY)?;
        let terms = PullTerms::new(&experiment.terms, &world)?;
        let (form, ends) = (experiment.form, experiment.ends);
        let published = matches!(terms.aim, PullAim::Published(_));
        if published && (form != GaitForm::Cubic || ends == Ends::Free) {
            return Err(PullCostError::PublishedForm);
        }
        let mut compared = vec![terms.base.clone()];
        let mut taken = terms.base.name == name;
        for gait in &experiment.compared {
            let gait = gait.parse(gait_file::parse)?;
            taken |= gait.name == name;
            let twice = compared.iter().any(|other| other.name == gait.name);
            if !twice && can_follow(robot.robot(), &gait) {
                compared.push(gait);
            }
        }
        if taken {
            return Err(PullCostError::NameTaken { name });
        }
        let durations = experiment.confirm_durations_s.iter();
        let durations = durations.map(|&seconds| PhaseDuration::new(seconds));
        let durations: Vec<PhaseDuration> = durations.collect::<Result<_, _>>()?;
        let costs = PullCosts::new(&world, terms)?;
        let base = &costs.terms().base;
        let form = PullForm::new(form, ends, base)?;
        let mut head = SearchHead::new(
            program,
            "optimize",
            prone_sim::engine_version(),
            experiment.solver,
            experiment.runs,
        );
        head.add_base(&base.name, &gait_file::write(base, ""));
        let plan = SearchPlan::Pull(Box::new(PullPlan {
            head,
            pricing: costs.terms().plan(&world, robot),
            form: form.form().to_string(),
            ends: form.ends(),
            name: name.clone(),
            confirm_durations_s: durations.iter().map(|it| it.seconds()).collect(),
        }));
        let worlds = [world, World::new(robot, Regime::LOCOMOTION)?];
        let confirmation = worlds.iter().flat_map(|world| {
            let setting = |&duration| PullSetting {
                world: world.clone(),
                duration,
            };
            durations.iter().map(setting)
        });
        Ok(Self {
            plan,
            confirmation: confirmation.collect(),
            jobs: vec![Job {
                at: None,
                base: base.name.clone(),
                candidates: PullSearch { costs, form },
            }],
            name,
            compared,
        })
    }

    /// The gait of the best point under its name.
    fn found(
        &self,
        searched: &PullSearch,
        run: &SeededRun,
        best: &Candidate,
    ) -> Result<Gait, SearchError> {
        let terms = searched.costs.terms();
        let objective = match terms.aim {
            PullAim::Published(_) => "the published cost",
            PullAim::Graded(objective) => objective.name(),
        };
        Ok(Gait {
            name: self.name.clone(),
            description: format!(
                "found by {}, seed {}: least {objective}, source {}",
                self.plan.head().solver.name(),
                run.seed,
                terms.source.name()
            ),
            ..searched.gait(&best.point)?
        })
    }

    /// The record; what others cost stands beside the found gait, where the objective has a cost.
    fn outcome(
        &self,
        searched: &PullSearch,
        search: &Search,
        seed: u64,
        end: SearchEnd,
        gait: &Gait,
        confirmation: &Confirmation,
    ) -> Result<Outcome, SearchError> {
        let cost = searched.costs.cost(gait, Depth::Everything);
        let cost = searched.costs.record(&cost);
        let runs = search.runs().iter().map(|run| {
            let cost = match run.best() {
                Some(best) => known_cost(searched, &searched.gait(&best.point)?),
                None => None,
            };
            Ok(RunOutcome {
                seed: run.seed,
                cost,
                evaluations: run.evaluations(),
                generations: run.last().map_or(0, |last| last.generation),
                restarts: run.last().map_or(0, |last| last.restarts),
            })
        });
        let compared = self.compared.iter().filter_map(|other| {
            let theirs = known_cost(searched, other)?;
            let torques = cost.torque.zip(theirs.torque);
            Some(Compared {
                gait: other.name.clone(),
                torque_ratio: torques.map(|(ours, theirs)| ours / theirs),
                cost: theirs,
            })
        });
        Ok(Outcome {
            gait: gait.name.clone(),
            curves: CurvesInfo::of(gait),
            unit: searched.costs.terms().aim.objective().unit().into(),
            seed,
            evaluations: search.evaluations(),
            complete: end == SearchEnd::Finished,
            variables: searched.bounds().len(),
            runs: runs.collect::<Result<_, SearchError>>()?,
            compared: compared.collect(),
            verdicts: confirmation.verdicts.clone(),
            refused: confirmation.refused.clone(),
            cost,
        })
    }

    /// The gait, the tables, the figures.
    fn files(
        &self,
        searched: &PullSearch,
        search: &Search,
        gaits: &[Gait],
        outcome: &Outcome,
        confirmation: &Confirmation,
    ) -> Result<Artefacts, SearchError> {
        let mut artefacts = Artefacts::new();
        let terms = searched.costs.terms();
        if let Some(gait) = gaits.last() {
            let text = gait_file::write(gait, &self.header(searched, gait, outcome));
            artefacts.insert("gait.toml".into(), text.into_bytes());
        }
        artefacts.insert("history.csv".into(), gait_search::history_csv(search)?);
        artefacts.insert(
            "confirmation.csv".into(),
            gait_search::confirmation_csv(confirmation)?,
        );
        let scores = match terms.aim {
            PullAim::Published(_) => Scores::Published,
            PullAim::Graded(_) => Scores::Graded,
        };
        let objective = terms.aim.objective();
        let history = SearchRecord::from_search(search, &objective, scores);
        let history = history.map(|history| figures::generations(&history));
        let rows = ConfirmedRecord::from_confirmation(confirmation);
        let drawn = [
            history.transpose()?.flatten(),
            figures::confirmation(&rows, objective.name())?,
        ];
        draw(&mut artefacts, drawn.into_iter().flatten())?;
        // The planned chains, the found gait's last. One that cannot be planned was refused by the
        // confirmation too, which says why.
        let chain = |gait| pulls::chain(searched.costs.world(), gait, terms.duration).ok();
        let chains: Vec<_> = gaits.iter().filter_map(chain).collect();
        artefacts.insert("chains.csv".into(), tables::chains(&chains)?);
        Ok(artefacts)
    }

    /// How the gait was found and what it does, for whoever reads its file.
    fn header(&self, searched: &PullSearch, gait: &Gait, outcome: &Outcome) -> String {
        let head = self.plan.head();
        let mut lines = vec![format!(
            "Found by prone {} ({}), seed {}, {} evaluations in {} runs, on robot {}.",
            head.version,
            head.commit,
            outcome.seed,
            outcome.evaluations,
            outcome.runs.len(),
            searched.costs.world().robot().name
        )];
        if let Some(cost) = outcome.cost.cost {
            lines.push(format!(
                "Cost {cost:.4} ({}), violations {:.4}.",
                outcome.unit, outcome.cost.violations
            ));
        }
        lines.push(
            "Simulated from its own first pose at several durations, cost over another gait's:"
                .into(),
        );
        lines.extend(outcome.verdicts.iter().map(Verdict::sentence));
        let refused = outcome.refused.iter().map(|refused| {
            let Refusal {
                regime,
                gait,
                reason,
            } = refused;
            format!("{regime}: {gait} cannot be simulated: {reason}.")
        });
        lines.extend(refused);
        lines.extend(clamps(searched, gait));
        lines.join("\n")
    }
}

impl SearchRun for PullRun {
    type Candidates = PullSearch;

    fn plan(&self) -> &SearchPlan {
        &self.plan
    }

    fn measure(&self) -> Measure {
        let terms = self.jobs.first().map(|job| job.candidates.costs.terms());
        Measure::of_pulls(terms.map_or("", |terms| terms.aim.objective().unit()))
    }

    fn jobs(&self) -> &[Job<PullSearch>] {
        &self.jobs
    }

    fn conclude(
        &self,
        searches: &[Search],
        end: SearchEnd,
        watch: &dyn Watch,
    ) -> Result<(SearchResult, Artefacts), SearchError> {
        let nothing = SearchError::Nothing {
            budget: searches.iter().map(Search::allowance).sum(),
        };
        let (Some(job), Some(search)) = (self.jobs.first(), searches.first()) else {
            return Err(nothing);
        };
        let searched = &job.candidates;
        let (run, best) = search.best().ok_or(nothing)?;
        let gait = self.found(searched, run, best)?;
        let mut gaits = self.compared.clone();
        gaits.push(gait.clone());
        let objective = searched.costs.terms().aim.objective();
        let confirmation = confirm::pulls(&gaits, &self.confirmation, &objective, watch)?;
        let outcome = self.outcome(searched, search, run.seed, end, &gait, &confirmation)?;
        let artefacts = self.files(searched, search, &gaits, &outcome, &confirmation)?;
        Ok((SearchResult::Pulls(Box::new(outcome)), artefacts))
    }
}

/// What a gait costs, `None` where the objective has no cost for it.
fn known_cost(searched: &PullSearch, gait: &Gait) -> Option<PullCost> {
    let cost = searched.costs.cost(gait, Depth::Everything);
    let no_cost = matches!(cost.refusal, Some(NoCost::NotCubic));
    (!no_cost).then(|| searched.costs.record(&cost))
}

/// Which joints the gait asks past their stops, where it asks any.
fn clamps(searched: &PullSearch, gait: &Gait) -> Option<String> {
    let robot = searched.costs.world().robot();
    // The manufacturer's: a regime may have moved them.
    let stops = robot.stops();
    let duration = searched.costs.terms().duration;
    let trajectory = CheckedTrajectory::plan(robot, &stops, gait, duration, INTERVALS).ok()?;
    let clamped = trajectory.clamps().iter().map(|clamp| {
        let by = clamp.largest.abs().to_degrees();
        format!("{} by up to {by:.1}°", robot.joints[clamp.joint.0].name)
    });
    let clamped: Vec<_> = clamped.collect();
    (!clamped.is_empty()).then(|| format!("Clamped at its limit: {}.", clamped.join(", ")))
}
