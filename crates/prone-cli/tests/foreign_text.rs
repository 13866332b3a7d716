//! Texts of others, in every file that is read: nothing that is printed or written commands a terminal,
//! turns text round or hides, and no message is long.

mod program;
mod short_crawl;

use std::fs;
use std::path::Path;
use std::process::Output;

use program::prone;
use prone::foreign_text::is_hidden;

const NAO_TOML: &str = include_str!("../../../robots/nao/v4/robot.toml");
const NAO_XML: &str = include_str!("../../../robots/nao/v4/robot.xml");
const PULL: &str = include_str!("../../../robots/nao/gaits/nominal.toml");
const CYCLE: &str = include_str!("../../../robots/nao/gaits/hip-10.toml");

/// Clears a screen, turns text round, hides, ends lines.
const HOSTILE: &str = "a\u{1b}[2J\u{9b}31m\u{202e}b\u{200b}\u{2028}\u{7f}\u{e0041}\u{feff}";

/// Longest message beside the paths that are named in it.
const LONGEST: usize = 1000;

/// A text as TOML and JSON have it, with every letter by its number.
fn escaped(text: &str) -> String {
    let units = text.encode_utf16().map(|unit| format!("\\u{unit:04x}"));
    units.collect()
}

fn in_toml(text: &str) -> String {
    let letters = text.chars().map(|it| format!("\\U{:08x}", u32::from(it)));
    letters.collect()
}

fn check_text(what: &str, text: &str) {
    let raw = |it: char| !matches!(it, '\n' | '\t' | '\r') && is_hidden(it);
    if let Some(at) = text.find(raw) {
        let begin = text[..at]
            .char_indices()
            .rev()
            .nth(60)
            .map_or(0, |(at, _)| at);
        panic!("{what} has a hidden letter behind {:?}", &text[begin..at]);
    }
}

fn check(what: &str, ended: &Output, place: &Path) {
    check_text(what, str::from_utf8(&ended.stdout).unwrap());
    let said = str::from_utf8(&ended.stderr).unwrap();
    check_text(what, said);
    let paths = said.matches(place.to_str().unwrap()).count() * place.as_os_str().len();
    assert!(said.len() < LONGEST + paths, "{what}: {} bytes", said.len());
    assert!(
        [Some(0), Some(1), Some(2)].contains(&ended.status.code()),
        "{what}: {said}"
    );
}

/// Every text file of a folder.
fn check_files(folder: &Path) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            check_files(&path);
        } else if let Ok(text) = fs::read_to_string(&path) {
            check_text(&path.display().to_string(), &text);
        }
    }
}

/// Runs commands on a file.
fn run(home: &Path, commands: &[&[&str]]) {
    for command in commands {
        let ended = prone(command);
        check(&command.join(" "), &ended, home);
    }
}

/// A line of TOML with another value, and with another key.
fn with_line(text: &str, key: &str, line: &str) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let place = lines.iter().position(|it| it.starts_with(key)).unwrap();
    lines[place] = line;
    lines.join("\n") + "\n"
}

#[test]
fn gaits_scenes_robots_and_maps_command_no_terminal() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name).to_str().unwrap().to_owned();
    let (file, out, scene) = (at("in.toml"), at("out"), at("scene.toml"));
    let long = "n".repeat(5_000_000);
    for foreign in [HOSTILE, long.as_str()] {
        let toml = in_toml(foreign);
        let pulls = [
            with_line(PULL, "name", &format!("name = \"{toml}\"")),
            with_line(PULL, "name", &format!("name = \"x\"\n\"{toml}\" = 1")),
            with_line(PULL, "name", &format!("name = \"x\"\nlimits = \"{toml}\"")),
            with_line(PULL, "name", &format!("name = {foreign}")),
            format!("{foreign}\n{PULL}"),
        ];
        for text in pulls {
            fs::write(&file, text).unwrap();
            run(
                home.path(),
                &[&["gait", "show", &file], &["crawl", "run", "--gait", &file]],
            );
        }
        let cycles = [
            with_line(CYCLE, "name", &format!("name = \"{toml}\"")),
            with_line(CYCLE, "[pull]", &format!("[pull]\n\"{toml}\" = 1")),
            CYCLE.replacen("LHipPitch =", &format!("\"{toml}\" ="), 1),
        ];
        for text in cycles {
            fs::write(&file, text).unwrap();
            run(
                home.path(),
                &[&["gait", "show", &file], &["crawl", "run", "--gait", &file]],
            );
        }
        fs::write(&scene, format!("name = \"{toml}\"\n")).unwrap();
        run(home.path(), &[&["crawl", "run", "--scene", &scene]]);
        // Maps: a comment, a header, a cell, a quote.
        let map = at("map.csv");
        let row = "1,2,3,4,5,6,7,8,9,10,11,12,13,14\n";
        for text in [
            format!("# {foreign}\n{row}{row}"),
            row.replace("14", foreign),
            row.replacen('1', foreign, 1),
            format!("\"{foreign}\n{row}"),
        ] {
            fs::write(&map, text).unwrap();
            let plot = ["torque-map", "plot", &map, "--out", &out];
            run(
                home.path(),
                &[&["torque-map", "compare", &map, &map], &plot],
            );
        }
    }
    let described = with_line(
        PULL,
        "description",
        &format!("description = \"{}\"", in_toml(HOSTILE)),
    );
    fs::write(&file, described).unwrap();
    let show = ["gait", "show", &file];
    run(home.path(), &[&show, &[&show[..], &["--json"]].concat()]);
    let json = prone(&[&show[..], &["--json"]].concat());
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    assert_eq!(json["description"], HOSTILE, "data stay what they are");
}

