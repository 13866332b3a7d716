//! What may be typed after `prone crawl under` and `prone crawl frontier`.

use std::path::PathBuf;

use clap::ValueEnum;

use prone_record::experiment::{CycleSearchExperiment, PassageExperiment};
use prone_record::frontier::Quantity;

use super::heights::ceiling;
use super::named::{GaitArgs, RobotArg};
use super::within;

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone crawl under --ceiling-mm 180
  prone crawl under --ceiling-mm 150 --length-m 2 --json | jq -r .gait
  prone crawl under --ceiling-mm 140 my-cycle.toml
  prone crawl under --ceiling-mm 121 --margin-mm 1 --seed 1 --gait-out lowest.toml

Each GAIT is crawled under a plate of that height and length. Those that get through untouched and
keep the margin go, the fastest first, through 24 corners under the same plate: joints off by up to
1° on ground that is more slippery at one side, friction 0.4 and 1, masses 10 % off, servos half and
twice as stiff, 1° of play in every gear, late commands. There the heading is held where the cycle can
be steered. The answer is the first that gets through all of them; where none does, the fastest that
passes as everything is in the model, which is said. Where none passes and a seed is given, one is
searched. The exit code is 0 for every answer.")]
pub(crate) struct UnderArgs {
    /// Height of the ceiling above the floor, mm
    #[arg(long, value_name = "H", value_parser = ceiling, allow_negative_numbers = true)]
    pub(crate) ceiling_mm: f64,
    /// Length of the plate along the way, m
    #[arg(long, value_name = "L", default_value = "1.2", value_parser = length, allow_negative_numbers = true)]
    pub(crate) length_m: f64,
    /// Distance that has to stay between robot and ceiling where everything is as in the model, mm
    #[arg(long, value_name = "MM", default_value = "2", value_parser = margin, allow_negative_numbers = true)]
    pub(crate) margin_mm: f64,
    /// Search where no GAIT fits, with this seed
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) seed: Option<u64>,
    /// Most evaluations of that search
    #[arg(long, value_name = "N", default_value = "800", requires = "seed", value_parser = clap::value_parser!(u64).range(16..=10_000_000))]
    pub(crate) budget: u64,
    /// Write the answer's cycle to a file
    #[arg(long, value_name = "FILE")]
    pub(crate) gait_out: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) robot: RobotArg,
    #[command(flatten)]
    pub(crate) gaits: GaitArgs,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Print everything as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone crawl frontier --seed 1 --out out/frontier
  prone crawl frontier --ceilings-mm 165,200 --runs 1 --budget 800 --seed 7 --out out/short
  prone crawl frontier --against heat --seed 1 --out out/heat-frontier
  prone crawl frontier --of ceiling,speed --at 165,180,200 --seed 1 --out out/speed
  prone crawl frontier --of speed,heat --at 30,40,50 --time-budget 600 --seed 1 --out out/speed-heat

