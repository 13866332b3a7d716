//! What a model may say without another robot, floor or servo coming of it.

mod changed;

use std::f64::consts::FRAC_PI_2;

use changed::{SAME, changed};
use prone::regime::Regime;
use prone::robot::ContactGroup;
use prone_files::shipped::NAO;
use prone_sim::{LoadedRobot, Placement, RobotFiles, Simulation, StepMeans, World};

fn nao() -> LoadedRobot {
    LoadedRobot::load(changed(SAME, SAME)).unwrap()
}

fn lying(loaded: &LoadedRobot) -> Placement {
    Placement {
        posture: loaded.robot().postures["recorded-start"].clone(),
        pitch: FRAC_PI_2,
    }
}

/// What a second on the floor looks like.
fn run(loaded: &LoadedRobot, regime: Regime) -> Vec<StepMeans> {
    let world = World::new(loaded, regime).unwrap();
    let mut simulation = Simulation::new(&world, &lying(loaded));
    (0..20)
        .map(|_| simulation.control_step().unwrap())
        .collect()
}

/// The angles of some attributes, from radians to degrees.
fn in_degrees(mjcf: &str) -> String {
    let mut text = mjcf.replace("angle=\"radian\" ", "");
    for key in [" range=\"", " euler=\""] {
        let mut parts = text.split(key);
        let mut turned = parts.next().unwrap().to_owned();
        for part in parts {
            let (angles, rest) = part.split_once('"').unwrap();
            let degrees: Vec<String> = angles
                .split(' ')
                .map(|angle| angle.parse::<f64>().unwrap().to_degrees().to_string())
                .collect();
            turned += &[key, &degrees.join(" "), "\"", rest].concat();
        }
        text = turned;
    }
    text
}

#[test]
fn a_model_in_degrees_is_the_same_robot_with_the_same_stops() {
    let radians = nao();
    let degrees = LoadedRobot::load(RobotFiles {
        mjcf: in_degrees(NAO.mjcf),
        ..changed(SAME, SAME)
    })
    .unwrap();
    // 1e-12: rounding of the conversion and back.
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
    let mut same = prone::robot::Robot::clone(degrees.robot());
    for (ours, theirs) in same.joints.iter_mut().zip(&radians.robot().joints) {
        near(ours.range.lower, theirs.range.lower);
        near(ours.range.upper, theirs.range.upper);
        ours.range = theirs.range;
    }
    assert_eq!(&same, radians.robot().as_ref());

    for regime in [Regime::TORQUE_STUDY, Regime::LOCOMOTION] {
        for loaded in [&radians, &degrees] {
            let world = World::new(loaded, regime).unwrap();
            let data = world.at(&Simulation::new(&world, &lying(loaded)).snapshot());
            // The free joint comes first.
            let compiled = &data.model().jnt_range()[1..];
            assert_eq!(compiled.len(), world.stops().len());
            for (compiled, stop) in compiled.iter().zip(world.stops()) {
                assert_eq!((compiled[0], compiled[1]), (stop.lower, stop.upper));
            }
            let expected = World::new(&radians, regime).unwrap();
            for (stop, theirs) in world.stops().iter().zip(expected.stops()) {
                near(stop.lower, theirs.lower);
                near(stop.upper, theirs.upper);
            }
        }
    }
}

/// A worse gear lets the robot sag where its own motors hold it, and changes no regime of the study.
#[test]
fn the_motors_of_a_robot_hold_in_locomotion_alone() {
    let lazy = ("gear_efficiency = 0.6", "gear_efficiency = 0.1");
    let loaded = LoadedRobot::load(changed(lazy, SAME)).unwrap();
    assert!(run(&loaded, Regime::LOCOMOTION) != run(&nao(), Regime::LOCOMOTION));
    for study in [Regime::TORQUE_STUDY, Regime::TABLE] {
        assert!(run(&loaded, study) == run(&nao(), study), "{}", study.name);
    }
}

