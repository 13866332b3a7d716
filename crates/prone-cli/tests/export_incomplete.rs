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
    let all = whole("urdf", home);
    let (code, said, bytes) = export(&run, "urdf", home);
    assert_eq!((code, said.as_str()), (Some(0), ""));
    assert!(bytes == all);
    // The same cycle; how far the joints were behind it is not known without the rows.
    let without_lag = |bytes: &[u8]| {
        let mut frames: serde_json::Value = serde_json::from_slice(bytes).unwrap();
        let lag = frames["largest_lag"].take();
        frames["largest_lag_by_joint"].take();
        (lag, frames)
    };
    let (lag, all) = without_lag(&whole("keyframes", home));
    assert!(lag.is_object());
    let (code, said, bytes) = export(&run, "keyframes", home);
    assert_eq!((code, said.as_str()), (Some(0), ""));
    assert_eq!(without_lag(&bytes), (serde_json::Value::Null, all));
    let (code, said, bytes) = export(&run, "xar", home);
    assert_eq!((code, said.as_str()), (Some(0), ""));
    let unknown = "how far the joints were behind their commands is unknown";
    assert!(String::from_utf8(bytes).unwrap().contains(unknown));
    // Nor is it of rows that were cut off: a larger lag may be among those that are missing.
    let cut = changed(home, "rows.csv", |text| without(text, |line, _| line > 51));
    let (_, _, bytes) = export(&cut, "keyframes", home);
    assert_eq!(without_lag(&bytes).0, serde_json::Value::Null);
    let run = changed(home, "rows.csv", |_| String::new());
    let (code, said, bytes) = export(&run, "csv", home);
    assert_eq!((code, bytes.len()), (Some(2), 0));
    assert!(
        said.ends_with("is not a recorded run: it has no rows.csv\n"),
        "{said}"
    );
}

/// The last stretch, 0.115 s at nearly the speed limit of `HeadYaw`, ends 15 ms after a tick of 1/25 s:
/// a line to that tick would be too fast.
#[test]
fn no_line_is_faster_than_its_command_and_none_than_a_joint_may_be() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let with = |change: &dyn Fn(&mut serde_json::Value)| {
        changed(home, "run.json", |text| {
            let mut run: serde_json::Value = serde_json::from_str(text).unwrap();
            change(&mut run);
            run.to_string()
        })
    };
    let short = with(&|run| {
        let gait = run["gait"]["text"].as_str().unwrap();
        let changes = [
            (
                "[approach]\ntime_s = 0.5",
                "[approach]\ntime_s = 0.115\neasing = \"linear\"",
            ),
            ("{ HeadPitch = 10,", "{ HeadPitch = 10, LAnklePitch = -20,"),
            (
                "{ LShoulderPitch = -53,",
                "{ HeadYaw = 45, LAnklePitch = -65, LShoulderPitch = -53,",
            ),
        ];
        let gait = changes.iter().fold(gait.to_owned(), |gait, (from, to)| {
            assert!(gait.contains(from), "{from}");
            gait.replace(from, to)
        });
        run["gait"]["text"] = gait.into();
    });
    for format in ["xar", "keyframes"] {
        let (code, said, _) = export(&short, format, home);
        assert_eq!((code, said.as_str()), (Some(0), ""), "{format}");
    }
    let fast = with(&|run| run["options"]["time_scale"] = 0.5.into());
    for format in ["xar", "keyframes"] {
        let (code, said, bytes) = export(&fast, format, home);
        assert_eq!((code, bytes.len()), (Some(2), 0), "{format}: {said}");
        assert!(said.contains("ShoulderPitch would need "), "{said}");
        assert!(said.contains("above its limit of 7.45 rad/s"), "{said}");
    }
}

#[test]
fn a_timeline_is_for_a_robot_that_choregraphe_knows() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let run = changed(home, "robot.compiled.json", |text| {
        text.replace("\"HeadYaw\"", "\"NeckYaw\"")
    });
    let (code, said, bytes) = export(&run, "xar", home);
    assert_eq!((code, bytes.len()), (Some(2), 0), "{said}");
    assert_eq!(
        said,
        "error: Choregraphe moves the hinges of a NAO, and has no joint \"NeckYaw\" of NAO H25 V4: \
         export keyframes instead\n"
    );
    let (code, said, _) = export(&run, "keyframes", home);
    assert_eq!((code, said.as_str()), (Some(0), ""));
}

