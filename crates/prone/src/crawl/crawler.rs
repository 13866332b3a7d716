//! The crawler.

use std::sync::Arc;

use crate::gait::cycle::{CheckedCycle, Steer};
use crate::port::{JointCommand, Senses};
use crate::robot::{JointAngles, Range, Robot};

use super::course::{Course, PhaseKind};
use super::error::CrawlerError;
use super::felt::Ticks;
use super::pilot::{Decision, Moment, Pilot, PilotError, Stage};
use super::program::{Begin, Ended, Event, Halt, Program};
use super::timing::{Delivery, Timing};
use super::way;

/// Turns what is felt into what is commanded, one tick at a time.
#[derive(Debug, Clone)]
pub struct Crawler<P> {
    robot: Arc<Robot>,
    stops: Vec<Range>,
    program: Program,
    pilot: P,
    /// The cycle that is crawled, or comes first.
    cycle: Arc<CheckedCycle>,
    /// The cycle after it, once the pilot has decided.
    next: Option<Arc<CheckedCycle>>,
    done: usize,
    doing: Doing,
    felt: Ticks,
    stage: Stage,
    commanded: Option<JointAngles>,
    halt: Option<Halt>,
    events: Vec<Event>,
}

/// What a crawler is about.
#[derive(Debug, Clone)]
enum Doing {
    Nothing,
    Following(Activity),
    Ended(Ended),
    Failed(Box<CrawlerError>),
}

/// A course that is being followed.
#[derive(Debug, Clone)]
struct Activity {
    part: Part,
    course: Course,
    began: f64,
    ticks: usize,
    /// Number of the last set-point; of a segment, 0.
    sent: Option<usize>,
}

/// Which part of a crawl a course is.
#[derive(Debug, Clone)]
enum Part {
    /// Being held where the robot lies, for a tick, so that the way begins there; then that way.
    Held(Box<Course>),
    /// The way to the first posture.
    Way,
    /// The rest in it.
    Rest,
    /// A phase of the cycle.
    Phase(PhaseKind),
}

impl<P: Pilot> Crawler<P> {
    /// A crawler of a robot, whose joints are kept within `stops`, rad, one per joint.
    ///
    /// # Errors
    /// [`CrawlerError`] where the first cycle cannot be planned.
    pub fn new(
        robot: Arc<Robot>,
        stops: Vec<Range>,
        program: Program,
        pilot: P,
    ) -> Result<Self, CrawlerError> {
        program.begin.check()?;
        let first = Decision {
            cycle: 0,
            steer: Steer::STRAIGHT,
        };
        let cycle = program.plan(&robot, &stops, first, 1)?;
        Ok(Self {
            robot,
            stops,
            pilot,
            cycle,
            next: None,
            done: 0,
            doing: Doing::Nothing,
            felt: Ticks::new(program.timing),
            program,
            stage: Stage::Recovery,
            commanded: None,
            halt: None,
            events: Vec::new(),
        })
    }

    /// What the joints are to do from now on, by what is felt now.
    ///
    /// The first call begins the crawl. [`Crawler::events`] says what has come to pass. After the end
    /// nothing is felt or commanded any more.
    ///
    /// # Errors
    /// [`CrawlerError`], naming the cycle and its gait. The crawl is over then: every later call
    /// returns the same error.
    pub fn tick(&mut self, senses: &Senses) -> Result<JointCommand, CrawlerError> {
        self.events.clear();
        match &self.doing {
            Doing::Ended(_) => return Ok(JointCommand::Continue),
            Doing::Failed(error) => return Err((**error).clone()),
            Doing::Nothing | Doing::Following(_) => {}
        }
        let ticked = self.go(senses);
        if let Err(error) = &ticked {
            self.doing = Doing::Failed(Box::new(error.clone()));
        }
        ticked
    }

    fn go(&mut self, senses: &Senses) -> Result<JointCommand, CrawlerError> {
        self.feel(senses)?;
        let before = matches!(self.doing, Doing::Nothing);
        match self.halt {
            // Nothing has been commanded: the robot keeps what it was told before.
            Some(halt) if before => {
                self.end(Ended::Halted(halt));
                return Ok(JointCommand::Continue);
            }
            Some(Halt::AtOnce) => return Ok(self.halt_here(senses)),
            Some(Halt::AfterCycle) | None => {}
        }
        if before {
            self.begin(senses)?;
        }
        while let Doing::Following(it) = &self.doing
            && self.is_over(it, senses.time)
        {
            let part = it.part.clone();
            self.go_on(part, senses)?;
        }
        Ok(self.command(senses.time))
    }

