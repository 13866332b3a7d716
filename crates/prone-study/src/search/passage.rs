//! Whether a robot gets under a ceiling, with which cycle, and what limits it.

use std::ops::ControlFlow;
use std::sync::Arc;

use prone::gait::cycle::Cycle;
use prone::robot::Robot;
use prone_record::experiment::PassageSearch;
use prone_record::frontier::CycleObjective;
use prone_record::measure::{Heats, Measure};
use prone_record::search::{Search, SearchEnd, Solver};
use prone_sim::LoadedRobot;
use serde::Serialize;

use super::candidates::Searched;
use super::candidates::{Candidates as _, Depth};
use super::cycle_cost::{CycleAim, CycleSearch, Merge};
use super::cycle_jobs::{self, CycleSearchError};
use super::room::too_low;
use super::run::SearchError;
use super::setting::Setting;
use super::settings;
use super::trial::{Trial, try_out};
use crate::watch::{Progress, Watch};
use prone_optim::Threads;

/// An answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Passage {
    /// The robot.
    pub robot: String,
    /// Height of the ceiling above the floor, mm.
    pub ceiling_mm: f64,
    /// Distance that has to stay between robot and ceiling, mm.
    pub margin_mm: f64,
    /// Whether there is a cycle.
    pub feasible: bool,
    /// The fastest one, where there is.
    pub best: Option<Tried>,
    /// Where it comes from: `shipped`, `file` or `searched`.
    pub found_by: Option<String>,
    /// What limits it: the part of the body that comes nearest to the ceiling, or why there is none.
    pub limited_by: String,
    /// Every cycle that was tried.
    pub tried: Vec<Tried>,
    /// Cycles that this robot cannot crawl, with the reason.
    pub refused: Vec<(String, String)>,
}

/// A cycle and what it came to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Tried {
    /// Its name.
    pub gait: String,
    /// Highest point of the robot, mm.
    pub top_mm: f64,
    /// Part of the body that reaches it.
    pub top_part: String,
    /// What is left below the ceiling, mm; negative where it does not fit.
    pub left_mm: f64,
    /// Advance per cycle, mm.
    pub mm_per_cycle: f64,
    /// Speed, mm/s.
    pub mm_per_s: f64,
    /// Largest applied torque over the manufacturer's effort limit.
    pub peak_torque_over_rated: f64,
    /// Name of the joint that reaches it.
    pub peak_joint: String,
}

impl Passage {
    /// Tries cycles, each with where it comes from, under a ceiling, m, with a margin, m; none is
    /// crawled where not even a foot fits, and none after the watch said stop.
    pub fn try_all<'a>(
        robot: &Robot,
        setting: &Setting,
        cycles: impl IntoIterator<Item = (&'a Cycle, &'a str)>,
        ceiling: f64,
        margin: f64,
        watch: &dyn Watch,
    ) -> Self {
        let mut passage = Self {
            robot: robot.name.clone(),
            ceiling_mm: ceiling * 1e3,
            margin_mm: margin * 1e3,
            feasible: false,
            best: None,
            found_by: None,
            limited_by: String::new(),
            tried: Vec::new(),
            refused: Vec::new(),
        };
        if let Some(reason) = too_low(robot, ceiling - margin) {
            passage.limited_by = reason;
            return passage;
        }
        for (cycle, origin) in cycles.into_iter().take_while(|_| !watch.stop()) {
            match try_out(setting, cycle) {
                Ok(trial) => passage.take(Tried::from_trial(cycle, &trial, ceiling), origin),
                Err(error) => {
                    let name = cycle.name.clone();
                    passage.refused.push((name, error.to_string()));
                }
            }
        }
        passage
    }

    /// Takes one more cycle into account.
    pub fn take(&mut self, tried: Tried, found_by: &str) {
        let fits = tried.left_mm >= self.margin_mm && tried.mm_per_cycle > 0.0;
        let faster = self
            .best
            .as_ref()
            .is_none_or(|best| tried.mm_per_s > best.mm_per_s);
        if fits && (faster || !self.feasible) {
            self.feasible = true;
            self.found_by = Some(found_by.to_owned());
            self.best = Some(tried.clone());
            self.limited_by = format!(
                "{}, whose highest point is {:.1} mm below the ceiling",
                tried.top_part, tried.left_mm
            );
        }
        self.tried.push(tried);
        if !self.feasible {
            let lowest = self
                .tried
                .iter()
                .min_by(|a, b| a.top_mm.total_cmp(&b.top_mm));
            self.limited_by = lowest.map_or_else(String::new, |lowest| {
                format!(
                    "the {}: {:.1} mm high in {}, the lowest cycle tried, and {:.1} mm are left",
                    lowest.top_part,
                    lowest.top_mm,
                    lowest.gait,
                    self.ceiling_mm - self.margin_mm
                )
            });
        }
    }

    /// Whether a search may still find one: nothing fits, but the foot does.
    pub fn may_be_searched(&self) -> bool {
        !self.feasible && !self.tried.is_empty()
    }
}

