//! The program under test.

use std::process::{Command, Output};

/// Runs it to its end.
pub(crate) fn prone(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_prone"))
        .args(arguments)
        .output()
        .unwrap()
}
