//! Whole runs of `prone reproduce`.

mod folder;
mod program;

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use prone_files::shipped::NAO;

use folder::files;
use program::prone;

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
            "0.5, 1",
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
        "torques-v4/optimal-01.0s.csv",
        "costs.csv",
        "costs-v4.csv",
        "squeeze.csv",
        "agreement.csv",
        "summary.json",
        "run.json",
        "report.html",
        "figures/fig-26-nominal-chain.svg",
        "figures/fig-27-nominal-frames.png",
        "figures/fig-28-thesis-nominal-sequence.png",
        "figures/fig-31-thesis-nominal-angles.svg",
        "figures/fig-45-left-cost.svg",
        "pulls/nominal-1s/contacts.csv",
        "pulls/optimal-1s/rows.csv",
        "crawls/table-9-cycles/summary.json",
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
    assert!(header.ends_with(",toe_n,elbow_n,torso_n,leg_n,top_mm,head_top_mm,squeeze_n"));
    assert_eq!(torques.lines().count(), 1 + 20, "one row per control step");
    let beside = runs[0][Path::new("torques-v4/optimal-01.0s.csv")].clone();
    let beside = String::from_utf8(beside).unwrap();
    assert_eq!(beside.lines().next(), Some(header));
    assert_ne!(beside, torques, "another robot's");

    let summary: serde_json::Value =
        serde_json::from_slice(&runs[0][Path::new("summary.json")]).unwrap();
    assert_eq!(summary["study_of"]["version"], "scene");
    assert_eq!(summary["crawl_of"]["version"], "v4");
    assert_eq!(summary["beside"]["robot"]["version"], "v4");

    let report = String::from_utf8(runs[0][Path::new("report.html")].clone()).unwrap();
    for link in ["src=\"http", "href=\"http", "<script", "@import", "url(h"] {
        assert!(!report.contains(link), "{link} in the report");
    }
}

/// The recorded version itself has nothing beside it; a version of one's own family names itself.
#[test]
fn a_version_that_was_recorded_is_studied_alone() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("result");
    let out = folder.to_str().unwrap();
    let run = |robot: &str| {
        let done = prone(&[
            "reproduce",
            "--durations",
            "0.5",
            "--robot",
            robot,
            "--out",
            out,
        ]);
        let message = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{message}");
        let names: Vec<_> = files(&folder).into_keys().collect();
        let beside = |name: &&std::path::PathBuf| {
            let name = name.to_str().unwrap();
            name.starts_with("torques-") || name.starts_with("costs-")
        };
        names.iter().filter(beside).cloned().collect::<Vec<_>>()
    };
    assert_eq!(run("nao/scene"), Vec::<std::path::PathBuf>::new());
    let v5 = [
        "costs-v5.csv",
        "torques-v5/nominal-00.5s.csv",
        "torques-v5/optimal-00.5s.csv",
    ];
    assert_eq!(run("nao/v5"), v5.map(std::path::PathBuf::from));
}

#[test]
fn a_recorded_version_that_is_not_there_is_refused_by_its_line() {
    let home = tempfile::tempdir().unwrap();
    let version = home.path().join("nao/v4");
    fs::create_dir_all(&version).unwrap();
    fs::write(version.join("robot.xml"), NAO.mjcf).unwrap();
    fs::write(version.join("robot.toml"), NAO.toml).unwrap();
    let family = "name = \"nao\"\ndefault = \"v4\"\nrecorded = \"attic\"\n";
    fs::write(home.path().join("nao/family.toml"), family).unwrap();
    let out = home.path().join("result");
    let robot = home.path().join("nao");
    let (robot, to) = (robot.to_str().unwrap(), out.to_str().unwrap());
    let reproduce = ["reproduce", "--robot", robot, "--out", to];
    for command in [&reproduce[..], &["robot", "check", robot]] {
        let refused = prone(command);
        let message = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{message}");
        assert!(
            message.contains("nao/family.toml:3:12: there is no "),
            "{message}"
        );
        assert!(message.contains("nao/attic/robot.toml"), "{message}");
    }
    assert!(!out.exists());
}

