//! Cycles of waypoints alone, what steers them, and limits that depend on another joint.

use proptest::prelude::*;

use super::*;
use crate::gait::cycle::{Steering, Waypoint};
use crate::robot::CoupledLimit;
use crate::robot::testing::two_armed_by_side;

/// Where a knee begins to fold, rad.
const FOLDED: f64 = 0.5;

fn waypoint(name: &str, seconds: f64, joints: &[(&str, f64)]) -> Waypoint {
    let joints = joints.iter();
    Waypoint {
        name: name.to_owned(),
        approach: Approach {
            seconds,
            easing: Easing::Smoothstep,
        },
        joints: joints
            .map(|&(joint, angle)| (joint.to_owned(), angle))
            .collect(),
        turn: BTreeMap::new(),
        shift: BTreeMap::new(),
    }
}

/// Legs fold, arms reach, arms push.
fn cycle() -> Cycle {
    Cycle {
        name: "round".to_owned(),
        description: String::new(),
        limits: LimitsPolicy::Refuse,
        pull: None,
        waypoints: vec![
            waypoint("fold", 0.4, &[("Lknee", FOLDED), ("Lhip", 0.2)]),
            waypoint("reach", 0.6, &[("Lshoulder", 0.6), ("Lroll", 0.3)]),
            waypoint("push", 0.5, &[("Lshoulder", -0.4), ("Lknee", 0.1)]),
        ],
        rest: 0.0,
        steering: Some(Steering {
            limit: 0.2,
            shift_limit: 0.1,
            dead_band: 0.05,
            spread: 0.0,
            joints: BTreeMap::new(),
        }),
    }
}

fn plan(cycle: &Cycle, steer: Steer) -> Result<CheckedCycle, CycleError> {
    plan_of(&two_armed_by_side(), cycle, steer)
}

fn plan_of(robot: &Robot, cycle: &Cycle, steer: Steer) -> Result<CheckedCycle, CycleError> {
    CheckedCycle::plan_steered(robot, &robot.stops(), cycle, steer, TimeScale::ONE)
}

fn joint(name: &str) -> JointId {
    two_armed_by_side().joint(name).unwrap()
}

#[track_caller]
fn near(found: &JointAngles, expected: &JointAngles) {
    for (found, expected) in found.pairs(expected) {
        assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
    }
}

#[test]
fn a_cycle_of_waypoints_begins_where_its_last_one_leaves_it() {
    let checked = plan(&cycle(), Steer::STRAIGHT).unwrap();
    let mut expected = JointAngles::zero(&two_armed_by_side());
    // What a waypoint does not name stays where an earlier one has put it.
    for (name, angle) in [
        ("knee", 0.1),
        ("hip", 0.2),
        ("shoulder", -0.4),
        ("roll", 0.3),
    ] {
        for side in ["L", "R"] {
            let id = joint(&format!("{side}{name}"));
            // The right arm's roll turns the other way round.
            let sign = if (side, name) == ("R", "roll") {
                -1.0
            } else {
                1.0
            };
            expected[id] = sign * angle;
        }
    }
    near(checked.extension(), &expected);
    assert_eq!(checked.compression(), checked.extension());
    assert_eq!(checked.pull(), None);
    assert!(checked.pull_seconds().abs() < f64::EPSILON);
    assert_eq!(&checked.pull_at(0.3), checked.extension());
    assert!((checked.root_pitch() - FLAT_ON_THE_BELLY).abs() < f64::EPSILON);
    let seconds = checked.recovery_seconds();
    assert!((seconds - cycle().duration(TimeScale::ONE)).abs() < 1e-12);
    let names: Vec<&str> = checked.recovery_ends().iter().map(|it| it.0).collect();
    assert_eq!(names, ["fold", "reach", "push"]);
}

#[test]
fn a_rest_is_the_last_stretch_and_keeps_the_extension() {
    let mut resting = cycle();
    resting.rest = 0.7;
    let checked = plan(&resting, Steer::STRAIGHT).unwrap();
    let straight = plan(&cycle(), Steer::STRAIGHT).unwrap();
    assert_eq!(checked.extension(), straight.extension());
    assert!((checked.recovery_seconds() - straight.recovery_seconds() - 0.7).abs() < 1e-12);
    let path = checked.recovery_after(&checked).unwrap();
    near(&path.at(1.9), checked.extension());
}

