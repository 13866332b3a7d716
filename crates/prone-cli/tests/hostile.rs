//! Files that strangers might send to break the program: each is a shipped file with one change, and is
//! refused with exit code 2 and a message that says what is wrong, within seconds and little memory.

use std::fs;
use std::path::Path;
use std::process::Command;

use prone_files::shipped::NAO;
use prone_mutants::program::{self, Ended};
use prone_mutants::seeds::{Bed, Seeds, alone};

/// Runs the program in a bed, by words.
fn prone(bed: &Bed, words: &str) -> Ended {
    let arguments: Vec<String> = words.split(' ').map(str::to_owned).collect();
    program::run(
        Path::new(env!("CARGO_BIN_EXE_prone")),
        &arguments,
        bed.path(),
    )
    .unwrap()
}

fn bed() -> Bed {
    Seeds::of_repository().bed().unwrap()
}

/// A refusal, in whose message one of the words stands.
#[track_caller]
fn refused(case: &str, ended: &Ended, words: &[&str]) {
    assert_eq!(ended.wrong(), None, "{case}");
    assert_eq!(ended.code, Some(2), "{case}: {}", ended.said);
    let named = words.iter().any(|word| ended.said.contains(word));
    assert!(named, "{case}: none of {words:?} in {}", ended.said);
}

/// `robot check` of the shipped robot with one change of its model.
#[track_caller]
fn model(from: &str, to: &str, words: &[&str]) {
    assert!(NAO.mjcf.contains(from), "{from}");
    let bed = bed();
    let text = NAO.mjcf.replacen(from, to, 1);
    fs::write(bed.path().join("robot/robot.xml"), text).unwrap();
    let to: String = to.chars().take(80).collect();
    refused(&to, &prone(&bed, "robot check robot"), words);
}

/// The model with something before `<worldbody>`.
#[track_caller]
fn before_world(added: &str, words: &[&str]) {
    model("<worldbody>", &format!("{added}<worldbody>"), words);
}

/// The model with something in its root body.
#[track_caller]
fn in_root(added: &str, words: &[&str]) {
    model("<freejoint", &format!("{added}<freejoint"), words);
}

/// `robot check` of the shipped robot with every place of one text in its other file replaced.
#[track_caller]
fn table(from: &str, to: &str, words: &[&str]) {
    let whole = alone(NAO.toml);
    assert!(whole.contains(from), "{from}");
    let bed = bed();
    fs::write(
        bed.path().join("robot/robot.toml"),
        whole.replacen(from, to, 1),
    )
    .unwrap();
    refused(to, &prone(&bed, "robot check robot"), words);
}

#[test]
fn a_class_is_no_format_of_the_engine() {
    for class in ["%s%s%s%s%s%s%s%s", "%n", "%p %p %p %p", "%100000000d"] {
        in_root(
            &format!("<geom class=\"{class}\" size=\".01\"/>"),
            &["class"],
        );
        in_root(&format!("<site class=\"{class}\"/>"), &["class"]);
        in_root(&format!("<body childclass=\"{class}\"/>"), &["class"]);
    }
}

#[test]
fn a_model_does_not_say_how_long_it_is_looked_at() {
    for option in [
        "<option ls_iterations=\"1000000000\" tolerance=\"0\"/>",
        "<option iterations=\"1000000000\" solver=\"PGS\" tolerance=\"0\"/>",
        "<option timestep=\"1e9\" iterations=\"1000000000\" gravity=\"0 0 1e9\" density=\"1e9\" wind=\"1e9 0 0\"/>",
    ] {
        let bed = bed();
        let text = NAO
            .mjcf
            .replacen("<worldbody>", &format!("{option}<worldbody>"), 1);
        fs::write(bed.path().join("robot/robot.xml"), text).unwrap();
        let ended = prone(&bed, "robot check robot");
        assert_eq!((ended.wrong(), ended.code), (None, Some(0)), "{option}");
        assert!(ended.took.as_secs() < 10, "{option}: {:?}", ended.took);
    }
}

#[test]
fn a_model_does_not_say_how_much_memory_it_takes() {
    let numbers = "1 ".repeat(100_000);
    for (element, rest) in [("site", ""), ("geom", " size=\".01\""), ("camera", "")] {
        let many = format!("<{element}{rest}/>").repeat(1_000);
        in_root(
            &format!("<{element} user=\"{numbers}\"{rest}/>{many}"),
            &["user"],
        );
    }
}

