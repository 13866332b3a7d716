//! Exports of the short crawl, and the programs of others that read them.
//!
//! Those programs are Python packages (`readers/requirements.txt`) of the Python that
//! `PRONE_READERS_PYTHON` names, else `python3`. A test whose package is missing says that it
//! skipped; with `PRONE_REQUIRE_READERS=1` it fails.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;
use tempfile::TempDir;

use crate::program::prone;
use crate::short_crawl::record;

/// The reader's way to say that a package is missing.
const NO_PACKAGE: i32 = 77;

/// Exports, and gives the file.
pub(crate) fn exported(home: &TempDir, format: &str, more: &[&str]) -> PathBuf {
    let file = home.path().join(format!("short.{format}"));
    let (run, out) = (record().to_str().unwrap(), file.to_str().unwrap());
    let arguments = [&["export", run, "--format", format, "--out", out], more].concat();
    let done = prone(&arguments);
    let (stdout, stderr) = (text(&done.stdout), text(&done.stderr));
    assert!(done.status.success(), "{stderr}");
    assert!(stdout.starts_with(out), "{stdout}");
    file
}

/// What another program finds in a file; `None` where that program is not installed.
pub(crate) fn read(kind: &str, file: &Path) -> Option<Value> {
    read_beside(kind, &[file])
}

/// The same of a program that compares files.
pub(crate) fn read_beside(kind: &str, files: &[&Path]) -> Option<Value> {
    let python = std::env::var("PRONE_READERS_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/readers/read.py");
    let done = Command::new(&python)
        .args([script, kind])
        .args(files)
        .output();
    let missing = match done {
        Ok(done) if done.status.code() == Some(NO_PACKAGE) => text(&done.stderr),
        Ok(done) => {
            assert!(done.status.success(), "{}", text(&done.stderr));
            let stdout = text(&done.stdout);
            let found = stdout.lines().find_map(|line| line.strip_prefix("FOUND "));
            return Some(serde_json::from_str(found.unwrap()).unwrap());
        }
        Err(error) => error.to_string(),
    };
    let required = std::env::var("PRONE_REQUIRE_READERS").is_ok_and(|value| value == "1");
    assert!(!required, "{python} does not read {kind}: {missing}");
    eprintln!("skipped: {python} does not read {kind}: {missing}");
    None
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
