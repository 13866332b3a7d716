//! The crawler.

use std::sync::Arc;

use crate::gait::cycle::{CheckedCycle, Cycle, Easing, TimeScale};
use crate::port::{JointCommand, Senses};
use crate::robot::{JointAngles, Range, Robot};

use super::course::{Course, PhaseKind};
use super::error::CrawlerError;
use super::pilot::{Decision, Moment, Pilot, PilotError, Stage};
use super::planned::{FirstPose, PlanError, Planned};
use super::timing::{Delivery, Timing};

/// What is crawled.
#[derive(Debug, Clone)]
pub struct Program {
    /// The cycles between which the pilot chooses; the first one begins, without a turn.
    pub cycles: Vec<Cycle>,
    /// What all durations are multiplied by.
    pub scale: TimeScale,
    /// After how many cycles it ends.
    pub most_cycles: usize,
    /// How it begins.
    pub begin: Begin,
    /// When the crawler is asked, and in which form it answers.
    pub timing: Timing,
}

/// How a crawl begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Begin {
    /// In the first cycle's extension ([`Crawler::first_pose`]), where it rests first.
    InExtension {
        /// For how long, s.
        rest: f64,
    },
    /// Wherever the joints are when it is first asked: they go to the extension on a straight line
    /// from rest to rest, all at once, and rest there. A joint that is measured beyond its stop
    /// begins at the stop: nothing is commanded beyond. Nothing looks at what is in their way: this is
    /// for a robot that lies on its belly.
    Lying {
        /// Share of each joint's speed limit that is used, above 0, at most 1.
        speed: f64,
        /// For how long it rests, s.
        rest: f64,
    },
}

/// When a crawl that has been asked to stop does so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Halt {
    /// When the cycle is over: the robot is in an extension again.
    AfterCycle,
    /// At the next tick, wherever the joints are then.
    AtOnce,
}

/// Why a crawl has ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ended {
    /// All cycles are done.
    Cycles,
    /// It was asked to.
    Halted(Halt),
}

/// What has come to pass in a tick.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Event {
    /// A cycle has begun: [`Crawler::cycle`].
    CycleBegan,
    /// A phase of it has ended; another one of it, or the cycle's end, follows.
    PhaseEnded(PhaseKind),
    /// The cycle has ended.
    CycleEnded,
    /// The crawl has ended; whatever comes next goes on from [`Crawler::commanded`].
    Ended(Ended),
}

/// Longest rest before the first cycle, s.
const LONGEST_REST: f64 = 60.0;

/// Shortest way to the first posture, s: nothing begins with a jerk.
const SHORTEST_WAY: f64 = 0.5;

/// Turns what is felt into what is commanded, one tick at a time.
#[derive(Debug, Clone)]
pub struct Crawler<P> {
    robot: Arc<Robot>,
    stops: Vec<Range>,
    program: Program,
    /// Who decides.
    pub pilot: P,
    /// The cycle that is crawled, or comes first.
    planned: Arc<Planned>,
    /// The cycle after it, once the pilot has decided.
    next: Option<Arc<Planned>>,
    done: usize,
    doing: Doing,
    last_tick: f64,
    stage: Stage,
    commanded: Option<JointAngles>,
    halt: Option<Halt>,
    events: Vec<Event>,
}

/// What a crawler is about.
#[derive(Debug, Clone)]
enum Doing {
    Nothing,
    /// The way to the first posture.
    Way(Activity),
    /// The rest in it.
    Rest(Activity),
    /// A phase of the cycle, by its place.
    Phase(usize, Activity),
    Ended(Ended),
}

