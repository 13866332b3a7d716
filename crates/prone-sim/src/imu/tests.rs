use std::sync::Arc;

use glam::DQuat;

use prone::attitude::{Attitude, AttitudeFilter, Gains};
use prone::gait::PhaseDuration;
use prone::statics::GRAVITY;
use prone_files::shipped;

use super::*;
use crate::pull::{self, Start};
use crate::{LoadedRobot, Placement, RobotFiles};
use prone::regime::{CONTROL_STEP, Regime, TIME_STEP};

/// The shipped robot in a world whose floor rises by `slope`, rad, in the direction of travel: seen
/// from the floor, gravity is tilted.
fn world(slope: f64) -> World {
    let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    let mut world = World::new(&loaded, Regime::LOCOMOTION).unwrap();
    let mut model = (*world.model).clone();
    model.opt_mut().gravity = (-GRAVITY * up(slope)).to_array();
    world.model = Arc::new(model);
    world
}

/// Up in the floor's frame.
fn up(slope: f64) -> DVec3 {
    DVec3::new(slope.sin(), 0.0, slope.cos())
}

/// The attitude that the root really has.
fn truth(simulation: &Simulation, slope: f64) -> Attitude {
    let root_from_ground = simulation.ground_from_root().rotation().inverse();
    Attitude::from_up(root_from_ground * up(slope)).unwrap()
}

/// Angle between two ups, rad.
fn between(one: Attitude, two: Attitude) -> f64 {
    let (one, two) = (one.up(), two.up());
    one.cross(two).length().atan2(one.dot(two))
}

/// How a shipped gait begins, and its planned root pitch.
fn gait_pose(world: &World) -> Placement {
    let gait = shipped::gait("nominal").unwrap().unwrap();
    let plan = pull::plan(world, &gait, PhaseDuration::new(3.0).unwrap()).unwrap();
    pull::placement(world, &plan, Start::FirstPose).unwrap()
}

/// Reads every engine step for some seconds.
fn filtered(simulation: &mut Simulation, imu: &mut SimulatedImu, seconds: f64) -> AttitudeFilter {
    simulation.step();
    let first = imu.read(simulation);
    let mut filter = AttitudeFilter::aligned(Gains::PUBLISHED, &first).unwrap();
    let mut time = 0.0;
    while time < seconds {
        simulation.step();
        filter.update(&imu.read(simulation), TIME_STEP).unwrap();
        time += TIME_STEP;
    }
    filter
}

/// Without noise and bias.
fn exact(mut imu: SimulatedImu) -> SimulatedImu {
    for sensor in [&mut imu.accelerometer, &mut imu.gyroscope] {
        sensor.bias = DVec3::ZERO;
        sensor.standard_deviation = 0.0;
    }
    imu
}

#[test]
fn identity_lying_still_the_accelerometer_points_up() {
    for slope_deg in [0.0, 10.0, -10.0] {
        let slope = f64::to_radians(slope_deg);
        let world = world(slope);
        let mut simulation = pull::settle(&world, &gait_pose(&world)).unwrap();
        simulation.step();
        let imu = SimulatedImu::new(&world, 1).unwrap();
        let reading = exact(imu.clone()).read(&simulation);
        let force = reading.specific_force;
        // Settled, but the servos still creep.
        assert!((force.length() - GRAVITY).abs() < 0.05, "{force}");
        let true_up = truth(&simulation, slope);
        let measured = Attitude::from_up(force).unwrap();
        assert!(between(measured, true_up) < 0.005, "at {slope_deg}°");
        for seed in 0..5 {
            let mut imu = SimulatedImu::new(&world, seed).unwrap();
            let mut simulation = simulation.clone();
            let filter = filtered(&mut simulation, &mut imu, 10.0);
            // Two axes of bias 0.05 m/s² are 0.0072 rad; a learned gyroscope's bias adds nothing,
            // filtered noise 0.0002.
            let error = between(filter.attitude(), truth(&simulation, slope));
            assert!(error < 0.009, "at {slope_deg}°, seed {seed}: {error} rad");
        }
    }
}

