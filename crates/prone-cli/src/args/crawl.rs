//! What may be typed after `prone crawl`.

use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};

use prone::gait::cycle::TimeScale;
use prone_record::experiment::CrawlExperiment;

use super::named::{GaitArg, RobotArg};
use super::passage::{FrontierArgs, UnderArgs};
use super::within;

#[derive(Debug, Subcommand)]
pub(crate) enum CrawlCommand {
    /// Simulate whole crawl cycles, in a scene or on a level floor
    Run(Box<CrawlRunArgs>),
    /// Whether the robot gets under a ceiling, with which cycle, and how fast
    Under(UnderArgs),
    /// Search the curve of ceiling against advance or heat
    Frontier(FrontierArgs),
}

#[derive(Debug, clap::Args)]
#[command(mut_arg("argument", |arg| {
    arg.help("Cycle: a name, of the robot's own or that ships (low-175, thesis-nominal, …), or a file")
}))]
#[command(mut_arg("gait", |arg| arg.help("Cycle, in place of the argument")))]
#[command(after_help = "\
Examples:
  prone crawl run low-175
  prone crawl run low-175 --ceiling-mm 190 --length-m 1.5 --until-past --heading-hold
  prone crawl run low-175 --turn-deg-per-cycle 12 --cycles 10 --json | jq .yaw_deg
  prone crawl run thesis-nominal --scene table --cycles 25 --record out/table
  prone crawl run hip-10 --uphill low-175 --scene ramp --seed 1 --cycles 20
  prone crawl run thesis-nominal --rest-s 3 --json | jq .verdict

Contact regime `locomotion`: friction 0.7 where nothing else is said, the robot's own motors, the
manufacturer's effort and joint limits on. The verdict says whether the motors of a robot could do
it: continuous, limited (for minutes), or not on a robot. The robot starts with its foremost point at
x = 0; a plate of --ceiling-mm begins 50 mm ahead. The record folder appears when all is done, and
replaces an earlier result in one step; all its files but timing.json are the same, byte for byte, for
the same input, on any number of threads. Ctrl-C ends it within two seconds, and nothing is written.
A second one ends the program at once.")]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a switch of the command line"
)]
pub(crate) struct CrawlRunArgs {
    #[command(flatten)]
    pub(crate) gait: GaitArg,
    /// Crawl this cycle instead where the robot feels that it goes uphill, more than `uphill_deg` of its
    /// robot.toml (NAO 1.5°) by its inertial unit, whose noise --seed draws
    #[arg(long, value_name = "GAIT", requires = "seed")]
    pub(crate) uphill: Option<String>,
    /// How many cycles, with --until-past at most [default: 9]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1000))]
    pub(crate) cycles: Option<u16>,
    /// End when the whole robot is past the plates and panels of the scene. Fails after --cycles N;
    /// without it, when the pace of the last 20 cycles does not lead past them within 1000
    #[arg(long)]
    pub(crate) until_past: bool,
    /// Exit with code 1 where a plate, a leg of one or a panel was touched; the record is written all the same
    #[arg(long)]
    pub(crate) fail_on_contact: bool,
    /// A scene that ships with prone (plate-200, table, …) or a scene file [default: a level floor]
    #[arg(long, value_name = "SCENE")]
    pub(crate) scene: Option<String>,
    /// A plate with its underside at this height, in place of --scene, mm
    #[arg(
        long,
        value_name = "H",
        requires = "length_m",
        conflicts_with = "scene",
        value_parser = super::heights::ceiling,
        allow_negative_numbers = true
    )]
    pub(crate) ceiling_mm: Option<f64>,
    /// Length of the plate of --ceiling-mm, m
    #[arg(
        long,
        value_name = "L",
        requires = "ceiling_mm",
        allow_negative_numbers = true
    )]
    pub(crate) length_m: Option<f64>,
    /// Turn each cycle so that the robot keeps to its line; it knows where it is from the simulation
    #[arg(long, conflicts_with = "turn_deg_per_cycle")]
    pub(crate) heading_hold: bool,
    /// Turn to this heading and keep it, degrees from the first one, positive to the left
    #[arg(long, value_name = "H", conflicts_with_all = ["heading_hold", "turn_deg_per_cycle"], value_parser = heading, allow_negative_numbers = true)]
    pub(crate) heading_deg: Option<f64>,
    /// Turn command of every cycle, degrees, positive to the left: what the arms are asked to turn,
    /// of which the robot turns a part
    #[arg(long, value_name = "U", allow_negative_numbers = true)]
    pub(crate) turn_deg_per_cycle: Option<f64>,
    /// Friction of the ground with the left limbs, in place of the regime's
    #[arg(
        long,
        value_name = "F",
        requires = "friction_right",
        allow_negative_numbers = true
    )]
    pub(crate) friction_left: Option<f64>,
    /// Friction of the ground with the right limbs
    #[arg(
        long,
        value_name = "F",
        requires = "friction_left",
        allow_negative_numbers = true
    )]
    pub(crate) friction_right: Option<f64>,
    /// Largest calibration error of the joints, degrees; each joint has its own, drawn uniformly within ± this
    #[arg(long, value_name = "D", requires = "seed", value_parser = offset, allow_negative_numbers = true)]
    pub(crate) joint_offset_deg: Option<f64>,
    /// Seed of the calibration errors of --joint-offset-deg, of the inertial unit's noise and of
    /// --late-commands-ms
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) seed: Option<u64>,
    /// Slope of the floor, uphill ahead, degrees
    #[arg(long, value_name = "D", allow_negative_numbers = true)]
    pub(crate) slope_deg: Option<f64>,
    /// What all durations of the cycle are multiplied by
    #[arg(long, value_name = "X", default_value = "1", value_parser = time_scale, allow_negative_numbers = true)]
    pub(crate) time_scale: TimeScale,
    /// Rest after each cycle, s, in the posture from which the next pull begins: shoulders cool, hips hold the legs
    #[arg(long, value_name = "S", default_value = "0", value_parser = rest, allow_negative_numbers = true)]
    pub(crate) rest_s: f64,
    /// Stiffness of the servos
    #[arg(long, value_enum, default_value = "normal")]
    pub(crate) servo: ServoName,
    /// What the stiffness of the servos is multiplied by, in place of --servo
    #[arg(long, value_name = "F", conflicts_with = "servo", value_parser = stiffness_factor, allow_negative_numbers = true)]
    pub(crate) stiffness_factor: Option<f64>,
    /// What masses and inertias of the robot are multiplied by: a robot that is lighter or heavier than its model
    #[arg(long, value_name = "F", value_parser = mass_factor, allow_negative_numbers = true)]
    pub(crate) mass_factor: Option<f64>,
    /// Play of every gear from one edge to the other, degrees: within it a motor passes on no torque
    #[arg(long, value_name = "D", value_parser = backlash, allow_negative_numbers = true)]
    pub(crate) backlash_deg: Option<f64>,
    /// Let the servos get one command every 20 ms, each late by 0 to MS, which --seed draws
    #[arg(long, value_name = "MS", requires = "seed", value_parser = late_commands, allow_negative_numbers = true)]
    pub(crate) late_commands_ms: Option<f64>,
    /// Share of the motors' torque that the gears pass on, in place of `gear_efficiency` of robot.toml
    /// (NAO 0.6, an estimate)
    #[arg(long, value_name = "E", value_parser = gear_efficiency, allow_negative_numbers = true)]
    pub(crate) gear_efficiency: Option<f64>,
    /// Length of one engine step, ms
    #[arg(long, value_enum, value_name = "MS", default_value = "2.5")]
    pub(crate) time_step_ms: TimeStepName,
    #[command(flatten)]
    pub(crate) robot: RobotArg,
    /// Record folder; made, or replaced if it holds an earlier result
    #[arg(long, value_name = "DIR")]
    pub(crate) record: Option<PathBuf>,
    /// Worker threads, for the pictures of --record [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Print the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// How stiff the servos are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ServoName {
    /// `servo_stiffness_nm_rad` of robot.toml: on the NAO 80 N·m/rad at legs and head, 40 at the arms
    Normal,
    /// Half as stiff
    Soft,
    /// Four times as stiff
    Stiff,
}

