//! Identities and limits of the statics, on a made-up robot whose axes have mixed signs.

mod virtual_work;

use proptest::prelude::*;

use super::*;
use crate::chain::GaitParameters;
use crate::frames::{Geom, Link};
use crate::mapping::{ArmMode, Mapping, MappingVariant};
use crate::robot::testing::two_armed;
use crate::robot::{Shape, Solid};
use crate::torque_map::{TorqueGap, TorqueSource};

/// The made-up robot with feet, elbows, hands and uneven masses.
fn shaped() -> Robot {
    let mut robot = two_armed();
    let sides = [robot.chain.left.clone(), robot.chain.right.clone()];
    for side in &sides {
        let forearm = robot.joints[side.forearm[1].0].body;
        let mut fix = |name: &str, body: BodyId, at: Point<Link>, solid: Solid| {
            robot.shapes.push(Shape {
                name: name.to_owned(),
                body,
                link_from_geom: Transform::<Link, Geom>::translation(at.metres()),
                solid,
            });
        };
        fix(
            "toe",
            side.toe.0,
            side.toe.1,
            Solid::Sphere { radius: 0.01 },
        );
        let heel = Solid::Ellipsoid {
            half_axes: DVec3::new(0.03, 0.02, 0.02),
        };
        fix("heel", side.toe.0, Point::ORIGIN, heel);
        fix(
            "elbow",
            side.elbow.0,
            side.elbow.1,
            Solid::Sphere { radius: 0.025 },
        );
        let hand = Point::new(0.08 * side.forearm_direction);
        fix("hand", forearm, hand, Solid::Sphere { radius: 0.03 });
        let thigh = robot.joints[side.hip.0].body;
        robot.bodies[thigh.0].mass = 0.5;
        robot.bodies[forearm.0].mass = 0.2;
        // Frames of both sides are turned alike about x: only what lies along x is mirrored.
        robot.bodies[thigh.0].centre_of_mass = Point::new(DVec3::X * 0.02);
        robot.bodies[forearm.0].centre_of_mass = Point::new(0.05 * side.forearm_direction);
    }
    robot.bodies[0].centre_of_mass = Point::new(DVec3::new(0.01, 0.0, 0.03));
    robot
}

fn pose(robot: &Robot, arm: ArmMode, knee: f64, hip: f64, upper_arm: f64) -> JointAngles {
    let mapping = Mapping::new(robot, MappingVariant::Exact, arm).unwrap();
    let at = GaitParameters {
        knee,
        hip,
        upper_arm,
    };
    let chain = mapping.chain().close(at).unwrap();
    mapping.joint_angles(robot, &chain).unwrap()
}

fn at_rest(robot: &Robot, angles: &JointAngles, stance: Stance) -> Rest {
    rest(
        robot,
        &HalfRobot::from_robot(robot).unwrap(),
        angles,
        stance,
    )
    .unwrap()
}

const RULES: [SupportRule; 2] = [SupportRule::AnyShape, SupportRule::ElbowNotHand];
const ARMS: [ArmMode; 2] = [ArmMode::FlatForearm, ArmMode::Fixed];

