//! The program, begun and not waited for.

use std::process::{Child, Command, Stdio};

/// Begun with the signals of a terminal, whatever these tests were begun with: under `nohup` they
/// are ignored, and stay so.
pub(crate) fn begun(arguments: &[&str]) -> Child {
    Command::new("env")
        .args(["--default-signal=HUP,INT,TERM", env!("CARGO_BIN_EXE_prone")])
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}
