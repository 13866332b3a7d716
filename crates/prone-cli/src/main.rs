//! The command line of prone: arguments become a plan with an experiment, which one dispatcher runs.
//!
//! Results go to standard output, everything else to standard error. Exit codes: 0 done, 1 the
//! work failed, 2 wrong input (nothing is written, but by `export` what is readable of a record that
//! was cut off), 130 stopped by the user.

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
mod passage;
mod plan;
mod progress;
mod pull_terms;
mod record_folder;
mod refusal;
mod report;
mod reproduce;
mod robot;
mod torque_map;
mod view;

use std::process::ExitCode;

use args::{Args, Command, GaitCommand, RobotCommand, TorqueMapCommand};
use failure::Failure;
use prone_record::program::Program;

fn main() -> ExitCode {
    let args = match misnamed::parse(std::env::args_os()) {
        Ok(args) => args,
        Err(error) => error.exit(),
    };
    match run(args) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
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
