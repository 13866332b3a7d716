//! What a search leaves behind: `result.json`, `history.csv`, `confirmation.csv`.

use serde::Serialize;

use prone::gait::{CurveError, Gait};
use prone_optim::{Candidate, Problem};

use super::confirm::{Confirmation, Refusal, Row, Verdict};
use super::form::Parametrisation;
use super::pricer::{NotCubic, Priced, Pricer};
use super::problem::GaitProblem;
use super::published_problem;
use super::search::{Search, SearchEnd, SeededRun};
use crate::curves_info::CurvesInfo;
use crate::tables::{finish, number};

/// Gaits of one form, priced.
pub struct Hunt<'a> {
    /// What prices them.
    pub pricer: &'a Pricer<'a>,
    /// What they are made of; the published objective has its own form.
    pub forms: &'a Parametrisation,
}

impl Hunt<'_> {
    /// Goes on with a search until it ends or `between` stops it.
    pub fn proceed(
        &self,
        search: &mut Search,
        between: impl FnMut(&Search) -> std::ops::ControlFlow<()>,
    ) -> SearchEnd {
        match self.pricer {
            Pricer::Published { problem, .. } => search.proceed(problem.as_ref(), between),
            Pricer::Graded(pricing) => {
                let problem = GaitProblem {
                    forms: self.forms,
                    pricing: pricing.as_ref(),
                };
                search.proceed(&problem, between)
            }
        }
    }

    /// Number of variables.
    pub fn variables(&self) -> usize {
        match self.pricer {
            Pricer::Published { problem, .. } => problem.bounds().len(),
            Pricer::Graded(_) => self.forms.bounds().len(),
        }
    }

    /// The gait of a point.
    ///
    /// # Errors
    /// [`CurveError`], which points within the bounds do not produce.
    pub fn gait(&self, point: &[f64]) -> Result<Gait, CurveError> {
        match self.pricer {
            Pricer::Graded(_) => self.forms.gait(point),
            Pricer::Published { .. } => {
                let coefficients =
                    published_problem::coefficients(point).ok_or(CurveError::NoCoefficients)?;
                published_problem::gait("published", &coefficients)
            }
        }
    }
}

/// What a search found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outcome {
    /// Name of the gait.
    pub gait: String,
    /// What it is made of.
    pub curves: CurvesInfo,
    /// Its price.
    #[serde(flatten)]
    pub price: Priced,
    /// Unit of the torque part.
    pub unit: &'static str,
    /// Seed of the run that found it.
    pub seed: u64,
    /// Evaluations of all runs.
    pub evaluations: u64,
    /// Whether every run came to its own end, or the search was stopped by its time budget.
    pub complete: bool,
    /// Variables.
    pub variables: usize,
    /// Each run's best.
    pub runs: Vec<RunOutcome>,
    /// The gaits that it is compared with, priced the same way.
    pub compared: Vec<Compared>,
    /// What simulation says at other durations and in the other regime.
    pub verdicts: Vec<Verdict>,
    /// Gaits that could not be simulated there.
    pub refused: Vec<Refusal>,
}

/// One run's best.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RunOutcome {
    /// Its seed.
    pub seed: u64,
    /// Its best gait's price, `None` where nothing was evaluated.
    #[serde(flatten)]
    pub price: Option<Priced>,
    /// Evaluations.
    pub evaluations: u64,
    /// Generations.
    pub generations: u64,
    /// How often the population began anew.
    pub restarts: u64,
}

/// Another gait's price, and the found one's over it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// Name of the gait.
    pub gait: String,
    /// Its price.
    #[serde(flatten)]
    pub price: Priced,
    /// The found gait's torque part over this one's, where both are known.
    pub torque_ratio: Option<f64>,
}

