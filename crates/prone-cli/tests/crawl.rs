//! Whole runs of `prone crawl run`.

mod begun;
mod folder;
mod program;

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Duration;

use serde_json::Value;

use begun::begun;
use folder::files;
use program::prone;

/// The summary of a run that ends well.
fn summary(arguments: &[&str]) -> Value {
    let done = prone(&[&["crawl", "run", "--json"], arguments].concat());
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
    serde_json::from_slice(&done.stdout).unwrap()
}

fn number(value: &Value, key: &str) -> f64 {
    value[key]
        .as_f64()
        .unwrap_or_else(|| panic!("{key}: {value}"))
}

#[test]
fn figures_agree_with_one_another() {
    let run = summary(&[
        "--gait",
        "hip-10",
        "--cycles",
        "4",
        "--turn-deg-per-cycle",
        "6",
    ]);
    let cycles = run["per_cycle"].as_array().unwrap();
    assert_eq!(run["cycles"], 4);
    assert_eq!(cycles.len(), 4);
    let sum = |key: &str| cycles.iter().map(|cycle| number(cycle, key)).sum::<f64>();
    // 1e-9: sums in another order.
    assert!((number(&run, "time_s") - sum("time_s")).abs() < 1e-9);
    assert!((number(&run, "yaw_deg") - sum("yaw_deg")).abs() < 1e-9);
    assert!((number(&run, "heat_s") - sum("heat_s")).abs() < 1e-9);
    assert!((number(&run, "work_j") - sum("work_j")).abs() < 1e-9);
    // Steps in turned frames, put together, are the way from start to end.
    let (mut x, mut y, mut yaw) = (0.0, 0.0, 0.0_f64);
    for cycle in cycles {
        let (forward, left) = (number(cycle, "advance_mm"), number(cycle, "left_mm"));
        let (sin, cos) = yaw.sin_cos();
        (x, y) = (
            x + cos * forward - sin * left,
            y + sin * forward + cos * left,
        );
        yaw += number(cycle, "yaw_deg").to_radians();
    }
    assert!((x - number(&run, "distance_mm")).abs() < 1e-6, "{x}");
    assert!((y - number(&run, "lateral_mm")).abs() < 1e-6, "{y}");
    assert!(yaw > 0.1, "a command to the left turns to the left: {yaw}");
    let over = |key: &str| number(&run, "path_mm") / number(&run, key);
    assert!((number(&run, "mm_per_cycle") - over("cycles")).abs() < 1e-9);
    assert!((number(&run, "mm_per_s") - over("time_s")).abs() < 1e-9);
    let efficiency = number(&run, "mm_per_cycle") / number(&run, "stride_mm");
    assert!((number(&run, "stride_efficiency") - efficiency).abs() < 1e-9);
    let parts = number(&run, "pull_mm_per_cycle") + number(&run, "recovery_mm_per_cycle");
    let own = cycles.iter().map(|cycle| number(cycle, "advance_mm"));
    let path = own.sum::<f64>();
    assert!((number(&run, "path_mm") - path).abs() < 1e-6);
    assert!((parts - path / cycles.len() as f64).abs() < 1e-6);
    // Current limits are on; a step that is braked by a contact may end a little beyond.
    assert!(number(&run, "peak_torque_over_rated") <= 1.1);
    let motors = run["joints"].as_array().unwrap();
    let all = |key: &str| motors.iter().map(|motor| number(motor, key)).sum::<f64>();
    assert!((number(&run, "heat_s") - all("heat_s")).abs() < 1e-9);
    assert!((number(&run, "heat_per_second") - all("heat_per_second")).abs() < 1e-9);
    assert!((number(&run, "work_j") - all("work_j")).abs() < 1e-9);
    // One motor turns both hips' yaw-pitch.
    assert_eq!(motors.len(), 23);
    let pair = motors.iter().find(|motor| motor["joint"] == "LHipYawPitch");
    assert_eq!(
        pair.unwrap()["joints"],
        serde_json::json!(["LHipYawPitch", "RHipYawPitch"])
    );
    let ground = run["ground"].as_object().unwrap();
    let carried = ground.values().map(|group| number(group, "mean_n"));
    let weight = 5.195_35 * 9.81;
    // Half a percent: the body's last state is not its first.
    assert!((carried.sum::<f64>() / weight - 1.0).abs() < 0.005);
    assert_eq!(run["verdict"]["duty"], "not on a robot");
    for (part, top) in run["top_mm"].as_object().unwrap() {
        let highest = cycles.iter().map(|cycle| number(&cycle["top_mm"], part));
        assert_eq!(top.as_f64(), highest.reduce(f64::max), "{part}");
    }
    assert_eq!(run["plate_contacts"], 0);
    assert_eq!(run["contacts"], Value::Array(Vec::new()));
    assert_eq!(run["arrived"], Value::Null);
}

