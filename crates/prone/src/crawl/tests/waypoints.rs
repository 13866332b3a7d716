//! Cycles of waypoints alone: they begin where the one before has left the robot, and the pilot decides
//! about each when it begins.

use super::*;

/// Half a second to one side and half a second back; the last waypoint can be turned.
fn round(name: &str) -> Cycle {
    let waypoint = |name: &str, angle: f64| Waypoint {
        name: name.to_owned(),
        approach: Approach {
            seconds: 0.5,
            easing: Easing::Smoothstep,
        },
        joints: BTreeMap::from([("Lshoulder".to_owned(), angle)]),
        turn: BTreeMap::from([("Lshoulder".to_owned(), 1.0)]),
        shift: BTreeMap::from([("Lshoulder".to_owned(), 1.0)]),
    };
    Cycle {
        pull: None,
        waypoints: vec![waypoint("reach", 0.5), waypoint("push", -0.4)],
        steering: Some(Steering {
            limit: 0.2,
            shift_limit: 0.1,
            dead_band: 0.0,
            spread: 0.0,
            joints: BTreeMap::new(),
        }),
        ..cycle(name)
    }
}

fn rounds(most_cycles: usize, begin: Begin, delivery: Delivery) -> Crawler<Straight> {
    let program = program(&[round("round")], most_cycles, begin, delivery);
    crawler_of(program, Straight::default())
}

#[test]
fn a_cycle_without_a_pull_is_one_phase() {
    let mut crawler = rounds(2, Begin::InExtension { rest: 0.1 }, set_points());
    let log = crawl(&mut crawler, whole).unwrap();
    let expected = [
        (0.1, Event::CycleBegan),
        (1.1, Event::PhaseEnded(PhaseKind::Waypoints)),
        (1.1, Event::CycleEnded),
        (1.1, Event::CycleBegan),
        (2.1, Event::PhaseEnded(PhaseKind::Waypoints)),
        (2.1, Event::CycleEnded),
        (2.1, Event::Ended(Ended::Cycles)),
    ];
    assert_eq!(log.events.len(), expected.len(), "{:?}", log.events);
    for ((time, event), (expected_time, expected)) in log.events.iter().zip(expected) {
        assert_eq!(*event, expected);
        assert!((time - expected_time).abs() < 1e-9, "{event:?} at {time} s");
    }
    assert_eq!(crawler.cycles_done(), 2);
    assert_eq!(crawler.commanded(), Some(crawler.cycle().extension()));
}

/// Each set-point is the posture that is to be reached when the next one comes, also over a waypoint.
#[test]
fn set_points_are_those_of_the_way_along_the_waypoints() {
    let mut crawler = rounds(1, AT_ONCE, set_points());
    let checked = crawler.cycle().clone();
    let path = checked.recovery_after(&checked).unwrap();
    let log = crawl(&mut crawler, whole).unwrap();
    assert_eq!(log.commands.len(), 100);
    for (index, (time, command)) in log.commands.iter().enumerate() {
        let reached = (index + 1) as f64 * EVERY;
        assert!((time - (reached - EVERY)).abs() < 1e-9);
        let JointCommand::SetPoint(posture) = command else {
            panic!("{command:?}");
        };
        for (a, b) in posture.pairs(&path.at(reached)) {
            assert!((a - b).abs() < 1e-12, "{a} and {b} rad at {time} s");
        }
    }
    let (_, last) = log.commands.last().unwrap();
    assert_eq!(*last, JointCommand::SetPoint(checked.extension().clone()));
}

/// A path in time is one a cycle, with a knot at each waypoint.
#[test]
fn a_cycle_is_one_path_in_time() {
    let mut crawler = rounds(2, AT_ONCE, Delivery::Segments { every: 0.1 });
    let log = crawl(&mut crawler, whole).unwrap();
    let times: Vec<f64> = log.commands.iter().map(|(time, _)| *time).collect();
    assert_eq!(times.len(), 2, "{times:?}");
    let reach = robot().joint("Lshoulder").unwrap();
    for (_, command) in &log.commands {
        let JointCommand::Segment(segment) = command else {
            panic!("{command:?}");
        };
        let knots = segment.knots.iter();
        let knots: Vec<f64> = knots.map(|knot| knot.seconds).collect();
        assert_eq!(knots.len(), 10, "{knots:?}");
        assert!((knots[4] - 0.5).abs() < 1e-12 && (knots[9] - 1.0).abs() < 1e-12);
        assert!((segment.knots[4].angles[reach] - 0.5).abs() < 1e-12);
    }
}

/// Turns each cycle by its own command, and remembers when it was asked.
#[derive(Default)]
struct Turning {
    steers: Vec<Steer>,
    asked: Vec<f64>,
}

impl Pilot for Turning {
    fn decide(&mut self, now: &Moment<'_>) -> Result<Decision, PilotError> {
        assert_eq!(now.stage, Stage::Recovery);
        let steer = self.steers[self.asked.len()];
        self.asked.push(now.senses.time);
        Ok(Decision { cycle: 0, steer })
    }
}