#[test]
fn identity_a_slope_is_measured_in_a_gait_pose() {
    for slope_deg in [-10.0, -4.0, 0.0, 4.0, 10.0] {
        let slope = f64::to_radians(slope_deg);
        let world = world(slope);
        let placement = gait_pose(&world);
        let mut simulation = pull::settle(&world, &placement).unwrap();
        let mut imu = SimulatedImu::new(&world, 7).unwrap();
        let filter = filtered(&mut simulation, &mut imu, 5.0);
        let measured = filter.attitude().slope(placement.pitch).unwrap();
        assert!(
            (measured - slope).abs().to_degrees() < 1.0,
            "at {slope_deg}°"
        );
    }
}

/// Over a whole pull, in which the robot moves, starts and stops.
#[test]
fn identity_a_moving_robot_knows_its_attitude() {
    let world = world(0.0);
    let gait = shipped::gait("nominal").unwrap().unwrap();
    let plan = pull::plan(&world, &gait, PhaseDuration::new(3.0).unwrap()).unwrap();
    let placement = pull::placement(&world, &plan, Start::FirstPose).unwrap();
    let mut simulation = pull::settle(&world, &placement).unwrap();
    let mut imu = SimulatedImu::new(&world, 3).unwrap();
    let mut filter = filtered(&mut simulation, &mut imu, 5.0);
    let mut largest = 0.0_f64;
    for sample in plan.samples() {
        simulation.command(&sample.joints);
        for _ in 0..world.regime().steps_in(CONTROL_STEP) {
            simulation.step();
            filter.update(&imu.read(&simulation), TIME_STEP).unwrap();
        }
        largest = largest.max(between(filter.attitude(), truth(&simulation, 0.0)));
    }
    // 0.5° of a biased accelerometer and as much again for the pull's jolts.
    assert!(largest.to_degrees() < 1.0, "{}°", largest.to_degrees());
}

#[test]
fn identity_sensors_change_no_motion() {
    let shipped = RobotFiles::shipped(&shipped::NAO);
    let mut without = shipped.clone();
    let (robot, _) = without.mjcf.split_once("<sensor>").unwrap();
    without.mjcf = format!("{robot}</mujoco>");
    without.toml = without_imu(&without.toml);
    let [one, other] = [shipped, without].map(|files| {
        let loaded = LoadedRobot::load(files).unwrap();
        let world = World::new(&loaded, Regime::LOCOMOTION).unwrap();
        let mut simulation = Simulation::new(&world, &gait_pose(&world));
        for _ in 0..400 {
            simulation.step();
        }
        simulation.snapshot()
    });
    assert_eq!(one, other, "to the bit");
}

/// The root falls from upright over its toes or heels: its turn about +y has the gyroscope's sign.
#[test]
fn identity_the_gyroscope_turns_as_the_root_does() {
    for pitch in [0.3, -0.3] {
        let world = world(0.0);
        let posture = prone::robot::JointAngles::zero(world.robot());
        let mut simulation = Simulation::new(&world, &Placement { posture, pitch });
        let mut imu = exact(SimulatedImu::new(&world, 1).unwrap());
        for _ in 0..120 {
            simulation.step();
        }
        let before = simulation.ground_from_root().rotation();
        simulation.step();
        let after = simulation.ground_from_root().rotation();
        // The reading is of the beginning of a step.
        simulation.step();
        let reading = imu.read(&simulation);
        let turn = (before.inverse() * after).to_scaled_axis() / TIME_STEP;
        assert!(turn.y * pitch > 0.0, "it falls the way it leans");
        assert!(turn.y.abs() > 0.1, "{turn}");
        // The engine moves the position with the speed at the end of the step.
        assert!(
            (reading.angular_velocity - turn).length() < 1e-6,
            "{turn} {reading:?}"
        );
    }
}

#[test]
fn limit_from_a_wrong_start_the_filter_finds_the_attitude() {
    let world = world(0.0);
    let mut simulation = pull::settle(&world, &gait_pose(&world)).unwrap();
    let mut imu = SimulatedImu::new(&world, 11).unwrap();
    let mut filter = AttitudeFilter::new(Gains::PUBLISHED, Attitude::from_up(DVec3::Z).unwrap());
    assert!(between(filter.attitude(), truth(&simulation, 0.0)) > 1.0);
    for _ in 0..8000 {
        simulation.step();
        filter.update(&imu.read(&simulation), TIME_STEP).unwrap();
    }
    assert!(between(filter.attitude(), truth(&simulation, 0.0)) < 0.009);
}

