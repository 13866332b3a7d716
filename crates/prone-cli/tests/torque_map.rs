//! Whole runs of `prone torque-map`.

use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::Duration;

use prone_files::shipped::NAO;

/// 6 × 5 × 7 = 210 rows: some seconds of simulation on one thread.
const GRID: [&str; 4] = ["--step-deg", "10", "--theta4-max-deg", "10"];

fn build(source: &str, out: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_prone"));
    command
        .args(["torque-map", "build", "--source", source])
        .args(GRID)
        .arg("--out")
        .arg(out)
        .args(more);
    command
}

fn succeeded(output: Output) -> (String, String) {
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let (stdout, stderr) = (text(output.stdout), text(output.stderr));
    assert!(output.status.success(), "{stderr}");
    (stdout, stderr)
}

fn journal(out: &Path) -> PathBuf {
    out.with_extension("csv.partial")
}

fn entries(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = names
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// A running build with some rows on disk and others still to come, and the file that it makes.
///
/// A machine may be so busy that the build ends before it is looked at again; then there is another.
fn halfway(home: &Path, start: impl Fn(&Path) -> Command) -> (Child, PathBuf) {
    for attempt in 0..20 {
        let out = home.join(format!("killed-{attempt}.csv"));
        let mut child = start(&out)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        while child.try_wait().unwrap().is_none() {
            let lines = fs::read_to_string(journal(&out)).map_or(0, |text| text.lines().count());
            if lines > 1 {
                return (child, out);
            }
            std::thread::sleep(Duration::from_millis(5));
        }
    }
    panic!("a build ends sooner than it can be stopped");
}

#[test]
fn a_killed_build_goes_on_and_its_bytes_are_those_of_an_undisturbed_one() {
    let home = tempfile::tempdir().unwrap();
    let whole = home.path().join("whole.csv");
    let (summary, _) = succeeded(
        build("simulation", &whole, &["--threads", "2"])
            .output()
            .unwrap(),
    );
    let home = tempfile::tempdir_in(home.path()).unwrap();
    let start = |out: &Path| build("simulation", out, &["--threads", "1"]);
    let (mut child, out) = halfway(home.path(), start);
    child.kill().unwrap();
    let ended = child.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), None, "killed");
    if out.exists() {
        // It was done just before.
        fs::remove_file(&out).unwrap();
    }
    let rows = fs::read_to_string(journal(&out)).map_or(0, |text| text.matches('\n').count() - 1);
    let (resumed, log) = succeeded(start(&out).output().unwrap());
    let taken_over = format!(
        "{rows} of 210 rows taken over from {}",
        journal(&out).display()
    );
    assert!(log.starts_with(&taken_over), "{log}");
    assert!(
        fs::read(&out).unwrap() == fs::read(&whole).unwrap(),
        "other bytes"
    );
    assert_eq!(
        summary.replace(&whole.display().to_string(), "FILE"),
        "FILE: torque map by simulation\n     210 rows\n     210 with torques\n       \
         0 masked: the chain does not close\n       0 masked: the source had no torques\n"
    );
    let named = |summary: &str, out: &Path| summary.replace(&out.display().to_string(), "FILE");
    assert_eq!(named(&resumed, &out), named(&summary, &whole));
    assert!(!journal(&out).exists());
}

#[test]
fn signals_keep_the_rows_and_leave_no_half_written_map() {
    for (name, more) in [("INT", &[][..]), ("TERM", &["--json"])] {
        let home = tempfile::tempdir().unwrap();
        // Whoever runs the tests may ignore signals; `env` resets that, then becomes the program.
        let start = |out: &Path| {
            let build = build("simulation", out, more);
            let mut command = Command::new("env");
            command
                .arg("--default-signal=HUP,INT,TERM")
                .arg(build.get_program());
            command.args(build.get_args());
            command
        };
        let (child, out) = halfway(home.path(), start);
        let id = child.id().to_string();
        assert!(
            Command::new("kill")
                .args(["-s", name, &id])
                .status()
                .unwrap()
                .success()
        );
        let ended = child.wait_with_output().unwrap();
        let message = String::from_utf8(ended.stderr).unwrap();
        if out.exists() {
            // It was done just before.
            continue;
        }
        assert_eq!(ended.status.code(), Some(130), "{message}");
        let journal = journal(&out);
        let rows = fs::read_to_string(&journal).unwrap().lines().count() - 1;
        let expected = format!(
            "stopping after this row; Ctrl-C again ends at once\nstopped; {rows} of 210 rows are in {}, and are taken over by the same command\n",
            journal.display()
        );
        assert_eq!(message, expected);
    }
}

