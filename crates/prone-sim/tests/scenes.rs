//! Robots in scenes: what a world makes of a [`Scene`], and how the robot feels it.

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;

use prone::frames::Point;
use prone::regime::Regime;
use prone::robot::ContactGroup;
use prone::scene::{Marker, Panel, Ramp, Roughness, Scene, SideFriction};
use prone_files::shipped;
use prone_sim::{LoadedRobot, Placement, RobotFiles, Simulation, World, WorldError};

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

fn lying(loaded: &LoadedRobot) -> Placement {
    Placement {
        posture: loaded.robot().postures["recorded-start"].clone(),
        pitch: FRAC_PI_2,
    }
}

fn floor(slope_deg: f64, friction: f64) -> Scene {
    let mut scene = Scene::level();
    scene.floor.slope = slope_deg.to_radians();
    scene.floor.friction = Some(SideFriction {
        left: friction,
        right: friction,
    });
    scene
}

fn rough(height: f64) -> Roughness {
    Roughness {
        height,
        spacing: 0.05,
        from_x: 0.1,
        length: 1.0,
        width: 0.8,
        seed: 3,
    }
}

/// How far the root moves in `seconds`, after one second of settling, m.
fn drift(world: &World, loaded: &LoadedRobot, seconds: usize) -> DVec3 {
    let mut simulation = Simulation::new(world, &lying(loaded));
    let mut run = |seconds: usize| {
        for _ in 0..20 * seconds {
            simulation.control_step().unwrap();
        }
        simulation.ground_from_root().origin().metres()
    };
    let start = run(1);
    run(seconds) - start
}

#[test]
fn identity_the_level_scene_is_the_plain_world() {
    let loaded = nao();
    for regime in [Regime::TORQUE_STUDY, Regime::LOCOMOTION] {
        let plain = World::new(&loaded, regime).unwrap();
        let mut named = Scene::level();
        named.name = "kitchen".to_owned();
        let level = World::in_scene(&loaded, regime, &named).unwrap();
        let mut runs = [&plain, &level].map(|world| Simulation::new(world, &lying(&loaded)));
        for _ in 0..20 {
            let [one, other] = runs.each_mut().map(|run| run.control_step().unwrap());
            assert_eq!(one, other);
        }
        let [one, other] = runs.map(|run| run.snapshot());
        assert_eq!(one, other);
        assert!(plain.scene().is_plain());
    }
}

/// On +10° the robot sticks where tan 10° = 0.18 is below the friction, and slides back, towards
/// −x, where it is far above. Without any it falls freely along the floor.
#[test]
fn a_slope_pulls_backwards_and_friction_holds() {
    let loaded = nao();
    let world = |slope, friction| {
        World::in_scene(&loaded, Regime::LOCOMOTION, &floor(slope, friction)).unwrap()
    };
    let sticks = drift(&world(10.0, 0.7), &loaded, 1);
    // Soft contacts creep; 1 mm/s is far from sliding.
    assert!(sticks.length() < 1e-3, "{sticks}");
    let slides = drift(&world(10.0, 0.05), &loaded, 1);
    assert!(slides.x < -0.5 && slides.y.abs() < 0.05, "{slides}");
    let down = drift(&world(-10.0, 0.05), &loaded, 1);
    assert!(down.x > 0.5, "{down}");
    // From rest g sin 10° moves it g sin 10° · (2² − 1²)/2 in the second second. 1 %: on the way
    // it also turns and settles a little.
    let free = drift(&world(10.0, 0.0), &loaded, 1);
    let expected = -9.81 * 10_f64.to_radians().sin() * 1.5;
    assert!((free.x / expected - 1.0).abs() < 0.01, "{free} {expected}");
}

/// Uneven friction turns the robot towards the side that holds: sliding back it swings about it.
#[test]
fn friction_has_sides_and_they_mirror() {
    let loaded = nao();
    let turn = |left, right| {
        let mut scene = floor(20.0, 0.0);
        scene.floor.friction = Some(SideFriction { left, right });
        let world = World::in_scene(&loaded, Regime::LOCOMOTION, &scene).unwrap();
        let mut simulation = Simulation::new(&world, &lying(&loaded));
        for _ in 0..20 {
            simulation.control_step().unwrap();
        }
        // The belly faces down; the robot's own z is its heading.
        let heading = simulation.ground_from_root().rotate(DVec3::Z);
        heading.y.atan2(heading.x)
    };
    let left = turn(0.6, 0.05);
    let right = turn(0.05, 0.6);
    // The left side stays up, the right one slides back: a turn to the right.
    assert!(left < -0.02, "{left}");
    // Two runs of one symmetric robot; its ankles' stops differ by half a degree.
    assert!((left + right).abs() < 0.2 * left.abs(), "{left} {right}");
}

