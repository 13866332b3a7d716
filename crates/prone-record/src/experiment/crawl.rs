//! A crawl of whole cycles, and a single pull.

use prone::robot::bounds;
use serde::{Deserialize, Serialize};

use super::{GaitText, RobotText, SceneText};

/// One closed-chain phase in the regime of the torque study, from the gait's own first pose.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PullExperiment {
    /// The robot that pulls.
    pub robot: RobotText,
    /// The pull that it does.
    pub gait: GaitText,
    /// How long it lasts, s.
    pub duration_s: f64,
}

/// Whole cycles in a scene, in the regime `locomotion`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CrawlExperiment {
    /// The robot that crawls.
    pub robot: RobotText,
    /// The cycle that it repeats.
    pub gait: GaitText,
    /// Which cycle instead where the robot feels that it goes uphill.
    pub uphill: Option<GaitText>,
    /// Where it crawls.
    pub scene: SceneChoice,
    /// When it ends.
    pub ending: Ending,
    /// How it is steered.
    pub steering: SteeringChoice,
    /// What all durations of the cycle are multiplied by.
    pub time_scale: f64,
    /// Rest after each cycle, s: the robot holds the posture from which the next pull begins.
    #[serde(default)]
    pub rest_s: f64,
    /// Stiffness of the servos.
    pub servo: ServoChoice,
    /// What masses and moments of inertia of the robot are multiplied by, where it does not weigh what
    /// its model says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mass_factor: Option<f64>,
    /// Play of every gear from one edge to the other, degrees, where there is any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub backlash_deg: Option<f64>,
    /// Where commands are late, the longest delay, ms: the servos get one every 20 ms, each after a
    /// delay that the seed draws.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub late_commands_ms: Option<f64>,
    /// Efficiency of the gears, in place of the robot's.
    pub gear_efficiency: Option<f64>,
    /// Length of an engine step, s, where it is not the regime's.
    pub time_step_s: Option<f64>,
    /// Largest calibration error of a joint, degrees, each drawn evenly by the seed.
    pub joint_offset_deg: Option<f64>,
    /// Seed of the calibration errors, of the inertial unit's noise and of late commands; all need it.
    pub seed: Option<u64>,
    /// What is kept.
    pub detail: Detail,
}

/// Where a crawl takes place: a level floor, and what is put on it or changed of it.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneChoice {
    /// A scene's file, in place of the level floor.
    pub text: Option<SceneText>,
    /// Height of a plate's underside, mm, and its length, m; in place of a file.
    pub plate: Option<(f64, f64)>,
    /// Friction of the ground with the left and with the right limbs.
    pub friction: Option<(f64, f64)>,
    /// Slope of the floor, uphill ahead, degrees.
    pub slope_deg: Option<f64>,
}

/// When a crawl ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Ending {
    /// After so many cycles.
    Cycles(usize),
    /// When the whole robot is past the obstacles of the scene, or after so many cycles; where nothing
    /// is said, as long as its pace leads past them within the most that a crawl may have.
    PastObstacles(Option<usize>),
}

/// How a crawl is steered.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SteeringChoice {
    /// Not at all.
    None,
    /// By one turn command for every cycle, degrees, positive to the left.
    Constant {
        /// The command.
        degrees: f64,
    },
    /// So that the robot keeps to its line.
    Line,
    /// So that the robot turns to a heading, degrees from the first one, and keeps it.
    Heading {
        /// The heading, positive to the left.
        degrees: f64,
    },
}

/// How stiff the servos are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ServoChoice {
    /// As the robot's are taken to be.
    Normal,
    /// Half as stiff.
    Soft,
    /// Four times as stiff.
    Stiff,
    /// So many times as stiff.
    Times(f64),
}

/// What is kept of a crawl.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Detail {
    /// Sums over cycles: advance, heights, efforts.
    Sums,
    /// Rows and pictures too: what a record folder needs.
    Rows,
}

impl CrawlExperiment {
    /// How many cycles are crawled where nothing is said.
    pub const CYCLES: usize = 9;

    /// Fewest and most cycles of a crawl.
    pub const CYCLES_BOUNDS: (usize, usize) = (1, 1000);

    /// Least and largest calibration error, degrees: a robot with a larger one is broken.
    pub const OFFSET_BOUNDS_DEG: (f64, f64) = (0.0, 10.0);

    /// Headings, degrees from the first one.
    pub const HEADING_BOUNDS_DEG: (f64, f64) = (-180.0, 180.0);

    /// Efficiencies of gears.
    pub const GEAR_EFFICIENCY_BOUNDS: (f64, f64) = bounds::GEAR_EFFICIENCY;

    /// Factors of the servos' stiffness.
    pub const STIFFNESS_BOUNDS: (f64, f64) = (0.1, 4.0);

    /// Factors of masses.
    pub const MASS_BOUNDS: (f64, f64) = (0.5, 2.0);

    /// Plays of gears, degrees.
    pub const BACKLASH_BOUNDS_DEG: (f64, f64) = (0.0, 5.0);

    /// Longest delays of late commands, ms: up to the time between two of them.
    pub const LATE_BOUNDS_MS: (f64, f64) = (0.0, 20.0);

    /// Rests after a cycle, s.
    pub const REST_BOUNDS_S: (f64, f64) = (0.0, 600.0);

    /// A cycle on a level floor, as the command line has it where nothing else is said.
    pub fn new(robot: RobotText, gait: GaitText) -> Self {
        Self {
            robot,
            gait,
            uphill: None,
            scene: SceneChoice::default(),
            ending: Ending::Cycles(Self::CYCLES),
            steering: SteeringChoice::None,
            time_scale: 1.0,
            rest_s: 0.0,
            servo: ServoChoice::Normal,
            mass_factor: None,
            backlash_deg: None,
            late_commands_ms: None,
            gear_efficiency: None,
            time_step_s: None,
            joint_offset_deg: None,
            seed: None,
            detail: Detail::Sums,
        }
    }
}
