//! The NAO as a driver has it: from its compiled file, with no engine linked.
//!
//! That the same plans come out as with the engine's robot is tested where there is an engine.

use std::f64::consts::PI;

use prone::chain::ClosedChain;
use prone::gait::cycle::{CheckedCycle, TimeScale};
use prone::mapping::{ArmMode, Mapping, MappingVariant};
use prone::robot::{Mirror, Range, Robot};
use prone_files::compiled_robot::CompiledRobot;
use prone_files::shipped;

fn nao() -> Robot {
    CompiledRobot::shipped(&shipped::NAO).unwrap().into_robot()
}

fn plan(robot: &Robot, stops: &[Range], turn: f64) -> CheckedCycle {
    let cycle = shipped::cycle("hip-10").unwrap().unwrap();
    CheckedCycle::plan(robot, stops, &cycle, turn, TimeScale::ONE).unwrap()
}

/// Mass and links of the manufacturer, within the digits that are printed.
#[test]
fn reference_mass_and_chain_are_the_manufacturers() {
    let robot = nao();
    assert!((robot.mass() - 5.195).abs() < 5e-4, "{} kg", robot.mass());
    let mapping = Mapping::new(&robot, MappingVariant::Exact, ArmMode::FlatForearm).unwrap();
    let chain: &ClosedChain = mapping.chain();
    for (ours, theirs) in chain
        .links()
        .iter()
        .zip([103.85, 102.9, 100.0, 185.0, 89.75])
    {
        assert!((ours * 1e3 - theirs).abs() < 5e-3, "{ours} m");
    }
}

/// Knee and head stand in the file; that the knee's chain angle is the NAO's joint angle follows
/// from a zero pose with straight legs.
#[test]
fn a_cycle_is_planned_as_its_file_says() {
    let robot = nao();
    let stops = robot.stops();
    let cycle = plan(&robot, &stops, 0.0);
    let joint = |name: &str| robot.joint(name).unwrap();
    for sample in cycle.pull().unwrap().samples() {
        let knee = sample.joints[joint("LKneePitch")].to_degrees();
        assert!((knee - 20.0).abs() < 1e-9, "{knee}° at {}", sample.s);
    }
    for (posture, head) in [(cycle.extension(), 5.0), (cycle.compression(), 28.0)] {
        let angle = posture[joint("HeadPitch")].to_degrees();
        assert!((angle - head).abs() < 1e-9, "{angle}°");
    }
    assert!((cycle.recovery_seconds() - 1.8).abs() < 1e-12);
    for sample in cycle.pull().unwrap().samples() {
        for (stop, &angle) in stops.iter().zip(sample.joints.as_slice()) {
            assert!(stop.contains(angle), "{angle}");
        }
    }
}

/// The stops of the ankles differ by side, and the cycle goes as far as them: so it is planned
/// without.
#[test]
fn left_mirrors_right() {
    let robot = nao();
    let mirror = Mirror::of(&robot);
    let everywhere = Range {
        lower: -PI,
        upper: PI,
    };
    let stops = vec![everywhere; robot.joints.len()];
    let [left, right, ahead] = [0.1, -0.1, 0.0].map(|turn| plan(&robot, &stops, turn));
    assert_ne!(left, ahead, "it turns");
    for (one, other) in left
        .pull()
        .unwrap()
        .samples()
        .iter()
        .zip(right.pull().unwrap().samples())
    {
        let image = mirror.posture(&other.joints);
        for (one, other) in one.joints.as_slice().iter().zip(image.as_slice()) {
            // Left and right agree to six digits of the model's file.
            assert!((one - other).abs() < 1e-6, "{one} {other}");
        }
    }
}
