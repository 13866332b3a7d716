//! `prone view` on records that the program makes, and its page in a browser.

mod program;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use program::prone;

/// What a minute of a robot with 26 joints, recorded every 20 ms, may take.
const LARGEST_PAGE: u64 = 3_000_000;

/// How the script says that there is no browser.
const NO_BROWSER: i32 = 77;

fn record(folder: &Path, gait: &str, scene: &str) -> String {
    let folder = folder.to_str().unwrap().to_owned();
    let run = [
        "crawl", "run", "--gait", gait, "--scene", scene, "--cycles", "1",
    ];
    let done = prone(&[&run[..], &["--record", &folder]].concat());
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
    folder
}

fn viewed(arguments: &[&str]) -> (Option<i32>, String, String) {
    let done = prone(&[&["view"], arguments].concat());
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (done.status.code(), text(done.stdout), text(done.stderr))
}

#[test]
fn a_record_becomes_a_page_beside_it() {
    let home = tempfile::tempdir().unwrap();
    let run = record(&home.path().join("low"), "hip-10", "plate-200");
    let page = home.path().join("low.html");

    let (code, said, notes) = viewed(&[&run]);
    assert_eq!((code, notes.as_str()), (Some(0), ""));
    assert!(said.starts_with(page.to_str().unwrap()), "{said}");
    let first = fs::read(&page).unwrap();
    assert!((first.len() as u64) < LARGEST_PAGE);
    viewed(&[&run]);
    assert!(
        first == fs::read(&page).unwrap(),
        "the same run, the same bytes"
    );

    // Two runs of the same name are told apart by their folders.
    let both = home.path().join("both.html");
    let (code, ..) = viewed(&[&run, "--compare", &run, "--out", both.to_str().unwrap()]);
    assert_eq!(code, Some(0));
    assert!(
        fs::read_to_string(&both)
            .unwrap()
            .contains("/low) | hip-10")
    );

    // What was read is not written over.
    let rows = format!("{run}/rows.csv");
    let (code, _, message) = viewed(&[&run, "--out", &rows]);
    assert_eq!(code, Some(2));
    assert!(message.contains("keeps its own files only"), "{message}");

    // Nor is anything put among the files of a record.
    let among = format!("{run}/page.html");
    let (code, _, message) = viewed(&[&run, "--out", &among]);
    assert_eq!(code, Some(2));
    assert!(message.contains("keeps its own files only"), "{message}");

    // What of a broken table is whole is shown, and said.
    let text = fs::read_to_string(&rows).unwrap();
    fs::write(&rows, &text[..text.len() / 2]).unwrap();
    let (code, said, message) = viewed(&[&run, "--compare", &run]);
    assert_eq!(code, Some(2));
    assert!(said.contains("rows,"), "{said}");
    let note = "the file ends within the line; ";
    assert_eq!(message.matches(note).count(), 2, "of both runs: {message}");
    let shown = fs::read_to_string(&page).unwrap();
    assert_eq!(shown.matches(note).count(), 2);

    // Where nothing is to be shown, the earlier page stays.
    fs::write(&rows, "").unwrap();
    let before = fs::read(&page).unwrap();
    let (code, said, message) = viewed(&[&run]);
    assert_eq!((code, said.as_str()), (Some(2), ""));
    assert_eq!(message.lines().count(), 1, "{message}");
    assert!(before == fs::read(&page).unwrap());
}

#[test]
fn a_browser_shows_the_robot() {
    let viewer = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../viewer");
    let home = tempfile::tempdir().unwrap();
    let one = record(&home.path().join("one"), "hip-10", "plate-200");
    let two = record(&home.path().join("two"), "thesis-nominal", "table");
    let (single, double) = (home.path().join("one.html"), home.path().join("two.html"));
    viewed(&[&one]);
    viewed(&[&one, "--compare", &two, "--out", double.to_str().unwrap()]);
    let pictures: PathBuf = [env!("CARGO_TARGET_TMPDIR"), "replay"].iter().collect();
    let ran = Command::new("node")
        .arg(viewer.join("test/replay.mjs"))
        .args([&single, &double, &pictures])
        .output();
    let missing = match &ran {
        Err(_) => true,
        Ok(ran) => ran.status.code() == Some(NO_BROWSER),
    };
    if missing {
        let required = std::env::var_os("PRONE_REQUIRE_BROWSER").is_some();
        assert!(
            !required,
            "no node or no Chromium, and PRONE_REQUIRE_BROWSER is set"
        );
        eprintln!("skipped: no node or no Chromium");
        return;
    }
    let ran = ran.unwrap();
    println!("{}", String::from_utf8_lossy(&ran.stdout));
    let message = String::from_utf8_lossy(&ran.stderr);
    assert!(
        ran.status.success(),
        "{message}; pictures in {}",
        pictures.display()
    );
}
