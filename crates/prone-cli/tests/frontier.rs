//! `prone crawl frontier`, `prone crawl under` and `prone optimize --source cycle` as wholes.

mod begun;
mod folder;
mod program;

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{BufRead as _, BufReader};
use std::path::{Path, PathBuf};
use std::process::Output;
use std::time::Duration;

use serde_json::Value;

use begun::begun;
use folder::files;
use program::prone;

fn succeeded(done: &Output) {
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
}

/// Every file below a folder but the one that may differ.
fn result(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = files(folder);
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
    // What is kept is not lost without a word.
    let kept = fs::read(&checkpoint).unwrap();
    let mut anew = begun(&search);
    let mut said = BufReader::new(anew.stderr.take().unwrap());
    let mut line = String::new();
    said.read_line(&mut line).unwrap();
    anew.kill().unwrap();
    anew.wait().unwrap();
    assert_eq!(
        line,
        format!(
            "replacing {}, which an earlier search has left: --resume goes on from there\n",
            checkpoint.display()
        )
    );
    fs::write(&checkpoint, kept).unwrap();
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

/// A finished search goes on where it ended, and one whose time was over where that left it: to the bytes
/// of one that had all evaluations from the start.
#[test]
fn a_search_of_cycles_is_lengthened() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name).display().to_string();
    let search = |out: &str, more: &[&str]| {
        let out = at(out);
        let arguments = [
            "optimize",
            "--objective",
            "speed",
            "--source",
            "cycle",
            "--from",
            "hip-10",
            "--seed",
            "3",
            "--runs",
            "2",
            "--out",
            &out,
        ];
        let done = prone(&[&arguments, more].concat());
        succeeded(&done);
        String::from_utf8(done.stdout).unwrap()
    };
    let said = search("whole", &["--budget", "48"]);
    assert!(
        said.contains("\nbest: ") && said.contains(" mm/s"),
        "{said}"
    );
    search("longer", &["--budget", "16"]);
    assert!(!home.path().join("longer.checkpoint.json").exists());
    search("longer", &["--budget", "48", "--resume"]);
    // Time for a generation of each search at the most.
    let said = search("timed", &["--budget", "48", "--time-budget", "0.001"]);
    assert!(said.contains("stopped by the time budget"), "{said}");
    search("timed", &["--budget", "48", "--resume"]);
    let result = |name: &str| result(&home.path().join(name));
    let whole = result("whole");
    assert_eq!(whole, result("longer"));
    assert_eq!(whole, result("timed"));
    // Less is refused, and another search, and the result stays.
    let out = at("whole");
    let search = [
        "optimize",
        "--objective",
        "speed",
        "--source",
        "cycle",
        "--from",
        "hip-10",
        "--seed",
        "3",
        "--runs",
        "2",
        "--resume",
        "--out",
        &out,
    ];
    for (more, said) in [
        (&["--budget", "32"][..], "has a budget of 48 evaluations"),
        (
            &["--budget", "64", "--reach", "0.5"],
            "reach was 1.0, and is 0.5 now",
        ),
        (
            &["--budget", "64", "--ideal"],
            "ideal was false, and is true now",
        ),
    ] {
        let refused = prone(&[&search, more].concat());
        assert_eq!(refused.status.code(), Some(2));
        let message = String::from_utf8(refused.stderr).unwrap();
        assert!(message.contains(said), "{message}");
    }
    assert_eq!(whole, result("whole"));
}

#[test]
fn a_frontier_is_drawn_of_any_two_quantities() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("result").display().to_string();
    let done = prone(&[
        "crawl",
        "frontier",
        "--of",
        "speed,heat",
        "--at",
        "20,30",
        "--runs",
        "1",
        "--seed",
        "1",
        "--budget",
        "1000000",
        "--time-budget",
        "0.001",
        "--out",
        &out,
    ]);
    succeeded(&done);
    let said = String::from_utf8(done.stdout).unwrap();
    for line in [
        "best with at least 20 mm/s: ",
        "best with at least 30 mm/s: ",
        " s/m",
    ] {
        assert!(said.contains(line), "{said}");
    }
    let files = result(&home.path().join("result"));
    let text = |name: &str| String::from_utf8(files[Path::new(name)].clone()).unwrap();
    assert!(text("frontier.csv").starts_with("least_speed_mm_s,seed,standing,setting,"));
    let read: Value = serde_json::from_str(&text("result.json")).unwrap();
    assert_eq!(
        (&read["held"], &read["unit"]),
        (&"speed".into(), &"s/m".into())
    );
    assert_eq!(read["complete"], false);
    for (found, at) in read["found"].as_array().unwrap().iter().zip([20.0, 30.0]) {
        assert_eq!(found["at"], at);
        assert_eq!(found["gait"], format!("speed-{at}-seed-1"));
    }
    let figure = text("figures/frontier.svg");
    for axis in ["least speed, mm/s", "heat per metre, s/m"] {
        assert!(figure.contains(axis), "{axis}");
    }
    // Its report has the same axes.
    let page = home.path().join("report.html").display().to_string();
    succeeded(&prone(&["report", &out, "--out", &page]));
}

