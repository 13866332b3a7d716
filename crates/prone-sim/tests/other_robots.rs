//! What is planned for one robot is not put to another: it is refused, with the numbers of joints.

use prone::chain::GaitParameters;
use prone::gait::cycle::{CheckedCycle, TimeScale};
use prone::gait::{CheckedTrajectory, PhaseDuration};
use prone::mapping::{ArmMode, Mapping, MappingVariant};
use prone::robot::Robot;
use prone::statics::{Stance, StaticTorques, SupportRule};
use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles};

fn nao() -> Robot {
    let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    Robot::clone(loaded.robot())
}

#[test]
fn limit_a_plan_needs_one_stop_for_each_joint() {
    let robot = nao();
    let cycle = shipped::cycle("hip-10").unwrap().unwrap();
    let mut few = robot.stops();
    few.pop();
    let duration = PhaseDuration::new(1.0).unwrap();
    let refused = CheckedTrajectory::plan(&robot, &few, &cycle.gait().unwrap(), duration, 10);
    let message = "gait hip-10: 23 stops are given, robot NAO H25 V4 has 24 joints";
    assert_eq!(refused.unwrap_err().to_string(), message);
    let refused = CheckedCycle::plan(&robot, &few, &cycle, 0.0, TimeScale::ONE);
    assert_eq!(refused.unwrap_err().to_string(), message);
    let mut many = robot.stops();
    many.push(many[0]);
    assert!(CheckedCycle::plan(&robot, &many, &cycle, 0.0, TimeScale::ONE).is_err());
}

#[test]
fn limit_the_statics_need_one_stop_for_each_joint() {
    let robot = nao();
    let mapping = Mapping::new(&robot, MappingVariant::Exact, ArmMode::FlatForearm).unwrap();
    let stance = Stance::unsqueezed(SupportRule::AnyShape);
    let source = StaticTorques::new(&robot, mapping, &robot.stops()[1..], stance).unwrap();
    let refused = source.command(GaitParameters {
        knee: 0.2,
        hip: 0.5,
        upper_arm: -1.0,
    });
    let message = "23 stops are given, robot NAO H25 V4 has 24 joints";
    let refused = refused.unwrap_err().to_string();
    assert!(refused.contains(message), "{refused}");
}

#[test]
fn limit_a_recovery_after_the_pull_of_another_robot_is_refused() {
    let (robot, mut other) = (nao(), nao());
    other.joints.push(robot.joints[0].clone());
    let cycle = shipped::cycle("hip-10").unwrap().unwrap();
    let plan = |robot: &Robot| {
        CheckedCycle::plan(robot, &robot.stops(), &cycle, 0.0, TimeScale::ONE).unwrap()
    };
    let (ours, theirs) = (plan(&robot), plan(&other));
    assert!(ours.recovery_after(&ours).is_ok());
    let refused = ours.recovery_after(&theirs).unwrap_err();
    assert_eq!(
        refused.to_string(),
        "cycle hip-10 is planned for a robot of 24 joints, and hip-10 before it for one of 25"
    );
    assert_eq!(refused.place(), "recovery");
}