/// Between cycles that are steered differently there is no jump: a path begins where the cycle before
/// has ended, and ends where the next one begins.
#[test]
fn a_path_closes_whatever_came_before() {
    let mut steered = cycle();
    steered.waypoints[2].turn = BTreeMap::from([("Lshoulder".to_owned(), 0.5)]);
    let straight = plan(&steered, Steer::STRAIGHT).unwrap();
    let turned = Steer {
        turn: 0.15,
        shift: 0.0,
    };
    let turned = plan(&steered, turned).unwrap();
    assert_ne!(straight.extension(), turned.extension());
    let fold = straight.recovery_ends()[0].1;
    for (before, after) in [
        (&straight, &straight),
        (&straight, &turned),
        (&turned, &straight),
        (&turned, &turned),
    ] {
        let path = after.recovery_after(before).unwrap();
        near(&path.at(0.0), before.extension());
        near(&path.at(after.recovery_seconds()), after.extension());
        assert!((path.at(fold)[joint("Rknee")] - FOLDED).abs() < 1e-12);
    }
}

#[test]
fn a_slower_cycle_goes_the_same_way() {
    let once = plan(&cycle(), Steer::STRAIGHT).unwrap();
    let robot = two_armed_by_side();
    let scale = TimeScale::new(2.0).unwrap();
    let twice = CheckedCycle::plan(&robot, &robot.stops(), &cycle(), 0.0, scale).unwrap();
    let (fast, slow) = (
        once.recovery_after(&once).unwrap(),
        twice.recovery_after(&twice).unwrap(),
    );
    for k in 0..=15 {
        let time = 0.1 * f64::from(k);
        near(&fast.at(time), &slow.at(2.0 * time));
    }
    assert!((once.fastest().speed - 2.0 * twice.fastest().speed).abs() < 1e-12);
}

/// The cycle with factors at two waypoints, of joints whose twins turn the same and the other way round.
fn steerable(turn: [f64; 2], shift: [f64; 2]) -> Cycle {
    let factors = |[shoulder, roll]: [f64; 2]| {
        [("Lshoulder", shoulder), ("Rroll", roll)]
            .map(|(joint, factor)| (joint.to_owned(), factor))
            .into()
    };
    let mut cycle = cycle();
    cycle.waypoints[1].turn = factors(turn);
    cycle.waypoints[1].shift = factors(shift);
    cycle.waypoints[2].shift = BTreeMap::from([("Rknee".to_owned(), shift[0])]);
    cycle
}

/// By how much a command moves each joint at the waypoint `reach`, rad.
fn moved(cycle: &Cycle, turn: f64, shift: f64) -> JointAngles {
    let at = |steer| {
        let checked = plan(cycle, steer).unwrap();
        let reach = checked.recovery_ends()[1].1;
        checked.recovery_after(&checked).unwrap().at(reach)
    };
    let straight = at(Steer::STRAIGHT);
    at(Steer { turn, shift }).map(|joint, angle| angle - straight[joint])
}

proptest! {
    /// A command to the right is the mirror image of one to the left, all the way round.
    #[test]
    fn left_mirrors_right(
        factors in proptest::array::uniform4(-1.0..1.0_f64),
        turn in -0.2..0.2_f64,
        shift in -0.1..0.1_f64,
    ) {
        let [a, b, c, d] = factors;
        let cycle = steerable([a, b], [c, d]);
        let path = |sign: f64| {
            let steer = Steer { turn: sign * turn, shift: sign * shift };
            let checked = plan(&cycle, steer).unwrap();
            checked.recovery_after(&checked).unwrap()
        };
        let (left, right) = (path(1.0), path(-1.0));
        let mirror = Mirror::of(&two_armed_by_side());
        for k in 0..=30 {
            let time = 0.05 * f64::from(k);
            near(&mirror.posture(&left.at(time)), &right.at(time));
        }
    }

    /// What turns and what shifts add up, each by its own factors.
    #[test]
    fn turn_and_shift_add_up(
        factors in proptest::array::uniform4(-1.0..1.0_f64),
        turn in -0.2..0.2_f64,
        shift in -0.1..0.1_f64,
    ) {
        let [a, b, c, d] = factors;
        let cycle = steerable([a, b], [c, d]);
        let both = moved(&cycle, turn, shift);
        let (turned, shifted) = (moved(&cycle, turn, 0.0), moved(&cycle, 0.0, shift));
        near(&both, &turned.map(|joint, angle| angle + shifted[joint]));
        let steering = cycle.steering.as_ref().unwrap();
        let (w, x) = (steering.at_waypoints(turn), steering.shift_at_waypoints(shift));
        for (name, expected) in [
            ("Lshoulder", a * w + c * x),
            ("Rshoulder", -a * w - c * x),
            // Its twin turns the other way round, so that both rolls go to the same side.
            ("Rroll", b * w + d * x),
            ("Lroll", b * w + d * x),
            ("Lhip", 0.0),
        ] {
            prop_assert!((both[joint(name)] - expected).abs() < 1e-12, "{name}");
        }
    }
}

