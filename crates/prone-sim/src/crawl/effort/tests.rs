use prone::robot::Motor;
use prone_files::shipped;

use super::*;
use crate::load::{LoadedRobot, RobotFiles};

fn nao() -> Robot {
    let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
    Robot::clone(loaded.robot())
}

/// A joint of 2 N·m whose motor may give 0.5 N·m for ever.
fn joint() -> Joint {
    let mut joint = nao().joints[0].clone();
    joint.effort_limit = 2.0;
    joint.motor = Some(Motor {
        ratio: 100.0,
        nominal: 0.5,
        stall: 2.5,
        no_load_speed: None,
    });
    joint
}

const STEP: MotorStep = MotorStep {
    torque: 0.0,
    demanded: 0.0,
    speed: 0.0,
    seconds: 0.1,
};

fn after(steps: &[MotorStep]) -> JointEffort {
    let mut effort = JointEffort::default();
    for step in steps {
        effort.add_step(step, &joint());
    }
    effort
}

#[track_caller]
fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
}

/// A motor works where it turns the way it pushes, and brakes where it is turned against that.
#[test]
fn a_motor_works_where_torque_and_speed_have_one_sign() {
    for (torque, speed, work) in [
        (2.0, 3.0, 0.6),
        (-2.0, -3.0, 0.6),
        (2.0, -3.0, 0.0),
        (-2.0, 3.0, 0.0),
        (2.0, 0.0, 0.0),
    ] {
        let step = MotorStep {
            torque,
            speed,
            ..STEP
        };
        near(after(&[step]).work, work);
        // Braking takes nothing back.
        let pushed = MotorStep {
            torque: 1.0,
            speed: 5.0,
            ..STEP
        };
        near(after(&[pushed, step]).work, 0.5 + work);
    }
}

#[test]
fn torque_warms_whichever_way_it_pushes() {
    let torques = [1.0, -2.0, 0.5];
    let effort = after(&torques.map(|torque| MotorStep { torque, ..STEP }));
    near(effort.square, (1.0 + 4.0 + 0.25) * 0.1);
    near(effort.peak, 2.0);
    near(effort.demanded_peak, 0.0);
}

#[test]
fn a_servo_is_saturated_where_it_demands_more_than_the_limit() {
    for side in [1.0, -1.0] {
        let demanded = [0.5, 0.6, 2.0, 2.1].map(|demanded| side * demanded);
        let effort = after(&demanded.map(|demanded| MotorStep { demanded, ..STEP }));
        near(effort.saturated, 0.1);
        near(effort.over_nominal, 0.3);
        near(effort.demanded_peak, 2.1);
        near(effort.peak, 0.0);
    }
}

/// Sums add up, peaks do not.
#[test]
fn efforts_of_cycles_add_up() {
    let robot = nao();
    let effort = |joint: JointEffort| {
        let mut effort = Effort::none(&robot);
        effort.seconds = 2.0;
        effort.joints[5] = joint;
        effort
    };
    let (one, other) = (
        JointEffort {
            square: 1.0,
            work: 2.0,
            peak: 3.0,
            demanded_peak: 5.0,
            saturated: 0.25,
            over_nominal: 0.5,
        },
        JointEffort {
            square: 10.0,
            work: 20.0,
            peak: 2.0,
            demanded_peak: 6.0,
            saturated: 2.5,
            over_nominal: 5.0,
        },
    );
    let mut sum = effort(one);
    sum.add(&effort(other));
    near(sum.seconds, 4.0);
    let expected = JointEffort {
        square: 11.0,
        work: 22.0,
        peak: 3.0,
        demanded_peak: 6.0,
        saturated: 2.75,
        over_nominal: 5.5,
    };
    assert_eq!(sum.joints[5], expected);
    assert_eq!(sum.joints[4], JointEffort::default());
    near(sum.work(), 22.0);
}

/// Each torque over its own motor's nominal one, and each peak over its own joint's limit.
#[test]
fn heat_and_peaks_are_over_each_joints_own_figures() {
    let mut robot = nao();
    for (index, joint) in robot.joints.iter_mut().enumerate() {
        joint.effort_limit = 1.0 + index as f64;
        joint.motor = None;
    }
    let motor = joint().motor.unwrap();
    robot.joints[2].motor = Some(motor);
    robot.joints[3].motor = Some(Motor {
        nominal: 2.0,
        ..motor
    });
    let mut effort = Effort::none(&robot);
    for (index, joint) in effort.joints.iter_mut().enumerate() {
        joint.square = 8.0;
        joint.peak = if index == 4 { 10.0 } else { 1.5 };
    }
    near(effort.heat(&robot), 8.0 / 0.25 + 8.0 / 4.0);
    let (peak, joint) = effort.peak_over_limit(&robot);
    near(peak, 2.0);
    assert_eq!(joint, JointId(4));
}