/// Whatever a model sets for floors, servos and the solver, the program sets it again.
#[test]
fn settings_of_the_model_change_neither_floor_nor_servos() {
    for change in [
        "<option gravity='0 0 -1.6' wind='3 0 0' density='1.2' viscosity='1' timestep='.01' \
         impratio='9' iterations='1' o_margin='.05' noslip_iterations='3'><flag contact='disable' \
         gravity='disable' limit='disable' actuation='disable' override='enable' \
         frictionloss='disable'/></option><default>",
        "<default><general gear='3' ctrllimited='true' ctrlrange='-.1 .1' forcerange='-.1 .1' \
         gainprm='7 7 7' biasprm='1 2 3' dyntype='filter' dynprm='.5' actlimited='true' \
         actrange='-.1 .1' group='3'/>",
        "<default><velocity gear='5' kv='100' ctrllimited='true' ctrlrange='-.1 .1'/>",
        "<default><position kp='9' dampratio='1' inheritrange='1'/>",
    ] {
        let loaded = LoadedRobot::load(changed(SAME, ("<default>", change))).unwrap();
        for regime in [Regime::TORQUE_STUDY, Regime::LOCOMOTION] {
            assert!(run(&loaded, regime) == run(&nao(), regime), "{change}");
        }
    }
    // For the geoms' defaults, on the NAO's own geoms too.
    let hostile = "contype=\"0\" conaffinity=\"1\" condim=\"6\" margin=\".01\" gap=\".005\" \
                   priority=\"3\" solmix=\"5\" shellinertia=\"true\" friction=\"9 9 9\"";
    let floor = "contype=\"0\" conaffinity=\"1\"";
    let loaded = LoadedRobot::load(changed(SAME, (floor, hostile))).unwrap();
    assert!(run(&loaded, Regime::LOCOMOTION) == run(&nao(), Regime::LOCOMOTION));
}

#[test]
fn a_new_floor_is_level_wherever_geoms_start() {
    let geom = "contype=\"0\" conaffinity=\"1\"";
    let posed = [geom, "euler=\".3 .2 .1\""].join(" ");
    let loaded = LoadedRobot::load(changed(SAME, (geom, &posed))).unwrap();
    let world = World::new(&loaded, Regime::LOCOMOTION).unwrap();
    let data = world.at(&Simulation::new(&world, &lying(&loaded)).snapshot());
    let [upright, ..] = data.model().geom_quat()[0];
    assert!((upright - 1.0).abs() < 1e-15, "{upright}");
}

#[test]
fn a_geom_may_be_called_floor() {
    let loaded = LoadedRobot::load(changed(SAME, ("name=\"Belly\"", "name=\"floor\""))).unwrap();
    assert!(run(&loaded, Regime::TORQUE_STUDY) == run(&nao(), Regime::TORQUE_STUDY));
}

/// Head and chest overlap; as a pair they press on each other, which the ground does not feel.
#[test]
fn parts_that_press_on_one_another_are_no_ground_contact() {
    let pair = "<contact><pair geom1='Skull' geom2='Chest' condim='3'/></contact>\n  <equality>";
    let loaded = LoadedRobot::load(changed(SAME, ("<equality>", pair))).unwrap();
    let weight = loaded.robot().mass() * 9.81;
    let world = World::new(&loaded, Regime::LOCOMOTION).unwrap();
    let mut simulation = Simulation::new(&world, &lying(&loaded));
    let mut contact = [0.0; ContactGroup::COUNT];
    for _ in 0..40 {
        contact = simulation.control_step().unwrap().contact;
    }
    let data = world.at(&simulation.snapshot());
    let pressing = data
        .contact()
        .iter()
        .any(|contact| !contact.geom.contains(&0));
    assert!(pressing, "the pair is in contact");
    let sum: f64 = contact.iter().sum();
    // 0.5 %: what is left of the fall after two seconds.
    assert!(
        (sum - weight).abs() < 5e-3 * weight,
        "{sum} is not {weight}"
    );
}