/// A factor for each twin replaces the mirror image, for what is to go to one side alone.
#[test]
fn twins_that_are_both_named_have_their_own_factors() {
    let mut cycle = cycle();
    let factors = [("Lshoulder", 1.0), ("Rshoulder", 0.0)];
    cycle.waypoints[1].shift = factors.map(|(it, factor)| (it.to_owned(), factor)).into();
    let moved = moved(&cycle, 0.0, 0.1);
    assert!((moved[joint("Lshoulder")] - 0.1).abs() < 1e-12);
    assert!(moved[joint("Rshoulder")].abs() < 1e-12);
}

#[test]
fn limit_commands_beyond_the_steering_are_refused() {
    let refused = |cycle: &Cycle, turn: f64, shift: f64| {
        let error = plan(cycle, Steer { turn, shift }).unwrap_err();
        assert_eq!(error.place(), "steering");
        error.to_string()
    };
    let cycle = cycle();
    for sign in [1.0, -1.0] {
        assert!(
            plan(
                &cycle,
                Steer {
                    turn: 0.2 * sign,
                    shift: 0.1 * sign
                }
            )
            .is_ok()
        );
        let said = refused(&cycle, 0.0, 0.11 * sign);
        assert!(
            said.contains("a shift of") && said.contains("5.73°"),
            "{said}"
        );
        let said = refused(&cycle, 0.21 * sign, 0.0);
        assert!(
            said.contains("a turn of") && said.contains("11.46°"),
            "{said}"
        );
    }
    refused(&cycle, f64::NAN, 0.0);
    refused(&cycle, 0.0, f64::NAN);
    let unsteered = Cycle {
        steering: None,
        ..cycle
    };
    assert!(refused(&unsteered, 0.01, 0.0).contains("0.00°"));
    assert!(refused(&unsteered, 0.0, 0.01).contains("0.00°"));
}

#[test]
fn limit_a_cycle_without_a_pull_goes_somewhere() {
    for waypoints in 0..2 {
        let mut short = cycle();
        short.waypoints.truncate(waypoints);
        let error = plan(&short, Steer::STRAIGHT).unwrap_err();
        let expected = CycleError::FewWaypoints {
            cycle: "round".to_owned(),
            waypoints,
        };
        assert_eq!(error, expected);
    }
    let mut two = cycle();
    two.waypoints.truncate(2);
    assert!(plan(&two, Steer::STRAIGHT).is_ok());
}

/// Also where it is not turned: it would be an error as soon as it is.
#[test]
fn limit_a_command_adds_to_angles_that_are_given() {
    for shift in [false, true] {
        let mut cycle = cycle();
        let factors = BTreeMap::from([("Lbend".to_owned(), 0.3)]);
        let reach = &mut cycle.waypoints[1];
        *(if shift {
            &mut reach.shift
        } else {
            &mut reach.turn
        }) = factors;
        let error = plan(&cycle, Steer::STRAIGHT).unwrap_err();
        let CycleError::NothingToTurn { place, joint, .. } = &error else {
            panic!("{error}");
        };
        assert_eq!(
            (place.as_str(), joint.as_str()),
            ("waypoint reach", "Lbend")
        );
        assert_eq!(error.place(), "reach");
    }
    let mut cycle = cycle();
    cycle.waypoints[1].turn = BTreeMap::from([("tail".to_owned(), 0.3)]);
    let error = plan(&cycle, Steer::STRAIGHT).unwrap_err();
    assert!(matches!(error, CycleError::UnknownJoint { .. }), "{error}");
}