#[test]
fn what_fits_and_what_does_not_is_said_with_its_reason() {
    let under = |mm: &str, more: &[&str]| -> Value {
        let done = prone(&[&["crawl", "under", "--json", "--ceiling-mm", mm], more].concat());
        succeeded(&done);
        serde_json::from_slice(&done.stdout).unwrap()
    };
    let home = tempfile::tempdir().unwrap();
    let written = home.path().join("answer.toml");
    let named = under(
        "200",
        &[
            "far-200",
            "robot",
            "--length-m",
            "0.5",
            "--gait-out",
            written.to_str().unwrap(),
        ],
    );
    assert_eq!(named["feasible"], true);
    assert_eq!(named["found_by"], "shipped");
    let candidates = named["candidates"].as_array().unwrap();
    let tried: BTreeSet<&str> = candidates
        .iter()
        .map(|it| it["gait"].as_str().unwrap())
        .collect();
    assert_eq!(tried, BTreeSet::from(["far-200", "robot"]));
    // The answer is the first that gets through all corners, or else the fastest that passes.
    let robust = candidates.iter().find(|it| it["robust"] == true);
    let answer = robust.unwrap_or(&candidates[0]);
    assert_eq!(named["gait"], answer["gait"]);
    assert_eq!(named["time_s"], answer["time_s"]);
    // That one is written, with its own figures, and not the fastest.
    assert_ne!(answer["gait"], candidates[0]["gait"]);
    let written = fs::read_to_string(written).unwrap();
    let name = format!("name = {}\n", answer["gait"]);
    let header = format!(
        "# Passes 200 mm over 0.5 m in all 24 corners, with {:.1} mm to spare, {:.1} mm per cycle",
        answer["margin_mm"].as_f64().unwrap(),
        answer["mm_per_cycle"].as_f64().unwrap()
    );
    assert!(
        written.contains(&name) && written.starts_with(&header),
        "{written}"
    );
    let low = under("115", &["hip-10"]);
    assert_eq!(low["feasible"], false);
    assert_eq!(low["impossible"], true);
    let reason = low["limited_by"].as_str().unwrap();
    assert!(
        reason.contains("the Head, which is 116.0 mm thick"),
        "{low}"
    );
    // A user's file does not ship, also where it has the name of one that does.
    let gait = home.path().join("mine.toml");
    let text = include_str!("../../../robots/nao/gaits/thesis-nominal.toml");
    fs::write(&gait, format!("{text}\n# mine\n")).unwrap();
    let at = gait.to_str().unwrap();
    let mine = under("230", &["--gait", at, "--length-m", "0.3"]);
    assert_eq!(mine["gait"], at);
    assert_eq!(mine["found_by"], "file");
}

/// What the head rules out is not searched for.
#[test]
fn ceilings_below_every_gait_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("result").display().to_string();
    let frontier = [
        "crawl",
        "frontier",
        "--seed",
        "1",
        "--ceilings-mm",
        "200,10",
    ];
    let optimize = [
        "optimize",
        "--objective",
        "heat",
        "--source",
        "cycle",
        "--seed",
        "1",
        "--ceiling-mm",
        "115",
    ];
    for (arguments, said) in [
        (
            &frontier[..],
            "--ceilings-mm 10 is too low for NAO H25 V4: the Head, which is 116.0 mm thick",
        ),
        (
            &optimize,
            "--ceiling-mm 115 is too low for NAO H25 V4: the Head, which is 116.0 mm thick",
        ),
    ] {
        let refused = prone(&[arguments, &["--out", &out]].concat());
        let message = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{message}");
        assert!(message.starts_with(&format!("error: {said}")), "{message}");
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
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
        "hip-10",
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

    // Its report has the generations, and what was found.
    let page = home.path().join("report.html").display().to_string();
    let done = prone(&["report", &out, "--out", &page, "--json"]);
    succeeded(&done);
    let numbers: Value = serde_json::from_slice(&done.stdout).unwrap();
    let figures = numbers["figures"].as_array().unwrap();
    let numbers = figures
        .iter()
        .map(|figure| figure["number"].as_str().unwrap());
    assert_eq!(numbers.collect::<Vec<_>>(), ["24"]);
    let page = fs::read_to_string(page).unwrap();
    for said in ["heat, s/m", " of each generation", "cooler"] {
        assert!(page.contains(said), "{said}");
    }
}

/// A cycle that has to turn to the left is tried in the settings in which it is steered, and so is
/// what is confirmed.
#[test]
fn a_steerable_cycle_is_searched_and_confirmed_by_how_it_turns() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("steerable").display().to_string();
    let done = prone(&[
        "optimize",
        "--objective",
        "advance",
        "--source",
        "cycle",
        "--steerable",
        "--from",
        "hip-10",
        "--seed",
        "1",
        "--budget",
        "16",
        "--out",
        &out,
    ]);
    succeeded(&done);
    let read = |name: &str| -> Value {
        let text = fs::read(home.path().join("steerable").join(name)).unwrap();
        serde_json::from_slice(&text).unwrap()
    };
    assert_eq!(read("run.json")["steerable"], true);
    let result = read("result.json");
    let settings = result["found"][0]["confirmed"]["settings"]
        .as_array()
        .unwrap();
    let yaw = |name: &str| {
        let row = settings.iter().find(|row| row["setting"] == name).unwrap();
        row["yaw_deg"].as_f64().unwrap()
    };
    assert!(yaw("turning") > 3.0, "{}°", yaw("turning"));
    for name in [
        "friction 0.5 and 0.9, joints off",
        "friction 0.9 and 0.5, joints off",
    ] {
        assert!(yaw(name).abs() < yaw("turning"), "{name}: {}°", yaw(name));
    }
}
