use std::ops::ControlFlow;
use std::sync::Arc;

use prone_files::shipped;
use prone_optim::Threads;
use prone_record::search::Solver;
use prone_sim::RobotFiles;

use super::super::candidates::Searched;
use super::super::cycle_cost::{CycleAim, Merge};
use super::super::cycle_form::Free;
use super::super::cycle_jobs::base;
use super::super::cycle_rules::Bounds;
use super::super::cycle_rules::CycleRules;
use super::super::setting::Role;
use super::super::settings::{for_advance, for_steering, for_steering_confirmation};
use super::super::steering::NotSteered;
use super::*;
use crate::watch::Unwatched;

#[test]
fn a_cycle_that_ships_with_steering_can_be_steered() {
    let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    let settings = for_steering_confirmation(&robot).unwrap();
    let cycle = |name: &str| shipped::cycle(name).unwrap().unwrap();
    for cycle in shipped::cycle_names().map(cycle) {
        if cycle.steering.is_none() {
            continue;
        }
        let steered = check_steering(&settings, &cycle);
        if cycle.name == "least-heat" {
            // Found with servos that no robot has: with motors it turns by 4° where 6° are asked.
            assert!(
                matches!(steered, Err(NotSteered::ThrownOff { .. })),
                "{steered:?}"
            );
        } else {
            assert_eq!(steered, Ok(()), "{}", cycle.name);
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
    let settings: Arc<[Setting]> = settings.into();
    let Role::Turn(least) = settings[1].spec.role else {
        panic!("{:?}", settings[1].spec);
    };
    let aim = CycleAim {
        objective: CycleObjective::Advance,
        merge: Merge::Mean,
        rules: CycleRules {
            head: f64::INFINITY,
            ..CycleRules::FREE
        },
    };
    let left = shipped::cycle("low-175").unwrap().unwrap();
    let best = |base: &Cycle| {
        let (robot, aim) = (robot.robot(), aim.clone());
        let searched = CycleSearch::new(robot, &settings, aim, base, Free::FULL).unwrap();
        let mut search = Search::new(Solver::AboutTheMiddle, 1, 1, 16);
        search.proceed(&Threads(Searched::new(&searched)), |_| {
            ControlFlow::Continue(())
        });
        let (_, best) = search.best().unwrap();
        let cycle = searched.gait(&best.point).unwrap();
        let cost = searched.cost(&cycle, Depth::Everything);
        (cost.trials[1].yaw, cost.violation)
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
    let cycles = [(reversed(&left), Bounds::NONE)];
    let confirmed = confirm::cycles(&cycles, &confirmation, &Unwatched).unwrap();
    assert!(!confirmed[0].holds);
}

#[test]
fn where_no_cycle_can_be_crawled_each_says_why() {
    let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    let settings = for_advance(&robot).unwrap();
    let mut hasty = shipped::cycle("low-175").unwrap().unwrap();
    hasty.waypoints[0].approach.seconds = 0.1;
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
