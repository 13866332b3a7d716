//! Time of one static evaluation on the NAO: gait parameters to torques and supports.
//!
//! Goal: 10 to 20 µs or less. Reference of the same run: forward kinematics of the whole robot.

use std::f64::consts::FRAC_PI_2;
use std::hint::black_box;

use glam::DQuat;

use prone::chain::GaitParameters;
use prone::frames::{Ground, Root, Transform};
use prone::mapping::{ArmMode, Mapping, MappingVariant};
use prone::robot::JointAngles;
use prone::statics::{Stance, StaticTorques, SupportRule};
use prone::torque_map::TorqueSource;
use prone_files::shipped;
use prone_sim::{LoadedRobot, RobotFiles};

fn main() {
    divan::main();
}

fn nao() -> LoadedRobot {
    LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).expect("the shipped robot loads")
}

/// Postures across the recorded table's grid, so that no one set of supports stays cached.
fn postures() -> Vec<GaitParameters> {
    let posture = |k: u32| GaitParameters {
        knee: f64::from(k % 7) * 0.05,
        hip: f64::from(k % 5) * 0.05,
        upper_arm: -0.6 - f64::from(k % 11) * 0.08,
    };
    (0..385).map(posture).collect()
}

#[divan::bench(args = [ArmMode::Fixed, ArmMode::FlatForearm])]
fn torques(bencher: divan::Bencher, arm: ArmMode) {
    let loaded = nao();
    let robot = loaded.robot();
    let mapping = Mapping::new(robot, MappingVariant::Original, arm).expect("the NAO has both");
    let stance = Stance::unsqueezed(SupportRule::ElbowNotHand);
    let source = StaticTorques::new(robot.as_ref(), mapping, &robot.study_stops(), stance)
        .expect("the NAO mirrors itself");
    let postures = postures();
    let mut next = postures.iter().cycle();
    bencher.bench_local(|| source.torques(*black_box(next.next().expect("a cycle never ends"))));
}

#[divan::bench]
fn reference_forward_kinematics(bencher: divan::Bencher) {
    let loaded = nao();
    let robot = loaded.robot();
    let angles = JointAngles::zero(robot);
    let turn = DQuat::from_rotation_y(FRAC_PI_2);
    let ground_from_root = Transform::<Ground, Root>::new(turn, glam::DVec3::ZERO);
    bencher.bench(|| robot.forward_kinematics(black_box(ground_from_root), black_box(&angles)));
}
