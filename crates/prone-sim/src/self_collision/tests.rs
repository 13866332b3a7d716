use std::collections::BTreeMap;

use glam::DVec3;

use prone::frames::{Root, Transform};
use prone::robot::Solid;
use prone_files::shipped;

use super::*;
use crate::{LoadedRobot, RobotFiles};
use prone::regime::Regime;

fn nao() -> World {
    let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    World::new(&loaded, Regime::LOCOMOTION).unwrap()
}

fn posture(robot: &Robot, angles: &[(&str, f64)]) -> JointAngles {
    let mut posture = JointAngles::zero(robot);
    for (name, angle) in angles {
        posture[robot.joint(name).unwrap()] = *angle;
    }
    posture
}

#[test]
fn identity_limbs_of_the_shipped_robot() {
    let world = nao();
    let robot = world.robot();
    let limbs = limbs(robot);
    for (body, limb) in [
        ("torso", None),
        ("Neck", Some(Limb::Head)),
        ("Head", Some(Limb::Head)),
        ("LPelvis", Some(Limb::LeftLeg)),
        ("LFoot", Some(Limb::LeftLeg)),
        ("RThigh", Some(Limb::RightLeg)),
        ("LShoulder", Some(Limb::LeftArm)),
        ("LHand", Some(Limb::LeftArm)),
        ("RForearm", Some(Limb::RightArm)),
    ] {
        assert_eq!(limbs[robot.body(body).unwrap().0], limb, "{body}");
    }
    // Arms of 4 shapes, legs of 5, one skull: 2·4·1 + 4·4 + 5·5 + 4·4·5.
    assert_eq!(limb_pairs(robot).len(), 129);
}

/// Three postures overlap: two where the heels meet, which the model has as corners of boxes, and
/// one whose hands lie on the shins.
#[test]
fn regression_shipped_postures() {
    let world = nao();
    let mut check = SelfCollision::new(&world).unwrap();
    let zero = JointAngles::zero(world.robot());
    for (name, distance_mm, one, other) in [
        // Toes out by 9°, ankles 75 mm apart: the square heels cross the middle by 11 mm each.
        ("crouch", -15.537, "LSole", "RSole"),
        ("lying-back", -3.116, "LSole", "RSole"),
        ("lying-belly", 12.127, "LHandShell", "Skull"),
        ("recorded-start", 18.482, "Chest", "LUpperArm"),
        ("sit", -0.398, "RHandShell", "RShinShell"),
        ("sit-relax", 16.689, "LPelvisBall", "RPelvisBall"),
        ("stand", 19.207, "Chest", "LUpperArm"),
        ("stand-init", 20.300, "Chest", "LUpperArm"),
        ("stand-zero", 19.337, "Chest", "LUpperArm"),
        // Upper arms begin 110 mm from the middle, 27 mm thick; the chest reaches to 59 mm at their height and
        // to 70 mm lower down: between 13 and 24 mm.
        ("zero", 19.244, "Chest", "LUpperArm"),
    ] {
        let angles = world.robot().postures.get(name).unwrap_or(&zero);
        let closest = check.scan([angles]).unwrap();
        assert_eq!(closest.shapes, (one.to_owned(), other.to_owned()), "{name}");
        let off = (closest.distance_m * 1e3 - distance_mm).abs();
        // Half of the last digit, and what the engine iterates to.
        assert!(off < 2e-3, "{name}: {closest:?}");
    }
    assert_eq!(world.robot().postures.len(), 9, "each is listed above");
}

/// The segment distance of two capsules by minimising over both axes on a grid that shrinks, with
/// poses from this program's own kinematics.
fn capsule_distance(robot: &Robot, angles: &JointAngles, names: [&str; 2]) -> f64 {
    let poses = robot.forward_kinematics(Transform::<Root, Root>::translation(DVec3::ZERO), angles);
    let [(a, b, r), (c, d, q)] = names.map(|name| {
        let shape = robot
            .shapes
            .iter()
            .find(|shape| shape.name == name)
            .unwrap();
        let Solid::Capsule {
            radius,
            half_length,
        } = shape.solid
        else {
            panic!("{name} is no capsule")
        };
        let root_from_geom = *poses.of(shape.body) * shape.link_from_geom;
        let axis = half_length * root_from_geom.rotate(DVec3::Z);
        let centre = root_from_geom.origin().metres();
        (centre - axis, centre + axis, radius)
    });
    let gap = |s: f64, t: f64| (a.lerp(b, s) - c.lerp(d, t)).length();
    let (mut s, mut t, mut width) = (0.5, 0.5, 0.5);
    while width > 1e-9 {
        let steps = (-10..=10).map(|k| f64::from(k) / 10.0 * width);
        let grid = steps
            .clone()
            .flat_map(|i| steps.clone().map(move |j| (i, j)))
            .map(|(i, j)| ((s + i).clamp(0.0, 1.0), (t + j).clamp(0.0, 1.0)));
        (s, t) = grid
            .min_by(|one, other| gap(one.0, one.1).total_cmp(&gap(other.0, other.1)))
            .unwrap();
        width *= 0.5;
    }
    gap(s, t) - r - q
}

