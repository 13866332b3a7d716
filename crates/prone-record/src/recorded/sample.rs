//! A small record for tests, as the program lays it out.

use std::fs;

use tempfile::TempDir;

/// Of a robot with one hinge: three rows, four contacts.
pub(crate) const ROWS: &str = "\
time_s,cycle,stage,s,x_mm,y_mm,z_mm,qw,qx,qy,qz,A_cmd_rad,A_rad,A_nm,toe_n,elbow_n,torso_n,leg_n,head_n,hand_n,contacts
0.0200,1,pull,0.0,100.000,0.000,50.000,1,0,0,0,0.1,0.0,0.5,1,2,3,4,5,6,1
0.0400,1,pull,0.1,200.000,0.000,50.000,1,0,0,0,0.2,1.5707963,0.6,1,2,3,4,5,6,2
0.0600,1,recovery,,300.000,0.000,50.000,1,0,0,0,0.3,2.0,0.7,1,2,3,4,5,6,1
";

pub(crate) const CONTACTS: &str = "\
time_s,body,with,x_mm,y_mm,z_mm,fx_n,fy_n,fz_n
0.0200,arm,floor,1,2,3,4,5,6
0.0400,trunk,plate 1,1,2,3,4,5,6
0.0400,arm,floor,1,2,3,4,5,7
0.0600,arm,floor,1,2,3,4,5,6
";

pub(crate) const MODEL: &str = r#"{"bodies": [
    {"name": "trunk", "parent": null, "position": [0.1000000001, 0, 0], "quaternion": [1, 0, 0, 0], "joint": null},
    {"name": "arm", "parent": 0, "position": [0.2, 0, 0], "quaternion": [1, 0, 0, 0],
     "joint": {"name": "A", "axis": [0, 0, 1], "anchor": [0, 0, 0]}}],
    "shapes": [], "chain": {},
    "obstacles": [{"kind": "plate", "half_edges": [0.75, 0.5, 0.009], "position": [0.8, 0, 0.209]}]}"#;

/// The channels of [`ROWS`] and [`CONTACTS`].
pub(crate) const CHANNELS: &str = r#"[
    {"table": "rows.csv", "columns": ["x_mm", "y_mm", "z_mm"], "is": "instant", "unit": "mm"},
    {"table": "rows.csv", "columns": ["qw", "qx", "qy", "qz"], "is": "instant", "unit": "1"},
    {"table": "rows.csv", "columns": ["A_cmd_rad"], "is": "command", "unit": "rad"},
    {"table": "rows.csv", "columns": ["A_rad"], "is": "instant", "unit": "rad"},
    {"table": "rows.csv", "columns": ["A_nm"], "is": "mean over the row", "unit": "N·m"},
    {"table": "rows.csv", "columns": ["toe_n", "elbow_n", "torso_n", "leg_n", "head_n", "hand_n"], "is": "mean over the row", "unit": "N"},
    {"table": "rows.csv", "columns": ["contacts"], "is": "instant", "unit": "1"},
    {"table": "contacts.csv", "columns": ["x_mm", "y_mm", "z_mm"], "is": "mean over the row", "unit": "mm"},
    {"table": "contacts.csv", "columns": ["fx_n", "fy_n", "fz_n"], "is": "mean over the row", "unit": "N"}]"#;

/// Where the sample comes from.
pub(crate) const ORIGIN: &str = r#"{"kind": "imported", "from": "a test"}"#;

pub(crate) fn run_json() -> String {
    format!(
        r#"{{"program": "prone", "version": "{}", "commit": "c", "command": "crawl run",
        "robot": {{"name": "r", "folder": "f", "sha256": "s"}},
        "gait": {{"name": "g", "description": "d", "file": "g.toml", "text": ""}},
        "scene": {{"name": "level"}},
        "origin": {ORIGIN},
        "options": {{"time_scale": 1.0, "scene_text": null, "steering": "none"}},
        "record": {{"format": 3, "rows": 3, "row_step_s": 0.02, "channels": {CHANNELS}}}}}"#,
        env!("CARGO_PKG_VERSION")
    )
}

/// A record folder with some files changed, or left out.
pub(crate) fn folder(changes: &[(&str, Option<&str>)]) -> TempDir {
    let home = tempfile::tempdir().unwrap();
    let run = run_json();
    let whole = [
        ("run.json", run.as_str()),
        ("model.json", MODEL),
        ("rows.csv", ROWS),
        ("contacts.csv", CONTACTS),
    ];
    for (name, text) in whole {
        let change = changes.iter().find(|(changed, _)| *changed == name);
        if let Some(text) = change.map_or(Some(text), |(_, change)| *change) {
            fs::write(home.path().join(name), text).unwrap();
        }
    }
    home
}