/// Two feet whose names differ in a sign that ROS has not, and an obstacle that begins with a digit.
#[test]
fn topics_of_names_that_ros_has_not_are_valid_and_distinct() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let rename = |text: &str| {
        let feet = text.replace("LFoot", "Foot.1").replace("RFoot", "Foot-1");
        feet.replace("LHand", "Foot_1")
    };
    let run = changed(home, "model.json", rename);
    let contacts = fs::read_to_string(run.join("contacts.csv")).unwrap();
    let mut lines: Vec<String> = contacts.lines().map(rename).collect();
    let with = lines.iter_mut().find(|line| line.contains("torso,floor"));
    let with = with.unwrap();
    *with = with.replace("torso,floor", "torso,2 × 4");
    fs::write(run.join("contacts.csv"), lines.join("\n") + "\n").unwrap();
    let (code, said, bytes) = export(&run, "mcap", home);
    assert_eq!((code, said.as_str()), (Some(0), ""));
    let log = String::from_utf8_lossy(&bytes);
    for topic in [
        "/contacts/Foot_1/floor",
        "/contacts/Foot_1_2/floor",
        "/contacts/Foot_1_3/floor",
        "/contacts/torso/thing_2_4",
    ] {
        assert!(log.contains(topic), "{topic}");
    }
    // The robot in the record has other bodies now: there is nothing that describes these.
    assert!(!log.contains("/robot_description"));
    let twice = changed(home, "model.json", |text| text.replace("RFoot", "LFoot"));
    let (code, said, bytes) = export(&twice, "mcap", home);
    assert_eq!((code, bytes.len()), (Some(2), 0));
    assert!(
        said.contains("two frames of the record are called \"LFoot\""),
        "{said}"
    );
}

#[test]
fn a_bag_replaces_an_earlier_bag_and_nothing_else() {
    let home = tempfile::tempdir().unwrap();
    let home = home.path();
    let run = changed(home, "rows.csv", str::to_owned);
    let bag = |out: &Path| {
        let (run, at) = (run.to_str().unwrap(), out.to_str().unwrap());
        let done = prone(&["export", run, "--format", "bag", "--out", at]);
        (done.status.code(), String::from_utf8(done.stderr).unwrap())
    };
    let out = home.join("out");
    for _ in 0..2 {
        assert_eq!(bag(&out), (Some(0), String::new()));
    }
    let names = fs::read_dir(&out)
        .unwrap()
        .map(|entry| entry.unwrap().file_name());
    let mut names: Vec<_> = names.collect();
    names.sort();
    assert_eq!(names, ["metadata.yaml", "out_0.mcap", "run.json"]);
    let metadata = fs::read_to_string(out.join("metadata.yaml")).unwrap();
    assert!(metadata.contains("  relative_file_paths:\n    - \"out_0.mcap\"\n"));
    fs::write(out.join("notes.txt"), b"mine").unwrap();
    let (other, photos) = (home.join("other"), home.join("photos"));
    fs::create_dir(&other).unwrap();
    for name in ["run.json", "rows.csv"] {
        fs::copy(run.join(name), other.join(name)).unwrap();
    }
    fs::create_dir(&photos).unwrap();
    fs::write(photos.join("metadata.yaml"), b"theirs").unwrap();
    for (place, reason) in [
        (out, "prone did not write notes.txt"),
        (run.clone(), "not an earlier bag"),
        (run.join("bag"), "keeps its own files only"),
        (other, "is not an earlier"),
        (photos, "it holds no run.json"),
        (run.join("rows.csv"), "is not a folder"),
    ] {
        let (code, said) = bag(&place);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(reason), "{said}");
    }
    assert_eq!(fs::read_dir(&run).unwrap().count(), FILES.len());
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
