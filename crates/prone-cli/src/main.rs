//! The command line of prone: arguments become a plan, a plan becomes calls.
//!
//! Results go to standard output, everything else to standard error. Exit codes: 0 done, 1 the
//! work failed, 2 wrong input (nothing is written, but by `export` what is readable of a record that
//! was cut off), 130 stopped by the user.

mod args;
mod checkpoint;
mod cost;
mod crawl;
mod cycle_search;
mod export;
mod failure;
mod gait;
mod interrupt;
mod optimize;
mod passage;
mod pricing;
mod progress;
mod record_folder;
mod report;
mod reproduce;
mod robot;
mod search;
mod torque_map;
mod view;

use std::io::Write as _;
use std::process::ExitCode;

use clap::{CommandFactory, Parser};

use args::{Args, Command, GaitCommand, RobotCommand};
use failure::Failure;
use prone_record::program::Program;

fn main() -> ExitCode {
    let args = Args::parse();
    let done = match args.command {
        Command::Reproduce(args) => reproduce::run(&args),
        Command::Crawl(command) => crawl::run(&command),
        Command::Export(args) => export::run(&args),
        Command::Optimize(args) => optimize::run(&args),
        Command::Cost(args) => cost::run(&args),
        Command::Gait(GaitCommand::Show(args)) => gait::show(&args),
        Command::Robot(RobotCommand::Check(args)) => robot::check(&args),
        Command::Robot(RobotCommand::Compile(args)) => robot::compile::run(&args),
        Command::Report(args) => report::run(&args),
        Command::TorqueMap(command) => torque_map::run(&command),
        Command::View(args) => view::run(&args),
        Command::Completions { shell } => completions(shell),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// What records say of this program.
pub(crate) fn program() -> Program {
    Program {
        version: env!("CARGO_PKG_VERSION").into(),
        commit: env!("PRONE_COMMIT").into(),
    }
}

fn completions(shell: clap_complete::Shell) -> Result<(), Failure> {
    // Into memory first: the generator panics where it cannot write.
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Args::command(), "prone", &mut script);
    let mut out = std::io::stdout().lock();
    out.write_all(&script)?;
    out.flush()?;
    Ok(())
}