#[test]
fn a_model_has_no_more_elements_than_a_robot() {
    in_root(&"<site/>".repeat(100_000), &["site", "element"]);
    in_root(
        &"<geom size=\".01\" contype=\"0\" conaffinity=\"0\"/>".repeat(20_000),
        &["geom", "element"],
    );
    let class = |n| format!("<default class=\"c{n}\"/>");
    let classes = (0..30_000).map(class).collect::<Vec<_>>().concat();
    model(
        "<default>",
        &format!("<default>{classes}"),
        &["default", "element"],
    );
}

#[test]
fn no_robot_has_such_physics() {
    for (key, value) in [
        ("damping", "-50"),
        ("armature", "-1"),
        ("stiffness", "-1000"),
        ("frictionloss", "-1"),
    ] {
        before_world(
            &format!("<default><joint {key}=\"{value}\"/></default>"),
            &[key],
        );
    }
    before_world(
        "<compiler settotalmass=\"1e-6\"/>",
        &["outside 0.05..500 kg"],
    );
    before_world(
        "<compiler settotalmass=\"400\"/>",
        &["of a robot whose chain"],
    );
    model(
        "<body name=\"torso\"",
        "<body gravcomp=\"1000000\" name=\"torso\"",
        &["gravcomp"],
    );
}

#[test]
fn a_knee_does_not_bend_the_other_way_on_one_side() {
    model(
        "name=\"RKneePitch\" axis=\"0 1 0\"",
        "name=\"RKneePitch\" axis=\"0 -1 0\"",
        &["RKneePitch"],
    );
}

#[test]
fn no_drive_is_like_that() {
    table("effort_nm = 1.547", "effort_nm = 0.000001", &["effort_nm"]);
    table(
        "speed_rad_s = 7.45",
        "speed_rad_s = 0.00001",
        &["speed_rad_s"],
    );
    table("nominal_mnm = 16.1", "nominal_mnm = 99999", &["nominal"]);
}

#[test]
fn a_name_is_no_cell_and_no_column() {
    for (joint, quoted) in [
        ("L,Knee", "L,Knee"),
        ("L\\\"Knee", "L&quot;Knee"),
        ("L\\nKnee", "L&#10;Knee"),
    ] {
        let bed = bed();
        let home = bed.path().join("robot");
        fs::write(
            home.join("robot.toml"),
            alone(NAO.toml)
                .replace("LKneePitch =", &format!("\"{joint}\" ="))
                .replace("LKneePitch", joint),
        )
        .unwrap();
        fs::write(
            home.join("robot.xml"),
            NAO.mjcf.replace("LKneePitch", quoted),
        )
        .unwrap();
        let ended = prone(&bed, "robot check robot");
        refused(joint, &ended, &["name", "letters"]);
    }
    let bed = bed();
    let home = bed.path().join("robot");
    fs::write(
        home.join("robot.toml"),
        alone(NAO.toml).replace("HeadYaw", "LKneePitch_cmd"),
    )
    .unwrap();
    fs::write(
        home.join("robot.xml"),
        NAO.mjcf.replace("HeadYaw", "LKneePitch_cmd"),
    )
    .unwrap();
    refused(
        "LKneePitch_cmd",
        &prone(&bed, "robot check robot"),
        &["the column of a joint's command"],
    );
}

#[test]
fn what_is_no_file_is_refused_and_not_waited_for() {
    for (file, command) in [
        ("record/rows.csv", "view record --out out/view.html"),
        ("record/contacts.csv", "view record --out out/view.html"),
        ("record/run.json", "report record --out out/report.html"),
        (
            "record/model.json",
            "export record --format csv --out out/table.csv",
        ),
        ("record/summary.json", "report record --out out/report.html"),
        ("record/figures.json", "report record --out out/report.html"),
        (
            "record/robot.compiled.json",
            "export record --format urdf --out out/robot.urdf",
        ),
        ("search/result.json", "report search --out out/report.html"),
        ("robot/robot.xml", "robot check robot"),
        ("robot/robot.toml", "robot check robot"),
        ("family/family.toml", "robot check family"),
        ("map.csv", "torque-map compare map.csv map.csv"),
    ] {
        for pipe in [true, false] {
            let bed = bed();
            let path = bed.path().join(file);
            let _ = fs::remove_file(&path);
            if pipe {
                assert!(
                    Command::new("mkfifo")
                        .arg(&path)
                        .status()
                        .unwrap()
                        .success()
                );
            } else {
                std::os::unix::fs::symlink("/dev/zero", &path).unwrap();
            }
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            refused(&format!("{file}, {pipe}"), &prone(&bed, command), &[&name]);
        }
    }
}