/// What is left of the NAO's 210 pairs: the neighbours that the module names, and shapes of one body, are
/// not compared.
#[test]
fn identity_neighbours_of_the_shipped_robot() {
    let world = nao();
    let check = SelfCollision::new(&world).unwrap();
    let robot = world.robot();
    let of_bodies = |one: &str, other: &str| {
        let bodies = [one, other].map(|name| robot.body(name).unwrap());
        let pairs = check.pairs.iter();
        let pairs = pairs.map(|pair| pair.map(|shape| robot.shapes[shape].body));
        pairs
            .filter(|&[a, b]| [a, b] == bodies || [b, a] == bodies)
            .count()
    };
    for (one, other, count) in [
        ("torso", "Head", 0),
        ("torso", "LPelvis", 0),
        ("torso", "LThigh", 0),
        ("LPelvis", "LThigh", 0),
        ("LTibia", "LFoot", 0),
        ("LBiceps", "LForearm", 0),
        ("LForearm", "LHand", 0),
        ("torso", "LBiceps", 4),
        ("torso", "LHand", 2),
        ("torso", "LTibia", 2),
        ("LThigh", "LFoot", 2),
        ("Head", "RFoot", 2),
        ("LBiceps", "LHand", 2),
        ("LHand", "RThigh", 1),
    ] {
        assert_eq!(of_bodies(one, other), count, "{one} {other}");
        let mirrored = [one, other].map(|name| match name.split_at(1) {
            ("L", rest) => format!("R{rest}"),
            ("R", rest) => format!("L{rest}"),
            _ => name.to_owned(),
        });
        assert_eq!(of_bodies(&mirrored[0], &mirrored[1]), count, "{mirrored:?}");
    }
    assert_eq!(check.pairs.len(), 181);
    let different: BTreeSet<[usize; 2]> = check.pairs.iter().map(|&pair| sorted(pair)).collect();
    assert_eq!(different.len(), 181, "no pair is there twice");
}

/// Only pairs that can be nearer than the nearest so far are measured; the answer is that of all.
#[test]
fn identity_a_scan_finds_the_nearest_of_all_pairs() {
    let world = nao();
    let mut check = SelfCollision::new(&world).unwrap();
    let swing = |k: i32| {
        let share = f64::from(k) / 10.0;
        posture(
            world.robot(),
            &[
                ("LShoulderPitch", 2.0 - 4.0 * share),
                ("LElbowRoll", -1.5 * share),
                ("RHipRoll", 0.3 * share),
                ("RKneePitch", 2.0 * share),
            ],
        )
    };
    let postures: Vec<JointAngles> = (0..=10).map(swing).collect();
    for postures in [&postures[..], &postures[3..4], &postures[7..]] {
        let all = check.distances(postures).unwrap();
        let nearest = check.scan(postures).unwrap();
        let least = all.iter().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        assert_eq!((nearest.distance_m, nearest.index), *least);
    }
}

/// A hand on its way into the belly: the trunk is no neighbour of it.
#[test]
fn limit_a_hand_in_the_trunk_collides() {
    let world = nao();
    let mut check = SelfCollision::new(&world).unwrap();
    let folded = posture(
        world.robot(),
        &[
            ("LShoulderPitch", 1.3),
            ("LShoulderRoll", -0.3),
            ("LElbowYaw", 0.0),
            ("LElbowRoll", -1.5),
        ],
    );
    let nearest = check.scan([&folded]).unwrap();
    assert!(nearest.distance_m < -0.005, "{nearest:?}");
    let trunk = ["Chest", "Belly"];
    assert!(trunk.contains(&nearest.shapes.0.as_str()), "{nearest:?}");
}

/// The distance of every pair, m, by the names of its shapes.
fn named_distances(check: &mut SelfCollision, angles: &JointAngles) -> BTreeMap<[String; 2], f64> {
    let distances = check.distances([angles]).unwrap().into_iter();
    let shapes = &check.robot.shapes;
    let named = distances.zip(&check.pairs).map(|((distance, _), pair)| {
        let names = pair.map(|shape| shapes[shape].name.clone());
        (names, distance)
    });
    named.collect()
}

fn engine_distance(check: &mut SelfCollision, angles: &JointAngles, names: [&str; 2]) -> f64 {
    let distances = named_distances(check, angles);
    distances[&names.map(str::to_owned)]
}

