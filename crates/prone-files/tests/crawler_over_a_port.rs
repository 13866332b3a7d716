//! The crawler drives a robot that is neither simulated nor real: a port that answers late, loses
//! commands and ticks, and whose inertial unit fails. No engine is linked here: the robot is the
//! compiled one.

use std::collections::VecDeque;
use std::sync::Arc;

use glam::DVec3;
use prone::attitude::ImuReading;
use prone::crawl::{
    Begin, Crawler, CrawlerError, Delivery, DriveError, Ended, Event, Halt, Pilot, PilotError,
    Program, SlopeAware, Straight, Timing, Watch, drive,
};
use prone::gait::cycle::TimeScale;
use prone::port::{
    Command, InertialUnit, JointCommand, Limits, Pace, PortError, Sense, Senses, Stop,
};
use prone::robot::{JointAngles, Range, Robot};
use prone::statics::GRAVITY;
use prone::steering::{Bearing, HeadingHold};
use prone_files::compiled_robot::CompiledRobot;
use prone_files::shipped;

/// Period of the port, s, and of its commands.
const TICK: f64 = 0.01;

/// How badly the port behaves.
#[derive(Debug, Clone, Copy, Default)]
struct Faults {
    /// Ticks that a command takes to reach the joints.
    delay: usize,
    /// Every how many commands one is lost; 0 for none.
    lost_command: usize,
    /// Every how many ticks five of them pass unseen; 0 for never.
    lost_ticks: usize,
    /// From when on the inertial unit does not answer, s.
    inertial_fails: Option<f64>,
    /// From when on nothing answers, s.
    link_fails: Option<f64>,
}

/// Joints that follow their set-points with a time constant of two ticks.
struct FakeRobot {
    robot: Arc<Robot>,
    stops: Vec<Range>,
    faults: Faults,
    ticks: usize,
    angles: JointAngles,
    held: JointAngles,
    on_the_way: VecDeque<(usize, JointCommand)>,
    commands: usize,
    waits: usize,
    stopped: usize,
    /// Commands that were on their way when it was stopped.
    late: usize,
}

impl FakeRobot {
    fn new(robot: &Arc<Robot>, at: JointAngles, faults: Faults) -> Self {
        Self {
            stops: robot.stops(),
            robot: Arc::clone(robot),
            faults,
            ticks: 0,
            held: at.clone(),
            angles: at,
            on_the_way: VecDeque::new(),
            commands: 0,
            waits: 0,
            stopped: 0,
            late: 0,
        }
    }

    fn answers(&self) -> Result<(), PortError> {
        match self.faults.link_fails {
            Some(from) if self.time() >= from => Err(PortError::Lost {
                reason: format!("nothing came for {TICK} s"),
            }),
            _ => Ok(()),
        }
    }

    fn one_tick(&mut self) {
        self.ticks += 1;
        while let Some((due, _)) = self.on_the_way.front()
            && *due <= self.ticks
            && let Some((_, command)) = self.on_the_way.pop_front()
        {
            match command {
                JointCommand::SetPoint(angles) => self.held = angles,
                JointCommand::Segment(_) | JointCommand::Continue => {}
            }
        }
        self.angles = self.angles.towards(&self.held, 0.5);
    }
}

impl Sense for FakeRobot {
    fn sense(&mut self) -> Result<Senses, PortError> {
        self.answers()?;
        let fails = self.faults.inertial_fails;
        let inertial = if fails.is_some_and(|from| self.time() >= from) {
            InertialUnit::Failed {
                reason: "checksum".to_owned(),
            }
        } else {
            // A trunk that lies flat on its belly: its front is down.
            InertialUnit::Reading(ImuReading {
                angular_velocity: DVec3::ZERO,
                specific_force: DVec3::NEG_X * GRAVITY,
            })
        };
        Ok(Senses {
            time: self.time(),
            angles: self.angles.clone(),
            inertial,
            bearing: Some(Bearing {
                y: 0.02,
                ..Bearing::default()
            }),
            touch: None,
        })
    }
}

impl Command for FakeRobot {
    fn command(&mut self, command: &JointCommand) -> Result<(), PortError> {
        self.answers()?;
        if *command == JointCommand::Continue {
            return Ok(());
        }
        self.commands += 1;
        let lost = self.faults.lost_command;
        if lost == 0 || !self.commands.is_multiple_of(lost) {
            let due = self.ticks + self.faults.delay;
            self.on_the_way.push_back((due, command.clone()));
        }
        Ok(())
    }
}

impl Pace for FakeRobot {
    fn time(&self) -> f64 {
        self.ticks as f64 * TICK
    }

    fn tick(&self) -> f64 {
        TICK
    }

