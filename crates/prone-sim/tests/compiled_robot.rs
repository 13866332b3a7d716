//! The compiled robots that ship against what the engine makes of their sources.

use serde_json::Value;

use prone::gait::cycle::{CheckedCycle, TimeScale};
use prone::robot::Robot;
use prone_files::compiled_robot::{self, CompiledRobot, RobotDocument};
use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles};

/// Largest difference of two numbers: the last digits may differ between processors and releases of
/// the engine.
const TOLERANCE: f64 = 1e-12;

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap()
}

fn renewal() -> String {
    let folder = shipped::NAO.folder;
    format!("`cargo run --release -- robot compile {folder}` renews it")
}

#[test]
fn the_compiled_nao_is_fresh() {
    let loaded = nao();
    let file = format!("{}/{}", loaded.files().folder, compiled_robot::FILE_NAME);
    let compiled = CompiledRobot::shipped().unwrap();
    let fresh = compiled.check_fresh(&file, loaded.files());
    assert!(fresh.is_ok(), "{fresh:?}: {}", renewal());
}

/// Every number of the compiled robot is the engine's, and everything else is the same.
#[test]
fn the_compiled_nao_is_the_engines() {
    let value = |robot: &Robot| serde_json::to_value(RobotDocument::from_robot(robot)).unwrap();
    let compiled = value(CompiledRobot::shipped().unwrap().robot());
    let engine = value(nao().robot());
    let mut numbers = 0;
    compare("", &compiled, &engine, &mut numbers);
    // Bodies, joints, shapes and postures of a humanoid: nothing was left out on the way.
    assert!(numbers > 1000, "{numbers} numbers");
}

fn compare(place: &str, compiled: &Value, engine: &Value, numbers: &mut usize) {
    match (compiled, engine) {
        (Value::Number(ours), Value::Number(theirs)) => {
            *numbers += 1;
            let off = (ours.as_f64().unwrap() - theirs.as_f64().unwrap()).abs();
            assert!(
                off <= TOLERANCE,
                "{place}: {ours} and {theirs}: {}",
                renewal()
            );
        }
        (Value::Array(ours), Value::Array(theirs)) => {
            assert_eq!(ours.len(), theirs.len(), "{place}: {}", renewal());
            for (index, (ours, theirs)) in ours.iter().zip(theirs).enumerate() {
                compare(&format!("{place}/{index}"), ours, theirs, numbers);
            }
        }
        (Value::Object(ours), Value::Object(theirs)) => {
            let keys = |object: &serde_json::Map<String, Value>| -> Vec<String> {
                object.keys().cloned().collect()
            };
            assert_eq!(keys(ours), keys(theirs), "{place}: {}", renewal());
            for (key, ours) in ours {
                compare(&format!("{place}/{key}"), ours, &theirs[key], numbers);
            }
        }
        (ours, theirs) => assert_eq!(ours, theirs, "{place}: {}", renewal()),
    }
}

/// Whoever plans without the engine plans the same.
#[test]
fn cycles_are_planned_alike_on_the_compiled_nao() {
    let compiled = CompiledRobot::shipped().unwrap().into_robot();
    let loaded = nao();
    for name in shipped::cycle_names() {
        let cycle = shipped::cycle(name).unwrap().unwrap();
        let plan = |robot: &Robot| {
            CheckedCycle::plan(robot, &robot.stops(), &cycle, 0.0, TimeScale::ONE).unwrap()
        };
        let (ours, theirs) = (plan(&compiled), plan(loaded.robot()));
        let (ours, theirs) = (ours.pull().samples(), theirs.pull().samples());
        assert_eq!(ours.len(), theirs.len(), "{name}");
        for (ours, theirs) in ours.iter().zip(theirs) {
            for (ours, theirs) in ours.joints.pairs(&theirs.joints) {
                // Angles are made of lengths of a tenth of a metre and more.
                let off = (ours - theirs).abs();
                assert!(off < 1e2 * TOLERANCE, "{name}: {off} rad");
            }
        }
    }
}
