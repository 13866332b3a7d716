//! Where results may go: never over what the same command reads, and nowhere that is seen to be wrong.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::{Command, Output};

const PULL: &str = include_str!("../../../robots/nao/gaits/nominal.toml");

fn prone(arguments: &[&str], home: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_prone"))
        .args(arguments)
        .current_dir(home)
        .output()
        .unwrap()
}

/// What a refused command says; it has left everything as it was.
fn refused(arguments: &[&str], home: &Path) -> String {
    let before = names(home);
    let ended = prone(arguments, home);
    let said = String::from_utf8(ended.stderr).unwrap();
    assert_eq!(ended.status.code(), Some(2), "{arguments:?}: {said}");
    assert_eq!(names(home), before, "{arguments:?}");
    said
}

fn names(home: &Path) -> Vec<String> {
    let names = fs::read_dir(home).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

/// A folder that is known as a result of a command, and holds a gait.
fn result(folder: &Path, command: &str, gait: &str) {
    fs::create_dir(folder).unwrap();
    fs::write(folder.join("gait.toml"), gait).unwrap();
    let run = format!(
        r#"{{"program": "prone", "command": "{command}", "artefacts": ["gait.toml", "run.json"]}}"#
    );
    fs::write(folder.join("run.json"), run).unwrap();
}

#[test]
fn no_output_replaces_an_input_of_the_same_command() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/nao/gaits/low-175.toml");
    let cycle = fs::read_to_string(shipped).unwrap();
    fs::write(at("cycle.toml"), &cycle).unwrap();
    fs::hard_link(at("cycle.toml"), at("hard.toml")).unwrap();
    symlink("cycle.toml", at("soft.toml")).unwrap();
    result(&at("found"), "optimize", PULL);
    result(&at("frog"), "optimize", &cycle);
    symlink("found", at("link")).unwrap();
    let torque = [
        "optimize",
        "--objective",
        "torque",
        "--source",
        "statics",
        "--seed",
        "1",
    ];
    let heat = [
        "optimize",
        "--objective",
        "heat",
        "--source",
        "cycle",
        "--seed",
        "1",
    ];
    let under = ["crawl", "under", "--ceiling-mm", "180"];
    let frontier = ["crawl", "frontier", "--seed", "1"];
    let cases: [(&[&str], &[&str]); 8] = [
        (
            &under,
            &["--gait", "cycle.toml", "--gait-out", "cycle.toml"],
        ),
        (&under, &["--gait", "cycle.toml", "--gait-out", "hard.toml"]),
        (
            &under,
            &["--gait", "soft.toml", "--gait-out", "./cycle.toml"],
        ),
        (&torque, &["--from", "found/gait.toml", "--out", "found"]),
        (&torque, &["--from", "found/gait.toml", "--out", "link"]),
        (
            &heat,
            &["--from", "frog/gait.toml", "--out", "frog/../frog"],
        ),
        (&frontier, &["--from", "frog/gait.toml", "--out", "frog"]),
        (&["crawl", "run", "frog/gait.toml"], &["--record", "frog"]),
    ];
    for (command, files) in cases {
        let said = refused(&[command, files].concat(), home.path());
        assert!(said.contains(" would overwrite "), "{files:?}: {said}");
        assert!(said.ends_with(", which was read\n"), "{files:?}: {said}");
    }
    assert_eq!(fs::read_to_string(at("cycle.toml")).unwrap(), cycle);
    assert_eq!(fs::read_to_string(at("found/gait.toml")).unwrap(), PULL);
}

#[test]
fn a_report_replaces_no_result_of_another_command() {
    let home = tempfile::tempdir().unwrap();
    result(&home.path().join("search"), "optimize", PULL);
    result(&home.path().join("other"), "optimize", PULL);
    let said = refused(&["report", "search", "--out", "other"], home.path());
    assert_eq!(
        said,
        "error: --out other is a result of `prone optimize`, which this command does not replace\n"
    );
}

#[test]
fn a_place_that_takes_nothing_is_found_before_the_work_begins() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    fs::write(at("file"), b"").unwrap();
    symlink("nowhere", at("dangling")).unwrap();
    // Long enough that the test would not end.
    let map = ["torque-map", "build", "--source", "simulation", "--out"];
    let search = [
        "optimize",
        "--objective",
        "torque",
        "--source",
        "dynamics",
        "--seed",
        "1",
        "--budget",
        "1000000",
        "--out",
    ];
    let crawl = ["crawl", "run", "low-175", "--cycles", "1000", "--record"];
    let under = ["crawl", "under", "--ceiling-mm", "180", "--gait-out"];
    let show = ["gait", "show", "nominal", "--csv"];
    let commands: [&[&str]; 5] = [&map, &search, &crawl, &under, &show];
    for command in commands {
        for place in ["dangling", "file/below"] {
            let said = refused(&[command, &[place]].concat(), home.path());
            assert!(!said.contains(".prone") && !said.contains(".tmp"), "{said}");
            if place == "dangling" {
                let plain = "a link to something that does not exist\n";
                assert!(said.ends_with(plain), "{command:?}: {said}");
            }
        }
    }
    for command in [&map[..], &under, &show] {
        refused(&[command, &["none/below"]].concat(), home.path());
    }
}