#[test]
fn robots_of_others_command_no_terminal() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("robot");
    fs::create_dir(&folder).unwrap();
    let at = folder.to_str().unwrap();
    let alone = NAO_TOML.replacen("family = \"nao\"\n", "", 1);
    let long = "n".repeat(5_000_000);
    for foreign in [HOSTILE, long.as_str()] {
        let toml = in_toml(foreign);
        for (toml, xml) in [
            (
                with_line(&alone, "name", &format!("name = \"{toml}\"")),
                NAO_XML.to_owned(),
            ),
            (
                with_line(&alone, "name", &format!("name = \"x\"\n\"{toml}\" = 1")),
                NAO_XML.to_owned(),
            ),
            (alone.replace("LKneePitch", &toml), NAO_XML.to_owned()),
            (
                with_line(&alone, "model", &format!("model = \"{toml}\"")),
                NAO_XML.to_owned(),
            ),
            (format!("family = \"{toml}\"\n{alone}"), NAO_XML.to_owned()),
            (alone.clone(), NAO_XML.replacen("LFoot", foreign, 2)),
        ] {
            fs::write(folder.join("robot.toml"), toml).unwrap();
            fs::write(folder.join("robot.xml"), xml).unwrap();
            run(
                home.path(),
                &[
                    &["robot", "check", at],
                    &["robot", "check", at, "--json"],
                    &["robot", "compile", at],
                ],
            );
        }
    }
    check_files_but_sources(&folder);
}

/// What was compiled of it.
fn check_files_but_sources(folder: &Path) {
    if let Ok(text) = fs::read_to_string(folder.join("robot.compiled.json")) {
        check_text("robot.compiled.json", &text);
    }
}

/// A copy of a record in which every text of `run.json` and `model.json` is foreign, one after another.
#[test]
fn records_of_others_command_no_terminal() {
    let home = tempfile::tempdir().unwrap();
    let copy = home.path().join("copy");
    let out = home.path().join("out");
    let at = copy.to_str().unwrap();
    copy_folder(short_crawl::record(), &copy);
    let run_json = fs::read_to_string(copy.join("run.json")).unwrap();
    let value: serde_json::Value = serde_json::from_str(&run_json).unwrap();
    let gait = value["gait"]["name"].as_str().unwrap();
    let title = format!("\"name\": \"{gait}\"");
    assert!(run_json.contains(&title));
    // Whoever reads the record takes such a name, or refuses it.
    let named = run_json.replace(&title, &format!("\"name\": \"{}\"", escaped(HOSTILE)));
    let described = "\"description\": \"";
    for (is_record, text) in [
        (
            true,
            named.replace(described, &format!("{described}{}", escaped(HOSTILE))),
        ),
        (
            false,
            run_json.replacen(
                "\"command\": \"",
                &format!("\"command\": \"{}", escaped(HOSTILE)),
                1,
            ),
        ),
        (
            false,
            run_json.replacen(
                "\"version\": \"",
                &format!("\"version\": \"{}", "9".repeat(5_000_000)),
                1,
            ),
        ),
        (false, run_json.replacen('{', &format!("{{{HOSTILE}"), 1)),
    ] {
        fs::write(copy.join("run.json"), text).unwrap();
        let page = out.with_extension("html");
        let (file, folder) = (page.to_str().unwrap(), out.to_str().unwrap());
        let commands: [&[&str]; 5] = [
            &["view", at, "--out", file],
            &["export", at, "--format", "csv", "--out", file],
            &["export", at, "--format", "urdf", "--out", file],
            &["report", at, "--json", "--out", folder],
            &["report", at, "--out", file],
        ];
        // What is refused is refused by all alike, and drawing takes its time.
        let commands = &commands[..if is_record { 4 } else { 1 }];
        for command in commands {
            let ended = prone(command);
            check(&command.join(" "), &ended, home.path());
            assert_eq!(ended.status.success(), is_record, "{command:?}");
            if page.exists() {
                check_text("page", &fs::read_to_string(&page).unwrap());
                fs::remove_file(&page).unwrap();
            }
        }
        if out.exists() {
            check_files(&out);
            fs::remove_dir_all(&out).unwrap();
        }
    }
    // Rows: a name, a cell, a table of another manner.
    fs::write(copy.join("run.json"), &run_json).unwrap();
    let rows = fs::read_to_string(copy.join("rows.csv")).unwrap();
    for text in [
        rows.replacen("time_s", HOSTILE, 1),
        rows.replacen("time_s", &"t".repeat(5_000_000), 1),
        rows.replacen("pull", HOSTILE, 1),
        rows.replace(',', ";"),
    ] {
        fs::write(copy.join("rows.csv"), text).unwrap();
        run(
            home.path(),
            &[&["view", at, "--out", out.to_str().unwrap()]],
        );
    }
    let semicolons = prone(&["view", at, "--out", out.to_str().unwrap()]);
    let said = String::from_utf8(semicolons.stderr).unwrap();
    assert!(
        said.contains("its cells are separated by semicolons"),
        "{said}"
    );
}

fn copy_folder(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let copy = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy_folder(&path, &copy);
        } else {
            fs::copy(&path, copy).unwrap();
        }
    }
}

/// A file whose name commands a terminal, named on the command line.
#[test]
fn names_of_files_command_no_terminal() {
    let home = tempfile::tempdir().unwrap();
    let file = home.path().join(format!("{HOSTILE}.toml"));
    fs::write(&file, PULL).unwrap();
    let at = file.to_str().unwrap();
    run(
        home.path(),
        &[
            &["gait", "show", at],
            &["crawl", "run", "--gait", at],
            &["robot", "check", at],
            &["gait", at],
        ],
    );
}
