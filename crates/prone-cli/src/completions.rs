//! `prone completions`: a script for a shell, with the names of what ships.

use std::io::Write as _;

use clap::builder::PossibleValuesParser;
use clap::{Command, CommandFactory};
use clap_complete::Shell;

use prone_files::shipped;

use crate::Failure;
use crate::args::Args;

/// Writes the script for a shell to standard output.
pub(crate) fn print(shell: Shell) -> Result<(), Failure> {
    // Into memory first: the generator panics where it cannot write.
    let mut script = Vec::new();
    let mut command = Args::command();
    // Of the shells only bash goes on to files where no name fits, and all that has a name may be a
    // file too.
    if shell == Shell::Bash {
        command = naming(command, Gaits::OfEitherKind);
    }
    clap_complete::generate(shell, &mut command, "prone", &mut script);
    #[expect(
        clippy::disallowed_methods,
        reason = "a script has tabs, and no foreign text"
    )]
    let mut out = std::io::stdout().lock();
    out.write_all(&script)?;
    out.flush()?;
    Ok(())
}

/// Which gaits a command takes.
#[derive(Clone, Copy)]
enum Gaits {
    OfEitherKind,
    Pulls,
    Cycles,
}

impl Gaits {
    fn names(self) -> Vec<String> {
        let (pulls, cycles) = (shipped::gait_names(), shipped::cycle_names());
        let names: Vec<&str> = match self {
            Self::OfEitherKind => pulls.chain(cycles).collect(),
            Self::Pulls => pulls.collect(),
            Self::Cycles => cycles.collect(),
        };
        names.into_iter().map(str::to_owned).collect()
    }
}

/// A command, and those within it, with the names that its arguments may be given. This is for a
/// script alone: as a parser it would refuse files.
fn naming(command: Command, around: Gaits) -> Command {
    let gaits = match command.get_name() {
        "crawl" => Gaits::Cycles,
        "cost" => Gaits::Pulls,
        _ => around,
    };
    let command = command.mut_args(|arg| {
        let value = arg.get_value_names().and_then(|names| names.first());
        let names = match value.map(clap::builder::Str::as_str) {
            Some("GAIT") => gaits.names(),
            Some("SCENE") => shipped::scene_names().map(str::to_owned).collect(),
            Some("ROBOT") => shipped::robot_names().collect(),
            _ => return arg,
        };
        arg.value_parser(PossibleValuesParser::new(names))
    });
    command.mut_subcommands(|within| naming(within, gaits))
}
