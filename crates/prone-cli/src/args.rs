//! What may be typed.

mod crawl;
pub(crate) mod cycle_rules;
mod export;
mod heights;
pub(crate) mod list;
mod named;
pub(crate) mod optimize;
pub(crate) mod passage;
pub(crate) mod pull_terms;
mod report;
mod torque_map;
mod view;

use std::path::PathBuf;

use clap::{Parser, Subcommand};

use prone::gait::PhaseDuration;

pub(crate) use crawl::{CrawlCommand, CrawlRunArgs, ServoName};
pub(crate) use export::{ExportArgs, Format, ViewName};
pub(crate) use named::{GaitArg, RobotArg, RobotArgument};
pub(crate) use report::ReportArgs;
pub(crate) use torque_map::{BuildArgs, CompareArgs, PlotArgs, SourceArg, TorqueMapCommand};
pub(crate) use view::ViewArgs;

/// Makes humanoid robots crawl where they cannot walk.
#[derive(Debug, Parser)]
#[command(
    name = "prone",
    version,
    propagate_version = true,
    arg_required_else_help = true
)]
#[command(after_help = "\
Examples:
  prone reproduce                         redo the published study, report in out/reproduce
  prone optimize --objective torque --source dynamics --seed 1 --out out/torque
                                          search a better gait
  prone cost nominal --objective heat --source dynamics
                                          tell what a gait costs
  prone crawl run low-175 --ceiling-mm 190 --length-m 1.5 --until-past
                                          crawl under a plate
  prone crawl under --ceiling-mm 180      whether the robot gets under it, how, and how fast
  prone crawl run low-175 --record out/low
                                          record a crawl
  prone view out/low --open               replay it in the browser
  prone report out/reproduce out/low      figures, report card and replay on one page
  prone export out/low --format mcap      the recorded crawl for other tools
  prone list                              gaits, cycles, scenes and robots by name
  prone gait show nominal                 a gait's joints, limits and heights
  prone robot check robots/nao            validate a robot and print its chain

Exit codes: 0 done; 2 the input is wrong: an option, a file, or a place for the result that is seen to
be wrong before the work begins; 1 the work failed, or its result could not be written, on a full disk
for example; 130 stopped by Ctrl-C, SIGTERM or SIGHUP. The first Ctrl-C is answered at once and ends
the work within two seconds, a second one ends the program at once.")]
pub(crate) struct Args {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Redo the published torque study: simulate, cost, compare, draw, report
    Reproduce(ReproduceArgs),
    /// Crawl whole cycles in simulation, and ask what a robot gets under
    #[command(subcommand)]
    Crawl(CrawlCommand),
    /// Write a recorded run for other tools: tables, ROS 2 logs, URDF, key frames, video
    Export(ExportArgs),
    /// Search a better gait, and simulate what is found beside the published ones
    Optimize(Box<optimize::OptimizeArgs>),
    /// Tell what one gait costs
    Cost(Box<optimize::CostArgs>),
    /// Look at gaits
    #[command(subcommand)]
    Gait(GaitCommand),
    /// List gaits, cycles, scenes and robots by name
    List(list::ListArgs),
    /// Look at robots
    #[command(subcommand)]
    Robot(RobotCommand),
    /// Make one page with figures, report card and replay of recorded runs
    Report(ReportArgs),
    /// Build, compare and draw maps of static joint torques
    #[command(subcommand)]
    TorqueMap(TorqueMapCommand),
    /// Make a page that replays a recorded run
    View(ViewArgs),
    /// Print a completion script for a shell
    #[command(
        after_help = "Example:\n  prone completions bash > ~/.local/share/bash-completion/completions/prone"
    )]
    Completions {
        /// For which shell
        shell: clap_complete::Shell,
    },
}

#[derive(Debug, Subcommand)]
pub(crate) enum GaitCommand {
    /// Plan a gait on a robot: joint trajectory, limits, heights
    Show(GaitShowArgs),
}

