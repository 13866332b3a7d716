//! `prone report` on results of which something is missing or wrong.

mod folder;
mod program;
mod reporting;
mod short_crawl;

use std::fs;
use std::path::Path;

use folder::files;
use program::prone;
use reporting::{results, text};

/// Exit code and message.
fn refused(arguments: &[&str]) -> (Option<i32>, String) {
    let done = prone(arguments);
    (done.status.code(), String::from_utf8(done.stderr).unwrap())
}

/// A copy of a result, to be broken.
fn copy(from: &str, to: &Path) {
    for (name, bytes) in files(Path::new(from)) {
        let file = to.join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, bytes).unwrap();
    }
}

#[test]
fn what_is_readable_of_a_cut_table_is_shown_and_said() {
    let home = tempfile::tempdir().unwrap();
    let run = home.path().join("run");
    let table = "torques/nominal-01.0s.csv";
    let whole = text(Path::new(&results().reproduction).join(table));
    let lines: Vec<&str> = whole.split_inclusive('\n').collect();
    // Within a line, between two, and with something that is no number.
    let cuts = [
        (
            whole[..whole.len() / 2].to_owned(),
            11,
            "the line is not whole",
        ),
        (lines[..8].concat(), 9, "rows are missing from here on"),
        (
            whole.replacen("\n0.200,", "\nNaN,", 1),
            5,
            "the line is not whole",
        ),
    ];
    for (cut, line, reason) in cuts {
        copy(&results().reproduction, &run);
        fs::write(run.join(table), cut).unwrap();
        let page = home.path().join("page.html");
        let (run, out) = (run.to_str().unwrap(), page.to_str().unwrap());
        let (code, message) = refused(&["report", run, "--out", out]);
        let expected = format!("error: {run}/{table}, line {line}: {reason}");
        assert_eq!(code, Some(2), "{message}");
        assert!(message.starts_with(&expected), "{message}");
        assert_eq!(message.lines().count(), 1);
        let page = text(page);
        assert!(page.contains(&format!("{table}, line {line}: {reason}")));
        assert!(page.contains("<figure id=\"fig-36-nominal-torque-by-duration\">"));
    }
    // Rows of a crawl.
    let crawl = home.path().join("crawl");
    copy(&results().crawl, &crawl);
    let rows = text(crawl.join("rows.csv"));
    fs::write(crawl.join("rows.csv"), &rows[..rows.len() / 2]).unwrap();
    let page = home.path().join("page.html");
    let arguments = [
        "report",
        crawl.to_str().unwrap(),
        "--out",
        page.to_str().unwrap(),
    ];
    let (code, message) = refused(&arguments);
    assert_eq!(code, Some(2));
    assert!(message.contains("crawl/rows.csv, line "), "{message}");
    let page = text(page);
    assert!(page.contains("Records that are not whole") && page.contains("fig-31-hip-10-angles"));
}

#[test]
fn what_cannot_be_read_is_one_message() {
    let home = tempfile::tempdir().unwrap();
    let run = home.path().join("run");
    let out = home.path().join("report");
    let arguments = [
        "report",
        run.to_str().unwrap(),
        "--out",
        out.to_str().unwrap(),
    ];
    let mut breaks: Vec<(&str, &str, Option<&str>, &str)> = vec![
        (
            &results().reproduction,
            "costs.csv",
            None,
            "it has no costs.csv",
        ),
        (
            &results().reproduction,
            "figures.json",
            None,
            "it has no figures.json",
        ),
        (
            &results().reproduction,
            "figures/fig-22-nominal-start.png",
            None,
            "it has no figures/fig-22-nominal-start.png",
        ),
        (
            &results().reproduction,
            "figures/fig-22-nominal-start.png",
            Some("GIF89a"),
            "fig-22-nominal-start.png is not a picture",
        ),
        (
            &results().reproduction,
            "summary.json",
            Some("{"),
            "summary.json: EOF while parsing",
        ),
        (
            &results().reproduction,
            "chains.csv",
            Some("gait,s\n"),
            "chains.csv has no column theta3_deg",
        ),
        (&results().crawl, "rows.csv", Some(""), "rows.csv"),
        (&results().crawl, "model.json", None, "it has no model.json"),
        (
            &results().search,
            "history.csv",
            Some("seed\n"),
            "history.csv has no column generation",
        ),
    ];
    for (result, file, becomes, expected) in breaks.drain(..) {
        if run.exists() {
            fs::remove_dir_all(&run).unwrap();
        }
        copy(result, &run);
        match becomes {
            None => fs::remove_file(run.join(file)).unwrap(),
            Some(text) => fs::write(run.join(file), text).unwrap(),
        }
        let (code, message) = refused(&arguments);
        assert_eq!(code, Some(2), "{file}: {message}");
        assert!(message.contains(expected), "{message}");
        assert_eq!(message.lines().count(), 1, "{message}");
        assert!(!out.exists(), "{file}");
    }
}

#[test]
fn nothing_is_put_into_what_is_read() {
    let run = &results().crawl;
    let inside = format!("{run}/report");
    let above = Path::new(run).parent().unwrap().display().to_string();
    for out in [run, &inside, &above] {
        let (code, message) = refused(&["report", run, "--out", out]);
        assert_eq!(code, Some(2), "{message}");
        assert!(message.contains("are one in the other"), "{message}");
    }
    let page = format!("{run}/page.html");
    let (code, message) = refused(&["report", run, "--out", &page]);
    assert_eq!(code, Some(2), "{message}");
    let (code, message) = refused(&["report", run, &format!("{run}/")]);
    assert_eq!(code, Some(2), "{message}");
    assert!(message.contains("is the same folder as"), "{message}");
}
