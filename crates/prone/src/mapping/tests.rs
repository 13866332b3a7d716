//! Identities of the mapping, on a made-up robot whose axes have mixed signs.

use glam::{DQuat, DVec3};
use proptest::prelude::*;

use super::*;
use crate::chain::GaitParameters;
use crate::frames::{Ground, Point, Root, Transform};
use crate::robot::testing::two_armed;

const VARIANTS: [MappingVariant; 2] = [MappingVariant::Exact, MappingVariant::Original];
const ARMS: [ArmMode; 2] = [ArmMode::FlatForearm, ArmMode::Fixed];

#[test]
fn a_robot_without_published_chain_has_no_original_mapping() {
    let mut robot = two_armed();
    robot.chain.published = None;
    let error = Mapping::new(&robot, MappingVariant::Original, ArmMode::FlatForearm);
    assert!(matches!(error, Err(MappingError::NoPublishedChain { .. })));
    robot.chain.fixed_arm = None;
    let error = Mapping::new(&robot, MappingVariant::Exact, ArmMode::Fixed);
    assert!(matches!(error, Err(MappingError::NoFixedArm { .. })));
}

#[test]
fn a_chain_that_leaves_the_sagittal_plane_is_refused() {
    let mut robot = two_armed();
    let knee = robot.chain.left.knee;
    robot.joints[knee.0].axis = DVec3::Z;
    let error = Mapping::new(&robot, MappingVariant::Exact, ArmMode::Fixed).unwrap_err();
    assert!(error.to_string().starts_with("knee turns about"), "{error}");
}

#[test]
fn an_upper_arm_too_long_to_project_is_refused() {
    let mut robot = two_armed();
    robot.chain.projected_upper_arm = 0.2;
    let error = Mapping::new(&robot, MappingVariant::Exact, ArmMode::Fixed).unwrap_err();
    assert!(error.to_string().contains("200.00 mm"), "{error}");
}

/// A toe site in front of the ankle and above it: θ2⁰ is more than half a turn, and the standing
/// pose is still all joints at zero.
#[test]
fn joint_angles_stay_within_half_a_turn() {
    let mut robot = two_armed();
    for height in [0.2, -0.2] {
        for forward in [0.2, -0.2] {
            let foot = robot.chain.left.toe.0;
            let poses = robot.zero_pose();
            let pose = poses.of(foot);
            let toe = pose.rotation().inverse() * DVec3::new(forward, 0.0, height);
            robot.chain.left.toe.1 = Point::new(toe);
            robot.chain.right.toe.1 = Point::new(toe);
            let mapping =
                Mapping::new(&robot, MappingVariant::Exact, ArmMode::FlatForearm).unwrap();
            let standing = chain_angles(&mapping, &robot, &JointAngles::zero(&robot));
            assert!(standing.ankle.abs() <= TAU / 2.0, "{standing:?}");
            let joints = mapping.unspread_limb_angles(&robot, &standing);
            let side = &robot.chain.left;
            for id in side.pitch_joints() {
                assert!(joints[id].abs() < 1e-12, "{}", joints[id]);
            }
            check_kinematics(&robot).unwrap();
        }
    }
}

#[test]
fn wrapping_keeps_half_a_turn_and_nan() {
    let half = TAU / 2.0;
    for (angle, wrapped) in [
        (half, half),
        (-half, half),
        (1.5 * TAU, half),
        (-7.0, TAU - 7.0),
    ] {
        assert!((wrap(angle) - wrapped).abs() < 1e-12, "{angle}");
    }
    assert!(wrap(f64::NAN).is_nan());
}

#[test]
fn kinematics_that_leave_the_chain_are_refused() {
    check_kinematics(&two_armed()).unwrap();
    let refused = |change: fn(&mut Robot)| {
        let mut robot = two_armed();
        change(&mut robot);
        check_kinematics(&robot).unwrap_err()
    };
    for (change, side, point) in [
        // The elbow's site beyond the hinges that point the forearm.
        (
            (|robot| {
                let hand = robot.joints[robot.chain.left.forearm[1].0].body;
                robot.chain.left.elbow = (hand, Point::new(DVec3::new(0.01, 0.0, 0.02)));
            }) as fn(&mut Robot),
            "left",
            "elbow",
        ),
        // One leg 1 mm longer than the other.
        (
            |robot| {
                let shin = robot.joints[robot.chain.right.ankle.0].body;
                let pose = &mut robot.bodies[shin.0].parent_from_body;
                *pose = Transform::new(pose.rotation(), pose.origin().metres() * 1.01);
            },
            "right",
            "toe",
        ),
        // A knee that another joint's name stands for.
        (
            |robot| robot.chain.left.knee = robot.chain.right.knee,
            "left",
            "ankle",
        ),
    ] {
        let error = refused(change);
        let MappingError::DoesNotClose {
            side: s,
            point: p,
            off_mm,
        } = error
        else {
            panic!("{error}");
        };
        assert_eq!((s, p), (side, point), "{off_mm} mm");
        assert!(off_mm > 0.1);
    }
}

