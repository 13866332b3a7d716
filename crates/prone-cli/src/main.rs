//! The command line of prone: arguments become a plan with an experiment, which one dispatcher runs.
//!
//! Results go to standard output, everything else to standard error. Exit codes: 0 done, else by the
//! rule of [`failure`]; where `view` and `export` write what is readable of a record that was cut off,
//! the code is 2 all the same.

mod args;
mod cells;
mod completions;
mod cost;
mod crawl;
mod cycle_search;
mod dispatch;
mod export;
mod failure;
mod gait;
mod interrupt;
mod list;
mod misnamed;
mod optimize;
mod outputs;
mod passage;
mod plan;
mod printed;
mod progress;
mod pull_terms;
mod record_folder;
mod refusal;
mod report;
mod reproduce;
mod robot;
mod torque_map;
mod view;

use std::ffi::OsStr;
use std::io::Write as _;
use std::process::ExitCode;

use args::{Args, Command, GaitCommand, RobotCommand, TorqueMapCommand};
use failure::Failure;
use prone::foreign_text;
use prone_record::program::Program;

fn main() -> ExitCode {
    // Before anything else, which may be slow.
    let ended = interrupt::listen().and_then(|()| match misnamed::parse(std::env::args_os()) {
        Ok(args) => run(args),
        Err(refused) => tell(&refused),
    });
    match ended {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            interrupt::ended();
            failure.report()
        }
    }
}

/// Prints what clap has to say: help and version are results, as any other; the rest is wrong input.
fn tell(said: &clap::Error) -> Result<(), Failure> {
    if said.use_stderr() && std::env::args_os().any(|it| !is_plain(&it)) {
        // Without clap's colours, whose letters would be shown too.
        failure::say(said.render().to_string().trim_end());
        return Err(Failure::Usage);
    }
    let printed = said.print();
    if said.use_stderr() {
        return Err(Failure::Usage);
    }
    printed?;
    Ok(printed::out().flush()?)
}

/// Whether what was typed is text without letters that are not seen.
fn is_plain(typed: &OsStr) -> bool {
    typed
        .to_str()
        .is_some_and(|it| !it.contains(foreign_text::is_hidden))
}

fn run(args: Args) -> Result<(), Failure> {
    match args.command {
        Command::Reproduce(args) => dispatch::carry_out(&reproduce::plan(&args)?),
        Command::Crawl(command) => dispatch::carry_out(&crawl::plan(&command)?),
        Command::Export(args) => export::run(&args),
        Command::Optimize(args) => dispatch::carry_out(&optimize::plan(&args)?),
        Command::Cost(args) => dispatch::carry_out(&cost::plan(&args)?),
        Command::Gait(GaitCommand::Show(args)) => gait::show(&args),
        Command::Robot(RobotCommand::Check(args)) => robot::check(&args),
        Command::Robot(RobotCommand::Compile(args)) => robot::compile::run(&args),
        Command::List(args) => list::run(&args),
        Command::Report(args) => report::run(&args),
        Command::TorqueMap(TorqueMapCommand::Build(args)) => {
            dispatch::carry_out(&torque_map::build::plan(&args)?)
        }
        Command::TorqueMap(TorqueMapCommand::Compare(args)) => torque_map::compare::run(&args),
        Command::TorqueMap(TorqueMapCommand::Plot(args)) => torque_map::plot::run(&args),
        Command::View(args) => view::run(&args),
        Command::Completions { shell } => completions::print(shell),
    }
}

/// What records say of this program.
pub(crate) fn program() -> Program {
    Program {
        version: env!("CARGO_PKG_VERSION").into(),
        commit: env!("PRONE_COMMIT").into(),
    }
}
