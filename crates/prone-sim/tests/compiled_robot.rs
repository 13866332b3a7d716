//! The compiled robots that ship against what the engine makes of their sources.

use serde_json::Value;

use prone::gait::CheckedTrajectory;
use prone::gait::cycle::{CheckedCycle, TimeScale};
use prone::robot::Robot;
use prone_files::compiled_robot::{self, CompiledRobot, RobotDocument};
use prone_files::shipped::{self, RobotSource};
use prone_sim::{LoadedRobot, RobotFiles};

/// Largest difference of two numbers: the last digits may differ between processors and releases of
/// the engine.
const TOLERANCE: f64 = 1e-12;

/// Every robot that ships, with the command that renews its compiled file.
fn robots() -> impl Iterator<Item = (&'static RobotSource, String)> {
    let versions = shipped::families().flat_map(|family| family.versions);
    versions.map(|source| {
        let folder = source.folder;
        let renewal = format!("`cargo run --release -- robot compile {folder}` renews it");
        (source, renewal)
    })
}

fn compiled(source: &RobotSource, renewal: &str) -> CompiledRobot {
    CompiledRobot::shipped(source).unwrap_or_else(|error| panic!("{error}: {renewal}"))
}

fn loaded(source: &RobotSource) -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(source)).unwrap()
}

#[test]
fn compiled_robots_are_fresh() {
    for (source, renewal) in robots() {
        let (compiled, loaded) = (compiled(source, &renewal), loaded(source));
        let file = format!("{}/{}", source.folder, compiled_robot::FILE_NAME);
        let fresh = compiled.check_fresh(&file, loaded.files());
        assert!(fresh.is_ok(), "{fresh:?}: {renewal}");
        assert_eq!(compiled.engine(), prone_sim::engine_version(), "{renewal}");
        assert_eq!(compiled.version().unwrap().version, source.version);
    }
}

/// Every number of the compiled robot is the engine's, and everything else is the same.
#[test]
fn compiled_robots_are_the_engines() {
    let value = |robot: &Robot| serde_json::to_value(RobotDocument::from_robot(robot)).unwrap();
    for (source, renewal) in robots() {
        let file = value(compiled(source, &renewal).robot());
        let engine = value(loaded(source).robot());
        let mut numbers = 0;
        let same = compare("robot", &file, &engine, &mut numbers);
        assert!(same.is_ok(), "{same:?}: {renewal}");
        // Bodies, joints, shapes and postures of a humanoid: nothing was left out on the way.
        assert!(numbers > 800, "{numbers} numbers");
    }
}

/// The first place in which two documents differ is the error.
fn compare(place: &str, file: &Value, engine: &Value, numbers: &mut usize) -> Result<(), String> {
    let differs = || format!("{place} is {file} in the file and {engine} by the engine");
    match (file, engine) {
        (Value::Number(ours), Value::Number(theirs)) => {
            *numbers += 1;
            let off = (ours.as_f64().unwrap() - theirs.as_f64().unwrap()).abs();
            if off <= TOLERANCE {
                Ok(())
            } else {
                Err(differs())
            }
        }
        (Value::Array(ours), Value::Array(theirs)) if ours.len() == theirs.len() => {
            let mut pairs = ours.iter().zip(theirs).enumerate();
            pairs.try_for_each(|(index, (ours, theirs))| {
                compare(&format!("{place}[{index}]"), ours, theirs, numbers)
            })
        }
        (Value::Object(ours), Value::Object(theirs)) if ours.len() == theirs.len() => {
            let mut pairs = ours.iter();
            pairs.try_for_each(|(key, ours)| {
                let theirs = theirs.get(key).unwrap_or(&Value::Null);
                compare(&format!("{place}.{key}"), ours, theirs, numbers)
            })
        }
        (ours, theirs) if ours == theirs => Ok(()),
        _ => Err(differs()),
    }
}

#[test]
fn a_difference_is_found() {
    let engine = serde_json::json!({ "a": [1.0, { "b": 2.0, "c": null }], "d": "e" });
    let differs = |pointer: &str, value: Value| {
        let mut file = engine.clone();
        *file.pointer_mut(pointer).unwrap() = value;
        compare("robot", &file, &engine, &mut 0).is_err()
    };
    assert!(!differs("/a/0", (1.0 + 1e-13).into()));
    assert!(differs("/a/0", (1.0 + 1e-11).into()));
    assert!(differs("/a/1/b", 2.1.into()));
    assert!(differs("/a/1/c", 2.0.into()));
    assert!(differs("/a", serde_json::json!([1.0])));
    assert!(differs("/d", "f".into()));
}

/// Whoever plans without the engine plans the same.
#[test]
fn cycles_are_planned_alike_on_the_compiled_nao() {
    let compiled = CompiledRobot::shipped(&shipped::NAO).unwrap().into_robot();
    let loaded = loaded(&shipped::NAO);
    for name in shipped::cycle_names() {
        let cycle = shipped::cycle(name).unwrap().unwrap();
        let plan = |robot: &Robot| {
            CheckedCycle::plan(robot, &robot.stops(), &cycle, 0.0, TimeScale::ONE).unwrap()
        };
        let (ours, theirs) = (plan(&compiled), plan(loaded.robot()));
        // As on the kind of machine that has compiled the file: the same to the bit.
        if compiled == **loaded.robot() {
            assert_eq!(ours, theirs, "{name}");
        }
        let postures = |checked: &CheckedCycle| {
            let path = checked.recovery_after(checked).unwrap();
            let pulled = checked.pull().map_or(&[][..], CheckedTrajectory::samples);
            let pulled = pulled.iter().map(|sample| sample.joints.clone());
            let back = checked.recovery_seconds();
            let way = (0..=100).map(|k| path.at(back * f64::from(k) / 100.0));
            pulled.chain(way).collect::<Vec<_>>()
        };
        let (ours, theirs) = (postures(&ours), postures(&theirs));
        assert_eq!(ours.len(), theirs.len(), "{name}");
        for (ours, theirs) in ours.iter().zip(&theirs) {
            for (ours, theirs) in ours.pairs(theirs) {
                // Angles are made of lengths of a tenth of a metre and more.
                let off = (ours - theirs).abs();
                assert!(off < 1e2 * TOLERANCE, "{name}: {off} rad");
            }
        }
    }
}
