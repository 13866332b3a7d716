//! What may be typed after `prone torque-map`.

use std::path::PathBuf;

use clap::{Subcommand, ValueEnum};

use super::named::RobotArg;

#[derive(Debug, Subcommand)]
pub(crate) enum TorqueMapCommand {
    /// Measure the torques at every node of a grid over theta3, theta4 and alpha
    Build(BuildArgs),
    /// Compare two maps, joint by joint
    Compare(CompareArgs),
    /// Draw a map as slices at constant theta3
    Plot(PlotArgs),
}

/// Where torques come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SourceArg {
    // Without documentation, which would make the help of all options longer.
    Statics,
    Simulation,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone torque-map build --source statics --out statics.csv
  prone torque-map build --source simulation --theta4-max-deg 15 --out thesis.csv
  prone torque-map build --source statics --step-deg 1.25 --out fine.csv

Statics takes a second, simulation minutes. The grid: theta3 -5..45°, theta4 from -30°, alpha
-90..-30°; the step must divide all three. The conditions are those of the published table: mapping
`original`, fixed arms, regime `table`.

Rows are kept in FILE.partial as they are measured. After Ctrl-C, or when the build was killed, the
same command takes them over; FILE is the same, byte for byte, as that of a build that was not
stopped, on any number of threads. FILE appears when all is done, and FILE.partial goes.")]
pub(crate) struct BuildArgs {
    /// A rigid body at rest, by moment balance, or a pose held in the engine until nothing changes
    #[arg(long)]
    pub(crate) source: SourceArg,
    /// The map; made, or replaced in one step
    #[arg(long, value_name = "FILE")]
    pub(crate) out: PathBuf,
    /// Distance of neighbours along all three angles, degrees
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 2.5,
        allow_negative_numbers = true
    )]
    pub(crate) step_deg: f64,
    /// Upper end of theta4, degrees; 15 is that of the thesis
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 27.5,
        allow_negative_numbers = true
    )]
    pub(crate) theta4_max_deg: f64,
    /// Discard the rows in FILE.partial
    #[arg(long)]
    pub(crate) restart: bool,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) robot: RobotArg,
    /// Print the summary as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone torque-map compare statics.csv simulation.csv
  prone torque-map compare statics.csv recorded.csv --worst 20
  prone torque-map compare statics.csv simulation.csv --json | jq .joints

Maps of either layout: 18 columns as `build` writes them, or the 14 of the published table. The grid
of one must lie within that of the other, node on node; the nodes of the smaller are compared.")]
pub(crate) struct CompareArgs {
    /// A map
    #[arg(value_name = "A")]
    pub(crate) a: PathBuf,
    /// Another map
    #[arg(value_name = "B")]
    pub(crate) b: PathBuf,
    /// How many of the rows that differ most are listed
    #[arg(long, value_name = "N", default_value_t = 5)]
    pub(crate) worst: u16,
    /// Print everything as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone torque-map plot statics.csv --out out/statics
  prone torque-map plot statics.csv --theta3-deg 15,17.5 --out out/near-the-gaits

One drawing per slice, as SVG and as PNG: a panel per joint over theta4 and alpha. All drawings of a
map share one colour scale. The folder appears when all is done; an earlier result is replaced.")]
pub(crate) struct PlotArgs {
    /// The map
    #[arg(value_name = "FILE")]
    pub(crate) map: PathBuf,
    /// Result folder; made, or replaced if it holds an earlier result
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Slices, degrees; nodes of the map [default: four, evenly spread]
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        allow_negative_numbers = true
    )]
    pub(crate) theta3_deg: Vec<f64>,
}
