//! Families of robots: versions, gaits of their own, and which of them are used by default.

mod program;

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use program::prone;
use prone_files::shipped::{self, NAO};

/// A family of two versions with three gaits, of which two have names of gaits that ship.
fn family() -> TempDir {
    let home = tempfile::tempdir().unwrap();
    let write = |path: &str, text: &str| {
        let path = home.path().join(path);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    };
    write(
        "toddler/family.toml",
        "name = \"toddler\"\ndefault = \"small\"\n\
         [defaults.pull]\nfrom = \"nominal\"\ncompared = [\"least-peak\"]\n\
         [defaults.cycle]\nfrom = [\"ours\"]\nunder = [\"ours\", \"low-165\"]\n",
    );
    let gait = |name: &str, of: &str| {
        let text = shipped::gait_file(of).unwrap().text;
        let text = text.replacen(&format!("\"{of}\""), &format!("\"{name}\""), 1);
        write(&format!("toddler/gaits/{name}.toml"), &text);
    };
    gait("ours", "hip-10");
    gait("low-165", "hip-10");
    gait("nominal", "least-torque");
    for (version, name) in [("small", "Toddler S"), ("large", "Toddler L")] {
        let toml = NAO
            .toml
            .replacen("family = \"nao\"", "family = \"toddler\"", 1)
            .replacen(
                "\nname = \"NAO H25 V4\"",
                &format!("\nname = \"{name}\""),
                1,
            );
        write(&format!("toddler/{version}/robot.toml"), &toml);
        write(&format!("toddler/{version}/robot.xml"), NAO.mjcf);
    }
    home
}

fn at(home: &TempDir, path: &str) -> String {
    home.path().join(path).to_str().unwrap().to_owned()
}

fn json(arguments: &[&str]) -> Value {
    let done = prone(arguments);
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
    serde_json::from_slice(&done.stdout).unwrap()
}

fn refused(arguments: &[&str]) -> String {
    let done = prone(arguments);
    assert_eq!(done.status.code(), Some(2));
    String::from_utf8(done.stderr).unwrap()
}

fn run_json(folder: &str) -> Value {
    serde_json::from_slice(&fs::read(Path::new(folder).join("run.json")).unwrap()).unwrap()
}

#[test]
fn a_family_is_its_default_version_and_what_ships_has_a_name() {
    let home = family();
    let checked = |name: &str| json(&["robot", "check", name, "--json"])["robot"].clone();
    assert_eq!(checked(&at(&home, "toddler")), "Toddler S");
    assert_eq!(checked(&at(&home, "toddler/large")), "Toddler L");
    assert_eq!(checked("nao"), "NAO H25 V4");
    assert_eq!(checked("nao/v4"), "NAO H25 V4");
}

#[test]
fn a_robot_s_own_gaits_go_before_those_that_ship() {
    let home = family();
    let robot = at(&home, "toddler/large");
    let knees = |arguments: &[&str]| {
        let shown = json(&[&["gait", "show"], arguments, &["--json"]].concat());
        shown["rows"][50]["chain_rad"][2].clone()
    };
    let own = knees(&["nominal", "--robot", &robot]);
    assert_eq!(own, knees(&["least-torque"]));
    assert_ne!(own, knees(&["nominal"]));

    let list = format!("`prone list --robot {}` shows all", at(&home, "toddler"));
    for command in [["gait", "show"], ["crawl", "run"]] {
        let named = |name: &str| refused(&[&command[..], &[name, "--robot", &robot]].concat());
        assert!(named("gallop").contains(&list), "{}", named("gallop"));
        // A cycle of its own is offered as those that ship are.
        let unknown = named("uors");
        assert!(unknown.contains("did you mean \"ours\"?"), "{unknown}");
    }
    // Names that are nearly there are those of the robot's own, too.
    let own = "did you mean \"ours\"";
    let unknown = |command: &[&str], robot: &str| refused(&[command, &["--robot", robot]].concat());
    for command in [&["gait", "show", "our"][..], &["crawl", "run", "our"]] {
        assert!(unknown(command, &robot).contains(own));
        assert!(!unknown(command, "nao").contains("ours"));
    }
    // And what there is, is listed: they are marked, and go before those that ship.
    let listed = json(&["list", "--quick", "--robot", &robot, "--json"]);
    let own = |kind: &str| -> Vec<&str> {
        let all = listed.as_array().unwrap().iter();
        let own = all.filter(|it| it["kind"] == kind && it["origin"] != "shipped");
        own.map(|it| it["name"].as_str().unwrap()).collect()
    };
    assert_eq!(own("gait"), ["nominal"]);
    assert_eq!(own("cycle"), ["low-165", "ours"]);
}

