use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::Arc;

use prone_files::shipped;
use prone_record::search::Solver;
use prone_sim::RobotFiles;

use super::super::candidates::Watched;
use super::super::cycle_cost::{CycleAim, Merge};
use super::super::cycle_form::Free;
use super::super::cycle_jobs::base;
use super::super::cycle_rules::Bounds;
use super::super::cycle_rules::CycleRules;
use super::super::setting::Role;
use super::super::settings::{for_search, for_steering, for_steering_confirmation};
use super::super::steering::{NotSteered, check_steering};
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
        assert_eq!(check_steering(&settings, &cycle), Ok(()), "{}", cycle.name);
    }
    // Commands that move nothing leave it to the ground.
    let mut idle = cycle("hip-10");
    let steering = idle.steering.as_mut().unwrap();
    (steering.spread, steering.joints) = (0.0, BTreeMap::new());
    let refused = check_steering(&settings, &idle).unwrap_err();
    assert!(matches!(refused, NotSteered::ThrownOff { .. }), "{refused}");
}

/// The same cycle, steered the other way.
fn reversed(cycle: &Cycle) -> Cycle {
    let mut reversed = cycle.clone();
    for waypoint in &mut reversed.waypoints {
        for factor in waypoint.turn.values_mut() {
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
    let mut settings = for_search(CycleObjective::Advance, &robot).unwrap();
    settings.truncate(1);
    settings.extend(for_steering(&robot).unwrap());
    let settings: Arc<[Setting]> = settings.into();
    let [half, whole] = [1, 2].map(|index: usize| match settings[index].spec.role {
        Role::Turn(least) => least,
        role => panic!("{role:?}"),
    });
    assert!(whole > half && half > 0.0, "{half} and {whole} rad");
    let aim = CycleAim {
        objective: CycleObjective::Advance,
        merge: Merge::Mean,
        rules: CycleRules {
            head: f64::INFINITY,
            ..CycleRules::FREE
        },
    };
    let left = shipped::cycle("low-175").unwrap().unwrap();
    let about = Free {
        reach: 0.02,
        turns: false,
    };
    let best = |base: &Cycle| {
        let (robot, aim) = (robot.robot(), aim.clone());
        let searched = CycleSearch::new(robot, &settings, aim, base, about).unwrap();
        let mut search = Search::new(Solver::AboutTheMiddle, 1, 1, 16);
        search.proceed(&Watched::new(&searched, &Unwatched), |_| {
            ControlFlow::Continue(())
        });
        let (_, best) = search.best().unwrap();
        let cycle = searched.gait(&best.point).unwrap();
        let cost = searched.cost_unless(&|| false, &cycle, Depth::Everything);
        let cost = cost.unwrap();
        (
            [1, 2].map(|index: usize| cost.trials[index].yaw),
            cost.violation,
        )
    };
    let (turned, violation) = best(&left);
    assert!(
        turned[0] >= half && turned[1] >= whole && violation == 0.0,
        "{turned:?} rad, {violation}"
    );
    let (turned, violation) = best(&reversed(&left));
    assert!(
        turned[0] < 0.0 && turned[1] < 0.0 && violation > 2.0,
        "{turned:?} rad, {violation}"
    );
    let confirmation = for_steering_confirmation(&robot).unwrap();
    let refused = check_steering(&confirmation, &reversed(&left)).unwrap_err();
    // More of a command to the left turns it further to the right.
    let NotSteered::Folds { half, whole } = refused else {
        panic!("{refused}");
    };
    assert!(whole < half && half < 0.0, "{half} and {whole} rad");
    let cycles = [(reversed(&left), Bounds::NONE)];
    let confirmed = confirm::cycles(&cycles, &confirmation, &Unwatched).unwrap();
    assert!(!confirmed[0].holds);
}

#[test]
fn where_no_cycle_can_be_crawled_each_says_why() {
    let robot = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    let settings = for_search(CycleObjective::Advance, &robot).unwrap();
    let mut hasty = shipped::cycle("hip-10").unwrap().unwrap();
    hasty.waypoints[0].approach.seconds = 0.1;
    let cycles = [hasty];
    let refused = base(&robot, &settings[0], &cycles, 0.2, &Unwatched).unwrap_err();
    let message = refused.to_string();
    let mut lines = message.lines();
    assert_eq!(
        lines.next(),
        Some("there is no cycle that NAO H25 V4 can crawl to begin with")
    );
    let why = lines.next().unwrap();
    assert!(why.starts_with("  hip-10: "), "{why}");
    assert!(why.contains("above its limit of"), "{why}");
    assert_eq!(lines.next(), None);
}