    fn wait(&mut self) -> Result<(), PortError> {
        self.answers()?;
        self.waits += 1;
        let lost = self.faults.lost_ticks;
        let ticks = if lost > 0 && self.waits.is_multiple_of(lost) {
            6
        } else {
            1
        };
        for _ in 0..ticks {
            self.one_tick();
        }
        Ok(())
    }
}

impl Stop for FakeRobot {
    fn stop(&mut self) -> Result<(), PortError> {
        self.stopped += 1;
        self.late = self.on_the_way.len();
        self.on_the_way.clear();
        Ok(())
    }
}

impl Limits for FakeRobot {
    fn robot(&self) -> &Robot {
        &self.robot
    }

    fn stops(&self) -> &[Range] {
        &self.stops
    }
}

/// What a run came to, tick by tick.
#[derive(Default)]
struct Log {
    events: Vec<(f64, Event)>,
    largest_lag: f64,
    halt_at: Option<(f64, Halt)>,
}

impl<P: Pilot> Watch<FakeRobot, P> for Log {
    fn before(&mut self, _: &FakeRobot, _: &Crawler<P>, senses: &Senses) -> Option<Halt> {
        let (at, halt) = self.halt_at?;
        (senses.time >= at).then_some(halt)
    }

    fn ticked(&mut self, port: &FakeRobot, crawler: &Crawler<P>, command: &JointCommand) {
        let events = crawler.events().iter();
        self.events
            .extend(events.map(|event| (port.time(), *event)));
        if let JointCommand::SetPoint(posture) = command {
            for (joint, (angle, stop)) in posture.as_slice().iter().zip(port.stops()).enumerate() {
                let name = &port.robot().joints[joint].name;
                assert!(stop.contains(*angle), "{name} is sent to {angle} rad");
            }
        }
    }

    fn waited(&mut self, port: &FakeRobot, crawler: &Crawler<P>) {
        if let Some(commanded) = crawler.commanded() {
            let lags = commanded.pairs(&port.angles).map(|(a, b)| (a - b).abs());
            self.largest_lag = lags.fold(self.largest_lag, f64::max);
        }
    }
}

fn nao() -> Arc<Robot> {
    Arc::new(CompiledRobot::shipped(&shipped::NAO).unwrap().into_robot())
}

fn program(most_cycles: usize) -> Program {
    let every = TICK;
    Program {
        cycles: ["hip-10", "thesis-nominal"]
            .map(|name| shipped::cycle(name).unwrap().unwrap())
            .to_vec(),
        scale: TimeScale::ONE,
        most_cycles,
        begin: Begin::Lying {
            speed: 0.5,
            rest: 0.3,
        },
        timing: Timing::new(TICK, Delivery::SetPoints { every }).unwrap(),
    }
}

/// Crawls, from lying with all joints at zero.
fn crawl<P: Pilot>(
    faults: Faults,
    log: &mut Log,
    pilot: P,
) -> (FakeRobot, Crawler<P>, Result<(), DriveError>) {
    let robot = nao();
    let mut crawler = Crawler::new(Arc::clone(&robot), robot.stops(), program(3), pilot).unwrap();
    let mut port = FakeRobot::new(&robot, JointAngles::zero(&robot), faults);
    let driven = drive(&mut port, &mut crawler, log);
    (port, crawler, driven)
}

fn hold_line() -> HeadingHold {
    HeadingHold::new(nao().control.steering, 0.2)
}

#[test]
fn a_port_without_faults_is_crawled_to_the_end() {
    let mut log = Log::default();
    let (port, crawler, driven) = crawl(Faults::default(), &mut log, hold_line());
    driven.unwrap();
    assert_eq!(crawler.ended(), Some(Ended::Cycles));
    assert_eq!(crawler.cycles_done(), 3);
    assert_eq!(port.stopped, 0);
    // It is left of its line all the time, so that it is turned to the right.
    assert!(crawler.cycle().turn() < 0.0);
}