proptest! {
    /// Moments and energy agree: 1e-7 N·m is fifty times the error of the differences.
    #[test]
    fn virtual_work_matches_force_balance(
        knee in 0.0..0.6_f64, hip in -0.2..0.4_f64, upper_arm in -1.4..-0.6_f64,
        squeeze in -10.0..10.0_f64, arm in prop::sample::select(&ARMS[..]),
    ) {
        let robot = shaped();
        let half = HalfRobot::from_robot(&robot).unwrap();
        let angles = pose(&robot, arm, knee, hip, upper_arm);
        // A level forearm has a choice of supports that the differences would jump between.
        let stance = Stance { supports: SupportRule::ElbowNotHand, squeeze };
        let balance = rest(&robot, &half, &angles, stance).unwrap();
        let work = virtual_work::loads(&robot, &half, &angles, stance).unwrap();
        for (index, joint) in robot.joints.iter().enumerate() {
            let difference = balance.load(JointId(index)) - work[index];
            prop_assert!(difference.abs() < 1e-7, "{} {} {:?}", joint.name, difference, balance);
        }
    }

    /// Force and moment of the reactions balance the weight, and nothing but the supports is on
    /// the floor.
    #[test]
    fn the_floor_carries_the_weight_and_nothing_sinks_in(
        knee in 0.0..0.6_f64, hip in -0.2..0.4_f64, upper_arm in -1.4..-0.6_f64,
        arm in prop::sample::select(&ARMS[..]), rule in prop::sample::select(&RULES[..]),
    ) {
        let robot = shaped();
        let angles = pose(&robot, arm, knee, hip, upper_arm);
        let rest = at_rest(&robot, &angles, Stance::unsqueezed(rule));
        let weight = robot.mass() * GRAVITY;
        let (mut carried, mut moment) = (0.0, 0.0);
        for support in rest.footing.supports() {
            prop_assert!(support.reaction >= 0.0 && support.point.z().abs() < 1e-12);
            carried += support.reaction;
            moment += support.reaction * support.point.x();
        }
        prop_assert!((carried - weight).abs() < 1e-12 * weight);
        // By the other code: the whole robot, shape by shape.
        let poses = robot.forward_kinematics(rest.ground_from_root, &angles);
        let centre = robot.centre_of_mass(&poses);
        prop_assert!((moment - weight * centre.x()).abs() < 1e-12 * weight);
        if rule == SupportRule::AnyShape {
            let bottom = robot.bottom(&poses, |_| true);
            prop_assert!(bottom.abs() < 1e-12, "{bottom}");
        }
    }

    /// Limbs, their images and the trunk together: nothing is left over at the root.
    #[test]
    fn all_forces_on_the_root_balance(
        knee in 0.0..0.6_f64, hip in -0.2..0.4_f64, upper_arm in -1.4..-0.6_f64,
        squeeze in -10.0..10.0_f64,
    ) {
        let robot = shaped();
        let half = HalfRobot::from_robot(&robot).unwrap();
        let angles = pose(&robot, ArmMode::Fixed, knee, hip, upper_arm);
        let pose = half.pose(&robot, &angles).unwrap();
        let centre = half.centre_of_mass(&robot, &pose);
        let start = start_pitch(&robot, &half, &pose);
        let parts = half.parts(&robot, &pose);
        let found = balance::settle(&parts, |_| true, centre, start).unwrap();
        let ground_from_root = ground_from_root(&found, centre);
        let weight = robot.mass() * GRAVITY;
        let footing = footing(&robot, &found, ground_from_root, squeeze);
        let at_root = moments::wrenches(&robot, &half, &pose, &found, &footing)[0];
        prop_assert!(at_root.force.length() < 1e-12 * weight, "{at_root:?}");
        prop_assert!(at_root.moment.y.abs() < 1e-12 * weight, "{at_root:?}");
    }

    /// Whoever leans on the trunk: mirrored joints carry mirrored loads.
    #[test]
    fn left_mirrors_right(knee in 0.0..0.6_f64, upper_arm in -1.4..-0.6_f64) {
        let robot = shaped();
        let angles = pose(&robot, ArmMode::Fixed, knee, 0.1, upper_arm);
        let rest = at_rest(&robot, &angles, Stance::unsqueezed(SupportRule::AnyShape));
        let [left, right] = robot.chain.sides();
        for (l, r) in left.pitch_joints().into_iter().zip(right.pitch_joints()) {
            prop_assert!((rest.load(l) - rest.load(r)).abs() < 1e-12);
        }
    }
}

