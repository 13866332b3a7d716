//! The records that `prone reproduce` leaves: what they hold, and that they are shown and exported.

mod folder;
mod program;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use tempfile::TempDir;

use prone_record::recorded::{Command, Recorded};

use folder::files;
use program::prone;

/// A short reproduction, made once.
fn result() -> &'static Path {
    static RESULT: OnceLock<(TempDir, PathBuf)> = OnceLock::new();
    let (_, folder) = RESULT.get_or_init(|| {
        let home = tempfile::tempdir().unwrap();
        let folder = home.path().canonicalize().unwrap().join("result");
        let out = folder.to_str().unwrap();
        let done = prone(&["reproduce", "--durations", "1", "--out", out]);
        let message = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "{message}");
        (home, folder)
    });
    folder
}

fn at(name: &str) -> String {
    result().join(name).display().to_string()
}

/// The rows of a table by their columns.
fn table(name: &str) -> Vec<BTreeMap<String, f64>> {
    let text = fs::read_to_string(result().join(name)).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row = |line: &str| {
        let cells = header.iter().zip(line.split(','));
        let numbers =
            cells.filter_map(|(name, cell)| Some(((*name).to_owned(), cell.parse().ok()?)));
        numbers.collect()
    };
    lines.map(row).collect()
}

fn succeeded(arguments: &[&str]) {
    let done = prone(arguments);
    let message = String::from_utf8(done.stderr).unwrap();
    assert!(done.status.success(), "{arguments:?}: {message}");
}

/// The pull that is shown is also one of the torque tables: what stands in both is the same.
#[test]
fn identity_a_recorded_pull_is_that_of_the_torque_table() {
    for gait in ["nominal", "optimal"] {
        let torques = table(&format!("torques/{gait}-01.0s.csv"));
        let rows = table(&format!("pulls/{gait}-1s/rows.csv"));
        assert_eq!(rows.len(), torques.len());
        for (row, torque) in rows.iter().zip(&torques) {
            // Within the decimals of either. The recordings' sign is minus the motor's.
            for (ours, sign, theirs, decimals) in [
                ("RKneePitch_nm", -1.0, "knee_nm", 1e-4),
                ("RShoulderPitch_nm", -1.0, "shoulder_nm", 1e-4),
                ("RKneePitch_rad", 1.0, "knee_rad", 1e-4),
                ("RKneePitch_cmd_rad", 1.0, "knee_cmd_rad", 1e-4),
                ("toe_n", 1.0, "toe_n", 1e-3),
                ("head_top_mm", 1.0, "head_top_mm", 1e-2),
            ] {
                let off = row[ours] - sign * torque[theirs];
                assert!(off.abs() < decimals, "{gait}, {ours}: {off}");
            }
            let tops = row.iter().filter(|(name, _)| name.ends_with("_top_mm"));
            let top = tops.fold(f64::NEG_INFINITY, |top, (_, other)| top.max(*other));
            assert!((top - torque["top_mm"]).abs() < 1e-2, "{gait}: {top}");
        }
    }
}

#[test]
fn records_are_whole_and_small() {
    let record = Recorded::read(&result().join("pulls/nominal-1s")).unwrap();
    assert_eq!(record.cuts, []);
    assert_eq!(record.run.head.command, Command::ReproducePull);
    assert!(
        record
            .run
            .gait
            .text
            .unwrap()
            .contains("constant_deg = 16.5")
    );
    assert_eq!(record.stages, [(0, "pull".to_owned())]);
    // The link masses of the recording scene's robot sum to 5.142 kg. In a pull of a second the body still comes to
    // rest on its limbs: the mean is within a tenth of the weight.
    let weight = 5.142 * 9.81;
    let forces = record.contacts.iter().map(|contact| contact.force_n.z);
    let carried = forces.sum::<f64>() / record.rows.len() as f64;
    assert!((carried / weight - 1.0).abs() < 0.1, "{carried} N");
    let crawl = Recorded::read(&result().join("crawls/table-9-cycles")).unwrap();
    assert_eq!(crawl.cuts, []);
    assert_eq!(crawl.run.head.command, Command::ReproduceCrawl);
    assert_eq!(crawl.rows.last().unwrap().cycle, 9);
    let size = |folder: &str| -> usize {
        let files = files(&result().join(folder));
        files.values().map(Vec::len).sum()
    };
    assert!(size("pulls/nominal-1s") < 1_000_000);
}

#[test]
fn they_are_shown_and_exported_like_a_crawl_s() {
    let page = at("../page.html");
    let (nominal, optimal) = (at("pulls/nominal-1s"), at("pulls/optimal-1s"));
    succeeded(&["view", &nominal, "--compare", &optimal, "--out", &page]);
    let text = fs::read_to_string(page).unwrap();
    assert!(text.contains("<title>nominal · level | optimal · level – prone</title>"));
    let crawl = at("crawls/table-9-cycles");
    succeeded(&["view", &crawl]);
    assert!(Path::new(&at("../result-table-9-cycles.html")).is_file());
    let out = at("../exported");
    for format in ["csv", "npz", "mcap", "urdf"] {
        succeeded(&["export", &nominal, "--format", format, "--out", &out]);
    }
    for format in ["xar", "keyframes"] {
        succeeded(&["export", &crawl, "--format", format, "--out", &out]);
    }
    for record in [&nominal, &crawl] {
        let film = ["--format", "gif", "--size", "64x36", "--fps", "2"];
        let export = ["export", record, "--to-s", "0.6", "--out", &out];
        succeeded(&[&export[..], &film].concat());
    }
}

#[test]
fn what_does_not_go_is_refused() {
    let nominal = at("pulls/nominal-1s");
    let out = at("../refused");
    let all = result().to_str().unwrap();
    let inside = format!(
        "recorded runs in it: {}, {nominal}, {}\n",
        at("crawls/table-9-cycles"),
        at("pulls/optimal-1s")
    );
    let among = at("pulls/a.csv");
    let refusals = [
        (&["view", all][..], inside.as_str()),
        (&["export", all, "--format", "csv", "--out", &out], &inside),
        (
            &["export", &nominal, "--format", "xar", "--out", &out],
            "is a pull alone: xar and keyframes are a whole cycle, with its way back\n",
        ),
        (
            &["export", &nominal, "--format", "csv", "--out", &among],
            "which keeps its own files only\n",
        ),
        (
            &["view", &nominal, "--out", &among],
            "which keeps its own files only\n",
        ),
    ];
    for (arguments, said) in refusals {
        let refused = prone(arguments);
        let message = String::from_utf8(refused.stderr).unwrap();
        assert_eq!(refused.status.code(), Some(2), "{message}");
        assert!(message.ends_with(said), "{message}");
    }
    assert!(!Path::new(&out).exists());
}