    /// Asks the crawl to stop. A stop at once is not taken back by one after the cycle.
    pub fn stop(&mut self, halt: Halt) {
        self.halt = self.halt.max(Some(halt));
    }

    /// What has come to pass in the last tick, in order.
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// Whether a tick at that time, s, would end the cycle that is crawled.
    pub fn cycle_ends_at(&self, time: f64) -> bool {
        let Doing::Following(it) = &self.doing else {
            return false;
        };
        let last = matches!(it.part, Part::Phase(PhaseKind::Waypoints));
        last && self.is_over(it, time)
    }

    fn is_over(&self, it: &Activity, now: f64) -> bool {
        self.program.timing.ticks(now - it.began) >= it.ticks
    }

    /// Who decides.
    pub const fn pilot(&self) -> &P {
        &self.pilot
    }

    /// When it is to be asked, and in which form it answers.
    pub const fn timing(&self) -> Timing {
        self.program.timing
    }

    /// The cycle that is crawled, or comes first.
    pub fn cycle(&self) -> &CheckedCycle {
        &self.cycle
    }

    /// How many cycles are done.
    pub const fn cycles_done(&self) -> usize {
        self.done
    }

    /// What the last set-point is for.
    pub const fn stage(&self) -> Stage {
        self.stage
    }

    /// The last posture that was commanded, rad: where a path in time leads to.
    pub const fn commanded(&self) -> Option<&JointAngles> {
        self.commanded.as_ref()
    }

    /// Why the crawl has ended, where it has.
    pub const fn ended(&self) -> Option<Ended> {
        match self.doing {
            Doing::Ended(ended) => Some(ended),
            Doing::Nothing | Doing::Following(_) | Doing::Failed(_) => None,
        }
    }

    /// Number, from 1, and name of the cycle that an error would be about.
    pub fn at(&self) -> (usize, String) {
        (self.done + 1, self.cycle.name().to_owned())
    }

    fn feel(&mut self, senses: &Senses) -> Result<(), CrawlerError> {
        let elapsed = self.felt.take(&self.robot, senses).map_err(|problem| {
            let (cycle, gait) = self.at();
            CrawlerError::Felt {
                cycle,
                gait,
                problem,
            }
        })?;
        let Some(elapsed) = elapsed else {
            return Ok(());
        };
        let moment = Moment {
            robot: &self.robot,
            senses,
            elapsed,
            stage: self.stage,
        };
        let felt = self.pilot.feel(&moment);
        felt.map_err(|source| self.pilot_error(source))
    }

    fn begin(&mut self, senses: &Senses) -> Result<(), CrawlerError> {
        let now = senses.time;
        let speed = match self.program.begin {
            Begin::InExtension { rest } => return self.rest(rest, senses),
            Begin::Lying { speed, .. } => speed,
        };
        let (measured, to) = (&senses.angles, self.cycle.extension());
        let way = way::plan(&self.robot, &self.stops, measured, to, speed)?;
        match self.program.timing.delivery() {
            Delivery::SetPoints { .. } => self.follow(Part::Way, way, now),
            // A path begins where the joints were last sent, which nobody knows here.
            Delivery::Segments { .. } => {
                let here = Course::Rest {
                    posture: senses.angles.within(&self.stops),
                    seconds: self.program.timing.tick(),
                };
                self.follow(Part::Held(Box::new(way)), here, now);
            }
        }
        Ok(())
    }

    fn rest(&mut self, seconds: f64, senses: &Senses) -> Result<(), CrawlerError> {
        if self.program.timing.ticks(seconds) == 0 {
            return self.begin_cycle(senses);
        }
        let posture = self.cycle.extension().clone();
        self.follow(Part::Rest, Course::Rest { posture, seconds }, senses.time);
        Ok(())
    }

    fn follow(&mut self, part: Part, course: Course, now: f64) {
        self.doing = Doing::Following(Activity {
            part,
            ticks: self.program.timing.ticks_of(course.seconds()),
            course,
            began: now,
            sent: None,
        });
    }

    /// From a part that is over to the next one.
    fn go_on(&mut self, part: Part, senses: &Senses) -> Result<(), CrawlerError> {
        match part {
            Part::Held(way) => {
                self.follow(Part::Way, *way, senses.time);
                Ok(())
            }
            Part::Way => self.rest(self.program.begin.rest(), senses),
            Part::Rest => self.begin_cycle(senses),
            Part::Phase(phase) => self.end_phase(phase, senses),
        }
    }

