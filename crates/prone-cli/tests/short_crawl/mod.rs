//! A short crawl, recorded once for all tests of a file.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use tempfile::TempDir;

use crate::program::prone;

/// Its record: one cycle under a plate.
pub(crate) fn record() -> &'static Path {
    static RECORD: OnceLock<(TempDir, PathBuf)> = OnceLock::new();
    let (_, folder) = RECORD.get_or_init(|| {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("short");
        let at = folder.to_str().unwrap();
        let crawl = [
            "crawl", "run", "--gait", "hip-10", "--cycles", "1", "--record", at,
        ];
        let plate = ["--ceiling-mm", "200", "--length-m", "1"];
        let done = prone(&[&crawl[..], &plate].concat());
        let message = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{message}");
        (home, folder)
    });
    folder
}