/// Under a plate low enough, the contacts are counted; past a short one, the run ends.
#[test]
fn plates_are_touched_or_passed() {
    let low = [
        "--gait",
        "hip-10",
        "--ceiling-mm",
        "150",
        "--length-m",
        "1",
        "--cycles",
        "3",
    ];
    let low = summary(&low);
    let contacts = low["contacts"].as_array().unwrap();
    assert!(!contacts.is_empty());
    let counts = contacts
        .iter()
        .map(|contact| contact["count"].as_u64().unwrap());
    assert_eq!(Some(counts.sum()), low["plate_contacts"].as_u64());
    for contact in contacts {
        assert!(number(contact, "peak_n") > 0.0, "{contact}");
        assert!(number(contact, "first_s") + number(contact, "seconds") <= number(&low, "time_s"));
    }
    let passed = summary(&[
        "--gait",
        "hip-10",
        "--ceiling-mm",
        "190",
        "--length-m",
        "0.2",
        "--until-past",
        "--heading-hold",
        "--joint-offset-deg",
        "1",
        "--seed",
        "3",
        "--friction-left",
        "0.5",
        "--friction-right",
        "0.9",
    ]);
    assert_eq!(passed["arrived"], true);
    assert_eq!(passed["plate_contacts"], 0);
    let outcome = &passed["outcome"];
    assert_eq!(
        (&outcome["passed"], &outcome["touched"]),
        (&true.into(), &false.into())
    );
    assert_eq!(outcome["largest_contact_n"], Value::Null);
    let outcome = &low["outcome"];
    assert_eq!(
        (&outcome["passed"], &outcome["touched"]),
        (&Value::Null, &true.into())
    );
    let forces = contacts.iter().map(|contact| number(contact, "peak_n"));
    assert_eq!(
        outcome["largest_contact_n"].as_f64(),
        forces.reduce(f64::max)
    );
    // Robot and plate: some 0.6 m and 0.25 m.
    assert!(
        (600.0..1200.0).contains(&number(&passed, "distance_mm")),
        "{passed}"
    );
    assert!(number(&passed, "lateral_mm").abs() < 120.0);
}

/// A touch is a failure where that is asked for, with its record in place; without one nothing fails.
#[test]
fn a_touch_may_be_a_failure() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("record");
    let run = |ceiling_mm: &str| {
        let typed =
            "crawl run --gait hip-10 --length-m 0.3 --cycles 1 --fail-on-contact --ceiling-mm";
        let mut typed: Vec<&str> = typed.split(' ').collect();
        typed.extend([ceiling_mm, "--record", folder.to_str().unwrap()]);
        prone(&typed)
    };
    let touching = run("140");
    let message = String::from_utf8_lossy(&touching.stderr);
    assert_eq!(touching.status.code(), Some(1), "{message}");
    assert!(
        message.contains("--fail-on-contact takes for a failure"),
        "{message}"
    );
    let printed = String::from_utf8_lossy(&touching.stdout);
    assert!(
        printed.lines().next().unwrap().contains("hit plate 1 with"),
        "{printed}"
    );
    let written = fs::read_to_string(folder.join("summary.json")).unwrap();
    let written: Value = serde_json::from_str(&written).unwrap();
    assert_eq!(written["outcome"]["touched"], true);
    assert_eq!(run("250").status.code(), Some(0));
}

