//! Cycles of waypoints alone, and crawls that end where they touch something.

use std::collections::BTreeMap;

use prone::gait::LimitsPolicy;
use prone::gait::cycle::{Approach, Cycle, Easing, Waypoint};
use prone::robot::JointAngles;
use prone::scene::Scene;

use super::*;

/// Time between two postures of a pull that is written as waypoints, s.
const STEP: f64 = 0.05;

/// How many of them a pull of a second has.
const STEPS: u32 = 20;

/// A cycle with its pull written as waypoints, so close that they leave nothing out.
fn without_its_pull(world: &World, cycle: &Cycle) -> Cycle {
    let planned = CheckedCycle::plan(world.robot(), world.stops(), cycle, 0.0, TimeScale::ONE);
    let planned = planned.unwrap();
    let joints = |posture: &JointAngles| {
        let named = world.robot().joints.iter().zip(posture.as_slice());
        named
            .map(|(joint, angle)| (joint.name.clone(), *angle))
            .collect()
    };
    let waypoint = |name: String, approach: Approach, posture: &JointAngles| Waypoint {
        name,
        approach,
        joints: joints(posture),
        turn: BTreeMap::new(),
        shift: BTreeMap::new(),
    };
    let step = Approach {
        seconds: STEP,
        easing: Easing::Linear,
    };
    assert!((planned.pull_seconds() - f64::from(STEPS) * STEP).abs() < 1e-12);
    let pulled = (1..=STEPS).map(|k| {
        let posture = planned.pull_at(f64::from(k) * STEP);
        waypoint(format!("pull {k}"), step, &posture)
    });
    let approach = cycle.pull.as_ref().unwrap().approach;
    let extension = waypoint("extension".to_owned(), approach, planned.extension());
    Cycle {
        limits: LimitsPolicy::Clamp,
        pull: None,
        waypoints: pulled
            .chain(cycle.waypoints.clone())
            .chain([extension])
            .collect(),
        steering: None,
        ..cycle.clone()
    }
}

/// The same postures at the same times crawl as far, whichever way a file gives them.
#[test]
fn identity_a_pull_that_is_written_as_waypoints_crawls_as_far() {
    let world = World::new(&nao(), Regime::LOCOMOTION).unwrap();
    let pulled = shipped::cycle("thesis-nominal").unwrap().unwrap();
    let crawled = |cycle: Cycle| {
        let plan = CrawlPlan {
            cycles: vec![cycle],
            ..steady(3)
        };
        run(&world, &plan, Straight::default()).unwrap()
    };
    let round = crawled(without_its_pull(&world, &pulled));
    let pulled = crawled(pulled);
    assert!(round.arrived);
    assert_eq!(round.cycles.len(), 3);
    for (a, b) in round.cycles.iter().zip(&pulled.cycles) {
        assert!((a.begin - b.begin).abs() < 1e-9);
        assert!((a.seconds - b.seconds).abs() < 1e-9);
    }
    let forward = |crawl: &Crawl| crawl.cycles[2].advance().forward * 1e3;
    let (one, other) = (forward(&round), forward(&pulled));
    assert!(other > 60.0, "{other} mm");
    // Between two waypoints a joint goes straight where the pull bends by less than a degree, and it
    // begins from another pitch of the trunk.
    assert!((one - other).abs() < 0.05 * other, "{one} and {other} mm");
    let (one, other) = (round.tops.highest(), pulled.tops.highest());
    assert!((one - other).abs() < 2e-3, "{one} and {other} m high");
}

/// Up to the touch it is the crawl that goes on.
#[test]
fn a_crawl_that_ends_at_a_touch_ends_at_its_first_one() {
    let robot = nao();
    let world = World::in_scene(&robot, Regime::LOCOMOTION, &Scene::under_plate(0.2, 0.5)).unwrap();
    let crawled = |on_touch| {
        let plan = CrawlPlan {
            cycles: vec![shipped::cycle("thesis-nominal").unwrap().unwrap()],
            on_touch,
            ..steady(3)
        };
        run(&world, &plan, Straight::default()).unwrap()
    };
    let (goes_on, ends) = (crawled(OnTouch::GoOn), crawled(OnTouch::End));
    let first = |crawl: &Crawl| {
        let times = crawl.touches.iter().map(|touch| touch.first);
        times.fold(f64::INFINITY, f64::min)
    };
    assert!(goes_on.arrived && !ends.arrived);
    assert!((first(&ends) - first(&goes_on)).abs() < 1e-12);
    // Cycles that are not ended have no row; what was stepped tells when it ended.
    let step = world.regime().time_step;
    let fewer = goes_on.engine_steps - ends.engine_steps;
    let late = goes_on.effort.seconds - fewer as f64 * step - first(&ends);
    assert!(
        (-1e-9..2.5 * step).contains(&late),
        "{late} s after the touch"
    );
    let [touch] = &ends.touches[..] else {
        panic!("{:?}", ends.touches);
    };
    assert_eq!(touch.count, 1);
    // What nothing touches goes on to its end.
    let free = World::new(&robot, Regime::LOCOMOTION).unwrap();
    let plan = CrawlPlan {
        on_touch: OnTouch::End,
        ..steady(1)
    };
    assert!(run(&free, &plan, Straight::default()).unwrap().arrived);
}
