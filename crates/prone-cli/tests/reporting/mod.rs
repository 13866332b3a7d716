//! Results of several commands, of which reports are made.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use tempfile::TempDir;

use crate::program::prone;
use crate::short_crawl;

/// Results of several commands, made once.
pub(crate) struct Results {
    _home: TempDir,
    pub(crate) reproduction: String,
    pub(crate) crawl: String,
    pub(crate) search: String,
}

pub(crate) fn results() -> &'static Results {
    static RESULTS: OnceLock<Results> = OnceLock::new();
    RESULTS.get_or_init(|| {
        let home = tempfile::tempdir().unwrap();
        let at = |name: &str| home.path().join(name).display().to_string();
        let (reproduction, search) = (at("reproduction"), at("search"));
        succeeded(&["reproduce", "--durations", "0.5,1", "--out", &reproduction]);
        let searched = ["optimize", "--objective", "torque", "--source", "statics"];
        let small = ["--seed", "1", "--budget", "300", "--confirm-durations", "1"];
        succeeded(&[&searched[..], &small, &["--out", &search]].concat());
        Results {
            reproduction,
            crawl: short_crawl::record().display().to_string(),
            search,
            _home: home,
        }
    })
}

pub(crate) fn succeeded(arguments: &[&str]) -> String {
    let done = prone(arguments);
    let message = String::from_utf8(done.stderr).unwrap();
    assert!(done.status.success(), "{arguments:?}: {message}");
    String::from_utf8(done.stdout).unwrap()
}

pub(crate) fn text(file: impl AsRef<Path>) -> String {
    fs::read_to_string(file).unwrap()
}
