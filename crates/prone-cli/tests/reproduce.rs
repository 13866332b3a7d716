//! Whole runs of `prone reproduce`.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

fn prone(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_prone"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Every file below a folder with its bytes.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let bytes = fs::read(&path).unwrap();
                found.insert(path.strip_prefix(folder).unwrap().to_owned(), bytes);
            }
        }
    }
    found
}

#[test]
fn results_are_the_same_on_any_number_of_threads_and_replace_each_other() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("result");
    let out = folder.to_str().unwrap();
    let mut runs = Vec::new();
    for threads in ["1", "3"] {
        let done = prone(&[
            "reproduce",
            "--durations",
            "0.5,1",
            "--threads",
            threads,
            "--out",
            out,
        ]);
        assert!(
            done.status.success(),
            "{}",
            String::from_utf8_lossy(&done.stderr)
        );
        let mut files = files(&folder);
        assert!(files.remove(Path::new("timing.json")).is_some());
        runs.push(files);
    }
    let names: Vec<_> = runs[0]
        .keys()
        .map(|path| path.display().to_string())
        .collect();
    assert_eq!(
        names,
        runs[1]
            .keys()
            .map(|p| p.display().to_string())
            .collect::<Vec<_>>()
    );
    for name in [
        "torques/nominal-00.5s.csv",
        "torques/optimal-01.0s.csv",
        "costs.csv",
        "agreement.csv",
        "summary.json",
        "run.json",
        "report.html",
        "figures/fig-26-nominal-chain.svg",
        "figures/fig-27-nominal-frames.png",
        "figures/fig-45-left-cost.svg",
    ] {
        assert!(
            names.iter().any(|known| known == name),
            "{name} is missing from {names:?}"
        );
    }
    for (name, bytes) in &runs[0] {
        assert!(bytes == &runs[1][name], "{} differs", name.display());
    }
    assert_eq!(
        fs::read_dir(home.path()).unwrap().count(),
        1,
        "nothing is left beside the result"
    );

    let torques =
        String::from_utf8(runs[0][Path::new("torques/optimal-01.0s.csv")].clone()).unwrap();
    let header = torques.lines().next().unwrap();
    assert!(header.starts_with(
        "time_s,cycle_percent,ankle_nm,knee_nm,hip_nm,shoulder_nm,ankle_cmd_rad,ankle_rad,"
    ));
    assert!(header.ends_with(",toe_n,elbow_n,torso_n,leg_n,top_mm,head_top_mm"));
    assert_eq!(torques.lines().count(), 1 + 20, "one row per control step");

    let report = String::from_utf8(runs[0][Path::new("report.html")].clone()).unwrap();
    for link in [
        "src=\"http",
        "href=\"http",
        "<link",
        "<script",
        "@import",
        "url(h",
    ] {
        assert!(!report.contains(link), "{link} in the report");
    }
}

#[test]
fn what_cannot_be_written_is_refused_before_the_work() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("photo.jpg"), b"cat").unwrap();
    let started = Instant::now();
    let refused = prone(&["reproduce", "--out", home.path().to_str().unwrap()]);
    assert_eq!(refused.status.code(), Some(2));
    let message = String::from_utf8(refused.stderr).unwrap();
    assert!(message.contains("is not an earlier result"), "{message}");
    let below = home.path().join("photo.jpg/result");
    let refused = prone(&["reproduce", "--out", below.to_str().unwrap()]);
    assert_eq!(refused.status.code(), Some(2));
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 1);
    // Far less than the work takes; only a guard against refusing after it.
    assert!(started.elapsed() < Duration::from_secs(20));
}

#[test]
fn ctrl_c_leaves_nothing_behind() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("result");
    let child = Command::new(env!("CARGO_BIN_EXE_prone"))
        .args([
            "reproduce",
            "--threads",
            "1",
            "--out",
            folder.to_str().unwrap(),
        ])
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    let interrupted = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(interrupted.success());
    let ended = child.wait_with_output().unwrap();
    assert_eq!(
        ended.status.code(),
        Some(130),
        "{}",
        String::from_utf8_lossy(&ended.stderr)
    );
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
}
