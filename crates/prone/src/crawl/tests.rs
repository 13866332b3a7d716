//! The crawler over a robot of numbers: joints that are at once where they are commanded.

mod waypoints;

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::*;
use crate::attitude::ImuReading;
use crate::frames::Transform;
use crate::gait::cycle::{Approach, Cycle, Easing, Pull, Steer, Steering, TimeScale, Waypoint};
use crate::gait::{Curve, LimitsPolicy, PhaseDuration};
use crate::mapping::{ArmMode, MappingVariant};
use crate::port::{InertialUnit, JointCommand, Senses};
use crate::robot::testing::two_armed_by_side;
use crate::robot::{ContactGroup, JointAngles, Robot, Shape, Solid};
use crate::statics::GRAVITY;
use crate::steering::{Bearing, HeadingHold};

const TICK: f64 = 0.0025;
const EVERY: f64 = 0.01;

/// Half a second of pull, and half a second back by way of one waypoint.
fn cycle(name: &str) -> Cycle {
    let approach = Approach {
        seconds: 0.25,
        easing: Easing::Smoothstep,
    };
    Cycle {
        name: name.to_owned(),
        description: String::new(),
        limits: LimitsPolicy::Refuse,
        pull: Some(Pull {
            knee: Curve::constant(0.35).unwrap(),
            hip: Curve::constant(0.35).unwrap(),
            upper_arm: Curve::linear(-0.6, -1.2).unwrap(),
            mapping: MappingVariant::Exact,
            arm: ArmMode::FlatForearm,
            duration: PhaseDuration::new(0.5).unwrap(),
            company: BTreeMap::new(),
            approach,
        }),
        waypoints: vec![Waypoint {
            name: "lift".to_owned(),
            approach,
            joints: BTreeMap::new(),
            turn: BTreeMap::new(),
            shift: BTreeMap::new(),
        }],
        rest: 0.0,
        steering: Some(Steering {
            limit: 0.2,
            shift_limit: 0.0,
            dead_band: 0.0,
            spread: 1.0,
            joints: BTreeMap::new(),
        }),
    }
}

fn set_points() -> Delivery {
    Delivery::SetPoints { every: EVERY }
}

fn program(cycles: &[Cycle], most_cycles: usize, begin: Begin, delivery: Delivery) -> Program {
    Program {
        cycles: cycles.to_vec(),
        scale: TimeScale::ONE,
        most_cycles,
        begin,
        timing: Timing::new(TICK, delivery).unwrap(),
    }
}

/// A made-up robot whose joints are named by side, as errors name them.
fn robot() -> Arc<Robot> {
    let mut robot = two_armed_by_side();
    // It is carried by balls at its toes and elbows.
    let sides = [robot.chain.left.clone(), robot.chain.right.clone()];
    for side in sides {
        let supports = [
            (side.toe, ContactGroup::Toe),
            (side.elbow, ContactGroup::Elbow),
        ];
        for ((body, at), group) in supports {
            robot.bodies[body.0].contact_group = group;
            robot.shapes.push(Shape {
                name: format!("{group}"),
                body,
                link_from_geom: Transform::translation(at.metres()),
                solid: Solid::Sphere { radius: 0.01 },
            });
        }
    }
    Arc::new(robot)
}

fn crawler_of<P: Pilot>(program: Program, pilot: P) -> Crawler<P> {
    let robot = robot();
    let stops = robot.stops();
    Crawler::new(robot, stops, program, pilot).unwrap()
}

fn straight(most_cycles: usize, begin: Begin, delivery: Delivery) -> Crawler<Straight> {
    let program = program(&[cycle("only")], most_cycles, begin, delivery);
    crawler_of(program, Straight::default())
}

const AT_ONCE: Begin = Begin::InExtension { rest: 0.0 };

fn senses(time: f64, angles: &JointAngles) -> Senses {
    Senses {
        time,
        angles: angles.clone(),
        inertial: InertialUnit::Absent,
        bearing: None,
        touch: None,
    }
}