/// How long an engine step lasts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum TimeStepName {
    // Without documentation, which would make the help of all options longer.
    #[value(name = "0.25", alias = ".25")]
    Finest,
    #[value(name = "0.5", alias = ".5")]
    Finer,
    #[value(name = "1")]
    Fine,
    #[value(name = "1.25")]
    Half,
    #[value(name = "2.5")]
    Usual,
}

impl TimeStepName {
    /// The step, s; nothing of the regime's own.
    pub(crate) const fn seconds(self) -> Option<f64> {
        match self {
            Self::Finest => Some(0.000_25),
            Self::Finer => Some(0.0005),
            Self::Fine => Some(0.001),
            Self::Half => Some(0.001_25),
            Self::Usual => None,
        }
    }
}

fn rest(text: &str) -> Result<f64, String> {
    within(text, " s", CrawlExperiment::REST_BOUNDS_S)
}

fn gear_efficiency(text: &str) -> Result<f64, String> {
    within(text, "", CrawlExperiment::GEAR_EFFICIENCY_BOUNDS)
}

fn stiffness_factor(text: &str) -> Result<f64, String> {
    within(text, "", CrawlExperiment::STIFFNESS_BOUNDS)
}

fn mass_factor(text: &str) -> Result<f64, String> {
    within(text, "", CrawlExperiment::MASS_BOUNDS)
}

fn backlash(text: &str) -> Result<f64, String> {
    within(text, "°", CrawlExperiment::BACKLASH_BOUNDS_DEG)
}

fn late_commands(text: &str) -> Result<f64, String> {
    within(text, " ms", CrawlExperiment::LATE_BOUNDS_MS)
}

fn heading(text: &str) -> Result<f64, String> {
    within(text, "°", CrawlExperiment::HEADING_BOUNDS_DEG)
}

fn offset(text: &str) -> Result<f64, String> {
    within(text, "°", CrawlExperiment::OFFSET_BOUNDS_DEG)
}

fn time_scale(text: &str) -> Result<TimeScale, String> {
    let factor: f64 = text.trim().parse().map_err(|_| "not a number".to_owned())?;
    TimeScale::new(factor).map_err(|error| error.to_string())
}
