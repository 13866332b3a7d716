//! Searching a cycle for a ceiling under which none passes.

use std::ops::ControlFlow;
use std::sync::Arc;

use prone::gait::cycle::Cycle;
use prone_record::experiment::PassageSearch;
use prone_record::frontier::CycleObjective;
use prone_record::measure::{Heats, Measure};
use prone_record::search::{Search, SearchEnd, Solver};
use prone_sim::LoadedRobot;

use super::super::candidates::{Candidates as _, Watched};
use super::super::cycle_cost::{CycleAim, CycleSearch, Merge};
use super::super::cycle_form::Free;
use super::super::cycle_jobs::{self, CycleSearchError};
use super::super::run::SearchError;
use super::super::setting::Setting;
use super::super::settings;
use crate::watch::Watch;

/// Share of the largest box that is searched: the base is the cycle that fits best.
const REACH: f64 = 0.4;

/// What is searched where no cycle passes: about the one that fits best under a height, m.
///
/// # Errors
/// [`CycleSearchError`] where there is nothing to search about.
pub fn candidates(
    robot: &LoadedRobot,
    cycles: &[Cycle],
    height: f64,
    watch: &dyn Watch,
) -> Result<CycleSearch, CycleSearchError> {
    let objective = CycleObjective::Advance;
    let mut settings = settings::for_search(objective, robot)?;
    settings.extend(settings::searched_corners(robot)?);
    let settings: Arc<[Setting]> = settings.into();
    let base = cycle_jobs::base(robot, &settings[0], cycles, height, watch)?;
    let aim = CycleAim {
        objective,
        merge: Merge::Mean,
        rules: cycle_jobs::usual_rules(objective, height, base, robot.robot()),
    };
    let free = Free {
        reach: REACH,
        turns: false,
    };
    Ok(CycleSearch::new(robot.robot(), &settings, aim, base, free)?)
}

/// Searches a cycle that fits under the ceiling. Nothing where the budget is too small.
///
/// # Errors
/// [`SearchError::Stopped`] where it was stopped.
pub fn search(
    asked: PassageSearch,
    searched: &CycleSearch,
    ceiling_mm: f64,
    watch: &dyn Watch,
) -> Result<Option<Cycle>, SearchError> {
    let mut search = Search::new(Solver::AboutTheMiddle, asked.seed, 1, asked.budget);
    let measure = Measure::of_cycles(CycleObjective::Advance, Heats::PerMetre);
    let scorer = Watched::new(searched, watch);
    let end = search.proceed(&scorer, |search| {
        scorer.tell(search, measure);
        if watch.stop() {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    });
    if end == SearchEnd::Interrupted {
        return Err(SearchError::Stopped);
    }
    let Some((_, best)) = search.best() else {
        return Ok(None);
    };
    let mut cycle = searched.gait(&best.point)?;
    let ceiling_name = ceiling_mm.to_string().replace('.', "-");
    cycle.name = format!("under-{ceiling_name}-seed-{}", asked.seed);
    Ok(Some(cycle))
}