Each value is searched with each seed about one of the cycles of --from. What is found is crawled
in other settings too: the 24 corners, time scales 0.8 and 1.7, steps of 1 ms, and, for information,
with stiff and with soft servos. A point is robust where it keeps three quarters of its advance in
them, below the ceiling; it is ideal where it keeps the rules in the settings of its search alone.
The folder appears when all is done; until then the searches are kept in OUT.checkpoint.json beside it,
and --resume goes on from there to the same bytes.")]
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a switch of the command line"
)]
pub(crate) struct FrontierArgs {
    /// Two quantities: the first is held at several values, the second is searched at each
    ///
    /// They are ceiling (mm; searched, the robot's highest point), advance (mm per cycle), speed (mm/s), heat
    /// (s/m) and duty (RMS torque of the worst motor over its nominal torque)
    #[arg(long, value_name = "HELD,SEARCHED", default_value = "ceiling,advance", value_parser = pair)]
    pub(crate) of: (Quantity, Quantity),
    /// Values at which the first quantity is held: ceilings in mm, least advances in mm per cycle, least
    /// speeds in mm/s, largest heats in s/m, largest duties [default: ceilings 165,183,200]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = value, allow_negative_numbers = true, conflicts_with = "ceilings_mm")]
    pub(crate) at: Vec<f64>,
    /// Ceilings, mm: --at where ceilings are held
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = ceiling, allow_negative_numbers = true)]
    pub(crate) ceilings_mm: Vec<f64>,
    /// What is searched under each ceiling, in place of --of
    #[arg(long, value_enum, conflicts_with = "of")]
    pub(crate) against: Option<AgainstName>,
    /// Distance that has to stay between robot and ceiling, mm [default: 1]
    #[arg(long, value_name = "MM", value_parser = margin, allow_negative_numbers = true)]
    pub(crate) margin_mm: Option<f64>,
    /// Seed of the first search of each value; the others follow
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) seed: u64,
    /// Searches of each value
    #[arg(long, value_name = "R", default_value = "3", value_parser = clap::value_parser!(u64).range(1..=100))]
    pub(crate) runs: u64,
    /// Most evaluations of each search
    #[arg(long, value_name = "N", default_value_t = CycleSearchExperiment::BUDGET, value_parser = clap::value_parser!(u64).range(16..=10_000_000))]
    pub(crate) budget: u64,
    /// Most seconds of searching in all, shared among values and runs; what is found by then is kept, and
    /// --resume goes on from there
    #[arg(long, value_name = "S", value_parser = super::optimize::seconds)]
    pub(crate) time_budget: Option<f64>,
    /// Cycles about which is searched, names or files: the one that fits and comes farthest, else
    /// the lowest [default: those of the robot's [defaults], of the NAO those called low-]
    #[arg(long, value_name = "GAIT")]
    pub(crate) from: Vec<String>,
    /// Search cycles that can be steered: at the largest turn command they turn 10° a cycle, and more
    /// than uneven ground and joints that are off throw them off
    #[arg(long)]
    pub(crate) steerable: bool,
    /// Leave out the corners, so that what is found is for good ground only
    #[arg(long)]
    pub(crate) ideal: bool,
    /// Size of the box about the cycle that is searched about, as a share of the largest
    #[arg(long, value_name = "SHARE", default_value = "1", value_parser = super::cycle_rules::reach, allow_negative_numbers = true)]
    pub(crate) reach: f64,
    /// Go on from the checkpoint of an interrupted search, or from a finished one in --out, if there is
    /// one; --budget may be larger than it was
    #[arg(long)]
    pub(crate) resume: bool,
    /// Result folder; made, or replaced if it holds an earlier result
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    #[command(flatten)]
    pub(crate) robot: RobotArg,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Print result.json instead of a table
    #[arg(long)]
    pub(crate) json: bool,
}

/// What a frontier is drawn against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum AgainstName {
    /// The largest advance per cycle
    Advance,
    /// The least motor heat per metre
    Heat,
}

fn length(text: &str) -> Result<f64, String> {
    within(text, " m", PassageExperiment::LENGTHS_M)
}

/// Two different quantities.
fn pair(text: &str) -> Result<(Quantity, Quantity), String> {
    let names = Quantity::ALL.map(Quantity::name).join(", ");
    let quantity = |name: &str| {
        let mut all = Quantity::ALL.into_iter();
        let found = all.find(|it| it.name() == name.trim());
        found.ok_or_else(|| format!("there is no quantity {name:?}; there are {names}"))
    };
    let (held, searched) = text
        .split_once(',')
        .ok_or_else(|| format!("it takes two of {names}, such as ceiling,speed"))?;
    let (held, searched) = (quantity(held)?, quantity(searched)?);
    if held == searched {
        return Err("a frontier is between two different quantities".to_owned());
    }
    Ok((held, searched))
}

/// A value of any quantity; its bounds are known with the quantity.
fn value(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "not a number".to_owned())
}

fn margin(text: &str) -> Result<f64, String> {
    within(text, " mm", (0.0, 1000.0))
}
