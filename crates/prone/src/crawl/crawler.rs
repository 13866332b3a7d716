//! The crawler.

use std::sync::Arc;

use crate::gait::cycle::{CheckedCycle, Easing};
use crate::port::{JointCommand, Senses};
use crate::robot::{JointAngles, Range, Robot};

use super::course::{Course, PhaseKind};
use super::error::CrawlerError;
use super::pilot::{Decision, Moment, Pilot, PilotError, Stage};
use super::planned::{FirstPose, PlanError, Planned};
use super::program::{Begin, Ended, Event, Halt, Program};
use super::timing::{Delivery, Timing};

/// How many ticks in a row may always come at one instant: a backend may repeat its last message.
/// More may, as long as they last no longer than a gap may.
const FEW_FROZEN: usize = 10;

/// Shortest way to the first posture, s: nothing begins with a jerk.
const SHORTEST_WAY: f64 = 0.5;

/// Turns what is felt into what is commanded, one tick at a time.
#[derive(Debug, Clone)]
pub struct Crawler<P> {
    robot: Arc<Robot>,
    stops: Vec<Range>,
    program: Program,
    pilot: P,
    /// The cycle that is crawled, or comes first.
    planned: Arc<Planned>,
    /// The cycle after it, once the pilot has decided.
    next: Option<Arc<Planned>>,
    done: usize,
    doing: Doing,
    last_tick: f64,
    /// Ticks in a row that came at one instant.
    frozen: usize,
    stage: Stage,
    commanded: Option<JointAngles>,
    halt: Option<Halt>,
    events: Vec<Event>,
}

/// What a crawler is about.
#[derive(Debug, Clone)]
enum Doing {
    Nothing,
    /// Being held where the robot lies, for a tick, so that the way begins there; then that way.
    Held(Activity, Box<Course>),
    /// The way to the first posture.
    Way(Activity),
    /// The rest in it.
    Rest(Activity),
    /// A phase of the cycle, by its place.
    Phase(usize, Activity),
    Ended(Ended),
    Failed(Box<CrawlerError>),
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
        program.begin.check()?;
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
            frozen: 0,
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
            Doing::Nothing
            | Doing::Held(..)
            | Doing::Way(_)
            | Doing::Rest(_)
            | Doing::Phase(..) => {}
        }
        let ticked = self.go(senses);
        if let Err(error) = &ticked {
            self.doing = Doing::Failed(Box::new(error.clone()));
        }
        ticked
    }

    fn go(&mut self, senses: &Senses) -> Result<JointCommand, CrawlerError> {
        self.check(senses)?;
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
            Doing::Nothing
            | Doing::Held(..)
            | Doing::Way(_)
            | Doing::Rest(_)
            | Doing::Ended(_)
            | Doing::Failed(_) => false,
        }
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
            Doing::Nothing
            | Doing::Held(..)
            | Doing::Way(_)
            | Doing::Rest(_)
            | Doing::Phase(..)
            | Doing::Failed(_) => None,
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
            return self.same_instant(senses.time);
        }
        let longest_s = self.program.timing.longest_gap();
        if elapsed > longest_s {
            let (cycle, gait) = self.at();
            return Err(CrawlerError::Gap {
                cycle,
                gait,
                seconds: elapsed,
                longest_s,
            });
        }
        self.frozen = 0;
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

    /// A clock may stand still for a moment, as a pause does, but not for ever.
    fn same_instant(&mut self, time_s: f64) -> Result<(), CrawlerError> {
        self.frozen += 1;
        let lasts = self.frozen as f64 * self.program.timing.tick();
        if self.frozen <= FEW_FROZEN || lasts <= self.program.timing.longest_gap() {
            return Ok(());
        }
        let (cycle, gait) = self.at();
        Err(CrawlerError::Frozen {
            cycle,
            gait,
            time_s,
            ticks: self.frozen,
        })
    }

    fn begin(&mut self, senses: &Senses) -> Result<(), CrawlerError> {
        match self.program.begin {
            Begin::Lying { speed, .. } => {
                self.check_stops(&senses.angles)?;
                let to = self.planned.checked.extension().clone();
                let seconds = way_seconds(&self.robot, &senses.angles, &to, speed);
                let from = self.within_stops(&senses.angles);
                let way = Course::Way {
                    from: from.clone(),
                    to,
                    seconds,
                };
                let now = senses.time;
                self.doing = match self.program.timing.delivery() {
                    Delivery::SetPoints { .. } => Doing::Way(self.activity_of(way, now)),
                    // A path begins where the joints were last sent, which nobody knows here.
                    Delivery::Segments { .. } => {
                        let here = Course::Rest {
                            posture: from,
                            seconds: self.program.timing.tick(),
                        };
                        Doing::Held(self.activity_of(here, now), Box::new(way))
                    }
                };
                Ok(())
            }
            Begin::InExtension { rest } => self.rest(rest, senses.time),
        }
    }

    /// No joint may be measured so far beyond its stop that it cannot be there.
    fn check_stops(&self, measured: &JointAngles) -> Result<(), CrawlerError> {
        let mut joints = self
            .robot
            .joints
            .iter()
            .zip(&self.stops)
            .zip(measured.as_slice());
        let beyond =
            joints.find(|((_, stop), angle)| stop.excess(**angle).abs() > Begin::BEYOND_STOP);
        match beyond {
            None => Ok(()),
            Some(((joint, stop), angle)) => Err(CrawlerError::BeyondStop {
                joint: joint.name.clone(),
                angle: *angle,
                lower: stop.lower,
                upper: stop.upper,
                most: Begin::BEYOND_STOP,
            }),
        }
    }

    fn within_stops(&self, angles: &JointAngles) -> JointAngles {
        angles.map(|joint, angle| {
            let stop = self.stops[joint.0];
            angle.clamp(stop.lower, stop.upper)
        })
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
        match &self.doing {
            Doing::Held(_, way) => {
                let way = (**way).clone();
                self.doing = Doing::Way(self.activity_of(way, senses.time));
                Ok(())
            }
            Doing::Way(_) => self.rest(self.program.begin.rest(), senses.time),
            Doing::Rest(_) => self.begin_cycle(senses.time),
            Doing::Phase(index, _) => self.end_phase(*index, senses),
            Doing::Nothing | Doing::Ended(_) | Doing::Failed(_) => Ok(()),
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
                (it.course.whole(every), end, stage)
            }
        };
        self.commanded = Some(commanded);
        self.stage = stage;
        command
    }

    /// Holds what was commanded last; in the middle of a path in time, where that has come to.
    fn halt_here(&mut self, senses: &Senses) -> JointCommand {
        let posture = match (self.program.timing.delivery(), self.activity()) {
            (Delivery::Segments { .. }, Some(it)) => {
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
            Doing::Held(it, _) | Doing::Way(it) | Doing::Rest(it) | Doing::Phase(_, it) => Some(it),
            Doing::Nothing | Doing::Ended(_) | Doing::Failed(_) => None,
        }
    }

    const fn activity_mut(&mut self) -> Option<&mut Activity> {
        match &mut self.doing {
            Doing::Held(it, _) | Doing::Way(it) | Doing::Rest(it) | Doing::Phase(_, it) => Some(it),
            Doing::Nothing | Doing::Ended(_) | Doing::Failed(_) => None,
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
