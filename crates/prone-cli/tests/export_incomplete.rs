//! Records of which something is missing, and places where nothing can be put.

mod program;
mod short_crawl;

use std::fs;
use std::path::{Path, PathBuf};

use prone_record::recorded::FILES;

use program::prone;
use short_crawl::record;

/// Copies the short crawl and changes a file of it; one that is empty is removed.
fn changed(home: &Path, file: &str, change: impl Fn(&str) -> String) -> PathBuf {
    let copy = home.join("cut");
    let _ = fs::remove_dir_all(&copy);
    fs::create_dir(&copy).unwrap();
    for name in FILES {
        fs::copy(record().join(name), copy.join(name)).unwrap();
    }
    let path = copy.join(file);
    let text = change(&fs::read_to_string(&path).unwrap());
    if text.is_empty() {
        fs::remove_file(path).unwrap();
    } else {
        fs::write(path, text).unwrap();
    }
    copy
}

/// Exit code, standard error and the file of an export.
fn export(run: &Path, format: &str, home: &Path) -> (Option<i32>, String, Vec<u8>) {
    let out = home.join(format!("out.{format}"));
    let _ = fs::remove_file(&out);
    let (run, at) = (run.to_str().unwrap(), out.to_str().unwrap());
    let done = prone(&["export", run, "--format", format, "--out", at]);
    let said = String::from_utf8(done.stderr).unwrap();
    (done.status.code(), said, fs::read(&out).unwrap_or_default())
}

fn whole(format: &str, home: &Path) -> Vec<u8> {
    let (code, said, bytes) = export(record(), format, home);
    assert_eq!((code, said.as_str()), (Some(0), ""), "{format}");
    bytes
}

/// What is done to the text of a table.
type Change = fn(&str) -> String;

/// Lines of a text but those for which `drop` holds of number, from 1, and content.
fn without(text: &str, drop: impl Fn(usize, &str) -> bool) -> String {
    let lines = text.lines().enumerate();
    let left = lines.filter(|(index, line)| !drop(index + 1, line));
    let left: Vec<&str> = left.map(|(_, line)| line).collect();
    left.join("\n") + "\n"
}

/// A cut within a line, between two lines, and a line that is missing: what stands before is
/// exported, the same is said by the replay, and both fail.
#[test]
fn what_is_left_of_the_rows_is_exported_and_shown_and_said() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let table = String::from_utf8(whole("csv", home)).unwrap();
    let cases: [(&str, Change); 3] = [
        ("the file ends within the line", |text| {
            let end: usize = text.lines().take(51).map(|line| line.len() + 1).sum();
            text[..end + 40].to_owned()
        }),
        ("the table ends after 50 of ", |text| {
            without(text, |line, _| line > 51)
        }),
        ("1.04 s, where the row of 1.0200 s is due", |text| {
            without(text, |line, _| line == 52)
        }),
    ];
    for (damage, change) in cases {
        let run = changed(home, "rows.csv", change);
        let (code, said, bytes) = export(&run, "csv", home);
        assert_eq!(code, Some(2), "{damage}");
        let place = format!("error: {}: rows.csv, line 52: {damage}", run.display());
        assert!(said.starts_with(&place), "{said}");
        assert!(
            said.ends_with(" instants are left, up to 1.00 s\n"),
            "{said}"
        );
        // The instants that are left, each with a line per joint; the last one's speed has no row
        // after it.
        let exported = String::from_utf8(bytes).unwrap();
        let same = exported.lines().zip(table.lines()).take(1 + 24 * 49);
        assert_eq!(exported.lines().count(), 1 + 24 * 50);
        assert!(same.clone().all(|(one, other)| one == other));
        let page = home.join("cut.html");
        let at = page.to_str().unwrap();
        let viewed = prone(&["view", run.to_str().unwrap(), "--out", at]);
        assert_eq!(viewed.status.code(), Some(2));
        assert_eq!(String::from_utf8(viewed.stderr).unwrap(), said);
        let note = said.split_once("rows.csv").unwrap().1.trim_end();
        let shown = fs::read_to_string(&page).unwrap();
        assert!(shown.contains(note), "the page says {note}");
    }
}