/// The same robot with one arm's axes turned round: the same rest, angles and loads negated.
#[test]
fn an_axis_turned_round_turns_its_angle_and_load_round() {
    let robot = shaped();
    let angles = pose(&robot, ArmMode::Fixed, 0.3, 0.1, -1.0);
    let (mut turned, mut negated) = (robot.clone(), angles.clone());
    let arm = &robot.chain.right;
    let joints = [arm.shoulder_roll, arm.forearm[0], arm.forearm[1]];
    for joint in joints {
        turned.joints[joint.0].axis = -turned.joints[joint.0].axis;
        negated[joint] = -negated[joint];
    }
    let stance = Stance::unsqueezed(SupportRule::AnyShape);
    let (before, after) = (
        at_rest(&robot, &angles, stance),
        at_rest(&turned, &negated, stance),
    );
    for joint in (0..robot.joints.len()).map(JointId) {
        let sign = if joints.contains(&joint) { -1.0 } else { 1.0 };
        assert!((after.load(joint) - sign * before.load(joint)).abs() < 1e-12);
    }
    // Not for want of anything to carry.
    assert!(before.load(joints[1]).abs() > 1e-3, "{before:?}");
}

/// A limb held out level: the load about its joint is its weight times its arm, downwards.
#[test]
fn a_level_limb_loads_its_joint_with_weight_times_arm() {
    let mut robot = shaped();
    // Only the trunk touches the floor: all that hangs on the shoulder hangs free.
    robot.shapes.retain(|shape| shape.name == "trunk");
    robot.shapes[0].solid = Solid::Cuboid {
        half_edges: DVec3::splat(0.4),
    };
    let zero = JointAngles::zero(&robot);
    let rest = at_rest(&robot, &zero, Stance::unsqueezed(SupportRule::AnyShape));
    let pitch = virtual_work::pitch(&rest);
    let Footing::Two { .. } = rest.footing else {
        panic!("{:?}", rest.footing)
    };

    let poses = robot.forward_kinematics(rest.ground_from_root, &zero);
    let left = &robot.chain.left;
    let shoulder = &robot.joints[left.shoulder.0];
    let at = poses.point((shoulder.body, shoulder.anchor)).x();
    let beyond = [
        left.shoulder,
        left.shoulder_roll,
        left.forearm[0],
        left.forearm[1],
    ];
    let moment: f64 = beyond
        .iter()
        .map(|joint| &robot.joints[joint.0].body)
        .map(|&body| {
            let mass = robot.bodies[body.0].mass;
            let centre = poses.point((body, robot.bodies[body.0].centre_of_mass)).x();
            mass * GRAVITY * (centre - at)
        })
        .sum();
    // Weight ahead of the joint turns about +y, nose down; this shoulder's axis is −y.
    assert!(
        (rest.load(left.shoulder) + moment).abs() < 1e-12,
        "{moment} at {pitch}"
    );
}

/// A ball with its centre of mass below its centre rolls until that is straight below.
#[test]
fn a_round_body_rocks_on_one_support() {
    let mut robot = shaped();
    robot.shapes.retain(|shape| shape.name == "trunk");
    robot.shapes[0].solid = Solid::Sphere { radius: 1.0 };
    let angles = JointAngles::zero(&robot);
    let half = HalfRobot::from_robot(&robot).unwrap();
    let stance = Stance {
        supports: SupportRule::AnyShape,
        squeeze: 5.0,
    };
    let rest = rest(&robot, &half, &angles, stance).unwrap();
    let Footing::One(support) = rest.footing else {
        panic!("{:?}", rest.footing)
    };
    assert!((support.reaction - robot.mass() * GRAVITY).abs() < 1e-12);
    assert!(support.forward.abs() < 1e-15, "nothing to squeeze");
    let poses = robot.forward_kinematics(rest.ground_from_root, &angles);
    assert!((support.point.x() - robot.centre_of_mass(&poses).x()).abs() < 1e-9);
    let work = virtual_work::loads(&robot, &half, &angles, stance).unwrap();
    for (ours, theirs) in rest.load.iter().zip(work) {
        assert!((ours - theirs).abs() < 1e-7, "{ours} {theirs}");
    }
}