#[test]
fn limit_stops_of_another_robot() {
    let robot = two_armed_by_side();
    let mut stops = robot.stops();
    stops.pop();
    let planned = CheckedCycle::plan(&robot, &stops, &cycle(), 0.0, TimeScale::ONE);
    let error = planned.unwrap_err();
    assert!(
        matches!(
            error,
            CycleError::Stops {
                stops: 13,
                joints: 14,
                ..
            }
        ),
        "{error}"
    );
}

/// A stop that only the turned posture passes.
#[test]
fn limit_a_turn_keeps_to_the_stops() {
    let mut robot = two_armed_by_side();
    robot.joints[joint("Rshoulder").0].range.lower = -FOLDED;
    let mut cycle = cycle();
    cycle.waypoints[2].turn = BTreeMap::from([("Lshoulder".to_owned(), 1.0)]);
    assert!(plan_of(&robot, &cycle, Steer::STRAIGHT).is_ok());
    let turned = Steer {
        turn: 0.2,
        shift: 0.0,
    };
    let error = plan_of(&robot, &cycle, turned).unwrap_err();
    let CycleError::Limit {
        place,
        joint: name,
        excess,
        ..
    } = &error
    else {
        panic!("{error}");
    };
    assert_eq!(
        (place.as_str(), name.as_str()),
        ("waypoint push", "Rshoulder")
    );
    // w(0.2) = 0.24 is added to -0.4 and taken from it at its twin.
    assert!((excess - 0.14).abs() < 1e-12, "{excess}");
    cycle.limits = LimitsPolicy::Clamp;
    let clamped = plan_of(&robot, &cycle, turned).unwrap();
    assert!((clamped.extension()[joint("Rshoulder")] + FOLDED).abs() < 1e-12);
    let [clamp] = clamped.clamps() else {
        panic!("{:?}", clamped.clamps());
    };
    assert_eq!(clamp.joint, joint("Rshoulder"));
    assert!((clamp.largest + 0.14).abs() < 1e-12);
}

#[test]
fn limit_a_leg_that_is_too_fast_is_named() {
    let mut hasty = cycle();
    hasty.waypoints[1].approach.seconds = 0.1;
    let error = plan(&hasty, Steer::STRAIGHT).unwrap_err();
    let CycleError::Speed {
        place,
        joint,
        speed,
        ..
    } = &error
    else {
        panic!("{error}");
    };
    assert_eq!((place.as_str(), joint.as_str()), ("reach", "Rshoulder"));
    // Half again as fast as 1 rad in 0.1 s.
    assert!((speed - 15.0).abs() < 1e-9, "{speed}");
}

/// A robot whose shoulders roll less the more its knees are folded: 1 rad at 0 and none at 1 rad.
fn coupled() -> Robot {
    let mut robot = two_armed_by_side();
    let range = |upper: f64| Range { lower: -2.0, upper };
    let table = vec![(0.0, range(1.0)), (1.0, range(0.0))];
    let limit = CoupledLimit::new(joint("Lroll"), joint("Lknee"), table).unwrap();
    robot.coupled_limits.push(limit);
    robot
}

/// Both waypoints keep the limit, and the way between them does not.
fn across(limits: LimitsPolicy) -> Cycle {
    let mut cycle = cycle();
    cycle.limits = limits;
    cycle.waypoints = vec![
        waypoint("folded", 0.5, &[("Lknee", 0.9), ("Lroll", 0.05)]),
        waypoint("rolled", 0.5, &[("Lknee", 0.0), ("Lroll", 0.95)]),
        waypoint("late", 0.5, &[("Lknee", 0.9)]),
        waypoint("down", 0.5, &[("Lroll", 0.05)]),
    ];
    cycle
}

#[test]
fn limits_by_another_joint_hold_between_waypoints_too() {
    let error = plan_of(&coupled(), &across(LimitsPolicy::Refuse), Steer::STRAIGHT).unwrap_err();
    let CycleError::Coupled { place, beyond, .. } = &error else {
        panic!("{error}");
    };
    assert_eq!(place, "waypoint late");
    assert_eq!(
        (beyond.joint.as_str(), beyond.by.as_str()),
        ("Lroll", "Lknee")
    );
    let (upper, expected) = (beyond.upper, 1.0 - beyond.at);
    assert!(
        beyond.angle > upper && (upper - expected).abs() < 1e-12,
        "{error}"
    );
    let free = plan(&across(LimitsPolicy::Refuse), Steer::STRAIGHT);
    assert!(free.is_ok(), "{free:?}");
}