#[test]
fn identity_the_same_seed_gives_the_same_errors() {
    let world = world(0.0);
    let simulation = Simulation::new(&world, &gait_pose(&world));
    let readings = |seed| {
        let mut imu = SimulatedImu::new(&world, seed).unwrap();
        [(); 5].map(|()| imu.read(&simulation))
    };
    assert_eq!(readings(4), readings(4));
    assert_ne!(readings(4), readings(5));
    let [first, second, ..] = readings(4);
    assert_ne!(first, second, "noise changes from sample to sample");
}

/// 20,000 samples: mean within 5 standard errors of the bias, deviation within 3 %.
#[test]
fn identity_noise_has_the_stated_deviation_and_bias() {
    let world = world(0.0);
    let simulation = Simulation::new(&world, &gait_pose(&world));
    let mut imu = SimulatedImu::new(&world, 21).unwrap();
    let truth = exact(imu.clone()).read(&simulation);
    let noise = world.robot().imu.as_ref().unwrap().gyroscope;
    let bias = imu.gyroscope.bias;
    assert!(bias.abs().max_element() <= noise.bias_bound);
    let count = 20_000;
    let (mut sum, mut squares) = (DVec3::ZERO, DVec3::ZERO);
    for _ in 0..count {
        let error = imu.read(&simulation).angular_velocity - truth.angular_velocity - bias;
        sum += error;
        squares += error * error;
    }
    let n = f64::from(count);
    let (mean, deviation) = (sum / n, (squares / n).powf(0.5));
    let standard_error = noise.standard_deviation / n.sqrt();
    assert!(mean.abs().max_element() < 5.0 * standard_error);
    let relative = (deviation / noise.standard_deviation - 1.0).abs();
    assert!(relative.max_element() < 0.03, "{deviation}");
}

#[test]
fn identity_the_sensors_axes_are_turned_into_the_roots() {
    let turned = "site name=\"imu\" euler=\"1.1 -0.4 0.7\"";
    let mjcf = shipped::NAO.mjcf.replace("site name=\"imu\"", turned);
    let files = RobotFiles {
        mjcf,
        ..RobotFiles::shipped(&shipped::NAO)
    };
    let world_turned = World::new(&LoadedRobot::load(files).unwrap(), Regime::LOCOMOTION).unwrap();
    let world = world(0.0);
    let read = |world: &World| {
        let mut simulation = Simulation::new(world, &gait_pose(world));
        for _ in 0..20 {
            simulation.step();
        }
        exact(SimulatedImu::new(world, 1).unwrap()).read(&simulation)
    };
    let (one, other) = (read(&world), read(&world_turned));
    assert!((one.specific_force - other.specific_force).length() < 1e-9);
    assert!((one.angular_velocity - other.angular_velocity).length() < 1e-9);
    let imu = world_turned.robot().imu.clone().unwrap();
    assert!(
        imu.root_from_sensor
            .rotation()
            .angle_between(DQuat::IDENTITY)
            > 0.5
    );
}

#[test]
fn limit_a_robot_without_one_says_so() {
    let toml = without_imu(shipped::NAO.toml);
    let files = RobotFiles {
        toml,
        ..RobotFiles::shipped(&shipped::NAO)
    };
    let world = World::new(&LoadedRobot::load(files).unwrap(), Regime::LOCOMOTION).unwrap();
    assert!(world.robot().imu.is_none());
    assert_eq!(
        SimulatedImu::new(&world, 1).unwrap_err().to_string(),
        "robot NAO H25 V4 has no inertial unit: its robot.toml has no [imu]"
    );
}

/// A `robot.toml` without its section on the inertial unit; sections may follow.
fn without_imu(toml: &str) -> String {
    let (before, section) = toml.split_once("[imu]").unwrap();
    let after = section.find("\n[").map_or("", |next| &section[next..]);
    format!("{before}{after}")
}
