//! `prone export`: pictures that move.

mod exporting;
mod program;
mod short_crawl;

use std::fs;
use std::process::{Command, Output};

use exporting::{exported, read, text};
use short_crawl::record;

/// Runs the program with another search path.
fn prone_with(path: &str, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_prone"))
        .env("PATH", path)
        .args(arguments)
        .output()
        .unwrap()
}

#[test]
fn pillow_reads_the_animations() {
    let small = ["--size", "161x91", "--fps", "5", "--to-s", "0.9"];
    let home = tempfile::tempdir().unwrap();
    for (format, kind, view) in [("gif", "GIF", "side"), ("webp", "WEBP", "follow")] {
        let file = exported(&home, format, &[&small[..], &["--view", view]].concat());
        let Some(found) = read(format, &file) else {
            continue;
        };
        assert_eq!(found["format"], kind);
        assert_eq!(found["size"], serde_json::json!([161, 91]));
        // 0.02 s to 0.9 s at five per second: 0.02, 0.22, … 0.82.
        assert_eq!(found["count"], 5, "{format}");
        assert_eq!(found["milliseconds"], 1000, "{format}");
        assert_eq!(found["loop"], 0, "{format}");
        assert!(found["colours"].as_u64().unwrap() > 50, "{format}: {found}");
        assert!(
            found["changed"].as_u64().unwrap() > 100,
            "{format}: {found}"
        );
    }
}

#[test]
fn the_eye_sees_past_the_head() {
    let home = tempfile::tempdir().unwrap();
    let eye = [
        "--view", "eye", "--size", "64x48", "--fps", "1", "--to-s", "0.5",
    ];
    let file = exported(&home, "webp", &eye);
    let Some(found) = read("webp", &file) else {
        return;
    };
    // What is blank has one colour; the floor close by, with its lines and shadows, dozens.
    assert!(found["colours"].as_u64().unwrap() > 40, "{found}");
}

#[test]
fn ffmpeg_makes_the_video_and_whoever_has_none_is_told() {
    let home = tempfile::tempdir().unwrap();
    let out = home.path().join("short.mp4");
    let arguments = [
        "export",
        record().to_str().unwrap(),
        "--format",
        "mp4",
        "--out",
        out.to_str().unwrap(),
        "--size",
        "160x90",
        "--fps",
        "10",
        "--to-s",
        "0.5",
    ];
    let empty = home.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let refused = prone_with(empty.to_str().unwrap(), &arguments);
    assert_eq!(refused.status.code(), Some(1));
    let message = text(&refused.stderr);
    assert!(
        message.contains("ffmpeg, which is not on PATH"),
        "{message}"
    );
    let files = || fs::read_dir(home.path()).unwrap().count();
    assert_eq!(files(), 1, "nothing is left");
    let Some(found) = read("ffmpeg", home.path()) else {
        return;
    };
    let ffmpeg = found["path"].as_str().unwrap();
    let folder = home.path().join("with");
    fs::create_dir(&folder).unwrap();
    std::os::unix::fs::symlink(ffmpeg, folder.join("ffmpeg")).unwrap();
    let done = prone_with(folder.to_str().unwrap(), &arguments);
    assert!(done.status.success(), "{}", text(&done.stderr));
    assert_eq!(files(), 3, "two folders and the film");
    let found = read("mp4", &out).unwrap();
    assert_eq!(found["size"], serde_json::json!([160, 90]));
    assert_eq!(found["codec"], "h264");
    // 0.02, 0.12, … 0.42.
    assert_eq!(found["count"], 5);
    assert!((found["fps"].as_f64().unwrap() - 10.0).abs() < 1e-9);
    assert_eq!(found["moves"], true);
    // One that fails leaves nothing either.
    fs::remove_file(folder.join("ffmpeg")).unwrap();
    fs::write(
        folder.join("ffmpeg"),
        "#!/bin/sh\necho no such codec >&2\nexit 3\n",
    )
    .unwrap();
    let mode = std::os::unix::fs::PermissionsExt::from_mode(0o755);
    fs::set_permissions(folder.join("ffmpeg"), mode).unwrap();
    fs::remove_file(&out).unwrap();
    let path = format!("{}:/bin:/usr/bin", folder.display());
    let failed = prone_with(&path, &arguments);
    assert_eq!(failed.status.code(), Some(1));
    assert_eq!(
        text(&failed.stderr),
        "error: ffmpeg failed: no such codec\n"
    );
    assert_eq!(files(), 2);
}

#[test]
fn the_same_record_gives_the_same_bytes_on_any_number_of_threads() {
    let home = tempfile::tempdir().unwrap();
    let file = |threads: &str| {
        let out = home.path().join(threads);
        let done = Command::new(env!("CARGO_BIN_EXE_prone"))
            .env("RAYON_NUM_THREADS", threads)
            .args([
                "export",
                record().to_str().unwrap(),
                "--format",
                "gif",
                "--size",
                "64x36",
            ])
            .args([
                "--fps",
                "10",
                "--to-s",
                "0.9",
                "--out",
                out.to_str().unwrap(),
            ])
            .output()
            .unwrap();
        assert!(done.status.success(), "{}", text(&done.stderr));
        fs::read(out).unwrap()
    };
    assert!(file("1") == file("3"));
}
