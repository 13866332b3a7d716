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
    let compiled = CompiledRobot::shipped().unwrap().into_robot();
    let loaded = nao();
    let engine = &**loaded.robot();
    for name in shipped::cycle_names() {
        let cycle = shipped::cycle(name).unwrap().unwrap();
        let plan = |robot: &Robot| {
            CheckedCycle::plan(robot, &robot.stops(), &cycle, 0.0, TimeScale::ONE).unwrap()
        };
        let (ours, theirs) = (plan(&compiled), plan(engine));
        if compiled == *engine {
            assert_eq!(ours, theirs, "{name}");
        }
        let pairs = ours.pull().samples().iter().zip(theirs.pull().samples());
        for (ours, theirs) in pairs {
            let pairs = ours.joints.as_slice().iter().zip(theirs.joints.as_slice());
            for (ours, theirs) in pairs {
                let off = (ours - theirs).abs();
                assert!(off < 1e3 * TOLERANCE, "{name}: {off} rad");
            }
        }
    }
}