/// Under a plate that is lower than the robot, what touches it is known by its place in the list,
/// and what the floor carries is not mixed with it.
#[test]
fn a_plate_that_is_too_low_is_touched() {
    let loaded = nao();
    let free = World::in_scene(&loaded, Regime::LOCOMOTION, &Scene::under_plate(0.3, 1.5)).unwrap();
    let kinds = |world: &World| {
        world
            .obstacles()
            .iter()
            .map(|o| o.kind.name())
            .collect::<Vec<_>>()
    };
    assert_eq!(kinds(&free)[..2], ["plate", "plate leg"]);
    let mut scene = floor(-40.0, 0.0);
    scene.plates = Scene::under_plate(0.1, 1.5).plates;
    let world = World::in_scene(&loaded, Regime::LOCOMOTION, &scene).unwrap();
    let mut simulation = Simulation::new(&world, &lying(&loaded));
    let mut touched = Vec::new();
    for _ in 0..20 {
        simulation.control_step().unwrap();
        touched.extend(simulation.contact_forces());
    }
    // It slides into the plate's near edge, and no further.
    touched.retain(|contact| contact.obstacle.is_some());
    let names: Vec<_> = touched
        .iter()
        .filter_map(|c| Some(world.obstacles()[c.obstacle?].kind.name()))
        .collect();
    assert!(names.contains(&"plate"), "{names:?}");
    assert!(touched.iter().any(|c| c.force.length() > 0.0));
    let x = simulation.ground_from_root().origin().x();
    assert!(x < 0.3, "{x}");
}

/// Rough ground and ramps are ground: lying on them the robot's weight is in the record.
#[test]
fn rough_ground_and_ramps_carry_the_weight() {
    let loaded = nao();
    let weight = loaded.robot().mass() * 9.81;
    let mut on_bumps = Scene::level();
    on_bumps.floor.roughness = Some(rough(0.01));
    let mut on_ramp = Scene::level();
    on_ramp.ramps.push(Ramp {
        start: 0.0,
        length: 3.0,
        angle: 2_f64.to_radians(),
        width: 1.0,
    });
    // Both reach under the robot, whose root begins at x = 0, and lift it.
    for scene in [on_bumps, on_ramp] {
        let world = World::in_scene(&loaded, Regime::LOCOMOTION, &scene).unwrap();
        let mut resting = Simulation::new(&world, &lying(&loaded));
        let mut contact = [0.0; ContactGroup::COUNT];
        for _ in 0..40 {
            contact = resting.control_step().unwrap().contact;
        }
        // 1 %: what is left of the fall after two seconds.
        let carried: f64 = contact.iter().sum();
        assert!((carried / weight - 1.0).abs() < 0.01, "{carried} {weight}");
    }
}

#[test]
fn identity_rough_ground_gives_the_same_bits_twice() {
    let loaded = nao();
    let mut scene = floor(-10.0, 0.0);
    scene.floor.roughness = Some(rough(0.005));
    let run = || {
        let world = World::in_scene(&loaded, Regime::LOCOMOTION, &scene).unwrap();
        let mut simulation = Simulation::new(&world, &lying(&loaded));
        for _ in 0..20 {
            simulation.control_step().unwrap();
        }
        (
            simulation.ground_from_root().origin().metres(),
            simulation.snapshot(),
        )
    };
    let (at, snapshot) = run();
    assert_eq!(snapshot, run().1);
    // 0.8 m further it lies among the bumps, which lift it; without them it slides on the plane.
    scene.floor.roughness = None;
    let plane = World::in_scene(&loaded, Regime::LOCOMOTION, &scene).unwrap();
    let mut simulation = Simulation::new(&plane, &lying(&loaded));
    for _ in 0..20 {
        simulation.control_step().unwrap();
    }
    let flat = simulation.ground_from_root().origin().metres();
    assert!(at.z > flat.z + 5e-4, "{at} {flat}");
}

/// A marker, however close, changes nothing: it has no contacts.
#[test]
fn a_marker_is_not_touched() {
    let loaded = nao();
    let mut scene = Scene::level();
    scene.marker = Some(Marker {
        position: Point::new(DVec3::new(-0.1, 0.0, 0.06)),
        radius: 0.05,
        facing: 0.0,
    });
    let marked = World::in_scene(&loaded, Regime::LOCOMOTION, &scene).unwrap();
    let plain = World::new(&loaded, Regime::LOCOMOTION).unwrap();
    let [with, without] = [&marked, &plain].map(|world| drift(world, &loaded, 1));
    // 1e-9 m: the two start at another x.
    assert!((with - without).length() < 1e-9, "{with} {without}");
}

#[test]
fn an_invalid_scene_is_an_error_that_names_it() {
    let loaded = nao();
    let mut scene = Scene::level();
    scene.panels.push(Panel {
        start: 0.1,
        width: 1.0,
        lower_edge: f64::NAN,
        upper_edge: 0.4,
        thickness: 0.01,
    });
    let error = World::in_scene(&loaded, Regime::LOCOMOTION, &scene).unwrap_err();
    assert!(matches!(error, WorldError::Scene { .. }));
    assert_eq!(
        error.to_string(),
        "scene level: panel 1: lower edge NaN m is outside 0 to 100 m"
    );
}
