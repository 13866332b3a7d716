//! What may be typed after `prone list`.

use clap::ValueEnum;

use super::named::RobotArg;

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone list                              all names; each cycle is crawled for its figures
  prone list --quick                      the same with descriptions in place of figures
  prone list --kind cycles --json | jq '.[] | select(.height_mm < 180) | .name'
  prone list --kind cycles --robot nao/v5

A gait is a pull alone; a cycle has its way back and can crawl. Each cycle is crawled three times
round on level ground, as `prone crawl run --cycles 3` does: the highest point of the robot, its
advance, motor heat per metre, whether a robot's motors could do it, and the largest force on the
head. Names of the robot's own are marked with *; they take precedence over those that ship.")]
pub(crate) struct ListArgs {
    /// List names of one kind alone
    #[arg(long, value_enum)]
    pub(crate) kind: Option<KindName>,
    /// Simulate nothing, and leave out what only a simulation tells
    #[arg(long)]
    pub(crate) quick: bool,
    #[command(flatten)]
    pub(crate) robot: RobotArg,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Print everything as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// A kind of names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum KindName {
    /// Pulls alone
    Gaits,
    /// Whole cycles
    Cycles,
    /// Scenes
    Scenes,
    /// Robots
    Robots,
}
