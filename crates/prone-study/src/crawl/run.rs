//! Under which conditions a crawl or a pull was simulated: `run.json`.

use serde::Serialize;

use prone::gait::Gait;
use prone::gait::cycle::Cycle;
use prone::regime::{Effort, SOLIMP, SOLREF, Servo, Stops};
use prone::robot::{JointAngles, Robot};
use prone_sim::{LoadedRobot, World};

use prone_record::program::{Program, RobotInfo};
use prone_record::recorded::{Command, Extent};

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

/// What was asked for, beside robot, gait and scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Conditions {
    /// After how many cycles it was to end, or at most.
    pub most_cycles: usize,
    /// Where it was to end, mm, if past the obstacles.
    pub until_past_mm: Option<f64>,
    /// What durations were multiplied by.
    pub time_scale: f64,
    /// `none`, `constant`, `heading` or `heading-hold`.
    pub steering: &'static str,
    /// The constant turn command, degrees.
    pub turn_command_deg: f64,
    /// The heading that was turned to, degrees.
    pub heading_deg: Option<f64>,
    /// Largest calibration error of a joint, degrees.
    pub joint_offset_deg: f64,
    /// Of those errors.
    pub seed: Option<u64>,
    /// The errors themselves, rad, by joint; those of the other joints are zero.
    pub joint_offsets_rad: Vec<(String, f64)>,
    /// Text of the scene's file, where there is one.
    pub scene_text: Option<String>,
    /// File and text of the cycle that is taken uphill, where there is one.
    pub uphill: Option<(String, String)>,
}

impl Conditions {
    /// Names the errors of a robot's joints.
    pub fn offsets_by_name(robot: &Robot, offsets: Option<&JointAngles>) -> Vec<(String, f64)> {
        let Some(offsets) = offsets else {
            return Vec::new();
        };
        let joints = robot.joints.iter().zip(offsets.as_slice());
        let named = joints.map(|(joint, &offset)| (joint.name.clone(), offset));
        named.filter(|(_, offset)| *offset != 0.0).collect()
    }
}

/// What tells one record from another: which command made it, of what, how long.
pub(super) struct Subject<'a, O> {
    pub(super) command: Command,
    pub(super) gait: &'a Gait,
    /// The gait's file, as the user named it, and its text.
    pub(super) file: (&'a str, &'a str),
    /// Time between two commands, s.
    pub(super) command_step_s: f64,
    pub(super) extent: Extent,
    pub(super) options: &'a O,
}

#[derive(Debug, Clone, Serialize)]
pub(super) struct RecordInfo<'a, O> {
    program: &'static str,
    #[serde(flatten)]
    built: Program,
    command: Command,
    engine: String,
    robot: RobotInfo,
    gait: GaitInfo<'a>,
    scene: SceneInfo<'a>,
    regime: RegimeInfo,
    options: &'a O,
    record: Extent,
}

#[derive(Debug, Clone, Serialize)]
struct GaitInfo<'a> {
    name: &'a str,
    description: &'a str,
    file: &'a str,
    mapping: &'static str,
    arm: &'static str,
    text: &'a str,
}

#[derive(Debug, Clone, Serialize)]
struct SceneInfo<'a> {
    name: &'a str,
    obstacles: usize,
    friction_left: f64,
    friction_right: f64,
    slope_deg: f64,
    rough: bool,
}

#[derive(Debug, Clone, Serialize)]
struct RegimeInfo {
    name: &'static str,
    friction: f64,
    impratio: f64,
    effort_limit: String,
    stops: &'static str,
    servo_gain: String,
    servo_rate_per_s: f64,
    servo_speed_rad_s: f64,
    time_step_s: f64,
    command_step_s: f64,
    settle_s: f64,
    solref: [f64; 2],
    solimp: [f64; 5],
}

impl<'a, O> RecordInfo<'a, O> {
    pub(super) fn of(
        robot: &LoadedRobot,
        world: &'a World,
        subject: &Subject<'a, O>,
        program: &Program,
    ) -> Self {
        let (gait, (file, text)) = (subject.gait, subject.file);
        let (regime, scene) = (world.regime(), world.scene());
        let sides = scene.floor.friction;
        Self {
            program: "prone",
            built: program.clone(),
            command: subject.command,
            engine: prone_sim::engine_version(),
            robot: RobotInfo::of(robot.robot(), robot.files()),
            gait: GaitInfo {
                name: &gait.name,
                description: &gait.description,
                file,
                mapping: gait.mapping.name(),
                arm: gait.arm.name(),
                text,
            },
            scene: SceneInfo {
                name: &scene.name,
                obstacles: world.obstacles().len(),
                friction_left: sides.map_or(regime.friction, |sides| sides.left),
                friction_right: sides.map_or(regime.friction, |sides| sides.right),
                slope_deg: scene.floor.slope.to_degrees(),
                rough: scene.floor.roughness.is_some(),
            },
            regime: RegimeInfo {
                name: regime.name,
                friction: regime.friction,
                impratio: regime.impratio,
                effort_limit: match regime.effort {
                    Effort::Published => "the maker's".to_owned(),
                    Effort::Uniform(limit) => format!("{limit} N·m on every joint"),
                },
                stops: match regime.stops {
                    Stops::Maker => "the maker's",
                    Stops::Study => "the study's",
                },
                servo_gain: match regime.servo {
                    Servo::Robot => "the robot's".to_owned(),
                    Servo::Uniform(gain) => format!("{gain} N·m·s/rad on every joint"),
                },
                servo_rate_per_s: world.servo_law().rate,
                servo_speed_rad_s: world.servo_law().speed,
                time_step_s: regime.time_step,
                command_step_s: subject.command_step_s,
                settle_s: prone_sim::pull::SETTLE,
                solref: SOLREF,
                solimp: SOLIMP,
            },
            options: subject.options,
            record: subject.extent,
        }
    }
}
