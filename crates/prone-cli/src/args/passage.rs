//! What may be typed after `prone crawl under` and `prone crawl frontier`.

use std::path::PathBuf;

use clap::ValueEnum;

use prone::scene::{LOWEST_CEILING, taken_for_metres};

use super::named::{GaitArgs, RobotArg};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone crawl under --ceiling-mm 180
  prone crawl under --ceiling-mm 172 --margin-mm 1 --json
  prone crawl under --ceiling-mm 163.5 --margin-mm 1 --seed 1 --gait-out lowest.toml

Each GAIT is crawled, in the locomotion regime, and the fastest that stays below the
ceiling by the margin is the answer. Where none does and a seed is given, one is searched. The exit
code is 0 for either answer.")]
pub(crate) struct UnderArgs {
    /// Height of the ceiling above the floor, mm
    #[arg(long, value_name = "H", value_parser = ceiling, allow_negative_numbers = true)]
    pub(crate) ceiling_mm: f64,
    /// Distance that has to stay between robot and ceiling, mm
    #[arg(long, value_name = "MM", default_value = "3", value_parser = margin, allow_negative_numbers = true)]
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

Each ceiling is searched with each seed about one of the cycles of --from. What is found is crawled
in other settings too: friction 0.4 and 1, time scales 0.8 and 1.7, steps of 1 ms (where it has to
keep 80 % of its advance and the ceiling to hold), and with stiff servos, for information. The folder appears when all is done; until then the searches are kept in OUT.checkpoint.json beside it,
and --resume goes on from there to the same bytes.")]
pub(crate) struct FrontierArgs {
    /// Ceilings, mm
    #[arg(long, value_name = "LIST", value_delimiter = ',', default_value = "165,183,200", value_parser = ceiling, allow_negative_numbers = true)]
    pub(crate) ceilings_mm: Vec<f64>,
    /// What is searched under each ceiling
    #[arg(long, value_enum, default_value = "advance")]
    pub(crate) against: AgainstName,
    /// Distance that has to stay between robot and ceiling, mm
    #[arg(long, value_name = "MM", default_value = "1", value_parser = margin, allow_negative_numbers = true)]
    pub(crate) margin_mm: f64,
    /// Seed of the first search of each ceiling; the others follow
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) seed: u64,
    /// Searches of each ceiling
    #[arg(long, value_name = "R", default_value = "3", value_parser = clap::value_parser!(u64).range(1..=100))]
    pub(crate) runs: u64,
    /// Most evaluations of each search
    #[arg(long, value_name = "N", default_value = "1600", value_parser = clap::value_parser!(u64).range(16..=10_000_000))]
    pub(crate) budget: u64,
    /// Cycles about which is searched, names or files: the one that fits and comes farthest, else
    /// the lowest [default: those of the robot's [defaults], of the NAO low-175 and low-165]
    #[arg(long, value_name = "GAIT")]
    pub(crate) from: Vec<String>,
    /// Search cycles that can be steered: at the largest turn command they turn 6° a cycle, and
    /// joints that are off by a degree on friction of 0.5 at one side and 0.9 at the other turn them
    /// by half of that at most
    #[arg(long)]
    pub(crate) steerable: bool,
    /// Go on from the checkpoint of an interrupted search, if there is one
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

/// A ceiling as typed, mm; one that is lower than any robot was typed in metres.
pub(crate) fn ceiling(text: &str) -> Result<f64, String> {
    let typed: Option<f64> = text.trim().parse().ok();
    let meant = |mm: f64| Some((mm, taken_for_metres(mm / 1e3)? * 1e3));
    if let Some((mm, meant)) = typed.and_then(meant) {
        // Without the digits that a conversion makes up.
        let meant = (meant * 1e9).round() / 1e9;
        return Err(format!("{mm} mm: did you mean {meant}?"));
    }
    within(text, LOWEST_CEILING * 1e3, 10_000.0)
}

/// A height as typed, mm: above nothing, below any room.
pub(crate) fn height(text: &str) -> Result<f64, String> {
    within(text, 1.0, 10_000.0)
}

fn margin(text: &str) -> Result<f64, String> {
    within(text, 0.0, 1000.0)
}

fn within(text: &str, least: f64, most: f64) -> Result<f64, String> {
    let number: f64 = text.trim().parse().map_err(|_| "not a number".to_owned())?;
    if (least..=most).contains(&number) {
        Ok(number)
    } else {
        Err(format!("{number} mm is outside {least}..{most} mm"))
    }
}