/// Late and lost commands and ticks leave joints behind for a moment, and change neither the order
/// nor the time of what is done.
#[test]
fn delays_and_drops_change_no_plan() {
    let mut clean = Log::default();
    let (_, _, driven) = crawl(Faults::default(), &mut clean, hold_line());
    driven.unwrap();
    for faults in [
        Faults {
            delay: 3,
            ..Faults::default()
        },
        Faults {
            lost_command: 4,
            ..Faults::default()
        },
        Faults {
            lost_ticks: 17,
            ..Faults::default()
        },
        Faults {
            delay: 2,
            lost_command: 7,
            lost_ticks: 31,
            ..Faults::default()
        },
    ] {
        let mut log = Log::default();
        let (port, crawler, driven) = crawl(faults, &mut log, hold_line());
        driven.unwrap();
        assert_eq!(crawler.ended(), Some(Ended::Cycles));
        let kinds = |log: &Log| -> Vec<Event> { log.events.iter().map(|(_, it)| *it).collect() };
        assert_eq!(kinds(&log), kinds(&clean), "{faults:?}");
        let late = log.events.iter().zip(&clean.events);
        for ((time, event), (due, _)) in late {
            // A phase ends with the first tick after its time, and the next begins there: each of
            // the crawl's nine phases may be late by the five ticks that pass unseen.
            let late = time - due;
            assert!(
                (-1e-9..9.0 * 5.0 * TICK).contains(&late),
                "{event:?} {late} s late: {faults:?}"
            );
        }
        assert!(log.largest_lag > clean.largest_lag, "{faults:?}");
        assert_eq!(port.stopped, 0);
    }
}

#[test]
fn a_failing_inertial_unit_stops_the_joints_and_says_so() {
    let slope_aware = || SlopeAware::new(Straight::default(), 0.5);
    let faults = Faults {
        delay: 3,
        inertial_fails: Some(6.0),
        ..Faults::default()
    };
    let (port, _, driven) = crawl(faults, &mut Log::default(), slope_aware());
    let error = driven.unwrap_err();
    let DriveError::Crawler(CrawlerError::Pilot {
        cycle,
        gait,
        source,
    }) = &error
    else {
        panic!("{error}");
    };
    assert!(
        matches!(source, PilotError::InertialUnit { reason } if reason == "checksum"),
        "{source}"
    );
    assert_eq!((*cycle, gait.as_str()), (2, "hip-10"), "{error}");
    assert_eq!(port.stopped, 1);
    // Of what was on its way nothing arrives any more.
    let held = port.held.clone();
    let mut port = port;
    assert!(port.late > 0, "a command was on its way");
    port.one_tick();
    assert_eq!(port.held, held);
    // Whoever does not go by it goes on.
    let (_, _, driven) = crawl(faults, &mut Log::default(), Straight::default());
    driven.unwrap();
}

#[test]
fn a_lost_link_is_an_error_of_its_cycle_and_stop_is_tried() {
    let faults = Faults {
        link_fails: Some(6.0),
        ..Faults::default()
    };
    let (port, _, driven) = crawl(faults, &mut Log::default(), Straight::default());
    let error = driven.unwrap_err().to_string();
    assert_eq!(
        error,
        "cycle 2 (hip-10): the link is lost: nothing came for 0.01 s"
    );
    assert_eq!(port.stopped, 1);
}

/// Time is counted in ticks: a crawler of other ticks than the port's would crawl at another speed.
#[test]
fn a_port_of_other_ticks_is_refused_before_anything_moves() {
    let robot = nao();
    let mut program = program(1);
    program.timing = Timing::new(2.0 * TICK, Delivery::SetPoints { every: 2.0 * TICK }).unwrap();
    let stops = robot.stops();
    let mut crawler =
        Crawler::new(Arc::clone(&robot), stops, program, Straight::default()).unwrap();
    let mut port = FakeRobot::new(&robot, JointAngles::zero(&robot), Faults::default());
    let error = drive(&mut port, &mut crawler, &mut Log::default()).unwrap_err();
    assert!(matches!(error, DriveError::Tick { .. }), "{error}");
    assert_eq!((port.commands, port.waits, port.stopped), (0, 0, 1));
}

/// Whatever comes next goes on from where the crawl has left the joints: here the same robot crawls
/// again.
#[test]
fn a_crawl_is_halted_and_followed_by_another() {
    for halt in [Halt::AfterCycle, Halt::AtOnce] {
        let mut log = Log {
            halt_at: Some((5.0, halt)),
            ..Log::default()
        };
        let (mut port, crawler, driven) = crawl(Faults::default(), &mut log, Straight::default());
        driven.unwrap();
        assert_eq!(crawler.ended(), Some(Ended::Halted(halt)));
        let (end, _) = *log.events.last().unwrap();
        match halt {
            Halt::AtOnce => assert!((end - 5.0).abs() < 1e-9, "{end} s"),
            Halt::AfterCycle => {
                assert!(end > 5.0, "{end} s");
                let extension = crawler.cycle().extension().clone();
                assert_eq!(crawler.commanded(), Some(&extension));
            }
        }
        let robot = nao();
        let stops = robot.stops();
        let mut next = Crawler::new(robot, stops, program(1), Straight::default()).unwrap();
        drive(&mut port, &mut next, &mut Log::default()).unwrap();
        assert_eq!(next.ended(), Some(Ended::Cycles));
    }
}
