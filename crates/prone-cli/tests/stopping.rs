//! Ctrl-C, SIGTERM and SIGHUP: answered in one line, the same exit code, and nothing left behind.

mod program;
mod short_crawl;

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process, test_kill_process};

/// Far more than anything here takes.
const LONGEST: Duration = Duration::from_secs(20);

/// What `env` gives a program.
const SIGNALS: &str = "--default-signal=HUP,INT,TERM";

fn start(program: &str, arguments: &[&str], home: &Path) -> Child {
    Command::new(program)
        .args(arguments)
        .current_dir(home)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// The program with the signals of a terminal, whatever these tests were begun with: in the background
/// of a script Ctrl-C is ignored, and stays so.
fn prone(arguments: &[&str], home: &Path) -> Child {
    let arguments = [&[SIGNALS, env!("CARGO_BIN_EXE_prone")], arguments].concat();
    start("env", &arguments, home)
}

fn send(child: &Child, signal: Signal) {
    kill_process(Pid::from_child(child), signal).unwrap();
}

/// Waits for the end, but not for ever.
fn ended(mut child: Child) -> Output {
    let begun = Instant::now();
    while child.try_wait().unwrap().is_none() {
        if begun.elapsed() > LONGEST {
            child.kill().unwrap();
            panic!("it does not end");
        }
        thread::sleep(Duration::from_millis(5));
    }
    child.wait_with_output().unwrap()
}

/// What a stopped command says.
fn stopped(child: Child) -> String {
    let ended = ended(child);
    let said = String::from_utf8(ended.stderr).unwrap();
    assert_eq!(ended.status.code(), Some(130), "{said}");
    said
}

fn left(home: &Path) -> Vec<String> {
    let names = fs::read_dir(home).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

/// Commands that take far longer than a test waits.
const LONG: [&[&str]; 6] = [
    &[
        "crawl", "run", "low-175", "--cycles", "1000", "--record", "r",
    ],
    &["reproduce", "--out", "r"],
    &["crawl", "frontier", "--seed", "1", "--out", "r"],
    &[
        "optimize",
        "--objective",
        "heat",
        "--source",
        "cycle",
        "--seed",
        "1",
        "--out",
        "r",
    ],
    &[
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
        "r",
    ],
    &[
        "torque-map",
        "build",
        "--source",
        "simulation",
        "--out",
        "r",
    ],
];

#[test]
fn every_signal_is_answered_and_ends_with_the_same_code() {
    let signals = [Signal::INT, Signal::TERM, Signal::HUP];
    for (index, command) in LONG.into_iter().enumerate() {
        for (wait_ms, signal) in [200, 900]
            .into_iter()
            .zip(signals.into_iter().cycle().skip(index))
        {
            let home = tempfile::tempdir().unwrap();
            let child = prone(command, home.path());
            thread::sleep(Duration::from_millis(wait_ms));
            send(&child, signal);
            let said = stopped(child);
            let lines: Vec<&str> = said.lines().collect();
            let last = lines.last().unwrap();
            assert!(last.starts_with("stopped; "), "{command:?}: {said}");
            // Before the work has begun, the end is the answer.
            if lines.len() > 1 {
                assert!(lines[0].starts_with("stopping after this "), "{said}");
                assert!(lines[0].ends_with("; Ctrl-C again ends at once"), "{said}");
            }
            let kept = ["r.checkpoint.json", "r.partial"];
            let left = left(home.path());
            assert!(left.iter().all(|name| kept.contains(&&**name)), "{left:?}");
        }
    }
}

#[test]
fn what_is_quick_ends_at_once() {
    let home = tempfile::tempdir().unwrap();
    let child = prone(&["list"], home.path());
    thread::sleep(Duration::from_millis(300));
    send(&child, Signal::TERM);
    assert!(stopped(child).contains("stopped"));
}

#[test]
fn a_second_signal_leaves_neither_locks_nor_hidden_files() {
    let home = tempfile::tempdir().unwrap();
    let child = prone(LONG[5], home.path());
    // Twice in one go: the work has no time to give way.
    thread::sleep(Duration::from_millis(700));
    send(&child, Signal::INT);
    send(&child, Signal::TERM);
    let said = stopped(child);
    assert!(said.contains("stopped"), "{said}");
    let left = left(home.path());
    assert!(left.iter().all(|name| name == "r.partial"), "{left:?}");
}

#[test]
fn signals_that_are_ignored_stay_so_and_the_others_are_heard() {
    let home = tempfile::tempdir().unwrap();
    let script = format!(
        "trap '' INT; exec {} {}",
        env!("CARGO_BIN_EXE_prone"),
        LONG[5].join(" ")
    );
    let mut child = start("sh", &["-c", &script], home.path());
    thread::sleep(Duration::from_millis(700));
    send(&child, Signal::INT);
    thread::sleep(Duration::from_millis(100));
    assert!(child.try_wait().unwrap().is_none(), "Ctrl-C is ignored");
    send(&child, Signal::TERM);
    assert!(stopped(child).contains("stopped; "));
}

/// An encoder that would go on for minutes ends with the program, and its file goes.
#[test]
fn a_stopped_film_ends_its_encoder() {
    let home = tempfile::tempdir().unwrap();
    let tools = home.path().join("tools");
    fs::create_dir(&tools).unwrap();
    let encoder = tools.join("ffmpeg");
    let script = "#!/bin/sh\necho $$ > \"$PIDFILE\"\nexec sleep 300\n";
    fs::write(&encoder, script).unwrap();
    fs::set_permissions(&encoder, fs::Permissions::from_mode(0o755)).unwrap();
    let pid_file = home.path().join("pid");
    let films = home.path().join("films");
    fs::create_dir(&films).unwrap();
    for signals in [1, 2] {
        let path = std::env::var("PATH").unwrap();
        let record = short_crawl::record().to_str().unwrap();
        let child = Command::new("env")
            .args([SIGNALS, env!("CARGO_BIN_EXE_prone")])
            .args(["export", record, "--format", "mp4", "--out", "film.mp4"])
            .env("PATH", format!("{}:{path}", tools.display()))
            .env("PIDFILE", &pid_file)
            .current_dir(&films)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let begun = Instant::now();
        let pid = loop {
            let pid = fs::read_to_string(&pid_file).unwrap_or_default();
            if let Ok(pid) = pid.trim().parse() {
                break Pid::from_raw(pid).unwrap();
            }
            assert!(begun.elapsed() < LONGEST, "no encoder was started");
            thread::sleep(Duration::from_millis(5));
        };
        for _ in 0..signals {
            send(&child, Signal::INT);
        }
        let said = stopped(child);
        assert!(said.contains("nothing was written"), "{said}");
        assert_eq!(left(&films), [""; 0]);
        // Reaped by whoever has inherited it, where the program did not.
        let begun = Instant::now();
        while test_kill_process(pid).is_ok() && !is_zombie(pid) {
            assert!(begun.elapsed() < LONGEST, "the encoder goes on");
            thread::sleep(Duration::from_millis(5));
        }
        fs::remove_file(&pid_file).unwrap();
    }
}

fn is_zombie(pid: Pid) -> bool {
    let status = fs::read_to_string(format!("/proc/{}/status", pid.as_raw_nonzero()));
    status.map_or(true, |status| status.contains("State:\tZ"))
}
