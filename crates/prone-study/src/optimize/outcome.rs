//! What a search leaves behind: `result.json`, `history.csv`, `confirmation.csv`.

use prone::gait::{CurveError, Gait};
use prone_optim::{Candidate, Problem};

use super::form::Parametrisation;
use super::pricer::{NotCubic, Pricer};
use super::problem::GaitProblem;
use super::published_problem;
use prone_record::curves_info::CurvesInfo;
use prone_record::gait_search::{Compared, Confirmation, Outcome, RunOutcome};
use prone_record::search::{Search, SearchEnd, SeededRun};

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
