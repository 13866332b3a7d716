//! A cycle under a ceiling, in figures.

use std::cmp::Ordering;
use std::f64::consts::FRAC_PI_4;

use prone::motor::Duty;
use prone_sim::crawl::CrawlError;
use serde::Serialize;

use super::super::corners::Corner;
use super::super::trial::Trial;
use super::attempt::Attempt;
use super::{Offered, Under, millimetres};

/// A robot that heads off its line by more has not crawled through but spun out, rad.
const ASKEW: f64 = FRAC_PI_4;

/// A cycle and what it came to under the ceiling.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Candidate {
    /// What `prone crawl run --gait` takes for it.
    pub gait: String,
    /// Where it comes from: `shipped`, `file` or `searched`.
    pub found_by: String,
    /// Whether it gets through with the margin where everything is as in the model.
    pub passes: bool,
    /// Whether it gets through in all corners; nothing where a faster one did, or where it does not
    /// pass.
    pub robust: Option<bool>,
    /// In how many corners, one after the other, it got through.
    pub corners_passed: usize,
    /// The first corner in which it did not.
    pub failed: Option<FailedCorner>,
    /// How long it takes where everything is as in the model, s.
    pub time_s: f64,
    /// Why it does not pass as in the model, where it does not.
    pub obstructed: Option<String>,
    /// Highest point on open ground, mm.
    pub open_top_mm: f64,
    /// Part of the body that reaches it.
    pub open_top_part: String,
    /// Highest point of all its runs, mm.
    pub top_mm: f64,
    /// Part of the body that reaches it.
    pub top_part: String,
    /// What is left below the ceiling there, mm; negative where it does not fit.
    pub margin_mm: f64,
    /// The widest it gets about its own heading where everything is as in the model, mm.
    pub width_mm: f64,
    /// Advance per cycle where everything is as in the model, mm; on open ground where it does not pass, as
    /// speed, verdict and head.
    pub mm_per_cycle: f64,
    /// Least advance per cycle of all its runs, mm.
    pub worst_mm_per_cycle: f64,
    /// Speed where everything is as in the model, mm/s.
    pub mm_per_s: f64,
    /// Whether it can be steered.
    pub steers: bool,
    /// Farthest from the line of the start, mm, at the end of any cycle of all its runs.
    pub drift_mm: f64,
    /// Whether the motors of a robot can do it as everything is in the model, where they are known.
    pub verdict: Option<String>,
    /// The same in the worst of all its runs.
    pub worst_verdict: Option<String>,
    #[serde(skip)]
    worst_duty: Option<Duty>,
    /// Largest mean force on the head over 20 ms, N, where everything is as in the model.
    pub head_n: f64,
    /// Heat per metre of path where everything is as in the model, s/m.
    pub heat_per_metre_s: Option<f64>,
}

/// A corner in which a cycle did not get through.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailedCorner {
    /// Its name.
    pub corner: String,
    /// What it is, in a sentence.
    pub sentence: String,
    /// What happened.
    pub reason: String,
}

impl Candidate {
    /// A cycle by its crawl on open ground and under the plate, as everything is in the model.
    pub(super) fn new(offered: &Offered<'_>, open: &Trial, run: &Attempt, under: Under) -> Self {
        let (top, part) = if run.top.0 < open.top.0 {
            open.top
        } else {
            run.top
        };
        let spare = under.height - top;
        let obstructed = reason(run).or_else(|| {
            (spare < under.margin).then(|| {
                let (part, spare) = (part.name(), spare * 1e3);
                if spare < 0.0 {
                    format!("its {part} comes {:.1} mm above the ceiling", -spare)
                } else {
                    format!("its {part} comes within {spare:.1} mm of the ceiling")
                }
            })
        });
        let passes = obstructed.is_none();
        // What stands before a plate does not crawl: of that the figures are those of open ground.
        let (verdict, advance, speed, head) = if passes {
            let path = run.advance * run.cycles as f64;
            (&run.verdict, run.advance, path / run.seconds, run.head)
        } else {
            (&open.verdict, open.advance, open.speed(), open.head)
        };
        let duty = verdict.as_ref().map(|it| it.duty);
        let verdict = duty.map(|duty| duty.name().to_owned());
        Self {
            gait: offered.called.to_owned(),
            found_by: offered.origin.to_owned(),
            passes,
            robust: None,
            corners_passed: 0,
            failed: None,
            time_s: run.seconds,
            obstructed,
            open_top_mm: millimetres(open.top.0),
            open_top_part: open.top.1.name().to_owned(),
            top_mm: millimetres(top),
            top_part: part.name().to_owned(),
            margin_mm: millimetres(spare),
            width_mm: millimetres(run.width),
            mm_per_cycle: advance * 1e3,
            worst_mm_per_cycle: advance * 1e3,
            mm_per_s: speed * 1e3,
            steers: offered.cycle.steering.is_some(),
            drift_mm: run.drift * 1e3,
            worst_verdict: verdict.clone(),
            verdict,
            worst_duty: duty,
            head_n: head,
            heat_per_metre_s: run.heat_per_metre,
        }
    }

    /// Adds a run in a corner, whatever came of it; an error where it does not get through there.
    pub(super) fn add(
        &mut self,
        corner: Corner,
        run: Result<Attempt, CrawlError>,
        under: Under,
    ) -> Result<(), FailedCorner> {
        let failed = |reason| FailedCorner {
            corner: corner.to_string(),
            sentence: corner.sentence(),
            reason,
        };
        let run = run.map_err(|error| failed(error.to_string()))?;
        if run.top.0 * 1e3 > self.top_mm {
            self.top_mm = millimetres(run.top.0);
            run.top.1.name().clone_into(&mut self.top_part);
            self.margin_mm = millimetres(under.height - run.top.0);
        }
        self.worst_mm_per_cycle = self.worst_mm_per_cycle.min(run.advance * 1e3);
        self.drift_mm = self.drift_mm.max(run.drift * 1e3);
        self.worst_duty = self.worst_duty.max(run.verdict.as_ref().map(|it| it.duty));
        self.worst_verdict = self.worst_duty.map(|duty| duty.name().to_owned());
        reason(&run).map_or(Ok(()), |reason| Err(failed(reason)))
    }

    /// Why it is no robust answer, in words.
    pub(super) fn failure(&self) -> String {
        self.failed.as_ref().map_or_else(
            || "corners that were not tried".to_owned(),
            |failed| format!("{}: {}", failed.corner, failed.reason),
        )
    }

    /// Those that pass first, by the time that they take; then the others by their height.
    pub(super) fn order(&self, other: &Self) -> Ordering {
        let passing = other.passes.cmp(&self.passes);
        let within = if self.passes {
            self.time_s.total_cmp(&other.time_s)
        } else {
            self.open_top_mm.total_cmp(&other.open_top_mm)
        };
        passing.then(within)
    }
}

/// Why a run did not get through, where it did not.
fn reason(run: &Attempt) -> Option<String> {
    if run.passed && run.askew <= ASKEW {
        return None;
    }
    if run.passed {
        return Some(format!(
            "past it, but {:.0}° off its heading",
            run.askew.to_degrees()
        ));
    }
    Some(run.touched.clone().unwrap_or_else(|| {
        format!(
            "not past it after {} cycles, {:.0} mm on",
            run.cycles,
            run.distance * 1e3
        )
    }))
}
