//! `prone crawl frontier`, `prone crawl under` and `prone optimize --source cycle` as wholes.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use serde_json::Value;

fn prone(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_prone"))
        .args(arguments)
        .output()
        .unwrap()
}

/// Begun with the signals of a terminal, whatever these tests were begun with.
fn begun(arguments: &[&str]) -> Child {
    Command::new("env")
        .args(["--default-signal=HUP,INT,TERM", env!("CARGO_BIN_EXE_prone")])
        .args(arguments)
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn succeeded(done: &Output) {
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
}

/// Every file below a folder but the one that may differ.
fn result(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
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
    assert!(found.remove(Path::new("timing.json")).is_some());
    found
}

/// Two ceilings, one seed, a few generations.
const FRONTIER: [&str; 9] = [
    "crawl",
    "frontier",
    "--ceilings-mm",
    "170,200",
    "--runs",
    "1",
    "--seed",
    "4",
    "--out",
];

#[test]
fn a_killed_frontier_resumes_to_the_bytes_of_an_uninterrupted_one() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name).display().to_string();
    let (whole, parts) = (at("whole"), at("parts"));
    let arguments = |out: &str, more: &[&str]| -> Vec<String> {
        let all = FRONTIER.iter().chain([&out]).chain(more);
        all.map(|argument| (*argument).to_owned()).collect()
    };
    let run = |out: &str, more: &[&str]| {
        let arguments = arguments(out, more);
        prone(&arguments.iter().map(String::as_str).collect::<Vec<_>>())
    };
    succeeded(&run(&whole, &["--budget", "32", "--threads", "1"]));

    let checkpoint = home.path().join("parts.checkpoint.json");
    let search = arguments(&parts, &["--budget", "32", "--threads", "2"]);
    let search: Vec<&str> = search.iter().map(String::as_str).collect();
    let mut killed = begun(&search);
    while !checkpoint.exists() {
        assert!(killed.try_wait().unwrap().is_none(), "it ended too soon");
        std::thread::sleep(Duration::from_millis(5));
    }
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(!home.path().join("parts").exists());
    succeeded(&run(
        &parts,
        &["--budget", "32", "--resume", "--threads", "2"],
    ));
    assert!(!checkpoint.exists());
    assert_eq!(
        result(&home.path().join("whole")),
        result(&home.path().join("parts"))
    );

    let read: Value =
        serde_json::from_slice(&fs::read(home.path().join("whole/result.json")).unwrap()).unwrap();
    let found = read["found"].as_array().unwrap();
    assert_eq!(found.len(), 2);
    for found in found {
        let settings = found["confirmed"]["settings"].as_array().unwrap();
        assert!(settings.len() >= 6);
        // What is found reads as a cycle that does what is said of it.
        let gait = home.path().join(format!(
            "whole/gaits/{}.toml",
            found["gait"].as_str().unwrap()
        ));
        let gait = gait.display().to_string();
        let done = prone(&["crawl", "run", "--gait", &gait, "--cycles", "3", "--json"]);
        succeeded(&done);
        let again: Value = serde_json::from_slice(&done.stdout).unwrap();
        let third = again["per_cycle"][2]["advance_mm"].as_f64().unwrap();
        let said = settings[0]["mm_per_cycle"].as_f64().unwrap();
        assert!(
            (third - said).abs() < 1e-6 * said.abs(),
            "{third} and {said}"
        );
    }
}

#[test]
fn what_fits_and_what_does_not_is_said_with_its_reason() {
    let under = |mm: &str, more: &[&str]| -> Value {
        let done = prone(&[&["crawl", "under", "--json", "--ceiling-mm", mm], more].concat());
        succeeded(&done);
        serde_json::from_slice(&done.stdout).unwrap()
    };
    let high = under("230", &[]);
    assert_eq!(high["feasible"], true);
    let best = &high["best"];
    let fastest = high["tried"].as_array().unwrap().iter();
    let fastest = fastest
        .map(|tried| tried["mm_per_s"].as_f64().unwrap())
        .fold(0.0, f64::max);
    assert!((best["mm_per_s"].as_f64().unwrap() - fastest).abs() < 1e-9);
    let low = under("160", &[]);
    assert_eq!(low["feasible"], false);
    assert!(
        low["limited_by"]
            .as_str()
            .unwrap()
            .contains("foot, 160.6 mm"),
        "{low}"
    );
    let named = under("230", &["--gait", "thesis-nominal"]);
    assert_eq!(named["best"]["gait"], "thesis-nominal");
}

#[test]
fn whole_cycles_are_optimised_too() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("heat").display().to_string();
    let done = prone(&[
        "optimize",
        "--objective",
        "heat",
        "--source",
        "cycle",
        "--from",
        "low-175",
        "--seed",
        "2",
        "--budget",
        "32",
        "--name",
        "cooler",
        "--out",
        &out,
    ]);
    succeeded(&done);
    let files = result(&home.path().join("heat"));
    for name in [
        "gait.toml",
        "result.json",
        "frontier.csv",
        "history.csv",
        "run.json",
    ] {
        assert!(files.contains_key(Path::new(name)), "{name}");
    }
    let gait = home.path().join("heat/gait.toml").display().to_string();
    let show = prone(&["gait", "show", &gait, "--json"]);
    succeeded(&show);
    let read: Value = serde_json::from_slice(&files[Path::new("result.json")]).unwrap();
    assert_eq!(read["objective"], "heat");
    // The published cycle stands beside it.
    assert_eq!(read["compared"][0]["gait"], "thesis-nominal");
}