#[test]
fn identity_capsules_are_as_far_apart_as_their_axes_say() {
    let world = nao();
    let robot = world.robot();
    let mut check = SelfCollision::new(&world).unwrap();
    let mut postures: Vec<JointAngles> = robot.postures.values().cloned().collect();
    postures.push(JointAngles::zero(robot));
    postures.push(posture(
        robot,
        &[("LShoulderRoll", -0.3), ("RShoulderRoll", 0.2)],
    ));
    postures.push(posture(robot, &[("LHipRoll", -0.37), ("RHipRoll", 0.1)]));
    for angles in &postures {
        for names in [
            ["LThighShell", "RThighShell"],
            ["LShinShell", "RShinShell"],
            ["LForearmShell", "RForearmShell"],
            ["LHandShell", "RHandShell"],
            ["LHandShell", "LThighShell"],
            ["RForearmShell", "RShinShell"],
        ] {
            let ours = capsule_distance(robot, angles, names);
            let engine = engine_distance(&mut check, angles, names);
            assert!((ours - engine).abs() < 1e-8, "{names:?}: {ours} {engine}");
        }
    }
}

/// The arm is raised beside the head (pitch −π/2) and rolled inwards, past its stop.
#[test]
fn limit_an_arm_through_the_head_collides() {
    let world = nao();
    let mut check = SelfCollision::new(&world).unwrap();
    let swing: Vec<JointAngles> = (0..=20)
        .map(|step| {
            let roll = -0.06 * f64::from(step);
            posture(
                world.robot(),
                &[
                    ("LShoulderPitch", -std::f64::consts::FRAC_PI_2),
                    ("LShoulderRoll", roll),
                ],
            )
        })
        .collect();
    let start = check.scan([&swing[0]]).unwrap();
    assert!(start.distance_m > 0.0, "{start:?}");
    let nearest = check.scan(&swing).unwrap();
    assert!(nearest.distance_m < -0.02);
    assert!(nearest.index > 0);
    let (arm, head) = &nearest.shapes;
    assert!(arm.starts_with('L') && head == "Skull", "{arm} {head}");
    // At that posture alone it is the same.
    let alone = check.scan([&swing[nearest.index]]).unwrap();
    assert_eq!(
        alone,
        Nearest {
            index: 0,
            ..nearest
        }
    );
}

#[test]
fn limit_crossing_legs_collide() {
    let world = nao();
    let mut check = SelfCollision::new(&world).unwrap();
    let crossed = posture(world.robot(), &[("LHipRoll", -0.3), ("RHipRoll", 0.3)]);
    let closest = check.scan([&crossed]).unwrap();
    assert!(closest.distance_m < -0.01, "{closest:?}");
    let (left, right) = &closest.shapes;
    assert!(
        left.starts_with('L') && right.starts_with('R'),
        "{left} {right}"
    );
}

/// Mirrored joints: roll, yaw and the head's yaw change sign, pitch does not.
#[test]
fn identity_left_mirrors_right() {
    let world = nao();
    let robot = world.robot();
    let mut check = SelfCollision::new(&world).unwrap();
    let mirror = |angles: &JointAngles| {
        let mut mirrored = JointAngles::zero(robot);
        for (index, joint) in robot.joints.iter().enumerate() {
            let name = &joint.name;
            let twin = match name.split_at(1) {
                ("L", rest) => format!("R{rest}"),
                ("R", rest) => format!("L{rest}"),
                _ => name.clone(),
            };
            let same = name.ends_with("Pitch");
            let sign = if same { 1.0 } else { -1.0 };
            mirrored[robot.joint(&twin).unwrap()] = sign * angles[JointId(index)];
        }
        mirrored
    };
    let side = |name: &str| match name.split_at(1) {
        ("L", rest) => format!("R{rest}"),
        ("R", rest) => format!("L{rest}"),
        _ => name.to_owned(),
    };
    for (name, angles) in &robot.postures {
        let distances = named_distances(&mut check, angles);
        let twins = named_distances(&mut check, &mirror(angles));
        for ([one, other], distance) in &distances {
            let (one_twin, other_twin) = (side(one), side(other));
            let twin = twins
                .get(&[one_twin.clone(), other_twin.clone()])
                .or_else(|| twins.get(&[other_twin, one_twin]))
                .unwrap();
            let off = (twin - distance).abs();
            // What the engine iterates to.
            assert!(off < 1e-5, "{name}: {one} {other}, off by {off} m");
        }
    }
}

#[test]
fn limit_what_is_no_posture_is_refused() {
    let world = nao();
    let mut check = SelfCollision::new(&world).unwrap();
    let bad = posture(world.robot(), &[("LKneePitch", f64::NAN)]);
    assert_eq!(
        check.scan([&bad]).unwrap_err().to_string(),
        "LKneePitch NaN rad at posture 0 is no angle"
    );
    let short = JointAngles::from_fn(3, |_| 0.0);
    assert_eq!(
        check.scan([&short]).unwrap_err().to_string(),
        "posture 0 has 3 joint angles, robot NAO H25 V4 has 24 joints"
    );
    assert_eq!(check.scan([]).unwrap_err(), SelfCollisionError::NoPostures);
}