/// A bound of the user ends a crawl that would get there.
#[test]
fn limit_a_crawl_past_obstacles_ends_after_its_bound() {
    let typed =
        "crawl run --gait hip-10 --ceiling-mm 190 --length-m 1 --until-past --cycles 2 --json";
    let typed: Vec<&str> = typed.split(' ').collect();
    let done = prone(&typed);
    assert_eq!(done.status.code(), Some(1));
    let run: Value = serde_json::from_slice(&done.stdout).unwrap();
    assert_eq!(
        (&run["cycles"], &run["arrived"]),
        (&2.into(), &false.into())
    );
}

#[test]
fn records_are_the_same_on_any_number_of_threads_and_replace_each_other() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("record");
    let mut runs = Vec::new();
    for threads in ["1", "2"] {
        let done = prone(&[
            "crawl",
            "run",
            "--gait",
            "hip-10",
            "--cycles",
            "2",
            "--scene",
            "table",
            "--joint-offset-deg",
            "1",
            "--seed",
            "7",
            "--threads",
            threads,
            "--record",
            folder.to_str().unwrap(),
        ]);
        let message = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{message}");
        let mut files = files(&folder);
        assert!(files.remove(Path::new("timing.json")).is_some());
        runs.push((done.stdout, files));
    }
    let names: Vec<_> = runs[0]
        .1
        .keys()
        .map(|path| path.display().to_string())
        .collect();
    assert_eq!(
        names,
        [
            "commands.csv",
            "contacts.csv",
            "cycles.csv",
            "figures/fig-22-hip-10-start.png",
            "figures/fig-22-hip-10-start.svg",
            "figures/fig-28-hip-10-sequence.png",
            "figures/fig-28-hip-10-sequence.svg",
            "figures/fig-31-hip-10-angles.png",
            "figures/fig-31-hip-10-angles.svg",
            "figures.json",
            "model.json",
            "motors.csv",
            "plate-contacts.csv",
            "robot.compiled.json",
            "rows.csv",
            "run.json",
            "start.json",
            "summary.json",
        ]
    );
    assert!(runs[0] == runs[1], "output or a file differs");
    let text = |name: &str| String::from_utf8(runs[0].1[Path::new(name)].clone()).unwrap();
    let rows = text("rows.csv");
    // 2.8 s a cycle, one row per 20 ms.
    assert_eq!(rows.lines().count(), 1 + 2 * 140);
    let columns = rows.lines().next().unwrap().split(',').count();
    assert!(rows.lines().all(|line| line.split(',').count() == columns));
    assert_eq!(text("cycles.csv").lines().count(), 1 + 2);
    let run: Value = serde_json::from_str(&text("run.json")).unwrap();
    assert_eq!(run["options"]["seed"], 7);
    assert_eq!(
        run["options"]["joint_offsets_rad"]
            .as_array()
            .unwrap()
            .len(),
        24
    );
    assert_eq!(run["regime"]["name"], "locomotion");
    assert_eq!(run["scene"]["friction_left"], 0.7);
    let model: Value = serde_json::from_str(&text("model.json")).unwrap();
    assert_eq!(model["obstacles"].as_array().unwrap().len(), 7);
    assert!(!model["shapes"].as_array().unwrap().is_empty());
}