/// Chain angles of the left side's joints: the inverse of [`Mapping::joint_angles`].
///
/// θ1 is passive: it follows from the elbow being on the ground (equation (2) of
/// [`crate::chain`]), whether or not it lies at the chain's span.
fn chain_angles(mapping: &Mapping, robot: &Robot, joints: &JointAngles) -> ChainAngles {
    let layout = &robot.chain.left;
    let [side, _] = &mapping.sides;
    let [_, zero_knee, zero_hip] = side.geometry.zero_angles;
    let sign = side.geometry.pitch_signs;
    let lying = ChainAngles {
        toe: 0.0,
        ankle: wrap(sign[0] * joints[layout.ankle] + side.ankle_zero),
        knee: wrap(sign[1] * joints[layout.knee] + zero_knee),
        hip: wrap(sign[2] * joints[layout.hip] + zero_hip),
        shoulder: wrap(-sign[3] * joints[layout.shoulder] + side.spread.shoulder_zero),
    };
    let elbow = mapping.chain.posture(&lying).elbow;
    ChainAngles {
        toe: -elbow.z().atan2(elbow.x()),
        ..lying
    }
}

/// The pose of the root over the ground: pitched, then shifted so that the toe is at the origin.
fn grounded(
    robot: &Robot,
    mapping: &Mapping,
    chain: &ChainAngles,
    joints: &JointAngles,
) -> Transform<Ground, Root> {
    let turned = Transform::<Ground, Root>::new(
        DQuat::from_rotation_y(mapping.root_pitch(chain)),
        DVec3::ZERO,
    );
    let toe = robot
        .forward_kinematics(turned, joints)
        .point(robot.chain.left.toe);
    Transform::new(turned.rotation(), DVec3::new(-toe.x(), 0.0, -toe.z()))
}

proptest! {
    #[test]
    fn mapping_round_trips(
        knee in 0.0..0.6_f64, hip in -0.2..0.4_f64, upper_arm in -1.5..-0.6_f64,
        variant in prop::sample::select(&VARIANTS[..]), arm in prop::sample::select(&ARMS[..]),
    ) {
        let robot = two_armed();
        let mapping = Mapping::new(&robot, variant, arm).unwrap();
        let chain = mapping.chain().close(GaitParameters { knee, hip, upper_arm }).unwrap();
        let joints = mapping.joint_angles(&robot, &chain).unwrap();
        let back = chain_angles(&mapping, &robot, &joints);
        for (a, b) in [
            (chain.toe, back.toe), (chain.ankle, back.ankle), (chain.knee, back.knee),
            (chain.hip, back.hip), (chain.shoulder, back.shoulder),
        ] {
            prop_assert!((a - b).abs() < 1e-9, "{chain:?} {back:?}");
        }
    }

    /// The robot's own kinematics put toe, joints and elbow where the planar chain has them, on
    /// both sides, and the forearm points along +x.
    #[test]
    fn exact_joints_put_the_robot_on_the_chain(
        knee in 0.0..0.6_f64, hip in -0.2..0.4_f64, upper_arm in -1.5..-0.6_f64,
    ) {
        let robot = two_armed();
        let mapping = Mapping::new(&robot, MappingVariant::Exact, ArmMode::FlatForearm).unwrap();
        let chain = mapping.chain().close(GaitParameters { knee, hip, upper_arm }).unwrap();
        let joints = mapping.joint_angles(&robot, &chain).unwrap();
        let poses = robot.forward_kinematics(grounded(&robot, &mapping, &chain, &joints), &joints);
        let planar = mapping.chain().posture(&chain);
        for side in robot.chain.sides() {
            let centre = |id: crate::robot::JointId| {
                let joint = &robot.joints[id.0];
                poses.point((joint.body, joint.anchor))
            };
            let ours = [
                poses.point(side.toe), centre(side.ankle), centre(side.knee), centre(side.hip),
                centre(side.shoulder), poses.point(side.elbow),
            ];
            for (point, wanted) in ours.iter().zip(planar.points()) {
                prop_assert!((point.x() - wanted.x()).abs() < 1e-9, "{point:?} {wanted:?}");
                prop_assert!((point.z() - wanted.z()).abs() < 1e-9, "{point:?} {wanted:?}");
            }
            let forearm = robot.joints[side.forearm[1].0].body;
            let forward = poses.of(forearm).rotate(side.forearm_direction);
            prop_assert!((forward - DVec3::X).length() < 1e-9, "{forward}");
        }
    }

    /// Mirrored bodies: every point of the right limbs is the left's with y negated.
    #[test]
    fn left_mirrors_right(
        knee in 0.0..0.6_f64, upper_arm in -1.5..-0.6_f64,
        variant in prop::sample::select(&VARIANTS[..]), arm in prop::sample::select(&ARMS[..]),
    ) {
        let robot = two_armed();
        let mapping = Mapping::new(&robot, variant, arm).unwrap();
        let chain = mapping.chain().close(GaitParameters { knee, hip: 0.1, upper_arm }).unwrap();
        let joints = mapping.joint_angles(&robot, &chain).unwrap();
        let poses = robot.forward_kinematics(
            Transform::<Root, Root>::translation(DVec3::ZERO), &joints,
        );
        let [left, right] = robot.chain.sides();
        let tips = |side: &crate::robot::SideLayout| {
            let forearm = robot.joints[side.forearm[1].0].body;
            [
                poses.point(side.toe).metres(),
                poses.point(side.elbow).metres(),
                poses.of(forearm).rotate(side.forearm_direction),
            ]
        };
        for (l, r) in tips(left).into_iter().zip(tips(right)) {
            prop_assert!((l * DVec3::new(1.0, -1.0, 1.0) - r).length() < 1e-9, "{l} {r}");
        }
    }
}
