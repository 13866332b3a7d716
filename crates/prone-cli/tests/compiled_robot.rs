//! `prone robot compile`: where the file goes, what it holds, and when it is stale.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use prone_files::compiled_robot::CompiledRobot;
use prone_files::shipped::NAO;

fn prone(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_prone"))
        .args(["robot"])
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap()
}

fn said(output: &Output) -> String {
    let code = output.status.code();
    assert_eq!(code, Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn refused(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// A folder with the shipped robot's sources in `robot`.
fn home() -> tempfile::TempDir {
    let home = tempfile::tempdir().unwrap();
    let robot = home.path().join("robot");
    fs::create_dir(&robot).unwrap();
    fs::write(robot.join("robot.toml"), alone(NAO.toml)).unwrap();
    fs::write(robot.join("robot.xml"), NAO.mjcf).unwrap();
    home
}

/// A robot of no family: its folder alone is here.
fn alone(toml: &str) -> String {
    toml.replacen("family = \"nao\"\n", "", 1)
}

#[test]
fn the_file_lies_beside_its_sources_or_where_it_is_asked_for() {
    let home = home();
    let at = |file: &str| home.path().join(file);
    let said_beside = said(&prone(home.path(), &["compile", "robot"]));
    assert!(said_beside.ends_with(": robot/robot.compiled.json\n"));
    let beside = fs::read(at("robot/robot.compiled.json")).unwrap();
    let compiled = CompiledRobot::read(&at("robot/robot.compiled.json")).unwrap();
    assert_eq!(
        compiled.robot(),
        CompiledRobot::shipped(&NAO).unwrap().robot()
    );

    let json = said(&prone(
        home.path(),
        &["compile", "robot", "--out", "other.json", "--json"],
    ));
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["file"], "other.json");
    assert_eq!(json["sources_sha256"], compiled.sources_hash());
    assert_eq!(fs::read(at("other.json")).unwrap(), beside);

    assert_eq!(json["family"], serde_json::Value::Null);

    said(&prone(home.path(), &["compile", "--out", "nao.json"]));
    let shipped = fs::read_to_string(at("nao.json")).unwrap();
    assert_eq!(shipped, NAO.compiled, "`prone robot compile robots/nao`");
}

#[test]
fn a_file_goes_over_none_that_was_read() {
    let home = home();
    let args = ["compile", "robot", "--out", "robot/robot.xml"];
    let message = refused(&prone(home.path(), &args));
    insta::assert_snapshot!(message, @"error: robot/robot.xml would overwrite robot/robot.xml, which was read");
    let args = ["compile", "robot", "--out", "nowhere/nao.json"];
    let message = refused(&prone(home.path(), &args));
    insta::assert_snapshot!(message, @"error: cannot write nowhere/nao.json: No such file or directory (os error 2)");
    assert!(!home.path().join("robot/robot.compiled.json").exists());
    for args in [&["compile"][..], &["compile", "nao"]] {
        let message = refused(&prone(home.path(), args));
        assert!(
            message.ends_with(
                "ships with prone and has no folder here: say where the file goes with --out\n"
            ),
            "{message}"
        );
    }
}

#[test]
fn checking_a_robot_says_when_its_compiled_file_is_stale() {
    let home = home();
    let state = || {
        let text = said(&prone(home.path(), &["check", "robot"]));
        assert!(text.ends_with("\n\nvalid\n"), "{text}");
        let json = said(&prone(home.path(), &["check", "robot", "--json"]));
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        let line = text.lines().find(|line| line.contains(".compiled.json"));
        let line = line.map(str::to_owned);
        (line, json["compiled"]["fresh"].as_bool())
    };
    assert_eq!(state(), (None, None));
    said(&prone(home.path(), &["compile", "robot"]));
    assert_eq!(state(), (None, Some(true)));

    let toml = alone(NAO.toml).replacen("span_mm = 430.0", "span_mm = 431.0", 1);
    fs::write(home.path().join("robot/robot.toml"), toml).unwrap();
    let (line, fresh) = state();
    let line = line.unwrap();
    let stale = "robot/robot.compiled.json is stale: it was compiled from ";
    assert!(line.starts_with(stale), "{line}");
    assert_eq!(fresh, Some(false));
    said(&prone(home.path(), &["compile", "robot"]));
    assert_eq!(state().1, Some(true));
}