#[test]
fn contacts_that_are_missing_shorten_no_export_that_needs_none() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let (table, arrays, log) = (whole("csv", home), whole("npz", home), whole("mcap", home));
    let cases: [(&str, Change); 3] = [
        (" contacts at 1.00 s; contacts of 49 of ", |text| {
            without(text, |_, line| line.as_bytes()[0] != b't' && line > "1.0")
        }),
        (" contacts at 1.00 s; contacts of 49 of ", |text| {
            let first = text.lines().position(|line| line.starts_with("1.0000"));
            without(text, |line, _| Some(line) == first.map(|index| index + 1))
        }),
        ("there is no such file; contacts of 0 of ", |_| {
            String::new()
        }),
    ];
    for (said_of_it, change) in cases {
        let run = changed(home, "contacts.csv", change);
        let (code, said, bytes) = export(&run, "csv", home);
        assert_eq!((code, said.as_str()), (Some(0), ""));
        assert!(bytes == table);
        for (format, all) in [("npz", &arrays), ("mcap", &log)] {
            let (code, said, bytes) = export(&run, format, home);
            assert_eq!(code, Some(2), "{format}");
            assert!(said.contains("contacts.csv, line "), "{said}");
            assert!(said.contains(said_of_it), "{said}");
            assert!(!bytes.is_empty() && bytes.len() < all.len(), "{format}");
        }
    }
}

#[test]
fn robot_and_cycle_need_no_table() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let run = changed(home, "rows.csv", |_| String::new());
    fs::remove_file(run.join("contacts.csv")).unwrap();
    for format in ["urdf", "keyframes", "xar"] {
        let all = whole(format, home);
        let (code, said, bytes) = export(&run, format, home);
        assert_eq!((code, said.as_str()), (Some(0), ""), "{format}");
        assert!(bytes == all, "{format}");
    }
    let (code, said, bytes) = export(&run, "csv", home);
    assert_eq!((code, bytes.len()), (Some(2), 0));
    assert!(
        said.ends_with("is not a recorded run: it has no rows.csv\n"),
        "{said}"
    );
}

#[test]
fn a_folder_is_no_place_for_a_file_and_no_message_names_a_hidden_one() {
    let home = tempfile::tempdir().unwrap();
    let (run, folder) = (record().to_str().unwrap(), home.path().to_str().unwrap());
    for arguments in [
        &["export", run, "--format", "csv", "--out", folder][..],
        &["export", run, "--format", "gif", "--out", folder],
        &["view", run, "--out", folder],
    ] {
        let refused = prone(arguments);
        assert_eq!(refused.status.code(), Some(2));
        assert_eq!(
            String::from_utf8(refused.stderr).unwrap(),
            format!("error: --out {folder} is a folder: name a file in it\n")
        );
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
    // No file can be made there, whoever asks.
    for arguments in [
        &["export", run, "--format", "csv", "--out", "/proc/out.csv"][..],
        &["view", run, "--out", "/proc/out.csv"],
    ] {
        let refused = prone(arguments);
        assert_eq!(
            String::from_utf8(refused.stderr).unwrap(),
            "error: cannot write /proc/out.csv: No such file or directory (os error 2)\n"
        );
    }
    let refused = prone(&["reproduce", "--out", "/proc/result"]);
    assert_eq!(
        String::from_utf8(refused.stderr).unwrap(),
        "error: cannot write /proc/result: No such file or directory (os error 2)\n"
    );
}

#[test]
fn a_robot_that_is_not_the_run_s_is_refused_in_every_format() {
    let home = tempfile::tempdir().unwrap();
    let other = home.path().join("robot");
    fs::create_dir(&other).unwrap();
    let nao = prone_files::shipped::NAO;
    let alone = nao.toml.replacen("family = \"nao\"\n", "", 1);
    let heavier = format!("{alone}\n# another\n");
    fs::write(other.join("robot.toml"), heavier).unwrap();
    fs::write(other.join("robot.xml"), nao.mjcf).unwrap();
    let nowhere = home.path().join("nowhere");
    let run = record().to_str().unwrap();
    for format in ["csv", "npz", "mcap", "urdf", "keyframes", "gif"] {
        for (robot, said) in [
            (&other, " are not those of the run's robot (NAO H25 V4)"),
            (&nowhere, "nowhere"),
        ] {
            let out = home.path().join("out");
            let (robot, at) = (robot.to_str().unwrap(), out.to_str().unwrap());
            let arguments = ["export", run, "--format", format, "--robot", robot];
            let refused = prone(&[&arguments[..], &["--out", at]].concat());
            let message = String::from_utf8(refused.stderr).unwrap();
            assert_eq!(refused.status.code(), Some(2), "{format}: {message}");
            assert!(message.contains(said), "{format}: {message}");
            assert!(!out.exists());
        }
    }
}
