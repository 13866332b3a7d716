//! Whole searches of `prone optimize`: interrupted, resumed, on any number of threads.

mod begun;
mod folder;
mod program;

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Duration;

use begun::begun;
use folder::files;
use program::prone;

fn succeeded(done: &Output) {
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
}

/// All files of a result but the one that may differ.
fn result(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = files(folder);
    assert!(found.remove(Path::new("timing.json")).is_some());
    found
}

/// Evaluations a run.
const BUDGET: &str = "2000";

/// A search of a few seconds: the statics of each gait, two runs; the budget comes before the folder.
const SEARCH: [&str; 14] = [
    "optimize",
    "--objective",
    "heat",
    "--source",
    "statics",
    "--seed",
    "3",
    "--runs",
    "2",
    "--confirm-durations",
    "0.5",
    "--budget",
    BUDGET,
    "--out",
];

#[test]
fn a_killed_search_resumes_to_the_bytes_of_an_uninterrupted_one() {
    for solver in ["de", "cma-es", "ga"] {
        killed_and_resumed(solver);
    }
}

fn killed_and_resumed(solver: &str) {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name).display().to_string();
    let (whole, parts) = (at("whole"), at("parts"));
    let search = |out: &str, more: &[&str]| -> Vec<String> {
        let arguments = SEARCH.iter().chain([&out, &"--solver", &solver]);
        arguments.chain(more).map(|a| (*a).to_owned()).collect()
    };
    let run = |out: &str, more: &[&str]| {
        let arguments = search(out, more);
        prone(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
    };
    succeeded(&run(&whole, &["--threads", "1"]));

    // A budget that is raised afterwards is as good as one from the start.
    let checkpoint = home.path().join("parts.checkpoint.json");
    let arguments = search(&parts, &["--threads", "2"]);
    let arguments: Vec<_> = arguments
        .iter()
        .map(|argument| if argument == BUDGET { "1500" } else { argument })
        .collect();
    let mut killed = begun(&arguments);
    while !checkpoint.exists() {
        assert!(killed.try_wait().unwrap().is_none(), "it ended too soon");
        std::thread::sleep(Duration::from_millis(5));
    }
    // Two searches do not share a checkpoint.
    let second = prone(&arguments);
    assert_eq!(second.status.code(), Some(2));
    let message = String::from_utf8(second.stderr).unwrap();
    assert!(
        message.contains("another search for this folder"),
        "{message}"
    );
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(!Path::new(&parts).exists(), "half a result");

    // What is kept is not lost without a word.
    let kept = fs::read(&checkpoint).unwrap();
    let mut anew = begun(&arguments);
    let mut line = String::new();
    let mut said = BufReader::new(anew.stderr.take().unwrap());
    said.read_line(&mut line).unwrap();
    anew.kill().unwrap();
    anew.wait().unwrap();
    assert!(line.starts_with("replacing "), "{line}");
    assert!(line.ends_with("--resume goes on from there\n"), "{line}");
    fs::write(&checkpoint, kept).unwrap();

    // A checkpoint belongs to one search.
    let other = run(&parts, &["--resume", "--ends", "free"]);
    assert_eq!(other.status.code(), Some(2));
    let message = String::from_utf8(other.stderr).unwrap();
    assert!(
        message.contains("ends was \"fixed\", and is \"free\" now"),
        "{message}"
    );

    let resumed = run(&parts, &["--resume"]);
    succeeded(&resumed);
    let message = String::from_utf8(resumed.stderr).unwrap();
    assert!(message.starts_with("going on after "), "{message}");
    assert!(!checkpoint.exists());
    let kept: Vec<_> = fs::read_dir(home.path()).unwrap().collect();
    assert_eq!(kept.len(), 2, "{kept:?}");
    let (whole, parts) = (result(Path::new(&whole)), result(Path::new(&parts)));
    assert_eq!(
        whole.keys().collect::<Vec<_>>(),
        parts.keys().collect::<Vec<_>>()
    );
    for (name, bytes) in whole {
        assert!(
            bytes == parts[&name],
            "{solver}: {} differs",
            name.display()
        );
    }
}

#[test]
fn a_stopped_search_says_how_to_go_on() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("result").display().to_string();
    let checkpoint = home.path().join("result.checkpoint.json");
    let mut arguments = SEARCH.to_vec();
    arguments[12] = "1000000";
    arguments.push(&out);
    let child = begun(&arguments);
    while !checkpoint.exists() {
        std::thread::sleep(Duration::from_millis(5));
    }
    let process = child.id().to_string();
    let sent = Command::new("kill").args(["-INT", &process]).status();
    assert!(sent.unwrap().success());
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(130));
    let message = String::from_utf8(ended.stderr).unwrap();
    assert!(message.contains("--resume goes on"), "{message}");
    assert!(!Path::new(&out).exists() && checkpoint.exists());
}

#[test]
fn simulated_searches_are_the_same_on_any_number_of_threads() {
    let home = tempfile::tempdir().unwrap();
    let mut results = Vec::new();
    for threads in ["1", "3"] {
        let out = home.path().join(threads).display().to_string();
        succeeded(&prone(&[
            "optimize",
            "--objective",
            "torque",
            "--source",
            "dynamics",
            "--duration",
            "0.5",
            "--gait-form",
            "bspline:5",
            "--ends",
            "free",
            "--seed",
            "1",
            "--budget",
            "300",
            "--confirm-durations",
            "0.5",
            "--threads",
            threads,
            "--out",
            &out,
        ]));
        results.push(result(Path::new(&out)));
    }
    assert!(results[0] == results[1]);
    let text = String::from_utf8(results[0][Path::new("result.json")].clone()).unwrap();
    for key in [
        "\"cost\"",
        "\"torque\"",
        "\"violations\"",
        "\"evaluations\"",
        "\"seed\"",
    ] {
        assert!(text.contains(key), "{key} is missing");
    }
    // What it found is a gait for every other command.
    let gait = home.path().join("1/gait.toml").display().to_string();
    succeeded(&prone(&["gait", "show", &gait]));
    succeeded(&prone(&[
        "cost",
        &gait,
        "--objective",
        "peak",
        "--source",
        "dynamics",
        "--duration",
        "0.5",
    ]));
}