/// A course that is being followed.
#[derive(Debug, Clone)]
struct Activity {
    course: Course,
    began: f64,
    ticks: usize,
    /// Number of the last set-point; of a segment, 0.
    sent: Option<usize>,
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
        let (Begin::InExtension { rest } | Begin::Lying { rest, .. }) = program.begin;
        if !(0.0..=LONGEST_REST).contains(&rest) {
            return Err(CrawlerError::Rest { seconds: rest });
        }
        if let Begin::Lying { speed, .. } = program.begin
            && !(speed > 0.0 && speed <= 1.0)
        {
            return Err(CrawlerError::BeginSpeed { share: speed });
        }
        let first = Decision {
            cycle: 0,
            turn: 0.0,
        };
        let planned = plan(&robot, &stops, &program, first, 1)?;
        Ok(Self {
            robot,
            stops,
            program,
            pilot,
            planned: Arc::new(planned),
            next: None,
            done: 0,
            doing: Doing::Nothing,
            last_tick: 0.0,
            stage: Stage::Recovery,
            commanded: None,
            halt: None,
            events: Vec::new(),
        })
    }

    /// What the joints are to do from now on, by what is felt now.
    ///
    /// The first call begins the crawl. [`Crawler::events`] says what has come to pass.
    ///
    /// # Errors
    /// [`CrawlerError`], naming the cycle and its gait; the crawl cannot go on then.
    pub fn tick(&mut self, senses: &Senses) -> Result<JointCommand, CrawlerError> {
        self.events.clear();
        self.check(senses)?;
        self.feel(senses)?;
        if matches!(self.doing, Doing::Ended(_)) {
            return Ok(JointCommand::Continue);
        }
        if self.halt == Some(Halt::AtOnce) {
            return Ok(self.halt_at_once(senses));
        }
        if matches!(self.doing, Doing::Nothing) {
            self.begin(senses)?;
        }
        while self
            .activity()
            .is_some_and(|it| self.program.timing.ticks(senses.time - it.began) >= it.ticks)
        {
            self.go_on(senses)?;
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
        match &self.doing {
            Doing::Phase(index, it) => {
                let last = index + 1 == PhaseKind::of(&self.planned).len();
                last && self.program.timing.ticks(time - it.began) >= it.ticks
            }
            Doing::Nothing | Doing::Way(_) | Doing::Rest(_) | Doing::Ended(_) => false,
        }
    }

    /// The cycle that is crawled, or comes first.
    pub fn cycle(&self) -> &CheckedCycle {
        &self.planned.checked
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
            Doing::Nothing | Doing::Way(_) | Doing::Rest(_) | Doing::Phase(..) => None,
        }
    }

    /// Where the first cycle begins.
    pub fn first_pose(&self) -> FirstPose {
        self.planned.first_pose()
    }

    /// Number, from 1, and name of the cycle that an error would be about.
    pub fn at(&self) -> (usize, String) {
        (self.done + 1, self.planned.checked.name().to_owned())
    }

    fn check(&self, senses: &Senses) -> Result<(), CrawlerError> {
        let begun = !matches!(self.doing, Doing::Nothing);
        let forwards = senses.time.is_finite() && (!begun || senses.time >= self.last_tick);
        let (cycle, gait) = self.at();
        if !forwards {
            return Err(CrawlerError::Time {
                cycle,
                gait,
                before_s: self.last_tick,
                time_s: senses.time,
            });
        }
        let (angles, joints) = (senses.angles.as_slice(), &self.robot.joints);
        if angles.len() != joints.len() {
            let problem = format!("there are {} for {} joints", angles.len(), joints.len());
            return Err(CrawlerError::Angles {
                cycle,
                gait,
                problem,
            });
        }
        let mut measured = joints.iter().zip(angles);
        match measured.find(|(_, angle)| !angle.is_finite()) {
            None => Ok(()),
            Some((joint, angle)) => Err(CrawlerError::Angles {
                cycle,
                gait,
                problem: format!("{} is at {angle} rad", joint.name),
            }),
        }
    }

    fn feel(&mut self, senses: &Senses) -> Result<(), CrawlerError> {
        let elapsed = match self.doing {
            Doing::Nothing => self.program.timing.snapped(0.0),
            _ => self.program.timing.snapped(senses.time - self.last_tick),
        };
        let begun = !matches!(self.doing, Doing::Nothing);
        if begun && elapsed == 0.0 {
            // The same instant again.
            return Ok(());
        }
        self.last_tick = senses.time;
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
        match self.program.begin {
            Begin::Lying { speed, .. } => {
                let from = senses.angles.map(|joint, angle| {
                    let stop = self.stops[joint.0];
                    angle.clamp(stop.lower, stop.upper)
                });
                let to = self.planned.checked.extension().clone();
                let seconds = way_seconds(&self.robot, &from, &to, speed);
                let course = Course::Way { from, to, seconds };
                self.doing = Doing::Way(self.activity_of(course, senses.time));
                Ok(())
            }
            Begin::InExtension { rest } => self.rest(rest, senses.time),
        }
    }

    fn rest(&mut self, seconds: f64, now: f64) -> Result<(), CrawlerError> {
        if self.program.timing.ticks(seconds) == 0 {
            return self.begin_cycle(now);
        }
        let posture = self.planned.checked.extension().clone();
        let course = Course::Rest { posture, seconds };
        self.doing = Doing::Rest(self.activity_of(course, now));
        Ok(())
    }

    /// From an activity that is over to the next one.
    fn go_on(&mut self, senses: &Senses) -> Result<(), CrawlerError> {
        match self.doing {
            Doing::Way(_) => {
                let (Begin::InExtension { rest } | Begin::Lying { rest, .. }) = self.program.begin;
                self.rest(rest, senses.time)
            }
            Doing::Rest(_) => self.begin_cycle(senses.time),
            Doing::Phase(index, _) => self.end_phase(index, senses),
            Doing::Nothing | Doing::Ended(_) => Ok(()),
        }
    }

    fn end_phase(&mut self, index: usize, senses: &Senses) -> Result<(), CrawlerError> {
        let phases = PhaseKind::of(&self.planned);
        self.events.push(Event::PhaseEnded(phases[index]));
        if index == PhaseKind::deciding(phases) {
            self.decide(senses)?;
        }
        if index + 1 < phases.len() {
            return self.begin_phase(index + 1, senses.time);
        }
        self.done += 1;
        self.events.push(Event::CycleEnded);
        if let Some(next) = self.next.take() {
            self.planned = next;
        }
        self.begin_cycle(senses.time)
    }

    /// The next cycle, or the end.
    fn begin_cycle(&mut self, now: f64) -> Result<(), CrawlerError> {
        if let Some(halt) = self.halt {
            self.end(Ended::Halted(halt));
            return Ok(());
        }
        if self.done >= self.program.most_cycles {
            self.end(Ended::Cycles);
            return Ok(());
        }
        self.events.push(Event::CycleBegan);
        self.begin_phase(0, now)
    }

    fn begin_phase(&mut self, index: usize, now: f64) -> Result<(), CrawlerError> {
        let course = match PhaseKind::of(&self.planned)[index] {
            PhaseKind::ClosedChain => Course::Pull(Arc::clone(&self.planned)),
            PhaseKind::Waypoints => {
                let next = self.next.as_ref().unwrap_or(&self.planned);
                Course::recovery(&self.planned, next).map_err(|source| CrawlerError::Cycle {
                    cycle: self.done + 2,
                    gait: next.checked.name().to_owned(),
                    source: Box::new(source),
                })?
            }
        };
        self.doing = Doing::Phase(index, self.activity_of(course, now));
        Ok(())
    }

    fn decide(&mut self, senses: &Senses) -> Result<(), CrawlerError> {
        let moment = Moment {
            robot: &self.robot,
            senses,
            elapsed: 0.0,
            stage: Stage::Recovery,
        };
        let decision = self.pilot.decide(&moment);
        let decision = decision.map_err(|source| self.pilot_error(source))?;
        let number = self.done + 2;
        let next = plan(&self.robot, &self.stops, &self.program, decision, number)?;
        self.next = Some(Arc::new(next));
        Ok(())
    }

    /// What the activity commands now, if it is anything new.
    fn command(&mut self, now: f64) -> JointCommand {
        let timing = self.program.timing;
        let Some(it) = self.activity_mut() else {
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
                let command = JointCommand::Segment(it.course.segment(every));
                (command, end, stage)
            }
        };
        self.commanded = Some(commanded);
        self.stage = stage;
        command
    }

    /// Holds what was commanded last; in the middle of a path in time, where that has come to.
    fn halt_at_once(&mut self, senses: &Senses) -> JointCommand {
        let posture = match (self.program.timing.delivery(), self.activity()) {
            (Delivery::Segments { .. }, Some(it)) => it.course.posture(senses.time - it.began),
            _ => self
                .commanded
                .clone()
                .unwrap_or_else(|| senses.angles.clone()),
        };
        self.commanded = Some(posture.clone());
        self.end(Ended::Halted(Halt::AtOnce));
        JointCommand::SetPoint(posture)
    }

    fn end(&mut self, ended: Ended) {
        self.doing = Doing::Ended(ended);
        self.stage = Stage::Recovery;
        self.events.push(Event::Ended(ended));
    }

    fn activity_of(&self, course: Course, now: f64) -> Activity {
        Activity {
            ticks: self.program.timing.ticks_of(course.seconds()),
            course,
            began: now,
            sent: None,
        }
    }

    const fn activity(&self) -> Option<&Activity> {
        match &self.doing {
            Doing::Way(it) | Doing::Rest(it) | Doing::Phase(_, it) => Some(it),
            Doing::Nothing | Doing::Ended(_) => None,
        }
    }

    const fn activity_mut(&mut self) -> Option<&mut Activity> {
        match &mut self.doing {
            Doing::Way(it) | Doing::Rest(it) | Doing::Phase(_, it) => Some(it),
            Doing::Nothing | Doing::Ended(_) => None,
        }
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

/// Plans the cycle that was decided for, which is the crawl's `number`th, from 1.
fn plan(
    robot: &Robot,
    stops: &[Range],
    program: &Program,
    decision: Decision,
    number: usize,
) -> Result<Planned, CrawlerError> {
    let cycle = program.cycles.get(decision.cycle);
    let cycle = cycle.ok_or(CrawlerError::NoCycle {
        asked: decision.cycle,
        cycles: program.cycles.len(),
    })?;
    let planned = Planned::new(robot, stops, cycle, decision.turn, program.scale);
    planned.map_err(|error| {
        let gait = cycle.pull.name.clone();
        match error {
            PlanError::Cycle(source) => CrawlerError::Cycle {
                cycle: number,
                gait,
                source,
            },
            PlanError::Mapping(source) => CrawlerError::Mapping {
                cycle: number,
                gait,
                source,
            },
        }
    })
}

/// How long all joints need together, s, where none passes a share of its speed limit.
fn way_seconds(robot: &Robot, from: &JointAngles, to: &JointAngles, speed: f64) -> f64 {
    let times = robot
        .joints
        .iter()
        .zip(from.pairs(to))
        .map(|(joint, (from, to))| {
            Easing::Smoothstep.peak_speed() * (to - from).abs() / (speed * joint.speed_limit)
        });
    times.fold(SHORTEST_WAY, f64::max)
}
