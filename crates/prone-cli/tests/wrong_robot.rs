//! Robots that are almost right: one message with the place, exit code 2.

use std::fs;
use std::process::{Command, Output};

use prone_files::shipped::NAO;

/// `prone robot check` on the shipped robot, without its family, with one change in each of its
/// files.
fn check(toml: (&str, &str), mjcf: (&str, &str)) -> String {
    let output = checked(toml, mjcf);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert_eq!(said, "");
    String::from_utf8(output.stderr).unwrap()
}

fn checked(toml: (&str, &str), mjcf: (&str, &str)) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let alone = NAO.toml.replacen("family = \"nao\"\n", "", 1);
    for (file, text, (from, to)) in [
        ("robot.toml", alone.as_str(), toml),
        ("robot.xml", NAO.mjcf, mjcf),
    ] {
        assert!(text.contains(from), "{from} is not in {file}");
        fs::write(folder.path().join(file), text.replacen(from, to, 1)).unwrap();
    }
    Command::new(env!("CARGO_BIN_EXE_prone"))
        .args(["robot", "check", "."])
        .current_dir(folder.path())
        .output()
        .unwrap()
}

const SAME: (&str, &str) = ("", "");

#[test]
fn a_joint_that_the_model_lacks_is_pointed_at() {
    let message = check(("knee = \"LKneePitch\"", "knee = \"LKneePich\""), SAME);
    insta::assert_snapshot!(message);
}

/// As a `robot.toml` of before those sections is.
#[test]
fn a_robot_without_control_is_told_what_it_lacks() {
    let at = NAO.toml.find("[control]").unwrap();
    let message = check((&NAO.toml[at..], ""), SAME);
    insta::assert_snapshot!(message);
}

#[test]
fn a_length_in_the_place_of_a_share_is_pointed_at() {
    let message = check(("lateral_rad_m = 2.0", "lateral_rad_m = 3500.0"), SAME);
    insta::assert_snapshot!(message);
}

#[test]
fn a_body_in_no_contact_group_is_named() {
    let message = check(("\"LThigh\", ", ""), SAME);
    insta::assert_snapshot!(message);
}

#[test]
fn a_joint_with_two_drives_is_pointed_at() {
    let message = check(
        (
            "joints = [\"HeadYaw\"]",
            "joints = [\"HeadYaw\", \"HeadYaw\"]",
        ),
        SAME,
    );
    insta::assert_snapshot!(message);
}

#[test]
fn a_hinge_out_of_the_sagittal_plane_is_refused() {
    let message = check(
        SAME,
        (
            "name=\"LKneePitch\" axis=\"0 1 0\"",
            "name=\"LKneePitch\" axis=\"0 0 1\"",
        ),
    );
    insta::assert_snapshot!(message);
}

#[test]
fn malformed_mjcf_is_shown_with_its_line() {
    let message = check(SAME, ("name=\"Chest\" type=", "name=\"Chest\" tipe="));
    insta::assert_snapshot!(message);
}

#[test]
fn unlimited_joints_are_refused() {
    let message = check(SAME, (" range=\"-.0923 2.1125\"", ""));
    insta::assert_snapshot!(message);
}

#[test]
fn negative_lengths_are_refused() {
    let message = check(("span_mm = 430.0", "span_mm = -430.0"), SAME);
    insta::assert_snapshot!(message);
}

/// The servos of the torque study are not the robot's own: one that is too stiff for them crawls.
#[test]
fn a_robot_that_is_too_stiff_for_the_torque_study_is_valid() {
    let neck = "speed_rad_s = 6.46          # published 7.19\nservo_stiffness_nm_rad = 80.0";
    let output = checked((neck, &neck.replace("80.0", "400.0")), SAME);
    let said = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(0), "{said}");
    let why =
        "the torque study does not run with it: joint HeadPitch: a velocity gain of 20 N·m·s/rad";
    assert!(said.contains(why), "{said}");
}
