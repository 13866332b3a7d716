//! Under which conditions a crawl or a pull was simulated: `run.json`.

use prone::gait::Gait;
use prone::gait::cycle::Cycle;
use prone::regime::{SOLIMP, SOLREF, Servo, Stops, TorqueLimit, VelocityServo};
use prone::robot::{JointAngles, Robot};
use prone_sim::{LoadedRobot, World, WorldDrive, WorldServo};

use prone_record::head::Head;
use prone_record::origin::{Origin, RegimeInfo, ServoInfo, Simulated};
use prone_record::program::{Program, RobotInfo};
use prone_record::record_columns;
use prone_record::record_info::{Extent, GaitInfo, Options, RecordInfo, SceneInfo};
use prone_record::recorded::Command;

/// A crawl that ends past the obstacles of its scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PastObstacles {
    /// Where that is, m.
    pub x: f64,
}

/// A cycle and where it came from.
#[derive(Debug, Clone, PartialEq)]
pub struct GaitSource {
    /// What was read.
    pub cycle: Cycle,
    /// Its file, as the user named it.
    pub file: String,
    /// The text of that file.
    pub text: String,
}

/// Names the calibration errors of a robot's joints, rad, but those that are zero.
pub(super) fn offsets_by_name(robot: &Robot, offsets: Option<&JointAngles>) -> Vec<(String, f64)> {
    let offsets = offsets.map_or(&[][..], JointAngles::as_slice);
    let joints = robot.joints.iter().zip(offsets);
    let named = joints.map(|(joint, &offset)| (joint.name.clone(), offset));
    named.filter(|(_, offset)| *offset != 0.0).collect()
}

/// What tells one record from another: which command made it, of what, how long.
pub(super) struct Subject<'a> {
    pub(super) command: Command,
    pub(super) gait: &'a Gait,
    /// The gait's file, as the user named it, and its text.
    pub(super) file: (&'a str, &'a str),
    /// Time between two commands, s.
    pub(super) command_step_s: f64,
    pub(super) rows: usize,
    /// Time between two rows, s.
    pub(super) row_step_s: f64,
    pub(super) options: Options,
}

/// `run.json` of what was simulated in a world.
pub(super) fn record_info(
    robot: &LoadedRobot,
    world: &World,
    subject: Subject<'_>,
    program: &Program,
) -> RecordInfo {
    let (gait, (file, text)) = (subject.gait, subject.file);
    let engine = prone_sim::engine_version();
    RecordInfo {
        head: Head::new(program, subject.command, Some(engine.clone())),
        robot: RobotInfo::of(robot.robot(), robot.files()),
        gait: GaitInfo {
            name: gait.name.clone(),
            description: Some(gait.description.clone()),
            file: Some(file.to_owned()),
            mapping: Some(gait.mapping.name().to_owned()),
            arm: Some(gait.arm.name().to_owned()),
            text: Some(text.to_owned()),
        },
        scene: scene_info(world),
        origin: Origin::Simulated(Box::new(simulated(world, subject.command_step_s, engine))),
        options: subject.options,
        record: Extent::new(
            subject.rows,
            Some(subject.row_step_s),
            record_columns::channels(world.robot()),
        ),
    }
}

fn scene_info(world: &World) -> SceneInfo {
    let (regime, scene) = (world.regime(), world.scene());
    let sides = scene.floor.friction;
    SceneInfo {
        name: scene.name.clone(),
        obstacles: Some(world.obstacles().len()),
        friction_left: Some(sides.map_or(regime.friction, |sides| sides.left)),
        friction_right: Some(sides.map_or(regime.friction, |sides| sides.right)),
        slope_deg: Some(scene.floor.slope.to_degrees()),
        rough: Some(scene.floor.roughness.is_some()),
    }
}

/// How it was simulated, as the compiled model of the world says.
fn simulated(world: &World, command_step_s: f64, engine: String) -> Simulated {
    let options = world.engine_options();
    let robot = world.robot();
    let servos = world.drives().iter();
    let servos = servos.map(|it| {
        (
            it.drive.named_after(robot).name.clone(),
            servo_info(robot, it),
        )
    });
    let joints = robot.joints.iter().map(|joint| joint.name.clone());
    Simulated {
        engine,
        regime: regime_info(world, command_step_s),
        integrator: options.integrator.to_owned(),
        solver: options.solver.to_owned(),
        solver_iterations: options.iterations,
        solver_tolerance: options.tolerance,
        cone: options.cone.to_owned(),
        gravity_m_s2: options.gravity.to_array(),
        servos: servos.collect(),
        joint_damping_nms_rad: joints.zip(options.joint_damping).collect(),
    }
}

fn servo_info(robot: &Robot, WorldDrive { drive, servo }: &WorldDrive) -> ServoInfo {
    let joints = drive.joints.iter();
    let joints = joints.map(|id| robot.joints[id.0].name.clone()).collect();
    match servo {
        WorldServo::Motor(motor) => ServoInfo::DcMotor {
            joints,
            stiffness_nm_rad: motor.stiffness,
            supply_torque_nm: motor.supply_torque,
            current_torque_nm: motor.current_torque,
            back_emf_nms_rad: motor.back_emf,
            assumed: motor.assumed,
            backlash_rad: (motor.backlash > 0.0).then_some(motor.backlash),
        },
        WorldServo::Velocity { law, gain, limit } => ServoInfo::Velocity {
            joints,
            gain_nms_rad: *gain,
            rate_per_s: law.rate,
            speed_rad_s: law.speed,
            limit_nm: *limit,
        },
    }
}

fn regime_info(world: &World, command_step_s: f64) -> RegimeInfo {
    let regime = world.regime();
    RegimeInfo {
        name: regime.name.to_owned(),
        friction: regime.friction,
        impratio: regime.impratio,
        effort_limit: match regime.torque_limit {
            TorqueLimit::Published => "the manufacturer's".to_owned(),
            TorqueLimit::Uniform(limit) => format!("{limit} N·m on every joint"),
        },
        stops: match regime.stops {
            Stops::Manufacturer => "the manufacturer's",
            Stops::Study => "the study's",
        }
        .to_owned(),
        servo: match regime.servo {
            Servo::DcMotor(motors) => format!(
                "DC motors, {} times the robot's stiffness, gear efficiency {}",
                motors.stiffness_factor,
                motors.gear_efficiency(&world.robot().control)
            ),
            Servo::Velocity(VelocityServo { rate, speed, .. }) => {
                format!("velocity servos of the recordings, {rate} /s, at most {speed} rad/s")
            }
        },
        time_step_s: regime.time_step,
        command_step_s,
        settle_s: prone_sim::pull::SETTLE,
        solref: SOLREF,
        solimp: SOLIMP,
    }
}