#[test]
fn what_is_tried_under_a_ceiling_is_said_by_the_family() {
    let home = family();
    let robot = at(&home, "toddler");
    let passage = json(&[
        "crawl",
        "under",
        "--ceiling-mm",
        "200",
        "--length-m",
        "0.3",
        "--robot",
        &robot,
        "--json",
    ]);
    let mut tried: Vec<&str> = passage["candidates"]
        .as_array()
        .unwrap()
        .iter()
        .map(|tried| tried["gait"].as_str().unwrap())
        .collect();
    tried.sort_unstable();
    assert_eq!(tried, ["low-165", "ours"]);
    assert_eq!(passage["found_by"], "file");
}

#[test]
fn a_record_names_the_version() {
    let home = family();
    let crawl = |robot: &str, out: &str| {
        let arguments = ["crawl", "run", "--gait", "low-175", "--cycles", "1"];
        let done = prone(&[&arguments[..], &["--robot", robot, "--record", out]].concat());
        assert!(done.status.success());
        run_json(out)
    };
    let run = crawl(&at(&home, "toddler/large"), &at(&home, "large"));
    assert_eq!(run["robot"]["name"], "Toddler L");
    assert_eq!(run["robot"]["family"], "toddler");
    assert_eq!(run["robot"]["version"], "large");
    assert_eq!(run["gait"]["file"], "robots/nao/gaits/low-175.toml");

    // A robot without a family has neither.
    let alone = at(&home, "alone");
    fs::create_dir(&alone).unwrap();
    let toml = NAO.toml.replacen("family = \"nao\"\n", "", 1);
    fs::write(Path::new(&alone).join("robot.toml"), toml).unwrap();
    fs::write(Path::new(&alone).join("robot.xml"), NAO.mjcf).unwrap();
    let run = crawl(&alone, &at(&home, "one"));
    assert_eq!(run["robot"]["family"], Value::Null);
    assert_eq!(run["robot"]["version"], Value::Null);
}

#[test]
fn a_search_starts_from_and_compares_what_the_family_says() {
    let home = family();
    let robot = at(&home, "toddler");
    let out = at(&home, "found");
    let search = [
        "optimize",
        "--objective",
        "heat",
        "--source",
        "statics",
        "--seed",
        "3",
        "--budget",
        "100",
        "--confirm-durations",
        "0.5",
        "--robot",
        &robot,
        "--out",
        &out,
    ];
    let done = prone(&search);
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let run = run_json(&out);
    assert_eq!(run["pricing"]["from"], "nominal");
    assert_eq!(run["pricing"]["robot"]["version"], "small");
    let table = fs::read_to_string(Path::new(&out).join("confirmation.csv")).unwrap();
    for (gait, is_there) in [("nominal", true), ("least-peak", true), ("optimal", false)] {
        assert_eq!(table.contains(gait), is_there, "{gait}:\n{table}");
    }
    let named = refused(&[&search[..], &["--name", "least-peak"]].concat());
    assert!(
        named.contains("like one that it is compared with"),
        "{named}"
    );
}
