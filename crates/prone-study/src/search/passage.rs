//! Whether a robot gets under a ceiling, with which cycle, and what limits it.
//!
//! Every cycle is crawled under a plate of the ceiling's height, from before it until the robot has come
//! out behind it, with its heading held where it can be steered, first as everything is in the model.
//! Those that get through without touching anything,
//! and stay below the ceiling by the margin, go, the fastest first, through all of the
//! [`corners`] under the same plate, where they have to get through too; a cycle stops at
//! the first in which it does not. The answer is the first one that gets through all of them, and where
//! none does the fastest that passes as things are in the model, called that.
//!
//! That nothing at all can pass is said only where the shapes of the robot prove it (`too_low`).

mod attempt;
mod candidate;
mod search;

pub use candidate::{Candidate, FailedCorner};
pub use search::{candidates, search};

use prone::crawl::CrawlerError;
use prone::gait::cycle::Cycle;
use prone::scene::Scene;
use prone_files::names::UnknownName;
use prone_sim::LoadedRobot;
use prone_sim::crawl::CrawlError;
use rayon::prelude::*;
use serde::Serialize;

use super::corners::{self, Asked, Corner};
use super::room::too_low;
use super::setting::{HOLDS, Role, Setting};
use super::settings::{self, SettingError};
use super::trial::try_out_unless;
use crate::watch::{Progress, Watch};
use attempt::{Attempt, attempt};

/// An answer.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Passage {
    /// The robot.
    pub robot: String,
    /// Height of the ceiling above the floor, mm.
    pub ceiling_mm: f64,
    /// How long the plate is, m.
    pub length_m: f64,
    /// Distance that was asked to stay between robot and ceiling, mm, where everything is as in the
    /// model.
    pub asked_margin_mm: f64,
    /// Whether some cycle gets through where everything is as in the model.
    pub feasible: bool,
    /// Whether [`Self::gait`] gets through in all corners too.
    pub robust: bool,
    /// Whether the shapes of the robot prove that nothing can pass.
    pub impossible: bool,
    /// The cycle to crawl with: what `prone crawl run --gait` takes.
    pub gait: Option<String>,
    /// Where it comes from: `shipped`, `file` or `searched`.
    pub found_by: Option<String>,
    /// How long it takes from before the plate to behind it, s.
    pub time_s: Option<f64>,
    /// Least distance between robot and ceiling, mm, over all runs of it.
    pub margin_mm: Option<f64>,
    /// Whether it can be steered.
    pub steers: Option<bool>,
    /// Farthest from the line of the start, mm, at the end of any cycle of all its runs.
    pub drift_mm: Option<f64>,
    /// Whether the motors of a robot can do it as everything is in the model: `continuous`, `limited`, `not
    /// on a robot`.
    pub verdict: Option<String>,
    /// The same in the worst of all its runs.
    pub worst_verdict: Option<String>,
    /// What limits it: the part of the body that comes nearest to the ceiling, or why there is none.
    pub limited_by: String,
    /// How many corners there are.
    pub corners: usize,
    /// Every cycle that was tried, those that pass first, by the time that they take.
    pub candidates: Vec<Candidate>,
    /// Cycles that this robot cannot crawl, with the reason.
    pub refused: Vec<(String, String)>,
}

/// A cycle, and where it comes from.
#[derive(Debug, Clone, Copy)]
pub struct Offered<'a> {
    /// The cycle.
    pub cycle: &'a Cycle,
    /// What `prone crawl run --gait` takes for it.
    pub called: &'a str,
    /// `shipped`, `file` or `searched`.
    pub origin: &'a str,
}

/// A ceiling over some length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Under {
    /// Its height above the floor, m.
    pub height: f64,
    /// Its length, m.
    pub length: f64,
    /// Distance that has to stay between robot and ceiling where everything is as in the model, m.
    pub margin: f64,
}

/// The settings of a passage: a plate in each.
#[derive(Debug)]
pub struct Plates {
    under: Under,
    /// On open ground, as everything is in the model.
    open: Setting,
    /// The same before the plate.
    ideal: Setting,
    corners: Vec<(Corner, Setting)>,
}