#[test]
fn squeeze_is_what_the_floor_adds_and_nothing_else() {
    let robot = shaped();
    let angles = pose(&robot, ArmMode::Fixed, 0.3, 0.1, -1.0);
    let supports = SupportRule::AnyShape;
    let free = at_rest(&robot, &angles, Stance::unsqueezed(supports));
    let squeezed = at_rest(
        &robot,
        &angles,
        Stance {
            supports,
            squeeze: 3.0,
        },
    );
    let poses = robot.forward_kinematics(free.ground_from_root, &angles);
    let ankle = &robot.joints[robot.chain.left.ankle.0];
    let height = poses.point((ankle.body, ankle.anchor)).z();
    // 1.5 N forwards on one foot, a lever `height` below the ankle, whose axis is +y.
    let added = squeezed.load(robot.chain.left.ankle) - free.load(robot.chain.left.ankle);
    assert!((added + 1.5 * height).abs() < 1e-12, "{added} {height}");
}

#[test]
fn lopsided_poses_are_refused_and_say_where() {
    let robot = shaped();
    let half = HalfRobot::from_robot(&robot).unwrap();
    let stance = Stance::unsqueezed(SupportRule::AnyShape);
    let mut angles = pose(&robot, ArmMode::Fixed, 0.3, 0.1, -1.0);
    angles[robot.chain.right.knee] += 0.5 * ASYMMETRY_TOLERANCE;
    assert!(rest(&robot, &half, &angles, stance).is_ok());
    angles[robot.chain.right.knee] += ASYMMETRY_TOLERANCE;
    let error = rest(&robot, &half, &angles, stance).unwrap_err();
    assert_eq!(
        error.to_string(),
        "knee and knee are -0.86° from mirroring each other; statics needs a symmetric pose"
    );
    angles[robot.chain.right.knee] = f64::NAN;
    assert_eq!(
        rest(&robot, &half, &angles, stance),
        Err(RestError::NotFinite)
    );
}

#[test]
fn robots_that_do_not_mirror_or_touch_are_refused() {
    let mut robot = shaped();
    let angles = JointAngles::zero(&robot);
    robot.shapes.clear();
    let half = HalfRobot::from_robot(&robot).unwrap();
    let stance = Stance::unsqueezed(SupportRule::AnyShape);
    assert_eq!(
        rest(&robot, &half, &angles, stance),
        Err(RestError::NothingCarries)
    );
    let thigh = robot.joints[robot.chain.left.hip.0].body;
    robot.bodies[thigh.0].mass += 0.1;
    let error = HalfRobot::from_robot(&robot).unwrap_err();
    assert_eq!(
        error.to_string(),
        "body hip has no mirror image among the robot's bodies; statics needs one"
    );
}

#[test]
fn a_source_answers_in_the_recordings_sign_and_says_what_it_cannot() {
    let robot = shaped();
    let mapping = Mapping::new(&robot, MappingVariant::Exact, ArmMode::Fixed).unwrap();
    let stance = Stance::unsqueezed(SupportRule::AnyShape);
    let source = StaticTorques::new(&robot, mapping, &robot.stops(), stance).unwrap();
    let at = GaitParameters {
        knee: 0.3,
        hip: 0.1,
        upper_arm: -1.0,
    };
    let angles = pose(&robot, ArmMode::Fixed, 0.3, 0.1, -1.0);
    let rest = at_rest(&robot, &angles, stance);
    let ours = source.torques(at).unwrap().to_array();
    for (torque, joint) in ours.into_iter().zip(robot.chain.right.pitch_joints()) {
        assert!((torque - rest.load(joint)).abs() < 1e-12);
    }
    let unreachable = GaitParameters {
        knee: 2.5,
        hip: 2.5,
        upper_arm: 0.0,
    };
    assert!(matches!(
        source.torques(unreachable),
        Err(TorqueGap::Closure(_))
    ));
}