impl Tried {
    /// What a cycle came to under a ceiling, m.
    pub fn from_trial(cycle: &Cycle, trial: &Trial, ceiling: f64) -> Self {
        Self {
            gait: cycle.name.clone(),
            top_mm: trial.top.0 * 1e3,
            top_part: trial.top.1.name().to_owned(),
            left_mm: (ceiling - trial.top.0) * 1e3,
            mm_per_cycle: trial.advance * 1e3,
            mm_per_s: trial.advance / trial.seconds * 1e3,
            peak_torque_over_rated: trial.peak_over_limit.0,
            peak_joint: trial.peak_over_limit.1.clone(),
        }
    }
}

/// What is searched where no cycle fits: about the one that fits best under a height, m.
pub fn candidates(
    robot: &LoadedRobot,
    cycles: &[Cycle],
    height: f64,
) -> Result<CycleSearch, CycleSearchError> {
    let objective = CycleObjective::Advance;
    let settings: Arc<[Setting]> = settings::for_search(objective, robot)?.into();
    let base = cycle_jobs::base(robot, &settings[0], cycles, height)?;
    let aim = CycleAim {
        objective,
        merge: Merge::Mean,
        rules: cycle_jobs::usual_rules(objective, height, base, robot.robot()),
    };
    Ok(CycleSearch::new(robot.robot(), &settings, aim, base)?)
}

impl Passage {
    /// Searches a cycle that fits under the ceiling, and takes it into account. Nothing where the
    /// budget is too small.
    pub fn search(
        &mut self,
        asked: PassageSearch,
        searched: &CycleSearch,
        ceiling_mm: f64,
        watch: &dyn Watch,
    ) -> Result<Option<Cycle>, SearchError> {
        let mut search = Search::new(Solver::AboutTheMiddle, asked.seed, 1, asked.budget);
        let measure = Measure::of_cycles(CycleObjective::Advance, Heats::PerMetre);
        let scorer = Threads(Searched::new(searched));
        let end = search.proceed(&scorer, |search| {
            let best = search.best();
            let broken = best.map_or_else(Vec::new, |(_, it)| scorer.0.broken_by(&it.score));
            watch.progress(&Progress::Searching {
                search,
                measure,
                broken: &broken,
            });
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
        let cost = searched.cost(&cycle, Depth::Everything);
        let ceiling_name = ceiling_mm.to_string().replace('.', "-");
        cycle.name = format!("under-{ceiling_name}-seed-{}", asked.seed);
        let Some(trial) = cost.trials.first() else {
            return Ok(None);
        };
        let tried = Tried::from_trial(&cycle, trial, ceiling_mm * 1e-3);
        self.take(tried, "searched");
        Ok(Some(cycle))
    }
}

#[cfg(test)]
mod tests {
    use prone_files::shipped;
    use prone_sim::{LoadedRobot, RobotFiles};

    use super::*;
    use crate::watch::Unwatched;

    #[test]
    fn reference_the_foot_decides_at_160_mm() {
        let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let settings = settings::for_advance(&robot).unwrap();
        let cycles: Vec<Cycle> = shipped::cycle_names()
            .map(|name| shipped::cycle(name).unwrap().unwrap())
            .collect();
        let under = |mm: f64| {
            let cycles = cycles.iter().map(|cycle| (cycle, "shipped"));
            Passage::try_all(
                robot.robot(),
                &settings[0],
                cycles,
                mm * 1e-3,
                3e-3,
                &Unwatched,
            )
        };
        let low = under(160.0);
        assert!(!low.feasible && !low.may_be_searched());
        assert!(low.limited_by.contains("foot"), "{}", low.limited_by);
        let tight = under(168.0);
        assert!(tight.feasible, "{tight:?}");
        assert!(tight.best.unwrap().left_mm >= 3.0);
        let high = under(178.5);
        assert!(high.best.unwrap().mm_per_cycle > 110.0);
    }
}
