//! What may be typed after `prone cost` and `prone optimize`.

use std::path::PathBuf;

use clap::ValueEnum;

use prone_record::experiment::{CycleSearchExperiment, GaitForm, PullSearchExperiment};

use super::cycle_rules::CycleRulesArgs;
use super::named::GaitArg;
use super::pull_terms::PullTermsArgs;

#[derive(Debug, clap::Args)]
#[command(mut_arg("argument", |arg| {
    arg.help("Gait or cycle: a name, of the robot's own or that ships (nominal, low-175, …), or a file")
}))]
#[command(mut_arg("gait", |arg| arg.help("Gait, in place of the argument")))]
#[command(after_help = "\
Examples:
  prone cost nominal --objective torque --source dynamics
  prone cost optimal --objective published --source table.csv --json
  prone cost my-gait.toml --objective heat --source statics --per metre
  prone cost low-175 --objective speed
  prone cost low-175 --objective heat --worst-over thesis-nominal --most-heat 0.7 --json

Without --source a pull is costed by dynamics, and a cycle by cycle.
Torque has the sign of the published recordings and is that of the right side. Violations are kept
apart from torque: the sum of what is broken, in shares of the limit (published: violated samples).
A cycle is crawled in the settings of a search; its value is printed in its own unit, with what it
breaks in each setting.")]
pub(crate) struct CostArgs {
    #[command(flatten)]
    pub(crate) gait: GaitArg,
    #[command(flatten)]
    pub(crate) terms: PullTermsArgs,
    #[command(flatten)]
    pub(crate) cycle: CycleRulesArgs,
    /// Print {"cost", "torque", "violations", …}
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, clap::Args)]
#[command(mut_arg("source", |arg| arg.required(true)))]
#[command(after_help = "\
Examples:
  prone optimize --objective torque --source dynamics --seed 1 --out out/torque
  prone optimize --objective torque --source dynamics --gait-form bspline:8 --ends free --seed 1 --runs 5 --out out/spline
  prone optimize --objective published --source table.csv --seed 1 --runs 20 --out out/published
  prone optimize --objective published --source table.csv --solver ga --seed 1 --out out/replication
  prone optimize --objective heat --source statics --seed 7 --budget 20000 --out out/heat --resume
  prone optimize --objective heat --source cycle --from low-175 --worst-over thesis-nominal --seed 1 --runs 6 --out out/efficient
  prone optimize --objective peak --source cycle --from low-175 --least-advance-mm 40 --seed 1 --out out/gentle
  prone optimize --objective speed --source cycle --ceiling-mm 180 --seed 1 --out out/fast

The folder appears when all is done: gait.toml (for every other command), result.json, history.csv,
confirmation.csv (the found gait simulated at other durations and in both contact regimes, beside
those of the robot's [defaults], such as nominal and optimal), figures, run.json, timing.json. Until then the search is kept in
OUT.checkpoint.json beside it; after Ctrl-C or a kill, --resume goes on from there and ends in the
same bytes as a search that was never stopped. A finished one can be lengthened: with --resume and a
larger --budget it goes on from the state in its folder (search.state.json). The same seed gives the same bytes on any number of
threads, except with --time-budget.")]
pub(crate) struct OptimizeArgs {
    #[command(flatten)]
    pub(crate) terms: PullTermsArgs,
    /// Curves that are searched: `cubic`, or `bspline:N` with N control points each [default: cubic]
    #[arg(long, value_name = "FORM", value_parser = gait_form)]
    pub(crate) gait_form: Option<GaitForm>,
    /// Whether knee and hip begin and end as in the gait of --from [default: fixed]
    #[arg(long, value_enum)]
    pub(crate) ends: Option<EndsName>,
    /// Method of search [default: de, with cycle cma-es]
    #[arg(long, value_enum)]
    pub(crate) solver: Option<SolverName>,
    /// Seed of the first run; the others follow
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub(crate) seed: u64,
    /// Independent runs, with the seeds S, S+1, …; the best of all is kept
    #[arg(long, value_name = "R", default_value = "1", value_parser = clap::value_parser!(u64).range(1..=1000))]
    pub(crate) runs: u64,
    #[arg(long, value_name = "N", help = budget_help(), value_parser = clap::value_parser!(u64).range(1..=1_000_000_000))]
    pub(crate) budget: Option<u64>,
    /// Most seconds of searching in all, shared among runs; what is found by then is kept, and --resume
    /// goes on from there
    #[arg(long, value_name = "S", value_parser = seconds)]
    pub(crate) time_budget: Option<f64>,
    /// Go on from the checkpoint of an interrupted search, or from a finished one in --out, if there is
    /// one; --budget may be larger than it was
    #[arg(long)]
    pub(crate) resume: bool,
    /// Durations at which the found gait is simulated, s [default: 1,2,3,4,5,6,7,8,9,10]
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = super::phase_duration)]
    pub(crate) confirm_durations: Option<Vec<prone::gait::PhaseDuration>>,
    #[command(flatten)]
    pub(crate) cycle: CycleRulesArgs,
    /// cycle: size of the box about the cycle of --from, as a share of the largest: about a good cycle
    /// a small one finds more [default: 1]
    #[arg(long, value_name = "SHARE", value_parser = super::cycle_rules::reach, allow_negative_numbers = true)]
    pub(crate) reach: Option<f64>,
    /// Name of the found gait [default: best-OBJECTIVE]
    #[arg(long, value_name = "NAME", value_parser = name)]
    pub(crate) name: Option<String>,
    /// Result folder; made, or replaced if it holds an earlier result
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Worker threads [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
    /// Print result.json instead of a table
    #[arg(long)]
    pub(crate) json: bool,
}

/// Whether ends are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum EndsName {
    /// Knee and hip begin and end as in the gait of --from
    Fixed,
    /// Both ends are searched too; those of the upper arm, which set the stroke, are not
    Free,
}

/// A solver's name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum SolverName {
    /// Differential evolution, with restarts
    De,
    /// CMA-ES of another library: the independent check
    CmaEs,
    /// Genetic algorithm with MATLAB's defaults, 200 × 80: the published search
    Ga,
}

/// Help of `--budget`, which tells what is used.
fn budget_help() -> String {
    format!(
        "Most evaluations of each run [default: {} with cycle, {} with dynamics, else {}]",
        CycleSearchExperiment::BUDGET,
        PullSearchExperiment::DYNAMIC_BUDGET,
        PullSearchExperiment::BUDGET
    )
}

fn gait_form(text: &str) -> Result<GaitForm, String> {
    if text == "cubic" {
        return Ok(GaitForm::Cubic);
    }
    let points = text.strip_prefix("bspline:").and_then(|n| n.parse().ok());
    match points {
        Some(points @ 4..=32) => Ok(GaitForm::BSpline { points }),
        Some(points) => Err(format!("{points} control points are outside 4..32")),
        None => Err("it is cubic or bspline:N".to_owned()),
    }
}

/// Most seconds of searching.
pub(crate) fn seconds(text: &str) -> Result<f64, String> {
    let seconds = super::seconds(text)?;
    if seconds > 0.0 && seconds <= PullSearchExperiment::LONGEST_S {
        Ok(seconds)
    } else {
        Err(format!(
            "not a number of seconds greater than 0, up to {}",
            PullSearchExperiment::LONGEST_S
        ))
    }
}

fn name(text: &str) -> Result<String, String> {
    if !prone_files::plain_name::is_plain(text) {
        return Err("a gait's name is made of letters, digits, - and _".to_owned());
    }
    Ok(text.to_owned())
}