#[test]
fn limits_by_another_joint_clamp_what_is_commanded_and_say_so() {
    let robot = coupled();
    let [limit] = &robot.coupled_limits[..] else {
        panic!("one limit");
    };
    let checked = plan_of(&robot, &across(LimitsPolicy::Clamp), Steer::STRAIGHT).unwrap();
    let path = checked.recovery_after(&checked).unwrap();
    let mut stopped = 0;
    for k in 0..=2000 {
        let posture = path.at(0.001 * f64::from(k));
        let range = limit.range(posture[limit.by]);
        assert!(range.contains(posture[limit.joint]), "at {k} ms");
        stopped += u32::from((posture[limit.joint] - range.upper).abs() < 1e-12);
    }
    assert!(stopped > 300, "it is at its limit for {stopped} ms");
    let [clamp] = checked.clamps() else {
        panic!("{:?}", checked.clamps());
    };
    assert_eq!(clamp.joint, limit.joint);
    // 0.95 rad where the folded knee leaves 0.1 rad.
    assert!((clamp.largest - 0.85).abs() < 1e-12, "{}", clamp.largest);
    // The other arm has no such limit, and goes where the cycle has it.
    let late = checked.recovery_ends()[2].1;
    assert!((path.at(late)[joint("Rroll")] + 0.95).abs() < 1e-12);
}

/// A joint that rests at 0.9 rad is pushed back by its limit as the knee is folded, faster than it may move.
#[test]
fn a_joint_follows_its_limit_no_faster_than_it_may_move() {
    let mut robot = coupled();
    let roll = joint("Lroll");
    robot.joints[roll.0].speed_limit = 1.0;
    let folding = |seconds: f64| {
        let mut cycle = across(LimitsPolicy::Clamp);
        cycle.waypoints = vec![
            waypoint("rolled", 5.0, &[("Lknee", 0.0), ("Lroll", 0.9)]),
            waypoint("late", seconds, &[("Lknee", 0.9)]),
            waypoint("down", 5.0, &[("Lroll", 0.05)]),
        ];
        plan_of(&robot, &cycle, Steer::STRAIGHT)
    };
    let error = folding(0.5).unwrap_err();
    let CycleError::Speed {
        place,
        joint,
        speed,
        ..
    } = &error
    else {
        panic!("{error}");
    };
    assert_eq!((place.as_str(), joint.as_str()), ("waypoint late", "Lroll"));
    assert!(*speed > 1.0, "{error}");
    assert!(folding(2.0).is_ok());
}

/// What a waypoint itself asks for is looked at, wherever the steps between fall, and the posture that
/// a cycle begins in keeps the limit.
#[test]
fn limits_by_another_joint_hold_at_each_waypoint() {
    let mut cycle = across(LimitsPolicy::Refuse);
    cycle.waypoints = vec![
        waypoint("folded", 0.5, &[("Lknee", 0.5), ("Lroll", 0.0)]),
        waypoint("peak", 0.553, &[("Lroll", 0.502)]),
        waypoint("down", 0.5, &[("Lroll", 0.0)]),
    ];
    for waypoint in &mut cycle.waypoints {
        waypoint.approach.easing = Easing::Linear;
    }
    let error = plan_of(&coupled(), &cycle, Steer::STRAIGHT).unwrap_err();
    let CycleError::Coupled { place, beyond, .. } = &error else {
        panic!("{error}");
    };
    assert_eq!(place, "waypoint peak");
    assert!((beyond.angle - 0.502).abs() < 1e-12, "{error}");
    assert_eq!(error.place(), "peak");
    // The same as the last waypoint: the extension is stopped where the limit is.
    cycle.limits = LimitsPolicy::Clamp;
    cycle.waypoints.pop();
    let checked = plan_of(&coupled(), &cycle, Steer::STRAIGHT).unwrap();
    assert!((checked.extension()[joint("Lroll")] - 0.5).abs() < 1e-12);
    let largest = checked.clamps()[0].largest;
    assert!((largest - 0.002).abs() < 1e-12, "{largest}");
}