#[test]
fn of_two_crawls_into_one_folder_the_second_is_refused() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path().join("new/record");
    let arguments = |cycles, record| {
        [
            "crawl", "run", "--gait", "hip-10", "--cycles", cycles, "--record", record,
        ]
    };
    let record = folder.to_str().unwrap();
    let mut first = begun(&arguments("1000", record));
    let lock = home.path().join("new/.record.prone.lock");
    while !lock.exists() {
        assert!(first.try_wait().unwrap().is_none(), "it ended too soon");
        std::thread::sleep(Duration::from_millis(5));
    }
    // By whatever name.
    std::os::unix::fs::symlink("new", home.path().join("link")).unwrap();
    let link = home.path().join("link/record");
    for name in [record, link.to_str().unwrap()] {
        let second = prone(&arguments("1", name));
        let message = String::from_utf8(second.stderr).unwrap();
        assert_eq!(second.status.code(), Some(2), "{message}");
        assert!(
            message.starts_with("error: another crawl that is recorded in this folder is at work"),
            "{message}"
        );
    }
    fs::remove_file(home.path().join("link")).unwrap();
    let stopped = Command::new("kill").arg(first.id().to_string()).status();
    assert!(stopped.unwrap().success());
    assert_eq!(first.wait().unwrap().code(), Some(130));
    let left = fs::read_dir(home.path()).unwrap().count();
    assert_eq!(left, 0, "not even the folder above");
    // Then the folder is free again.
    let done = prone(&arguments("1", record));
    assert!(done.status.success());
    let left = fs::read_dir(home.path().join("new")).unwrap().count();
    assert_eq!(left, 1, "the record alone");
}

/// A pull in which nothing moves has a stride of zero, one from the end to the beginning a negative
/// one: of neither can anything come about.
#[test]
fn limit_a_plan_that_does_not_lead_forward_has_no_efficiency() {
    let home = tempfile::tempdir().unwrap();
    let gait = home.path().join("gait.toml");
    let at = gait.to_str().unwrap();
    for (arm, stride) in [
        ("constant_deg = -60", "0.0"),
        ("linear_deg = [-60, -50]", "-"),
    ] {
        let low = include_str!("../../../robots/nao/gaits/hip-10.toml");
        let text = low.replacen("linear_deg = [-30, -85]", arm, 1);
        assert_ne!(text, low);
        fs::write(&gait, text).unwrap();
        let run = summary(&["--gait", at, "--cycles", "1"]);
        assert!(run["stride_efficiency"].is_null(), "{run}");
        assert!(run["pull_efficiency"].is_null(), "{run}");
        let done = prone(&["crawl", "run", "--gait", at, "--cycles", "1"]);
        let said = String::from_utf8(done.stdout).unwrap();
        assert!(!said.contains("inf") && !said.contains("NaN"), "{said}");
        let line = said
            .lines()
            .find(|line| line.contains("planned chain"))
            .unwrap();
        assert!(
            line.starts_with(&format!("  stride of the planned chain {stride}")),
            "{line}"
        );
        assert!(
            line.ends_with(" mm: the pull does not lead forward"),
            "{line}"
        );
    }
}

#[test]
fn what_a_robot_cannot_do_is_said_with_its_line() {
    let home = tempfile::tempdir().unwrap();
    let gait = home.path().join("gait.toml");
    let at = gait.to_str().unwrap();
    let low = include_str!("../../../robots/nao/gaits/hip-10.toml");
    let comment = low.lines().take_while(|line| line.starts_with('#')).count();
    // Lines after the comment at its head.
    let cases = [
        (
            "LHipPitch = -25",
            "LHop = -25",
            23,
            "waypoint fold: robot NAO H25 V4 has no joint LHop",
        ),
        ("time_s = 0.3", "time_s = 0.06", 33, "reach: "),
        (
            "constant_deg = 10\n\n[pull.upper",
            "constant_deg = 70\n\n[pull.upper",
            7,
            "",
        ),
    ];
    for (from, to, line, what) in cases {
        let line = comment + line;
        let text = low.replacen(from, to, 1);
        assert_ne!(text, low);
        fs::write(&gait, text).unwrap();
        for command in [&["crawl", "run", "--gait", at][..], &["gait", "show", at]] {
            let refused = prone(command);
            let message = String::from_utf8(refused.stderr).unwrap();
            assert_eq!(refused.status.code(), Some(2), "{message}");
            assert!(
                message.starts_with(&format!("error: {at}:{line}: ")),
                "{message}"
            );
            assert!(message.contains(what), "{message}");
        }
    }
}

#[test]
fn a_record_replaces_nothing_that_is_not_one() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("cat.jpg"), b"cat").unwrap();
    let record = home.path().to_str().unwrap();
    let refused = prone(&["crawl", "run", "--gait", "hip-10", "--record", record]);
    let message = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(message.contains("is not an earlier result"), "{message}");
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 1);
}