/// What came of a crawl: commands with their times, and events with theirs.
struct Log {
    commands: Vec<(f64, JointCommand)>,
    events: Vec<(f64, Event)>,
}

/// Ticks a crawler to its end; `change` says what is felt otherwise, `true` that a tick is lost.
fn crawl<P: Pilot>(
    crawler: &mut Crawler<P>,
    mut change: impl FnMut(&mut Senses) -> Sensed,
) -> Result<Log, CrawlerError> {
    let mut angles = crawler.cycle().extension().clone();
    let mut log = Log {
        commands: Vec::new(),
        events: Vec::new(),
    };
    for tick in 0..100_000 {
        let time = f64::from(tick) * TICK;
        let mut senses = senses(time, &angles);
        if change(&mut senses) == Sensed::Lost {
            continue;
        }
        let command = crawler.tick(&senses)?;
        log.events
            .extend(crawler.events().iter().map(|event| (time, *event)));
        if let JointCommand::SetPoint(posture) = &command {
            angles = posture.clone();
        }
        if command != JointCommand::Continue {
            log.commands.push((time, command));
        }
        if crawler.ended().is_some() {
            return Ok(log);
        }
    }
    panic!("the crawl has no end");
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sensed {
    Whole,
    Lost,
}

fn whole(_: &mut Senses) -> Sensed {
    Sensed::Whole
}

#[test]
fn phases_and_cycles_follow_one_another() {
    let mut crawler = straight(2, Begin::InExtension { rest: 0.1 }, set_points());
    let log = crawl(&mut crawler, whole).unwrap();
    let close = |a: f64, b: f64| (a - b).abs() < 1e-9;
    let expected = [
        (0.1, Event::CycleBegan),
        (0.6, Event::PhaseEnded(PhaseKind::ClosedChain)),
        (1.1, Event::PhaseEnded(PhaseKind::Waypoints)),
        (1.1, Event::CycleEnded),
        (1.1, Event::CycleBegan),
        (1.6, Event::PhaseEnded(PhaseKind::ClosedChain)),
        (2.1, Event::PhaseEnded(PhaseKind::Waypoints)),
        (2.1, Event::CycleEnded),
        (2.1, Event::Ended(Ended::Cycles)),
    ];
    assert_eq!(log.events.len(), expected.len(), "{:?}", log.events);
    for ((time, event), (expected_time, expected)) in log.events.iter().zip(expected) {
        assert_eq!(*event, expected);
        assert!(close(*time, expected_time), "{event:?} at {time} s");
    }
    assert_eq!(crawler.cycles_done(), 2);
    // It ends where it began, and hands over from there.
    let extension = crawler.cycle().extension().clone();
    assert_eq!(crawler.commanded(), Some(&extension));
    assert_eq!(
        crawler.tick(&senses(9.0, &extension)),
        Ok(JointCommand::Continue)
    );
}

/// Each set-point is the posture that is to be reached when the next one comes.
#[test]
fn set_points_are_those_of_the_planned_pull() {
    let mut crawler = straight(1, AT_ONCE, set_points());
    let log = crawl(&mut crawler, whole).unwrap();
    let checked = crawler.cycle().clone();
    for (index, (time, command)) in log.commands.iter().take(50).enumerate() {
        let reached = (index + 1) as f64 * EVERY;
        assert!((time - (reached - EVERY)).abs() < 1e-9);
        assert_eq!(*command, JointCommand::SetPoint(checked.pull_at(reached)));
    }
    let (_, last) = &log.commands[49];
    assert_eq!(*last, JointCommand::SetPoint(checked.compression().clone()));
}

/// A robot that follows a path by itself is where the set-points would have put it.
#[test]
fn segments_go_where_set_points_go() {
    let points = crawl(&mut straight(2, AT_ONCE, set_points()), whole).unwrap();
    let mut crawler = straight(2, AT_ONCE, Delivery::Segments { every: EVERY });
    let extension = crawler.cycle().extension().clone();
    let segments = crawl(&mut crawler, whole).unwrap();
    assert_eq!(segments.events, points.events);
    assert_eq!(segments.commands.len(), 4, "one a phase");
    let mut from = extension;
    for (began, command) in &segments.commands {
        let JointCommand::Segment(segment) = command else {
            panic!("{command:?}");
        };
        for (time, command) in &points.commands {
            let since = time + EVERY - began;
            let last = segment.knots.last().unwrap().seconds;
            if !(1e-9..last + 1e-9).contains(&since) {
                continue;
            }
            let JointCommand::SetPoint(posture) = command else {
                panic!("{command:?}");
            };
            let there = segment.at(since, &from);
            for (a, b) in there.as_slice().iter().zip(posture.as_slice()) {
                assert!((a - b).abs() < 1e-9, "{a} and {b} rad at {time} s");
            }
        }
        from = segment.knots.last().unwrap().angles.clone();
    }
}

/// Of lost ticks the crawler makes up the time: what it commands is what is due.
#[test]
fn lost_ticks_lose_set_points_and_no_time() {
    let mut crawler = straight(1, AT_ONCE, set_points());
    let mut ticks = 0;
    let log = crawl(&mut crawler, |_| {
        ticks += 1;
        // Every second stretch of 15 ms is lost.
        if ticks / 6 % 2 == 1 {
            Sensed::Lost
        } else {
            Sensed::Whole
        }
    });
    let log = log.unwrap();
    let checked = crawler.cycle().clone();
    let pull = log.commands.iter().take_while(|(time, _)| *time < 0.49);
    let mut seen = 0;
    for (time, command) in pull {
        let due = ((time / EVERY + 1e-9).floor() + 1.0) * EVERY;
        let JointCommand::SetPoint(posture) = command else {
            panic!("{command:?}");
        };
        let planned = checked.pull_at(due);
        for (a, b) in posture.as_slice().iter().zip(planned.as_slice()) {
            assert!((a - b).abs() < 1e-9, "at {time} s");
        }
        seen += 1;
    }
    assert!((20..50).contains(&seen), "{seen} set-points");
    let (end, _) = log.events.last().unwrap();
    assert!((1.0..1.02).contains(end), "{end} s");
}

#[test]
fn a_crawl_stops_after_the_cycle_or_at_once() {
    let stopped_at = |halt: Halt, delivery: Delivery| {
        let mut crawler = straight(9, AT_ONCE, delivery);
        let mut commands = Vec::new();
        for tick in 0..10_000 {
            let time = f64::from(tick) * TICK;
            if tick == 100 {
                crawler.stop(halt);
            }
            let angles = crawler.cycle().extension().clone();
            let command = crawler.tick(&senses(time, &angles)).unwrap();
            commands.push(command);
            if let Some(ended) = crawler.ended() {
                assert_eq!(ended, Ended::Halted(halt));
                return (time, crawler.commanded().unwrap().clone(), commands);
            }
        }
        panic!("it does not stop");
    };
    let reference = straight(1, AT_ONCE, set_points());
    let (time, posture, _) = stopped_at(Halt::AfterCycle, set_points());
    assert!((time - 1.0).abs() < 1e-9, "{time} s");
    assert_eq!(posture, reference.cycle().extension().clone());
    // 0.25 s into the pull, its last set-point is that of 0.25 s.
    for delivery in [set_points(), Delivery::Segments { every: EVERY }] {
        let (time, posture, commands) = stopped_at(Halt::AtOnce, delivery);
        assert!((time - 0.25).abs() < 1e-9, "{time} s");
        let planned = reference.cycle().pull_at(0.25);
        for (a, b) in posture.as_slice().iter().zip(planned.as_slice()) {
            assert!((a - b).abs() < 1e-9, "{delivery:?}");
        }
        let last = commands.last().unwrap();
        assert_eq!(*last, JointCommand::SetPoint(posture), "it is told to hold");
    }
}

/// Nothing has been commanded yet, and nothing is: a posture that sags under load would sink with every
/// attempt.
#[test]
fn a_crawl_that_is_stopped_before_it_begins_ends_at_its_first_tick() {
    for halt in [Halt::AfterCycle, Halt::AtOnce] {
        let mut crawler = straight(2, AT_ONCE, set_points());
        let measured = crawler.cycle().extension().clone();
        crawler.stop(halt);
        let command = crawler.tick(&senses(3.0, &measured)).unwrap();
        assert_eq!(command, JointCommand::Continue);
        assert_eq!(crawler.ended(), Some(Ended::Halted(halt)));
        assert_eq!(crawler.events(), [Event::Ended(Ended::Halted(halt))]);
        assert_eq!(crawler.commanded(), None);
    }
}

/// A path begins where the joints were last sent, which may be anywhere: the robot is first held where
/// it lies, and a rest is a posture, not a path.
#[test]
fn a_lying_robot_is_held_where_it_lies_before_it_goes_along_a_path() {
    let begin = Begin::Lying {
        speed: 0.5,
        rest: 0.2,
    };
    let mut crawler = straight(1, begin, Delivery::Segments { every: 0.05 });
    let lying = JointAngles::zero(&robot());
    let mut commands = Vec::new();
    for tick in 0..10_000 {
        let time = f64::from(tick) * TICK;
        let command = crawler.tick(&senses(time, &lying)).unwrap();
        if command != JointCommand::Continue {
            commands.push((tick, command));
        }
        if crawler.events().contains(&Event::CycleBegan) {
            break;
        }
    }
    let extension = crawler.cycle().extension().clone();
    assert_eq!(commands[0], (0, JointCommand::SetPoint(lying)));
    let (tick, JointCommand::Segment(way)) = &commands[1] else {
        panic!("{commands:?}");
    };
    assert_eq!(*tick, 1);
    assert_eq!(way.knots.last().unwrap().angles, extension);
    assert_eq!(commands[2].1, JointCommand::SetPoint(extension));
    assert_eq!(commands.len(), 4, "hold, way, rest, pull");
}

/// A robot that goes from knot to knot by itself misses no waypoint, however coarse the knots are.
#[test]
fn every_waypoint_is_a_knot() {
    let mut crawler = straight(1, AT_ONCE, Delivery::Segments { every: 0.1 });
    let log = crawl(&mut crawler, whole).unwrap();
    let (_, JointCommand::Segment(recovery)) = &log.commands[1] else {
        panic!("{:?}", log.commands);
    };
    let knots: Vec<f64> = recovery.knots.iter().map(|knot| knot.seconds).collect();
    for (_, end) in crawler.cycle().recovery_ends() {
        assert!(
            knots.iter().any(|at| (at - end).abs() < 1e-12),
            "{end} s in {knots:?}"
        );
    }
    let mut before = 0.0;
    for knot in knots {
        assert!(before < knot && knot <= before + 0.1 + 1e-12);
        before = knot;
    }
}

#[test]
fn a_lying_robot_goes_to_the_extension_within_its_speeds() {
    let speed = 0.5;
    let begin = Begin::Lying { speed, rest: 0.2 };
    let mut crawler = straight(1, begin, set_points());
    let robot = robot();
    let lying = JointAngles::zero(&robot);
    let mut last = lying.clone();
    let mut began = None;
    for tick in 0..10_000 {
        let time = f64::from(tick) * TICK;
        let command = crawler.tick(&senses(time, &lying)).unwrap();
        if crawler.events().contains(&Event::CycleBegan) {
            began = Some(time);
            break;
        }
        if let JointCommand::SetPoint(posture) = command {
            let ways = posture.as_slice().iter().zip(last.as_slice());
            for (joint, (to, from)) in robot.joints.iter().zip(ways) {
                let rate = (to - from).abs() / EVERY;
                assert!(rate <= speed * joint.speed_limit * 1.001, "{}", joint.name);
            }
            last = posture;
        }
    }
    assert!(began.unwrap() > 0.5, "{began:?}");
    assert_eq!(last, crawler.cycle().extension().clone());
}

/// Chooses a cycle by number, and remembers what it felt.
#[derive(Default)]
struct Choosing {
    cycles: Vec<usize>,
    decided: usize,
    felt: usize,
}

impl Pilot for Choosing {
    fn decide(&mut self, _: &Moment<'_>) -> Result<Decision, PilotError> {
        let cycle = self.cycles[self.decided];
        self.decided += 1;
        let steer = Steer::STRAIGHT;
        Ok(Decision { cycle, steer })
    }

    fn feel(&mut self, _: &Moment<'_>) -> Result<(), PilotError> {
        self.felt += 1;
        Ok(())
    }
}

#[test]
fn the_pilot_decides_once_a_cycle_and_feels_every_tick() {
    let program = program(
        &[cycle("one"), cycle("two")],
        3,
        Begin::InExtension { rest: 0.1 },
        set_points(),
    );
    let pilot = Choosing {
        cycles: vec![1, 0, 1],
        ..Choosing::default()
    };
    let mut crawler = crawler_of(program, pilot);
    let mut names = Vec::new();
    let mut angles = crawler.cycle().extension().clone();
    let mut ticks = 0_usize;
    while crawler.ended().is_none() {
        let time = ticks as f64 * TICK;
        if let JointCommand::SetPoint(posture) = crawler.tick(&senses(time, &angles)).unwrap() {
            angles = posture;
        }
        if crawler.events().contains(&Event::CycleBegan) {
            names.push(crawler.cycle().name().to_owned());
        }
        ticks += 1;
    }
    assert_eq!(names, ["one", "two", "one"]);
    assert_eq!(crawler.pilot().decided, 3);
    assert_eq!(crawler.pilot().felt, ticks);
}

#[test]
fn an_error_names_the_cycle_that_it_is_about() {
    let mut broken = cycle("broken");
    broken.pull.as_mut().unwrap().upper_arm = Curve::linear(-0.6, 1.4).unwrap();
    let program = program(&[cycle("good"), broken], 9, AT_ONCE, set_points());
    let pilot = Choosing {
        cycles: vec![0, 1],
        ..Choosing::default()
    };
    let error = crawl(&mut crawler_of(program, pilot), whole).err().unwrap();
    let CrawlerError::Cycle { cycle, gait, .. } = &error else {
        panic!("{error}");
    };
    // The first decision is about the second cycle.
    assert_eq!((*cycle, gait.as_str()), (3, "broken"), "{error}");
    assert!(error.to_string().starts_with("in cycle 3: "), "{error}");
}

#[test]
fn limit_senses_that_are_none() {
    let robot = robot();
    let good = straight(1, AT_ONCE, set_points())
        .cycle()
        .extension()
        .clone();
    let short = JointAngles::from_fn(3, |_| 0.0);
    let mut unknown = good.clone();
    unknown[robot.chain.left.knee] = f64::NAN;
    for (time, angles, said) in [
        (f64::NAN, &good, "says NaN s, which does not follow 0.5 s"),
        (0.4, &good, "says 0.4 s, which does not follow 0.5 s"),
        (0.6, &short, "there are 3 for 14 joints"),
        (0.6, &unknown, "Lknee is at NaN rad"),
    ] {
        let mut crawler = straight(1, AT_ONCE, set_points());
        crawler.tick(&senses(0.5, &good)).unwrap();
        let error = crawler.tick(&senses(time, angles)).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
        assert!(error.contains("cycle 1 (only)"), "{error}");
        // What could not go on does not go on, whatever is felt later.
        let later = crawler.tick(&senses(0.6, &good)).unwrap_err().to_string();
        assert_eq!(later, error);
        assert_eq!(crawler.ended(), None);
    }
}

#[test]
fn limit_a_clock_that_leaps_or_stands_still() {
    let good = straight(1, AT_ONCE, set_points())
        .cycle()
        .extension()
        .clone();
    let mut crawler = straight(1, AT_ONCE, set_points());
    crawler.tick(&senses(0.5, &good)).unwrap();
    crawler.tick(&senses(0.59, &good)).unwrap();
    let error = crawler.tick(&senses(0.7, &good)).unwrap_err();
    assert!(
        matches!(
            error,
            CrawlerError::Felt {
                cycle: 1,
                problem: FeltError::Gap { .. },
                ..
            }
        ),
        "{error}"
    );

    let mut crawler = straight(1, AT_ONCE, set_points());
    let error = (0..1000).find_map(|_| crawler.tick(&senses(0.5, &good)).err());
    assert!(
        matches!(
            error,
            Some(CrawlerError::Felt {
                problem: FeltError::Frozen { ticks: 41, .. },
                ..
            })
        ),
        "{error:?}"
    );
}

/// A small calibration error is cut at the stop; a joint that cannot be where it is measured is an
/// error before anything moves.
#[test]
fn limit_a_beginning_beyond_a_stop() {
    let robot = robot();
    let knee = robot.chain.left.knee;
    let stop = robot.stops()[knee.0];
    let begin = |beyond: f64| {
        let lying = Begin::Lying {
            speed: 0.5,
            rest: 0.0,
        };
        let mut crawler = straight(1, lying, set_points());
        let mut angles = JointAngles::zero(&robot);
        angles[knee] = stop.lower - beyond;
        crawler.tick(&senses(0.0, &angles))
    };
    let JointCommand::SetPoint(first) = begin(0.09).unwrap() else {
        panic!("no set-point");
    };
    assert!(stop.contains(first[knee]), "{} rad", first[knee]);
    let error = begin(0.11).unwrap_err();
    assert!(
        matches!(&error, CrawlerError::BeyondStop { joint, .. } if joint == "Lknee"),
        "{error}"
    );
}

#[test]
fn who_follows_a_line_needs_a_bearing() {
    let hold = || HeadingHold::new(two_armed_by_side().control.steering, 0.2);
    let program = program(&[cycle("only")], 2, AT_ONCE, set_points());
    let error = crawl(&mut crawler_of(program.clone(), hold()), whole).err();
    assert!(
        matches!(
            error,
            Some(CrawlerError::Pilot {
                cycle: 1,
                source: PilotError::NoBearing,
                ..
            })
        ),
        "{error:?}"
    );
    // With one, a robot that is left of its line turns right.
    let mut crawler = crawler_of(program, hold());
    crawl(&mut crawler, |senses| {
        senses.bearing = Some(Bearing {
            y: 0.01,
            ..Bearing::default()
        });
        Sensed::Whole
    })
    .unwrap();
    assert!(crawler.cycle().turn() < 0.0, "{}", crawler.cycle().turn());
}

/// A robot whose trunk is pitched as on a slope, rad, uphill positive.
fn on_slope(robot: &Robot, crawler_pitch: f64, slope: f64, senses: &mut Senses) {
    let level = robot.level_pitch(&senses.angles, crawler_pitch).unwrap();
    // Uphill its front is higher: it is pitched back, about -y.
    let pitch = level - slope;
    let up = DVec3::new(-pitch.sin(), 0.0, pitch.cos());
    senses.inertial = InertialUnit::Reading(ImuReading {
        angular_velocity: DVec3::ZERO,
        specific_force: GRAVITY * up,
    });
}

fn slope_aware(degrees: f64) -> SlopeAware<Straight> {
    SlopeAware::new(Straight::default(), degrees.to_radians())
}

fn two_cycles() -> Program {
    let cycles = [cycle("flat"), cycle("uphill")];
    program(&cycles, 3, Begin::InExtension { rest: 0.3 }, set_points())
}

#[test]
fn the_slope_that_is_felt_has_the_sign_of_the_slope() {
    let robot = robot();
    for slope in [-6.0_f64, 0.0, 6.0] {
        let mut crawler = crawler_of(two_cycles(), slope_aware(3.0));
        let pitch = crawler.cycle().root_pitch();
        crawl(&mut crawler, |senses| {
            on_slope(&robot, pitch, slope.to_radians(), senses);
            Sensed::Whole
        })
        .unwrap();
        for felt in crawler.pilot().felt() {
            // The filter follows the pull's own pitching with its time constant of a second.
            let off = felt.to_degrees() - slope;
            assert!(off.abs() < 3.0, "{off}° on {slope}°");
        }
        assert_eq!(crawler.pilot().felt().len(), 3);
    }
}

/// A unit that fails, is taken away or reads nonsense in the second cycle ends the crawl there, and
/// the error says so.
#[test]
fn a_failing_inertial_unit_is_an_error_and_never_silence() {
    let robot = robot();
    let nonsense = ImuReading {
        angular_velocity: DVec3::new(0.0, f64::NAN, 0.0),
        specific_force: DVec3::new(0.0, 0.0, GRAVITY),
    };
    let failed = InertialUnit::Failed {
        reason: "no answer on bus 1".to_owned(),
    };
    for (bad, said) in [
        (failed, "failed: no answer on bus 1"),
        (InertialUnit::Absent, "no inertial unit"),
        (InertialUnit::Reading(nonsense), "NaN"),
    ] {
        let mut crawler = crawler_of(two_cycles(), slope_aware(45.0));
        let pitch = crawler.cycle().root_pitch();
        let error = crawl(&mut crawler, |senses| {
            on_slope(&robot, pitch, 0.0, senses);
            if senses.time > 1.4 {
                senses.inertial = bad.clone();
            }
            Sensed::Whole
        });
        let error = error.err().unwrap().to_string();
        assert!(error.starts_with("in cycle 2 (flat): "), "{error}");
        assert!(error.contains(said), "{error}");
    }
    // One that is shaken all the time tells no slope, which is said when it is asked for.
    let mut crawler = crawler_of(two_cycles(), slope_aware(45.0));
    let error = crawl(&mut crawler, |senses| {
        senses.inertial = InertialUnit::Reading(ImuReading {
            angular_velocity: DVec3::ZERO,
            specific_force: DVec3::new(0.0, 0.0, 3.0 * GRAVITY),
        });
        Sensed::Whole
    });
    assert!(
        matches!(
            error.as_ref().err(),
            Some(CrawlerError::Pilot {
                source: PilotError::NotFelt,
                ..
            })
        ),
        "{:?}",
        error.err()
    );
}

#[test]
fn limit_beginnings() {
    let robot = robot();
    let refused = |begin: Begin| {
        let program = program(&[cycle("only")], 1, begin, set_points());
        Crawler::new(
            Arc::clone(&robot),
            robot.stops(),
            program,
            Straight::default(),
        )
        .err()
    };
    for speed in [0.0, -0.5, 1.1, f64::NAN] {
        let error = refused(Begin::Lying { speed, rest: 0.0 });
        assert!(
            matches!(error, Some(CrawlerError::BeginSpeed { .. })),
            "{error:?}"
        );
    }
    for rest in [-0.1, 61.0, f64::NAN] {
        let error = refused(Begin::InExtension { rest });
        assert!(
            matches!(error, Some(CrawlerError::Rest { .. })),
            "{error:?}"
        );
    }
    let none = program(&[], 1, AT_ONCE, set_points());
    let error = Crawler::new(Arc::clone(&robot), robot.stops(), none, Straight::default()).err();
    assert!(
        matches!(
            error,
            Some(CrawlerError::NoCycle {
                asked: 0,
                cycles: 0
            })
        ),
        "{error:?}"
    );
}