#[derive(Debug, Subcommand)]
pub(crate) enum RobotCommand {
    /// Validate a robot's files and print its crawling chain
    Check(RobotCheckArgs),
    /// Write a robot for programs that have no physics engine
    Compile(RobotCompileArgs),
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone reproduce
  prone reproduce --durations 1,5,10 --out /tmp/short
  prone reproduce --json | jq .ratios

The folder appears when all is done, and replaces an earlier result in one step. What is replaced:
an empty folder, or one that holds nothing but files that its run.json lists as written by prone;
with any other file in it, it is left alone. A link is followed. All files of a result but
timing.json are the same, byte for byte, for the same input, on any number of threads.")]
pub(crate) struct ReproduceArgs {
    /// Result folder; made, or replaced if it holds an earlier result
    #[arg(long, value_name = "DIR", default_value = "out/reproduce")]
    pub(crate) out: PathBuf,
    /// Durations of the phase, s, multiples of 0.1
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        value_parser = seconds,
        allow_negative_numbers = true,
        default_value = "1,2,3,4,5,6,7,8,9,10"
    )]
    pub(crate) durations: Vec<f64>,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    #[command(flatten)]
    pub(crate) robot: RobotArg,
    /// Print the figures of summary.json instead of a table
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone gait show nominal
  prone gait show my-gait.toml --duration 3 --csv my-gait.csv
  prone gait show low-175                 a whole cycle: its pull and the way back
  prone gait show optimal --json | jq .clamps")]
pub(crate) struct GaitShowArgs {
    #[command(flatten)]
    pub(crate) gait: GaitArg,
    /// Duration of the pull, s [default: 5, or a cycle's own]
    #[arg(
        long,
        value_name = "S",
        value_parser = phase_duration,
        allow_negative_numbers = true
    )]
    pub(crate) duration: Option<PhaseDuration>,
    /// Write all 101 instants to a CSV file
    #[arg(long, value_name = "FILE")]
    pub(crate) csv: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) robot: RobotArg,
    /// Print everything as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone robot check
  prone robot check robots/nao --json")]
pub(crate) struct RobotCheckArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgument,
    /// Print everything as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone robot compile robots/nao          beside robot.toml, as robot.compiled.json
  prone robot compile my-robot --out /tmp/my-robot.json
  prone robot compile --out nao.json --json

The file holds all that prone knows of the robot, and the hash of robot.toml and its model: once one
of them has changed it is stale and refused. The same robot gives the same bytes.")]
pub(crate) struct RobotCompileArgs {
    #[command(flatten)]
    pub(crate) robot: RobotArgument,
    /// The file [default: robot.compiled.json beside the robot.toml of a folder]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Print what was written as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// A number of seconds, with spaces around it or not.
fn seconds(text: &str) -> Result<f64, String> {
    let number = text.trim();
    if number.is_empty() {
        return Err("a number of seconds is missing".to_owned());
    }
    number
        .parse()
        .map_err(|_| "not a number of seconds".to_owned())
}

fn phase_duration(text: &str) -> Result<PhaseDuration, String> {
    PhaseDuration::new(seconds(text)?).map_err(|_| {
        let (shortest, longest) = (PhaseDuration::SHORTEST, PhaseDuration::LONGEST);
        format!("a phase lasts {shortest} to {longest} s")
    })
}

/// A number as typed, within bounds; `unit` follows it in messages, as " mm".
fn within(text: &str, unit: &str, (least, most): (f64, f64)) -> Result<f64, String> {
    let number: f64 = text.trim().parse().map_err(|_| "not a number".to_owned())?;
    if (least..=most).contains(&number) {
        Ok(number)
    } else {
        Err(format!("{number}{unit} is outside {least}..{most}{unit}"))
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn arguments_are_consistent() {
        Args::command().debug_assert();
    }
}
