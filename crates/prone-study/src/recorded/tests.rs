use std::fs;
use std::path::Path;

use super::{ReadError, Recorded};

/// A record of a robot with one hinge, as `prone crawl run --record` lays it out.
fn write(folder: &Path, rows: &str, contacts: &str) {
    let run = format!(
        r#"{{"program": "prone", "version": "{}", "commit": "c", "command": "crawl run",
        "robot": {{"name": "r", "folder": "f", "sha256": "s"}},
        "gait": {{"name": "g", "file": "g.toml", "text": ""}},
        "scene": {{"name": "level"}},
        "options": {{"time_scale": 1.0, "scene_text": null}}}}"#,
        env!("CARGO_PKG_VERSION")
    );
    let model = r#"{"bodies": [
        {"name": "trunk", "parent": null, "position": [0, 0, 0], "quaternion": [1, 0, 0, 0], "joint": null},
        {"name": "arm", "parent": 0, "position": [0.2, 0, 0], "quaternion": [1, 0, 0, 0],
         "joint": {"name": "A", "axis": [0, 0, 1], "anchor": [0, 0, 0]}}],
        "obstacles": [{"kind": "plate", "half_edges": [0.75, 0.5, 0.009], "position": [0.8, 0, 0.209]}]}"#;
    fs::write(folder.join("run.json"), run).unwrap();
    fs::write(folder.join("model.json"), model).unwrap();
    fs::write(folder.join("rows.csv"), rows).unwrap();
    fs::write(folder.join("contacts.csv"), contacts).unwrap();
}

const ROWS: &str = "time_s,cycle,stage,s,x_mm,y_mm,z_mm,qw,qx,qy,qz,A_cmd_rad,A_rad,A_nm,toe_n,elbow_n,torso_n,leg_n
0.0200,1,pull,0.0,100.000,0.000,50.000,1,0,0,0,0.1,0.0,0.5,1,2,3,4
0.0400,1,pull,0.1,200.000,0.000,50.000,1,0,0,0,0.2,1.5707963,0.6,1,2,3,4
0.0600,1,recovery,,300.000,0.000,50.000,1,0,0,0,0.3,2.0,0.7,1,2,3,4
";
const CONTACTS: &str = "time_s,body,with,x_mm,y_mm,z_mm,fx_n,fy_n,fz_n
0.0200,arm,floor,1,2,3,4,5,6
0.0400,trunk,plate 1,1,2,3,4,5,6
0.0600,arm,floor,1,2,3,4,5,6
";

fn read(rows: &str, contacts: &str) -> Result<Recorded, ReadError> {
    let home = tempfile::tempdir().unwrap();
    write(home.path(), rows, contacts);
    Recorded::read(home.path())
}

#[test]
fn a_record_is_read_in_si() {
    let record = read(ROWS, CONTACTS).unwrap();
    assert_eq!(record.joints, ["A"]);
    assert_eq!(record.cuts, []);
    assert_eq!((record.rows.len(), record.contacts.len()), (3, 3));
    assert!((record.rows[1].ground_from_root.origin().x() - 0.2).abs() < 1e-12);
    assert_eq!(record.contacts[1].with, "plate 1");
    let (height, length) = record.plate.unwrap();
    assert!((height - 0.2).abs() < 1e-12 && (length - 1.5).abs() < 1e-12);
    // (2 - 0) rad over 0.04 s in the middle, one-sided at the ends.
    let speeds = record.joint_speeds();
    assert!((speeds[1][0] - 50.0).abs() < 1e-9, "{speeds:?}");
    assert!(
        (speeds[0][0] - std::f64::consts::FRAC_PI_2 / 0.02).abs() < 1e-5,
        "{speeds:?}"
    );
    // The arm's origin is 0.2 m ahead of the trunk's, whatever its angle; a quarter turn about z
    // takes its x axis to the trunk's y axis.
    let arm = record.ground_from_bodies(&record.rows[1])[1];
    assert!((arm.origin().x() - 0.4).abs() < 1e-12);
    assert!((arm.rotate(glam::DVec3::X) - glam::DVec3::Y).length() < 1e-6);
}

#[test]
fn limit_what_is_cut_off_ends_both_tables() {
    // In the middle of a number, which would still parse.
    let record = read(&ROWS[..ROWS.len() - 20], CONTACTS).unwrap();
    assert_eq!((record.rows.len(), record.contacts.len()), (2, 2));
    assert_eq!(record.cuts[0].line, 4);
    let record = read(ROWS, &CONTACTS[..CONTACTS.len() - 2]).unwrap();
    // The instant of the last complete contact may have had more.
    assert_eq!((record.rows.len(), record.contacts.len()), (1, 1));
    assert!(
        record.cuts[0]
            .to_string()
            .ends_with("contacts.csv is cut off or damaged at line 4")
    );
    let damaged = ROWS.replace("0.0400,1", "0.0400,x");
    assert_eq!(read(&damaged, CONTACTS).unwrap().cuts[0].line, 3);
    let header = &ROWS[..=ROWS.find('\n').unwrap()];
    assert!(matches!(
        read(header, CONTACTS),
        Err(ReadError::NoRows { .. })
    ));
    assert!(matches!(read("", CONTACTS), Err(ReadError::Model { .. })));
    let renamed = ROWS.replace("toe_n", "foot_n");
    assert!(matches!(
        read(&renamed, CONTACTS),
        Err(ReadError::Column { .. })
    ));
}

#[test]
fn other_folders_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let error = |home: &Path| Recorded::read(home).unwrap_err();
    assert!(matches!(
        error(home.path()),
        ReadError::Missing {
            file: "run.json",
            ..
        }
    ));
    write(home.path(), ROWS, CONTACTS);
    let run = home.path().join("run.json");
    let text = fs::read_to_string(&run).unwrap();
    fs::write(&run, text.replace(env!("CARGO_PKG_VERSION"), "0.0.7")).unwrap();
    let message = error(home.path()).to_string();
    assert!(message.contains("was written by prone 0.0.7"), "{message}");
    fs::write(&run, text.replace("crawl run", "optimize")).unwrap();
    let message = error(home.path()).to_string();
    assert!(
        message.contains("a result of `prone optimize`"),
        "{message}"
    );
    fs::write(&run, "{").unwrap();
    assert!(matches!(error(home.path()), ReadError::Json { .. }));
}
