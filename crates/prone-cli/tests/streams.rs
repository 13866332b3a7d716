//! Outputs that are full or closed, inputs that never end, and tables where they must not go.

use std::fs::{self, File, OpenOptions};
use std::io::Read as _;
use std::path::Path;
use std::process::{Command, Output, Stdio};

const GAIT: &str = include_str!("../../../robots/nao/gaits/nominal.toml");

fn prone() -> Command {
    Command::new(env!("CARGO_BIN_EXE_prone"))
}

fn full() -> File {
    OpenOptions::new().write(true).open("/dev/full").unwrap()
}

/// `prone gait show my.toml --csv <csv>` beside a copy of a shipped gait.
fn show(folder: &Path, csv: &str) -> Output {
    fs::write(folder.join("my.toml"), GAIT).unwrap();
    prone()
        .args(["gait", "show", "my.toml", "--csv", csv])
        .current_dir(folder)
        .output()
        .unwrap()
}

#[test]
fn a_full_output_is_one_message_and_a_closed_one_is_none() {
    for arguments in [
        &["completions", "bash"][..],
        &["gait", "show", "nominal"],
        &["--help"],
        &["optimize", "--help"],
        &["--version"],
    ] {
        let ended = prone().args(arguments).stdout(full()).output().unwrap();
        assert_eq!(ended.status.code(), Some(1));
        let message = String::from_utf8(ended.stderr).unwrap();
        let expected =
            "error: cannot write to standard output: No space left on device (os error 28)\n";
        assert_eq!(message, expected);

        let (mut reader, writer) = std::io::pipe().unwrap();
        let mut child = prone();
        child.args(arguments).stdout(writer).stderr(Stdio::piped());
        let running = child.spawn().unwrap();
        // Our own end of the pipe; then the reader goes after a byte, as `head` does.
        drop(child);
        reader.read_exact(&mut [0]).unwrap();
        drop(reader);
        let ended = running.wait_with_output().unwrap();
        assert_eq!(ended.status.code(), Some(0));
        assert_eq!(String::from_utf8(ended.stderr).unwrap(), "");
    }
}

#[test]
fn an_error_that_nobody_hears_still_has_its_exit_code() {
    for arguments in [&["gait", "show", "gallop"][..], &["gait", "run"]] {
        let ended = prone().args(arguments).stderr(full()).status().unwrap();
        assert_eq!(ended.code(), Some(2));
    }
}

#[test]
fn inputs_that_never_end_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let pipe = home.path().join("pipe");
    assert!(
        Command::new("mkfifo")
            .arg(&pipe)
            .status()
            .unwrap()
            .success()
    );
    for input in [pipe.as_path(), Path::new("/dev/zero"), home.path()] {
        let ended = prone().args(["gait", "show"]).arg(input).output().unwrap();
        assert_eq!(ended.status.code(), Some(2));
        let message = String::from_utf8(ended.stderr).unwrap();
        assert!(
            message.ends_with(": it is not a regular file\n"),
            "{message}"
        );
    }
}

#[test]
fn a_table_never_overwrites_what_was_read() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("my.toml"), GAIT).unwrap();
    fs::hard_link(home.path().join("my.toml"), home.path().join("alias.csv")).unwrap();
    for csv in ["my.toml", "./my.toml", "alias.csv"] {
        let refused = show(home.path(), csv);
        assert_eq!(refused.status.code(), Some(2));
        let message = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(
            message,
            format!("error: --csv {csv} would overwrite my.toml, which was read\n")
        );
        assert!(refused.stdout.is_empty());
        assert_eq!(
            fs::read_to_string(home.path().join("my.toml")).unwrap(),
            GAIT
        );
    }
}

#[test]
fn tables_go_to_files_and_to_devices() {
    let home = tempfile::tempdir().unwrap();
    for _ in 0..2 {
        assert!(show(home.path(), "my.csv").status.success());
        let table = fs::read_to_string(home.path().join("my.csv")).unwrap();
        assert_eq!(table.lines().count(), 1 + 101);
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 2);
    let both = show(home.path(), "/dev/stdout");
    assert!(both.status.success());
    assert!(both.stdout.starts_with(b"cycle_percent,time_s,"));
    let lost = show(home.path(), "/dev/full");
    assert_eq!(lost.status.code(), Some(1));
    let message = String::from_utf8(lost.stderr).unwrap();
    assert!(
        message.starts_with("error: cannot write /dev/full: "),
        "{message}"
    );
}