#[test]
fn a_picture_does_not_lead_out_of_its_folder() {
    let png = [b"\x89PNG\r\n\x1a\n".as_slice(), &[0; 32]].concat();
    let entry = |file: &str| {
        format!(
            "[{{\"file\": \"{file}\", \"number\": \"\", \"title\": \"x\", \"caption\": \"x\", \"alt\": \"x\", \"picture\": true}}]"
        )
    };
    for file in [
        "../victim/secret",
        "/tmp/secret",
        "figures/../../victim/secret",
    ] {
        let bed = bed();
        fs::create_dir(bed.path().join("victim")).unwrap();
        fs::write(bed.path().join("victim/secret.png"), &png).unwrap();
        fs::write(bed.path().join("victim/secret.svg"), "<svg/>").unwrap();
        fs::write(bed.path().join("record/figures.json"), entry(file)).unwrap();
        refused(
            file,
            &prone(&bed, "report record --out out/report.html"),
            &["figures.json", "victim", "/tmp/secret"],
        );
    }
}

#[test]
fn a_text_of_a_file_does_nothing_to_the_terminal() {
    let hostile = "a\\u001b[2J\\u001b[31mX\\u202e";
    let bed = bed();
    let gait = prone_files::shipped::gait_file("nominal").unwrap().text;
    let name = format!("name = \"{hostile}\"");
    let lines = gait.lines().map(|line| {
        if line.starts_with("name =") {
            name.as_str()
        } else {
            line
        }
    });
    fs::write(
        bed.path().join("pull.toml"),
        lines.collect::<Vec<_>>().join("\n"),
    )
    .unwrap();
    refused("name", &prone(&bed, "gait show pull.toml"), &["name"]);
    let whole =
        alone(NAO.toml).replacen("name = \"NAO H25 V4\"", &format!("name = \"{hostile}\""), 1);
    fs::write(bed.path().join("robot/robot.toml"), whole).unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_prone"))
        .args(["robot", "check", "robot"])
        .current_dir(bed.path())
        .output()
        .unwrap();
    for bytes in [output.stdout, output.stderr] {
        let said = String::from_utf8(bytes).unwrap();
        assert!(!said.contains(['\u{1b}', '\u{202e}']), "{said:?}");
    }
}

#[test]
fn a_long_name_makes_no_long_message() {
    let bed = bed();
    let long = "x".repeat(5_000_000);
    let text = alone(NAO.toml).replacen("knee = \"LKneePitch\"", &format!("knee = \"{long}\""), 1);
    fs::write(bed.path().join("robot/robot.toml"), text).unwrap();
    refused("5 MB", &prone(&bed, "robot check robot"), &["robot.toml"]);
}

#[test]
fn a_changed_number_of_a_state_is_noticed() {
    let bed = bed();
    let search = |more: &str| {
        let words = "optimize --objective torque --source statics --duration 1 --seed 1 --confirm-durations 1 --out out/search";
        prone(&bed, &format!("{words} {more}"))
    };
    assert_eq!(search("--budget 40").code, Some(0));
    let path = bed.path().join("out/search/search.state.json");
    let text = fs::read_to_string(&path).unwrap();
    let (head, state) = text.split_once('\n').unwrap();
    let at = state.rfind("0.").unwrap();
    let changed = [head, "\n", &state[..at], "1.", &state[at + 2..]].concat();
    fs::write(&path, changed).unwrap();
    refused("changed", &search("--budget 80 --resume"), &["damaged"]);
    fs::write(&path, text).unwrap();
    assert_eq!(search("--budget 80 --resume").code, Some(0));
}
