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
    insta::assert_snapshot!(message, @"error: --out robot/robot.xml would overwrite robot/robot.xml, which was read");
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
fn a_file_goes_over_a_compiled_robot_and_over_nothing_else() {
    let home = home();
    let at = |file: &str| home.path().join(file);
    let to = |file: &str| prone(home.path(), &["compile", "robot", "--out", file]);
    fs::write(at("gait.toml"), "name = \"mine\"\n").unwrap();
    fs::write(at("other.json"), "{\"format\": \"something else\"}").unwrap();
    fs::write(at("empty"), "").unwrap();
    fs::write(at("bytes"), b"\xff\xfe").unwrap();
    for file in ["gait.toml", "other.json", "empty", "bytes"] {
        let before = fs::read(at(file)).unwrap();
        let message = refused(&to(file));
        let why = match file {
            "bytes" => {
                "cannot be read, so that it is not overwritten: it is not UTF-8 text in line 1"
            }
            _ => "is no compiled robot: it is not overwritten",
        };
        assert_eq!(
            message,
            format!("error: {file} is there already and {why}\n")
        );
        assert_eq!(fs::read(at(file)).unwrap(), before);
    }
    // A stale one, and one of another version of the format.
    said(&to("nao.json"));
    let text = fs::read_to_string(at("nao.json")).unwrap();
    for (old, new) in [
        ("\"sources_sha256\": \"", "\"sources_sha256\": \"0"),
        ("\"format_version\": 3", "\"format_version\": 99"),
    ] {
        let other = text.replacen(old, new, 1);
        assert_ne!(other, text);
        fs::write(at("nao.json"), other).unwrap();
        said(&to("nao.json"));
        assert_eq!(fs::read_to_string(at("nao.json")).unwrap(), text);
    }
    // The place beside the sources is its own.
    fs::write(at("robot/robot.compiled.json"), &text[..100]).unwrap();
    said(&prone(home.path(), &["compile", "robot"]));
    assert_eq!(
        fs::read_to_string(at("robot/robot.compiled.json")).unwrap(),
        text
    );
    let to_a_device = to("/dev/null");
    assert_eq!(to_a_device.status.code(), Some(0));
}

#[test]
fn checking_a_robot_fails_when_its_compiled_file_is_stale() {
    let home = home();
    let check = |args: &[&str]| {
        let output = prone(home.path(), &[&["check", "robot"], args].concat());
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        (output.status.code(), out, err)
    };
    let state = || {
        let (code, out, err) = check(&[]);
        assert_eq!(out.ends_with("\n\nvalid\n"), code == Some(0), "{out}");
        assert!(out.contains("l1 toe-ankle"), "{out}");
        let (json_code, json, json_err) = check(&["--json"]);
        assert_eq!((json_code, &json_err), (code, &err));
        let json: serde_json::Value = serde_json::from_str(&json).unwrap();
        (code, err, json["compiled"]["fresh"].as_bool())
    };
    assert_eq!(state(), (Some(0), String::new(), None));
    said(&prone(home.path(), &["compile", "robot"]));
    assert_eq!(state(), (Some(0), String::new(), Some(true)));

    let toml = alone(NAO.toml).replacen("span_mm = 430.0", "span_mm = 431.0", 1);
    fs::write(home.path().join("robot/robot.toml"), toml).unwrap();
    let (code, message, fresh) = state();
    assert_eq!((code, fresh), (Some(1), Some(false)));
    let stale = "error: the robot in robot is valid, but not the compiled one beside it: \
                 robot/robot.compiled.json is stale: it was compiled from ";
    assert!(message.starts_with(stale), "{message}");
    let renewal = "; `prone robot compile robot` renews it\n";
    assert!(message.ends_with(renewal), "{message}");
    said(&prone(home.path(), &["compile", "robot"]));
    assert_eq!(state(), (Some(0), String::new(), Some(true)));

    fs::write(home.path().join("robot/robot.compiled.json"), "{}").unwrap();
    let (code, message, fresh) = state();
    assert_eq!((code, fresh), (Some(1), Some(false)));
    assert!(
        message.contains("robot/robot.compiled.json:1:"),
        "{message}"
    );
    let renewal = "; `prone robot compile robot` writes it anew\n";
    assert!(message.ends_with(renewal), "{message}");

    // One that is broken, in its own place, is written anew whether the place is named or not.
    said(&prone(
        home.path(),
        &["compile", "robot", "--out", "robot/robot.compiled.json"],
    ));
    assert_eq!(state(), (Some(0), String::new(), Some(true)));
    let place = home.path().join("robot/robot.compiled.json");
    let text = fs::read_to_string(&place).unwrap();
    fs::write(
        &place,
        text.replacen("\"format_version\": 3", "\"format_version\": 4", 1),
    )
    .unwrap();
    let (code, message, _) = state();
    assert_eq!(code, Some(1));
    assert!(message.contains("has version 4 of its format"), "{message}");
    assert!(message.ends_with(renewal), "{message}");
}