/// Why a search has no outcome.
#[derive(Debug, thiserror::Error)]
pub enum OutcomeError {
    /// Nothing was evaluated.
    #[error("the budget of {budget} evaluations is too small for one generation")]
    Nothing {
        /// The budget of all runs.
        budget: u64,
    },
    /// A found point makes no gait.
    #[error(transparent)]
    Curve(#[from] CurveError),
    /// A found gait cannot be priced.
    #[error(transparent)]
    NotCubic(#[from] NotCubic),
}

/// The best gait of a search, under a name.
///
/// # Errors
/// [`OutcomeError`].
pub fn best(hunt: &Hunt<'_>, search: &Search, name: &str) -> Result<Gait, OutcomeError> {
    let (_, best) = found(search)?;
    let gait = hunt.gait(&best.point)?;
    Ok(Gait {
        name: name.to_owned(),
        ..gait
    })
}

fn found(search: &Search) -> Result<(&SeededRun, &Candidate), OutcomeError> {
    search.best().ok_or(OutcomeError::Nothing {
        budget: search.allowance(),
    })
}

/// Puts an outcome together; `others` are priced beside the found gait, those of them that can be.
///
/// # Errors
/// [`OutcomeError`].
pub fn of(
    hunt: &Hunt<'_>,
    search: &Search,
    end: SearchEnd,
    gait: &Gait,
    unit: &'static str,
    others: &[Gait],
    confirmation: &Confirmation,
) -> Result<Outcome, OutcomeError> {
    let (run, _) = found(search)?;
    let price = hunt.pricer.price(gait)?;
    let runs = search.runs().iter().map(|run| run_outcome(hunt, run));
    let compared = others.iter().filter_map(|other| {
        let theirs = hunt.pricer.price(other).ok()?;
        Some(Compared {
            gait: other.name.clone(),
            torque_ratio: price
                .torque
                .zip(theirs.torque)
                .map(|(ours, theirs)| ours / theirs),
            price: theirs,
        })
    });
    Ok(Outcome {
        gait: gait.name.clone(),
        curves: CurvesInfo::of(gait),
        unit,
        seed: run.seed,
        evaluations: search.evaluations(),
        complete: end == SearchEnd::Finished,
        variables: hunt.variables(),
        runs: runs.collect::<Result<_, _>>()?,
        compared: compared.collect(),
        verdicts: confirmation.verdicts.clone(),
        refused: confirmation.refused.clone(),
        price,
    })
}

fn run_outcome(hunt: &Hunt<'_>, run: &SeededRun) -> Result<RunOutcome, OutcomeError> {
    let price = match run.best() {
        Some(best) => Some(hunt.pricer.price(&hunt.gait(&best.point)?)?),
        None => None,
    };
    Ok(RunOutcome {
        seed: run.seed,
        price,
        evaluations: run.evaluations(),
        generations: run.last().map_or(0, |last| last.generation),
        restarts: run.last().map_or(0, |last| last.restarts),
    })
}

/// `history.csv`: one row per generation of each run.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn history_csv(search: &Search) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "seed",
        "generation",
        "evaluations",
        "best_violation",
        "best_torque",
        "generation_best_violation",
        "generation_best_torque",
        "mean_violation",
        "feasible",
        "mean_feasible_torque",
        "restarts",
        "mean_torque",
    ])?;
    for run in search.runs() {
        for row in &run.history.0 {
            let mean_torque = (row.mean_value.is_finite()).then(|| number(row.mean_value, 6));
            let mean = (row.feasible > 0).then(|| number(row.mean_feasible_value, 6));
            table.write_record([
                run.seed.to_string(),
                row.generation.to_string(),
                row.evaluations.to_string(),
                number(row.best.violation(), 6),
                number(row.best.value(), 6),
                number(row.generation_best.violation(), 6),
                number(row.generation_best.value(), 6),
                number(row.mean_violation, 6),
                row.feasible.to_string(),
                mean.unwrap_or_default(),
                row.restarts.to_string(),
                mean_torque.unwrap_or_default(),
            ])?;
        }
    }
    finish(table)
}

/// `confirmation.csv`: one row per simulated pull.
///
/// # Errors
/// [`csv::Error`], which writing to memory does not produce.
pub fn confirmation_csv(confirmation: &Confirmation) -> Result<Vec<u8>, csv::Error> {
    let mut table = csv::Writer::from_writer(Vec::new());
    table.write_record([
        "regime",
        "gait",
        "duration_s",
        "objective",
        "ratio",
        "torque_n2m2s",
        "heat_s",
        "peak_of_effort",
        "peak_joint",
        "body_share_percent",
        "carried_from_percent",
        "advance_mm",
        "top_mm",
    ])?;
    for row in &confirmation.rows {
        table.write_record(cells(row))?;
    }
    finish(table)
}

fn cells(row: &Row) -> [String; 13] {
    let maybe = |value: Option<f64>, decimals| {
        let value = value.filter(|value| value.is_finite());
        value.map_or_else(String::new, |value| number(value, decimals))
    };
    [
        row.regime.to_owned(),
        row.gait.clone(),
        row.duration_s.to_string(),
        number(row.objective, 6),
        maybe(Some(row.ratio), 6),
        number(row.torque_n2m2s, 6),
        maybe(row.heat_s, 6),
        number(row.peak_of_effort, 6),
        row.peak_joint.to_owned(),
        number(row.body_share_percent, 3),
        maybe(row.carried_from_percent, 3),
        number(row.advance_mm, 3),
        number(row.top_mm, 3),
    ]
}