/// A rest between cycles counts: the motors do less in the mean, and as much in sum but for holding.
#[test]
fn a_rest_lowers_what_motors_feel() {
    let run = |rest: &str| {
        let gait = [
            "--gait",
            "thesis-nominal",
            "--cycles",
            "2",
            "--rest-s",
            rest,
        ];
        summary(&gait)
    };
    let (busy, rested) = (run("0"), run("3"));
    let seconds = number(&rested, "time_s") - number(&busy, "time_s");
    assert!((seconds - 6.0).abs() < 0.02, "{seconds}");
    let felt = |run: &Value| {
        let motors = run["joints"].as_array().unwrap();
        let rms = motors.iter().map(|it| number(it, "rms_over_nominal"));
        rms.fold(0.0, f64::max)
    };
    assert!(felt(&rested) < 0.9 * felt(&busy));
    assert!(number(&rested, "heat_per_second") < 0.8 * number(&busy, "heat_per_second"));
    let reasons = |run: &Value| run["verdict"]["reasons"].as_array().unwrap().len();
    // Its plan is still too fast for what can go on for ever.
    assert_eq!((reasons(&busy), reasons(&rested)), (2, 1));
    assert_eq!(rested["verdict"]["duty"], "limited");
    // How well they follow is a question of the time in which they are moved.
    let clipped = |run: &Value| {
        let motors = run["joints"].as_array().unwrap();
        let shares = motors.iter().map(|it| number(it, "voltage_clipped_share"));
        shares.fold(0.0, f64::max)
    };
    let (busy, rested) = (clipped(&busy), clipped(&rested));
    assert!(
        busy > 0.1 && (rested - busy).abs() < 0.1 * busy,
        "{busy} {rested}"
    );
}

/// A robot whose motors are not known crawls; its heat is unknown, and no search of it begins.
#[test]
fn a_robot_without_motors_has_no_heat_and_no_verdict() {
    let home = tempfile::tempdir().unwrap();
    let robot = home.path().join("robot");
    fs::create_dir(&robot).unwrap();
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/nao/v4");
    fs::copy(source.join("robot.xml"), robot.join("robot.xml")).unwrap();
    let text = fs::read_to_string(source.join("robot.toml")).unwrap();
    let text = text.replace("family = \"nao\"\n", "");
    fs::write(robot.join("robot.toml"), text.replace("\nmotor = ", "\n#")).unwrap();
    let robot = robot.to_str().unwrap();
    let typed = [
        "--gait",
        "thesis-nominal",
        "--cycles",
        "1",
        "--robot",
        robot,
    ];
    let run = summary(&typed);
    for place in [
        "/heat_s",
        "/heat_per_metre_s",
        "/heat_per_second",
        "/winding_loss_j",
    ] {
        assert_eq!(run.pointer(place), Some(&Value::Null), "{place}");
    }
    assert_eq!(run.pointer("/joints/0/heat_s"), Some(&Value::Null));
    assert_eq!(run["verdict"]["duty"], Value::Null);
    let unknown = "joint HeadYaw has no motor with all of its figures in robot.toml (ratio, nominal and stall torque, no-load speed), without which its load is not known";
    assert_eq!(run["verdict"]["unknown"], unknown);
    assert!(number(&run, "work_j") > 1.0);
    let said = prone(&[&["crawl", "run"], &typed[..]].concat());
    let said = String::from_utf8(said.stdout).unwrap();
    assert!(said.contains("; motor heat unknown\n"), "{said}");
    assert!(
        said.contains(&format!("  on a robot: unknown, {unknown}\n")),
        "{said}"
    );
    let out = home.path().join("out");
    let refused = prone(&[
        "optimize",
        "--objective",
        "heat",
        "--source",
        "cycle",
        "--from",
        "thesis-nominal",
        "--seed",
        "1",
        "--budget",
        "40",
        "--robot",
        robot,
        "--out",
        out.to_str().unwrap(),
    ]);
    assert_eq!(refused.status.code(), Some(2));
    let message = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(message, format!("error: {unknown}\n"));
    assert!(!out.exists());
}