#[test]
fn maps_are_the_same_on_any_number_of_threads_and_replace_each_other() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("map.csv");
    let mut built = Vec::new();
    for threads in ["1", "2"] {
        let done = build("statics", &out, &["--threads", threads, "--json"]).output();
        let (stdout, _) = succeeded(done.unwrap());
        built.push((stdout, fs::read(&out).unwrap()));
    }
    assert!(built[0] == built[1]);
    let summary: serde_json::Value = serde_json::from_str(&built[0].0).unwrap();
    assert_eq!(summary["rows"], 210);
    assert_eq!(entries(home.path()), ["map.csv"]);
}

#[test]
fn what_cannot_be_built_is_refused_before_anything_is_made() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    fs::create_dir(at("robot")).unwrap();
    let alone = NAO.toml.replacen("family = \"nao\"\n", "", 1);
    let from = alone.find("[chain.published]").unwrap();
    let to = from + alone[from + 1..].find("\n[").unwrap() + 1;
    let unpublished = [&alone[..from], &alone[to..]].concat();
    fs::write(at("robot/robot.toml"), unpublished).unwrap();
    fs::write(at("robot/robot.xml"), NAO.mjcf).unwrap();
    fs::create_dir(at("nao")).unwrap();
    fs::write(at("nao/robot.toml"), &alone).unwrap();
    fs::write(at("nao/robot.xml"), NAO.mjcf).unwrap();
    symlink("nowhere", at("link")).unwrap();
    let (robot, nao) = (at("robot"), at("nao"));
    let (robot, nao) = (robot.to_str().unwrap(), nao.to_str().unwrap());
    for (out, more, expected) in [
        (
            "map.csv",
            &["--robot", robot][..],
            "has no published chain, which the mapping `original` needs",
        ),
        ("nao/robot.xml", &["--robot", nao], "would overwrite"),
        ("none/map.csv", &[], "No such file or directory"),
        ("robot", &[], "it is a folder"),
        ("link", &[], "it is a link to something that does not exist"),
    ] {
        let refused = build("statics", &at(out), more).output().unwrap();
        let message = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{message}");
        assert!(message.contains(expected), "{message}");
        assert!(refused.stdout.is_empty());
    }
    assert_eq!(entries(home.path()), ["link", "nao", "robot"]);
    assert_eq!(fs::read_to_string(at("nao/robot.xml")).unwrap(), NAO.mjcf);
}

#[test]
fn a_journal_of_other_options_is_kept_until_it_is_discarded() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("map.csv");
    let (child, killed) = halfway(home.path(), |out| build("simulation", out, &[]));
    let mut child = child;
    child.kill().unwrap();
    child.wait().unwrap();
    if !journal(&killed).exists() {
        return;
    }
    fs::rename(journal(&killed), journal(&out)).unwrap();
    let refused = build("statics", &out, &[]).output().unwrap();
    let message = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(2), "{message}");
    let expected = "source was \"simulation\", and is \"statics\" now; --restart discards it";
    assert!(message.contains(expected), "{message}");
    let (_, log) = succeeded(build("statics", &out, &["--restart"]).output().unwrap());
    assert!(log.starts_with("done in "), "nothing is taken over: {log}");
    assert!(out.exists() && !journal(&out).exists());
}

#[test]
fn plots_appear_whole_and_replace_each_other() {
    let home = tempfile::tempdir().unwrap();
    let (map, out) = (home.path().join("map.csv"), home.path().join("plots"));
    succeeded(build("statics", &map, &[]).output().unwrap());
    let plot = |more: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_prone"));
        command
            .args(["torque-map", "plot"])
            .arg(&map)
            .arg("--out")
            .arg(&out);
        command.args(more).output().unwrap()
    };
    let (stdout, _) = succeeded(plot(&[]));
    assert_eq!(stdout.lines().count(), 2 * 4);
    succeeded(plot(&["--theta3-deg", "15"]));
    let files = [
        "figures.json",
        "run.json",
        "torque-map-theta3+15.00deg.png",
        "torque-map-theta3+15.00deg.svg",
    ];
    assert_eq!(entries(&out), files);
    let refused = plot(&["--theta3-deg", "12"]);
    assert_eq!(refused.status.code(), Some(2));
    let message = String::from_utf8(refused.stderr).unwrap();
    let expected = "theta3 = 12.0° is no node of the map: they go from -5.00° to 45.00° by 10.00°";
    assert!(message.contains(expected), "{message}");
    assert_eq!(entries(&out), files, "the earlier result stays");
}
