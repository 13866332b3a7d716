use prone::robot::BodyPart;
use prone_files::shipped;
use prone_sim::RobotFiles;

use super::super::price::Merge;
use super::super::rules::CycleRules;
use super::super::settings::{for_advance, for_steering, for_steering_confirmation};
use super::*;
use prone_record::frontier::CycleObjective;

#[test]
fn a_cycle_that_ships_with_steering_can_be_steered() {
    let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    let settings = for_steering_confirmation(&robot).unwrap();
    let cycle = |name: &str| shipped::cycle(name).unwrap().unwrap();
    for cycle in shipped::cycle_names().map(cycle) {
        if cycle.steering.is_some() {
            assert_eq!(
                check_steering(&settings, &cycle),
                Ok(()),
                "{}",
                cycle.pull.name
            );
        }
    }
    // What would steer another one does not steer this.
    let borrowed = Cycle {
        steering: cycle("low-175").steering,
        ..cycle("far-200")
    };
    let refused = check_steering(&settings, &borrowed).unwrap_err();
    assert!(matches!(refused, NotSteered::ThrownOff { .. }), "{refused}");
}

/// The same cycle, steered the other way.
fn reversed(cycle: &Cycle) -> Cycle {
    let mut reversed = cycle.clone();
    if let Some(steering) = &mut reversed.steering {
        steering.spread = -steering.spread;
        for factor in steering.joints.values_mut() {
            *factor = -*factor;
        }
    }
    reversed
}

/// A search for a cycle that can be steered: about one that turns to the left it finds one that does,
/// about one that turns to the right by as much it finds none that counts.
#[test]
fn a_steerable_search_finds_what_turns_to_the_left() {
    let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    let mut settings = for_advance(&robot).unwrap();
    settings.truncate(1);
    settings.extend(for_steering(&robot).unwrap().into_iter().take(1));
    let Role::Turn(least) = settings[1].spec.role else {
        panic!("{:?}", settings[1].spec);
    };
    let aim = Aim {
        objective: CycleObjective::Advance,
        merge: Merge::Mean,
        rules: CycleRules::FREE,
    };
    let left = shipped::cycle("low-175").unwrap().unwrap();
    let best = |base: &Cycle| {
        let hunt = Hunt::new(robot.robot(), &settings, aim.clone(), base).unwrap();
        let mut search = Search::about_the_middle(1, 1, 16);
        hunt.proceed(&mut search, |_| std::ops::ControlFlow::Continue(()));
        let (_, best) = search.best().unwrap();
        let (_, price) = hunt.quote(&best.point).unwrap();
        (price.trials[1].yaw, price.violation)
    };
    let (yaw, violation) = best(&left);
    assert!(yaw >= least && violation == 0.0, "{yaw} rad, {violation}");
    let (yaw, violation) = best(&reversed(&left));
    assert!(yaw < 0.0 && violation > 1.0, "{yaw} rad, {violation}");
    let confirmation = for_steering_confirmation(&robot).unwrap();
    let refused = check_steering(&confirmation, &reversed(&left)).unwrap_err();
    let NotSteered::ThrownOff { turned, .. } = refused else {
        panic!("{refused}");
    };
    assert!(turned < 0.0, "{turned} rad");
    assert!(!confirm(&confirmation, &reversed(&left), f64::INFINITY).holds);
}

#[test]
fn where_no_cycle_can_be_crawled_each_says_why() {
    let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    let settings = for_advance(&robot).unwrap();
    let mut hasty = shipped::cycle("low-175").unwrap().unwrap();
    hasty.recovery[0].approach.seconds = 0.1;
    let cycles = [hasty];
    let refused = base(&robot, &settings[0], &cycles, 0.2).unwrap_err();
    let message = refused.to_string();
    let mut lines = message.lines();
    assert_eq!(
        lines.next(),
        Some("there is no cycle that NAO H25 V4 can crawl to begin with")
    );
    let why = lines.next().unwrap();
    assert!(why.starts_with("  low-175: "), "{why}");
    assert!(why.contains("above its limit of"), "{why}");
    assert_eq!(lines.next(), None);
}

/// What a confirmation asks, one thing at a time.
#[test]
fn a_cycle_holds_where_it_is_low_far_and_straight() {
    let trial = Trial {
        setting: SettingKind::AsItIs,
        advance: 0.1,
        seconds: 4.0,
        top: (0.17, BodyPart::Head),
        heat_per_metre: 50.0,
        peak_over_limit: (1.0, String::new()),
        demanded_shoulder: 2.0,
        shoulder_saturated: 0.0,
        body_share: 0.1,
        yaw: 0.03,
    };
    let at = |role: Role, kept: f64, ceiling: f64| does_hold(role, &trial, kept, ceiling);
    assert!(at(Role::Value, 1.0, 0.18));
    for ceiling in [0.16, 0.17, f64::NAN] {
        assert!(!at(Role::Value, 1.0, ceiling), "under {ceiling} m");
        assert!(at(Role::Beside, 0.0, ceiling), "beside");
    }
    // A share of its own, or the usual one.
    for (role, share) in [(Role::Keep(0.6), 0.6), (Role::Value, HOLDS)] {
        assert!(at(role, share, 0.18));
        assert!(!at(role, share - 0.01, 0.18));
        assert!(!at(role, f64::NAN, 0.18));
    }
    let straight = |yaw: f64| Role::Straight { yaw, keep: 0.6 };
    assert!(at(straight(0.04), 1.0, 0.18));
    assert!(!at(straight(0.02), 1.0, 0.18));
    assert!(at(Role::Turn(0.02), 1.0, 0.18));
    assert!(!at(Role::Turn(0.04), 1.0, 0.18));
    for (advance, yaw) in [(-0.1, 0.03), (0.0, 0.03), (0.1, f64::NAN)] {
        let bad = Trial {
            advance,
            yaw,
            ..trial.clone()
        };
        assert!(!does_hold(straight(0.04), &bad, 1.0, 0.18), "{bad:?}");
    }
}
