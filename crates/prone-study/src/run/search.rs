//! Searching, with a checkpoint where the result has a place; and the cost of a single pull.

use std::time::Duration;

use prone::gait::Gait;
use prone::regime::Regime;
use prone_files::gait_file;
use prone_record::experiment::{CostExperiment, CycleSearchExperiment, PullSearchExperiment};
use prone_record::gait_search::PullCost;
use prone_record::resumption::{Earlier, Opening, Snapshot, Work};
use prone_record::search::Search;
use prone_sim::{LoadedRobot, World};

use super::{RunError, Session};
use crate::search::candidates::{Depth, Refusal};
use crate::search::cycles::CycleRun;
use crate::search::pull_cost::PullCosts;
use crate::search::pull_error::PullCostError;
use crate::search::pull_terms::{PullAim, PullTerms, Share, check_advance};
use crate::search::pulls::PullRun;
use crate::search::run::{self, Done, SearchRun};
use crate::watch::{Found, Progress, Watch};

/// What a pull costs.
#[derive(Debug)]
pub struct CostOutcome {
    /// The pull.
    pub gait: Gait,
    /// Its cost.
    pub cost: PullCost,
    /// Unit of its torque part.
    pub unit: &'static str,
}

/// What a pull costs, and what it breaks.
pub(super) fn cost(
    experiment: &CostExperiment,
    robot: &LoadedRobot,
    watch: &dyn Watch,
) -> Result<CostOutcome, RunError> {
    let gait = experiment.gait.parse(gait_file::parse);
    let gait = gait.map_err(PullCostError::from)?;
    let world = World::new(robot, Regime::TORQUE_STUDY).map_err(PullCostError::from)?;
    let terms = PullTerms::new(&experiment.terms, &world)?;
    let base = &terms.base;
    let same_kind = (gait.mapping, gait.arm) == (base.mapping, base.arm);
    if matches!(terms.aim, PullAim::Graded(_)) && !same_kind {
        let kind = |gait: &Gait| {
            let (mapping, arm) = (gait.mapping.name(), gait.arm.name());
            format!("{} has mapping {mapping} and arms {arm}", gait.name)
        };
        let (gait, base) = (kind(&gait), kind(base));
        return Err(PullCostError::OtherKind { gait, base }.into());
    }
    if terms.share == Share::Metre {
        check_advance(world.robot(), &gait)?;
    }
    let unit = terms.aim.objective().unit();
    let costs = PullCosts::new(&world, terms)?;
    let cost = costs.cost_unless(&|| watch.stop(), &gait, Depth::Everything);
    let cost = cost.ok_or(RunError::Stopped)?;
    if let Some(Refusal::NotCubic) = cost.refusal {
        return Err(PullCostError::NotCubic { gait: gait.name }.into());
    }
    let cost = costs.record(&cost);
    Ok(CostOutcome { gait, cost, unit })
}

impl Session {
    pub(super) fn pull_search(
        &self,
        experiment: &PullSearchExperiment,
        watch: &dyn Watch,
    ) -> Result<Done, RunError> {
        self.check_place()?;
        let robot = LoadedRobot::load(experiment.robot.files()?)?;
        let run = PullRun::new(experiment, &robot, &self.program)?;
        let time = experiment.time_budget_s.map(Duration::from_secs_f64);
        self.search(&run, time, watch)
    }

    pub(super) fn cycle_search(
        &self,
        experiment: &CycleSearchExperiment,
        watch: &dyn Watch,
    ) -> Result<Done, RunError> {
        self.check_place()?;
        let robot = LoadedRobot::load(experiment.robot.files()?)?;
        let run = CycleRun::new(experiment, &robot, &self.program, watch)?;
        let time = experiment.time_budget_s.map(Duration::from_secs_f64);
        self.search(&run, time, watch)
    }

    /// Searches, confirms, and puts the result folder in place.
    fn search<R: SearchRun>(
        &self,
        run: &R,
        time: Option<Duration>,
        watch: &dyn Watch,
    ) -> Result<Done, RunError> {
        // What an earlier search has left is not replaced by one that did nothing.
        if watch.stop() {
            return Err(RunError::Stopped);
        }
        let pool = self.pool()?;
        let mut checkpoint = None;
        let mut searches = run::begin(run);
        if let Some(place) = &self.place {
            // A search may be given more than it had.
            let plan = run.plan().without_budget();
            let (snapshot, earlier) =
                Snapshot::open(Work::Search, &place.path, &plan, place.opening)?;
            if let Some(found) = take_up(run, &mut searches, earlier, place.opening)? {
                watch.progress(&Progress::Found(snapshot.path(), found));
            }
            checkpoint = Some(snapshot);
        }
        let kept = checkpoint.as_mut();
        let done = pool.install(|| run::run(run, &mut searches, time, watch, kept));
        let kept = |error| match (error, &checkpoint) {
            (RunError::Stopped, Some(checkpoint)) if checkpoint.path().exists() => {
                RunError::StoppedSearch {
                    checkpoint: checkpoint.path().to_owned(),
                }
            }
            (error, _) => error,
        };
        let done = done.map_err(|error| kept(error.into()))?;
        // It can still go on, from the state in the result folder.
        let published = self.publish(&done.artefacts, watch, || {
            checkpoint.as_ref().map_or(Ok(()), |it| Ok(it.remove()?))
        });
        published.map_err(kept)?;
        Ok(done)
    }
}

/// Takes up what an earlier program has left, and tells what that was.
fn take_up<R: SearchRun>(
    run: &R,
    searches: &mut Vec<Search>,
    earlier: Earlier<Vec<Search>>,
    opening: Opening,
) -> Result<Option<Found>, RunError> {
    let mut kept = match earlier {
        Earlier::State(kept) => kept,
        Earlier::Nothing => return Ok((opening == Opening::Resume).then_some(Found::Nothing)),
        Earlier::Torn => return Ok(Some(Found::Torn)),
        Earlier::Discarded { readable: true } => return Ok(Some(Found::Replaced)),
        Earlier::Discarded { readable: false } => return Ok(Some(Found::ReplacedOther)),
    };
    if kept.len() != searches.len() {
        return Err(RunError::Searches {
            found: kept.len(),
            expected: searches.len(),
        });
    }
    let budget = run.plan().head().budget.unwrap_or(0);
    for search in &mut kept {
        search.allow(budget)?;
    }
    *searches = kept;
    let evaluations = searches.iter().map(Search::evaluations).sum();
    Ok(Some(Found::Evaluations(evaluations)))
}
