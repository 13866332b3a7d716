use crate::robot::JointId;
use crate::robot::testing::two_armed_with_motors as robot;

use super::*;

const STEP: MotorStep = MotorStep {
    torque: 0.0,
    power: 0.0,
    lag: 0.0,
    supply_clipped: false,
    current_limited: false,
};

fn after(steps: &[MotorStep]) -> MotorEffort {
    let mut effort = MotorEffort::default();
    for step in steps {
        effort.add_step(step, 0.1, Commands::Move);
    }
    effort
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
}

#[test]
fn braking_takes_nothing_back() {
    for (power, work) in [(6.0, 0.6), (-6.0, 0.0), (0.0, 0.0)] {
        let step = MotorStep { power, ..STEP };
        near(after(&[step]).work, work);
        let pushed = MotorStep { power: 5.0, ..STEP };
        near(after(&[pushed, step]).work, 0.5 + work);
    }
}

#[test]
fn torque_warms_whichever_way_it_pushes() {
    let torques = [1.0, -2.0, 0.5];
    let effort = after(&torques.map(|torque| MotorStep { torque, ..STEP }));
    near(effort.square, (1.0 + 4.0 + 0.25) * 0.1);
    near(effort.peak, 2.0);
    near(effort.rms(0.3), (5.25_f64 / 3.0).sqrt());
}

#[test]
fn limits_count_the_time_and_a_lag_its_largest() {
    let step = |lag, supply_clipped, current_limited| MotorStep {
        lag,
        supply_clipped,
        current_limited,
        ..STEP
    };
    let effort = after(&[
        step(0.2, true, false),
        step(0.5, true, true),
        step(0.1, false, false),
    ]);
    near(effort.supply_clipped, 0.2);
    near(effort.current_limited, 0.1);
    near(effort.largest_lag, 0.5);
}

/// Sums add up, peaks do not.
#[test]
fn efforts_of_cycles_add_up() {
    let robot = robot();
    let effort = |motor: MotorEffort| {
        let mut effort = Effort::none(&robot);
        effort.seconds = 2.0;
        effort.motors[5] = motor;
        effort
    };
    let one = MotorEffort {
        square: 1.0,
        work: 2.0,
        peak: 3.0,
        supply_clipped: 0.25,
        current_limited: 0.5,
        largest_lag: 0.1,
        planned_speed: 4.0,
    };
    let other = MotorEffort {
        square: 10.0,
        work: 20.0,
        peak: 2.0,
        supply_clipped: 2.5,
        current_limited: 5.0,
        largest_lag: 0.2,
        planned_speed: 3.0,
    };
    let mut sum = effort(one);
    sum.add(&effort(other));
    near(sum.seconds, 4.0);
    let expected = MotorEffort {
        square: 11.0,
        work: 22.0,
        peak: 3.0,
        supply_clipped: 2.75,
        current_limited: 5.5,
        largest_lag: 0.2,
        planned_speed: 4.0,
    };
    assert_eq!(sum.motors[5], expected);
    assert_eq!(sum.motors[4], MotorEffort::default());
    near(sum.work(), 22.0);
}

/// Each torque over its own motor's nominal one, and each peak over its own joint's limit.
#[test]
fn heat_and_peaks_are_over_each_motors_own_figures() {
    let mut robot = robot();
    for (index, joint) in robot.joints.iter_mut().enumerate() {
        joint.effort_limit = 1.0 + index as f64;
    }
    robot.joints[3].motor.as_mut().unwrap().nominal = 2.0;
    let mut effort = Effort::none(&robot);
    effort.motors[2].square = 8.0;
    effort.motors[3].square = 8.0;
    for (index, motor) in effort.motors.iter_mut().enumerate() {
        motor.peak = if index == 4 { 10.0 } else { 1.5 };
    }
    near(effort.heat(&robot).unwrap(), 8.0 / 0.25 + 8.0 / 4.0);
    let (peak, joint) = effort.peak_over_limit(&robot);
    near(peak, 2.0);
    assert_eq!(joint, robot.joints[4].name);
}

/// One motor behind two joints gives the sum of their torques, and is as warm as one.
#[test]
fn a_shared_motor_has_one_heat() {
    let mut robot = robot();
    robot.shared_motors = vec![vec![JointId(1), JointId(4)]];
    let mut effort = Effort::none(&robot);
    let step = MotorStep {
        torque: 1.0,
        ..STEP
    };
    effort.motors[1].add_step(&step, 0.1, Commands::Move);
    near(effort.heat(&robot).unwrap(), 0.1 / 0.25);
    assert_eq!(effort.motors.len(), robot.joints.len() - 1);
}

/// No part of a heat is given out for the whole, and none is zero because nothing is known.
#[test]
fn a_robot_with_an_unknown_motor_has_no_heat() {
    let mut robot = robot();
    robot.joints[6].motor.as_mut().unwrap().no_load_speed = None;
    let error = Effort::none(&robot).heat(&robot).unwrap_err();
    assert_eq!(error.joint, robot.joints[6].name);
    assert_eq!(robot.check_motors(), Err(error));
    robot.joints[2].motor = None;
    let error = robot.check_motors().unwrap_err();
    assert_eq!(error.joint, robot.joints[2].name);
}

#[test]
fn a_use_is_over_what_the_motor_can_do() {
    let robot = robot();
    let drives = robot.drives();
    let effort = MotorEffort {
        square: 0.5,
        planned_speed: 4.0,
        ..MotorEffort::default()
    };
    let it = effort.motor_use(&robot, &drives[0], 2.0, 0.5).unwrap();
    near(it.heat, 2.0);
    near(it.rms_over_nominal, 0.5 / 0.25);
    near(it.planned_over_no_load, 0.8);
    near(it.winding_loss, 0.5 * 5.0 / 2.5);
}