    fn end_phase(&mut self, phase: PhaseKind, senses: &Senses) -> Result<(), CrawlerError> {
        self.events.push(Event::PhaseEnded(phase));
        match phase {
            PhaseKind::ClosedChain => {
                // The way back leads to what comes next.
                let next = self.decide(senses, self.done + 2)?;
                self.begin_waypoints(&next, self.done + 2, senses.time)?;
                self.next = Some(next);
                Ok(())
            }
            PhaseKind::Waypoints => {
                self.done += 1;
                self.events.push(Event::CycleEnded);
                if let Some(next) = self.next.take() {
                    self.cycle = next;
                }
                self.begin_cycle(senses)
            }
        }
    }

    /// The next cycle, or the end.
    fn begin_cycle(&mut self, senses: &Senses) -> Result<(), CrawlerError> {
        if let Some(halt) = self.halt {
            self.end(Ended::Halted(halt));
            return Ok(());
        }
        if self.done >= self.program.most_cycles {
            self.end(Ended::Cycles);
            return Ok(());
        }
        if self.cycle.pull().is_some() {
            self.events.push(Event::CycleBegan);
            let pull = Course::Pull(Arc::clone(&self.cycle));
            self.follow(Part::Phase(PhaseKind::ClosedChain), pull, senses.time);
            return Ok(());
        }
        let next = self.decide(senses, self.done + 1)?;
        self.begin_waypoints(&next, self.done + 1, senses.time)?;
        self.cycle = next;
        self.events.push(Event::CycleBegan);
        Ok(())
    }

    /// Goes along the waypoints to the extension of `next`, the crawl's `number`th cycle.
    fn begin_waypoints(
        &mut self,
        next: &CheckedCycle,
        number: usize,
        now: f64,
    ) -> Result<(), CrawlerError> {
        let path = next.recovery_after(&self.cycle);
        let path = path.map_err(|source| CrawlerError::Cycle {
            cycle: number,
            gait: next.name().to_owned(),
            source: Box::new(source),
        })?;
        let seconds = next.recovery_seconds();
        let course = Course::Recovery { path, seconds };
        self.follow(Part::Phase(PhaseKind::Waypoints), course, now);
        Ok(())
    }

    /// Plans what the pilot decides for, the crawl's `number`th cycle.
    fn decide(
        &mut self,
        senses: &Senses,
        number: usize,
    ) -> Result<Arc<CheckedCycle>, CrawlerError> {
        let moment = Moment {
            robot: &self.robot,
            senses,
            elapsed: 0.0,
            stage: Stage::Recovery,
        };
        let decision = self.pilot.decide(&moment);
        let decision = decision.map_err(|source| self.pilot_error(source))?;
        self.program
            .plan(&self.robot, &self.stops, decision, number)
    }

    /// What the activity commands now, if it is anything new.
    fn command(&mut self, now: f64) -> JointCommand {
        let timing = self.program.timing;
        let Doing::Following(it) = &mut self.doing else {
            return JointCommand::Continue;
        };
        let tick = timing.ticks(now - it.began);
        let (command, commanded, stage) = match timing.delivery() {
            Delivery::SetPoints { every } => {
                let (number, time) = timing.set_point(every, tick);
                if it.sent == Some(number) {
                    return JointCommand::Continue;
                }
                it.sent = Some(number);
                let posture = it.course.posture(time);
                let command = JointCommand::SetPoint(posture.clone());
                (command, posture, it.course.stage(time))
            }
            Delivery::Segments { every } => {
                let stage = it.course.stage(now - it.began);
                let sent = it.sent.replace(0).is_some();
                if sent {
                    self.stage = stage;
                    return JointCommand::Continue;
                }
                let end = it.course.posture(it.course.seconds());
                (it.course.whole(every), end, stage)
            }
        };
        self.commanded = Some(commanded);
        self.stage = stage;
        command
    }

    /// Holds what was commanded last; in the middle of a path in time, where that has come to.
    fn halt_here(&mut self, senses: &Senses) -> JointCommand {
        let posture = match (self.program.timing.delivery(), &self.doing) {
            (Delivery::Segments { .. }, Doing::Following(it)) => {
                Some(it.course.posture(senses.time - it.began))
            }
            _ => self.commanded.clone(),
        };
        self.commanded.clone_from(&posture);
        self.end(Ended::Halted(Halt::AtOnce));
        posture.map_or(JointCommand::Continue, JointCommand::SetPoint)
    }

    fn end(&mut self, ended: Ended) {
        self.doing = Doing::Ended(ended);
        self.stage = Stage::Recovery;
        self.events.push(Event::Ended(ended));
    }

    fn pilot_error(&self, source: PilotError) -> CrawlerError {
        let (cycle, gait) = self.at();
        CrawlerError::Pilot {
            cycle,
            gait,
            source,
        }
    }
}