impl Plates {
    /// Puts a robot before plates.
    ///
    /// # Errors
    /// [`SettingError`] where the engine refuses a model.
    pub fn new(robot: &LoadedRobot, under: Under) -> Result<Self, SettingError> {
        let scene = Scene::under_plate(under.height, under.length);
        let asked = Asked {
            cycles: 1,
            role: Role::Keep(HOLDS),
        };
        let each = corners::all().zip(corners::settings(robot, &scene, corners::all(), asked)?);
        Ok(Self {
            under,
            open: settings::as_it_is(robot, Scene::level())?,
            ideal: settings::held(robot, scene)?,
            corners: each.collect(),
        })
    }

    /// Where the last point of the robot has to have passed, m.
    fn end(&self) -> f64 {
        Scene::CLEAR_START + self.under.length
    }
}

impl Passage {
    /// Tries cycles under a ceiling on the current rayon pool. None is crawled where the shapes prove that
    /// nothing passes; none after the watch said stop.
    pub fn answer(plates: &Plates, offered: &[Offered<'_>], watch: &dyn Watch) -> Self {
        let robot = plates.ideal.world.robot();
        let under = plates.under;
        let mut passage = Self {
            robot: robot.name.clone(),
            ceiling_mm: millimetres(under.height),
            length_m: under.length,
            asked_margin_mm: millimetres(under.margin),
            feasible: false,
            robust: false,
            impossible: false,
            gait: None,
            found_by: None,
            time_s: None,
            margin_mm: None,
            steers: None,
            drift_mm: None,
            verdict: None,
            worst_verdict: None,
            limited_by: String::new(),
            corners: plates.corners.len(),
            candidates: Vec::new(),
            refused: Vec::new(),
        };
        if let Some(reason) = too_low(robot, under.height) {
            passage.impossible = true;
            passage.limited_by = reason;
            return passage;
        }
        passage.take(plates, offered, watch);
        passage
    }

    /// Takes more cycles into account.
    pub fn take(&mut self, plates: &Plates, offered: &[Offered<'_>], watch: &dyn Watch) {
        watch.progress(&Progress::Simulating(offered.len()));
        let ideal: Vec<_> = offered
            .par_iter()
            .map(|it| (it, ideal(plates, it, watch)))
            .collect();
        let mut passing = Vec::new();
        for (offered, tried) in ideal {
            match tried {
                Ok((candidate, run)) => {
                    passing.extend(candidate.passes.then_some((offered, run.seconds)));
                    self.candidates.push(candidate);
                }
                Err(reason) => self.refused.push((offered.called.to_owned(), reason)),
            }
        }
        passing.sort_by(|(_, a), (_, b)| a.total_cmp(b));
        for (offered, _) in passing {
            if self.robust || watch.stop() {
                break;
            }
            let name = offered.called;
            let Some(candidate) = self.candidates.iter_mut().find(|it| it.gait == name) else {
                continue;
            };
            through_corners(plates, offered.cycle, candidate, watch);
            if candidate.robust == Some(true) {
                self.robust = true;
            }
        }
        self.candidates.sort_by(Candidate::order);
        self.conclude();
    }

    /// Names the answer among the candidates.
    fn conclude(&mut self) {
        let robust = self.candidates.iter().find(|it| it.robust == Some(true));
        let named = robust.or_else(|| self.candidates.iter().find(|it| it.passes));
        self.feasible = named.is_some();
        self.robust = robust.is_some();
        let Some(named) = named else {
            self.limited_by = self.nothing_found();
            return;
        };
        self.limited_by = if self.robust {
            format!(
                "the {}, {:.1} mm below the ceiling at the closest",
                named.top_part, named.margin_mm
            )
        } else {
            named.failure()
        };
        self.gait = Some(named.gait.clone());
        self.found_by = Some(named.found_by.clone());
        self.time_s = Some(named.time_s);
        self.margin_mm = Some(named.margin_mm);
        self.steers = Some(named.steers);
        self.drift_mm = Some(named.drift_mm);
        self.verdict.clone_from(&named.verdict);
        self.worst_verdict.clone_from(&named.worst_verdict);
    }

    /// The cycle of the answer, in figures.
    pub fn named(&self) -> Option<&Candidate> {
        let gait = self.gait.as_ref()?;
        self.candidates.iter().find(|it| it.gait == *gait)
    }

    fn nothing_found(&self) -> String {
        let lowest = self.candidates.iter();
        let lowest = lowest.min_by(|a, b| a.open_top_mm.total_cmp(&b.open_top_mm));
        lowest.map_or_else(
            || "cycles that the robot cannot crawl".to_owned(),
            |lowest| {
                let fits = self.ceiling_mm - lowest.open_top_mm >= self.asked_margin_mm;
                if let (true, Some(reason)) = (fits, &lowest.obstructed) {
                    return format!("{reason} in {}, the lowest cycle tried", lowest.gait);
                }
                format!(
                    "the {}: {:.1} mm high in {}, the lowest cycle tried, and {:.1} mm are left",
                    lowest.open_top_part,
                    lowest.open_top_mm,
                    lowest.gait,
                    self.ceiling_mm - self.asked_margin_mm
                )
            },
        )
    }

    /// Whether a search may still find one: nothing passes, and nothing proves that nothing can.
    pub const fn may_be_searched(&self) -> bool {
        !self.feasible && !self.impossible
    }
}

/// Crawls a cycle on open ground, for its height, and under the plate as everything is in the model.
fn ideal(
    plates: &Plates,
    offered: &Offered<'_>,
    watch: &dyn Watch,
) -> Result<(Candidate, Attempt), String> {
    let (cycle, under) = (offered.cycle, plates.under);
    let stopped = || watch.stop();
    let trial = try_out_unless(&stopped, &plates.open, cycle).map_err(|error| reason(&error))?;
    let run = attempt(&plates.ideal, cycle, plates.end(), &stopped);
    let run = run.map_err(|error| reason(&error))?;
    watch.progress(&Progress::Done(1));
    let candidate = Candidate::new(offered, &trial, &run, under);
    Ok((candidate, run))
}

/// Crawls a cycle through the corners, so many at once as there are threads, until it fails in one.
fn through_corners(plates: &Plates, cycle: &Cycle, candidate: &mut Candidate, watch: &dyn Watch) {
    watch.progress(&Progress::Simulating(plates.corners.len()));
    let stopped = || watch.stop();
    let mut got_through = 0;
    for some in plates.corners.chunks(rayon::current_num_threads().max(1)) {
        let runs: Vec<_> = some
            .par_iter()
            .map(|(_, setting)| {
                let run = attempt(setting, cycle, plates.end(), &stopped);
                watch.progress(&Progress::Done(1));
                run
            })
            .collect();
        // What comes after the first that fails is not looked at, so that the number of threads does
        // not matter.
        for ((corner, _), run) in some.iter().zip(runs) {
            if watch.stop() {
                return;
            }
            if let Err(failed) = candidate.add(*corner, run, plates.under) {
                candidate.failed = Some(failed);
                candidate.robust = Some(false);
                candidate.corners_passed = got_through;
                return;
            }
            got_through += 1;
        }
    }
    candidate.robust = Some(true);
    candidate.corners_passed = got_through;
}

/// Why a cycle cannot be crawled, with the joint that may have been meant.
fn reason(error: &CrawlError) -> String {
    let hint = match error {
        CrawlError::Crawler(CrawlerError::Cycle { source, .. }) => {
            UnknownName::hint_for_cycle(source)
        }
        _ => String::new(),
    };
    format!("{error}{hint}")
}

/// A length in mm, to the micrometre: what was typed comes back as it was typed.
fn millimetres(metres: f64) -> f64 {
    (metres * 1e6).round() / 1e3
}

#[cfg(test)]
mod tests;