/// What is decided when a cycle begins is what that cycle does, also the first one.
#[test]
fn a_decision_is_about_the_cycle_that_begins() {
    let steer = |turn: f64, shift: f64| Steer { turn, shift };
    let steers = vec![steer(0.2, 0.0), steer(-0.1, 0.05), steer(0.0, 0.1)];
    let pilot = Turning {
        steers: steers.clone(),
        asked: Vec::new(),
    };
    let begin = Begin::InExtension { rest: 0.1 };
    let program = program(&[round("round")], 3, begin, set_points());
    let mut crawler = crawler_of(program, pilot);
    let shoulder = robot().joint("Lshoulder").unwrap();
    let mut angles = crawler.cycle().extension().clone();
    let mut ends = Vec::new();
    let mut began = Vec::new();
    for tick in 0..10_000 {
        let time = f64::from(tick) * TICK;
        let command = crawler.tick(&senses(time, &angles)).unwrap();
        if crawler.events().contains(&Event::CycleEnded) {
            ends.push(angles[shoulder]);
        }
        if crawler.events().contains(&Event::CycleBegan) {
            began.push((time, crawler.cycle().steer()));
        }
        if let JointCommand::SetPoint(posture) = command {
            angles = posture;
        }
        if crawler.ended().is_some() {
            break;
        }
    }
    let times: Vec<f64> = began.iter().map(|it| it.0).collect();
    assert_eq!(crawler.pilot().asked, times);
    assert_eq!(began.iter().map(|it| it.1).collect::<Vec<_>>(), steers);
    assert_eq!(ends.len(), steers.len());
    let steering = round("round").steering.unwrap();
    for (end, Steer { turn, shift }) in ends.into_iter().zip(steers) {
        let expected = turn + steering.shift_at_waypoints(shift) - 0.4;
        assert!((end - expected).abs() < 1e-12, "{end} rad");
    }
}

/// Kept to its line by a command for each error: what cannot be shifted is turned alone.
#[test]
fn a_line_is_held_by_turn_and_shift() {
    let gains = two_armed_by_side().control.steering;
    let steering = round("round").steering.unwrap();
    let program = program(&[round("round")], 2, AT_ONCE, set_points());
    let mut crawler = crawler_of(program, HeadingHold::of(gains, &steering));
    crawl(&mut crawler, |senses| {
        senses.bearing = Some(Bearing {
            y: 0.02,
            yaw: -0.05,
            ..Bearing::default()
        });
        Sensed::Whole
    })
    .unwrap();
    let Steer { turn, shift } = crawler.cycle().steer();
    assert!(
        turn > 0.0,
        "it heads right, and is turned left by {turn} rad"
    );
    assert!(shift < 0.0, "it is left, and is moved right by {shift} rad");
}

/// A stop after the cycle leaves the robot in the extension from which another crawl would begin.
#[test]
fn a_stop_after_the_cycle_waits_for_its_last_waypoint() {
    let mut crawler = rounds(9, AT_ONCE, set_points());
    let log = crawl(&mut crawler, |_| Sensed::Whole);
    assert_eq!(log.unwrap().events.len(), 9 * 3 + 1);

    let mut crawler = rounds(9, AT_ONCE, set_points());
    let mut angles = crawler.cycle().extension().clone();
    for tick in 0..10_000 {
        let time = f64::from(tick) * TICK;
        if tick == 100 {
            crawler.stop(Halt::AfterCycle);
        }
        if let JointCommand::SetPoint(posture) = crawler.tick(&senses(time, &angles)).unwrap() {
            angles = posture;
        }
        if crawler.ended().is_some() {
            assert!((time - 1.0).abs() < 1e-9, "{time} s");
            break;
        }
        assert_eq!(
            crawler.cycle_ends_at(time + TICK),
            (time + TICK - 1.0).abs() < 1e-9
        );
    }
    assert_eq!(crawler.ended(), Some(Ended::Halted(Halt::AfterCycle)));
    assert_eq!(crawler.cycles_done(), 1);
    assert_eq!(crawler.commanded(), Some(crawler.cycle().extension()));
}

/// At once it is held on its way.
#[test]
fn a_stop_at_once_is_on_the_way() {
    let mut crawler = rounds(9, AT_ONCE, set_points());
    let mut angles = crawler.cycle().extension().clone();
    let mut last = angles.clone();
    for tick in 0..10_000 {
        let time = f64::from(tick) * TICK;
        if tick == 100 {
            last = angles.clone();
            crawler.stop(Halt::AtOnce);
        }
        if let JointCommand::SetPoint(posture) = crawler.tick(&senses(time, &angles)).unwrap() {
            angles = posture;
        }
        if crawler.ended().is_some() {
            assert_eq!(tick, 100);
            break;
        }
    }
    assert_eq!(crawler.ended(), Some(Ended::Halted(Halt::AtOnce)));
    assert_eq!(angles, last);
    assert_ne!(&angles, crawler.cycle().extension());
    assert_eq!(crawler.cycles_done(), 0);
}

/// Cycles with and without a pull follow one another: each begins where the other has come to.
#[test]
fn cycles_with_a_pull_and_without_one_follow_one_another() {
    let mut pulls = cycle("pulls");
    pulls.pull.as_mut().unwrap().approach.seconds = 0.75;
    let cycles = [round("round"), pulls];
    let program = program(&cycles, 3, AT_ONCE, set_points());
    let pilot = Choosing {
        cycles: vec![0, 1, 0, 0],
        ..Choosing::default()
    };
    let mut crawler = crawler_of(program, pilot);
    let log = crawl(&mut crawler, whole).unwrap();
    let mut before: Option<JointAngles> = None;
    let robot = robot();
    for (time, command) in &log.commands {
        let JointCommand::SetPoint(posture) = command else {
            panic!("{command:?}");
        };
        for (joint, (to, from)) in before
            .iter()
            .flat_map(|it| robot.joints.iter().zip(posture.pairs(it)))
        {
            let speed = (to - from).abs() / EVERY;
            let most = joint.speed_limit * 1.001;
            assert!(speed <= most, "{} at {speed} rad/s at {time} s", joint.name);
        }
        before = Some(posture.clone());
    }
}