#[test]
fn what_cannot_be_written_is_refused_before_the_work() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name).display().to_string();
    fs::write(at("photo.jpg"), b"cat").unwrap();
    symlink("nowhere", at("link")).unwrap();
    for (out, expected) in [
        (
            at(""),
            "is not an earlier result, so it is not replaced: it holds no run.json",
        ),
        (at("photo.jpg"), "is not a folder"),
        (at("photo.jpg/result"), "Not a directory"),
        (at("link"), "is a link to something that does not exist"),
        ("/dev/shm".to_owned(), "is a file system of its own"),
    ] {
        let refused = prone(&["reproduce", "--out", &out]);
        let message = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{message}");
        // A shared memory that is in use, or is missing, is refused for that.
        assert!(message.contains(expected) || out == "/dev/shm", "{message}");
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 2);
}

#[test]
fn a_robot_that_cannot_follow_is_refused_before_anything_is_made() {
    let home = tempfile::tempdir().unwrap();
    let robot = home.path().join("robot");
    fs::create_dir(&robot).unwrap();
    fs::write(robot.join("robot.xml"), NAO.mjcf).unwrap();
    let long = NAO
        .toml
        .replacen("family = \"nao\"\n", "", 1)
        .replace("links_mm = [103.85, 102.9,", "links_mm = [103.85, 302.9,");
    assert!(long.contains("302.9"));
    fs::write(robot.join("robot.toml"), long).unwrap();
    let out = home.path().join("new/result");
    let refused = prone(&[
        "reproduce",
        "--robot",
        robot.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ]);
    let message = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(message.contains("the chain cannot close"), "{message}");
    assert!(!home.path().join("new").exists());
}

#[test]
fn two_runs_at_once_leave_one_whole_result_and_nothing_of_killed_ones() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("new/result");
    fs::create_dir_all(home.path().join("new/.result.partial-killed/result")).unwrap();
    let run = |durations: &str| {
        Command::new(env!("CARGO_BIN_EXE_prone"))
            .args(["reproduce", "--threads", "1", "--durations", durations])
            .args([Path::new("--out"), &folder])
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap()
    };
    for child in [run("0.5"), run("0.7")] {
        let ended = child.wait_with_output().unwrap();
        let message = String::from_utf8_lossy(&ended.stderr);
        assert!(ended.status.success(), "{message}");
    }
    assert_eq!(fs::read_dir(folder.parent().unwrap()).unwrap().count(), 1);
    let run: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.join("run.json")).unwrap()).unwrap();
    let listed: Vec<_> = run["artefacts"].as_array().unwrap().iter().collect();
    let found = files(&folder);
    let found: Vec<_> = found.keys().map(|path| path.to_str().unwrap()).collect();
    assert_eq!(listed.len(), found.len());
    assert!(
        listed
            .iter()
            .all(|name| found.contains(&name.as_str().unwrap()))
    );
    let tables = found.iter().filter(|name| name.starts_with("torques/"));
    assert_eq!(tables.count(), 2, "of one of the two runs");
}

/// Whether a process has taken a signal into its own hands, by the mask of its `/proc` entry.
fn handles(process: u32, signal: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    let mask = u64::from_str_radix(caught.unwrap().trim(), 16).unwrap();
    mask & (1 << (signal - 1)) != 0
}

#[test]
fn signals_leave_nothing_behind() {
    for (name, number) in [("INT", 2), ("TERM", 15), ("HUP", 1)] {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().join("new/result");
        // Whoever runs the tests may ignore signals; `env` resets that, then becomes the program.
        let child = Command::new("env")
            .args(["--default-signal=INT,TERM,HUP", env!("CARGO_BIN_EXE_prone")])
            .args(["reproduce", "--threads", "1"])
            .args([Path::new("--out"), &folder])
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        while !handles(child.id(), number) {
            std::thread::sleep(Duration::from_millis(20));
        }
        let interrupted = Command::new("kill")
            .args(["-s", name, &child.id().to_string()])
            .status()
            .unwrap();
        assert!(interrupted.success());
        let ended = child.wait_with_output().unwrap();
        let message = String::from_utf8_lossy(&ended.stderr);
        assert_eq!(ended.status.code(), Some(130), "{name}: {message}");
        assert!(
            message.starts_with("stopping after this ")
                && message.ends_with("stopped; nothing was written\n"),
            "{message}"
        );
        assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0, "{name}");
    }
}
