use super::sample::{CONTACTS, MODEL, ROWS, folder, run_json};
use super::*;
use crate::record_info::{Kind, Options};

fn read(changes: &[(&str, Option<&str>)]) -> Result<Recorded, ReadError> {
    Recorded::read(folder(changes).path())
}

fn of_rows(text: &str) -> Recorded {
    read(&[(ROWS_FILE, Some(text))]).unwrap()
}

fn of_contacts(text: &str) -> Recorded {
    read(&[(CONTACTS_FILE, Some(text))]).unwrap()
}

#[test]
fn a_record_that_says_no_version_is_of_an_unknown_one() {
    let version = |run: &str| {
        let home = folder(&[(RUN_FILE, Some(run))]);
        RecordInfo::read(home.path()).unwrap().robot.version_name()
    };
    assert_eq!(version(&run_json()), "unknown");
    let said =
        |more: &str| run_json().replace("\"name\": \"r\"", &format!("\"name\": \"r\", {more}"));
    assert_eq!(
        version(&said(r#""family": "nao", "version": "v4""#)),
        "v4 of nao"
    );
    assert_eq!(
        version(&said(r#""family": null, "version": null"#)),
        "unknown"
    );
}

#[test]
fn a_record_is_read_in_si() {
    let record = read(&[]).unwrap();
    assert_eq!(record.joints, ["A"]);
    assert_eq!(record.cuts, []);
    assert_eq!(record.shortfalls(&[Part::Rows, Part::Contacts]), [""; 0]);
    assert_eq!((record.rows.len(), record.contacts.len()), (3, 4));
    assert_eq!(record.contact_counts, [1, 2, 1]);
    assert_eq!(
        record.stages,
        [(0, "pull".to_owned()), (2, "recovery".to_owned())]
    );
    assert!((record.rows[1].ground_from_root.unwrap().origin().x() - 0.2).abs() < 1e-12);
    assert_eq!(record.contacts[1].with, "plate 1");
    let (height, length) = record.plate.unwrap();
    assert!((height - 0.2).abs() < 1e-12 && (length - 1.5).abs() < 1e-12);
    // The columns as they stand: all but the stage; an empty cell is not a number.
    let column = |name: &str| {
        let mut columns = record.columns.iter();
        columns.find(|(known, _)| known == name)
    };
    assert_eq!(column("x_mm").unwrap().1, [100.0, 200.0, 300.0]);
    assert!(column("s").unwrap().1[2].is_nan());
    assert!(column("stage").is_none());
    // (2 - 0) rad over 0.04 s in the middle, one-sided at the ends.
    let speeds = record.joint_speeds();
    assert!((speeds[1][0] - 50.0).abs() < 1e-9, "{speeds:?}");
    assert!(
        (speeds[0][0] - std::f64::consts::FRAC_PI_2 / 0.02).abs() < 1e-5,
        "{speeds:?}"
    );
    // The arm's origin is 0.2 m ahead of the trunk's, whatever its angle; a quarter turn about z
    // takes its x axis to the trunk's y axis.
    let arm = record.ground_from_bodies(&record.rows[1])[1].unwrap();
    assert!((arm.origin().x() - 0.4).abs() < 1e-12);
    assert!((arm.rotate(glam::DVec3::X) - glam::DVec3::Y).length() < 1e-6);
}

/// Each row has one thing wrong in its last line; two rows are left, and three contacts.
#[test]
fn rows_end_where_they_are_damaged() {
    let last = "0.0600,1,recovery,,300.000,0.000,50.000,1,0,0,0,0.3,2.0,0.7,1,2,3,4,5,6,1\n";
    assert!(ROWS.ends_with(last));
    let with = |from: &str, to: &str| ROWS.replace(from, to);
    let cases = [
        (
            ROWS[..ROWS.len() - 20].to_owned(),
            "the file ends within the line",
        ),
        (ROWS.replace(last, ""), "the table ends after 2 of 3 rows"),
        (
            with(",0.7,1,2,3,4,5,6,1", ""),
            "13 cells, where the header has 21",
        ),
        (
            with("0.0600,1", "x,1"),
            "time_s is \"x\", which is no value of a record",
        ),
        (
            with("0.0600,1", "inf,1"),
            "time_s is \"inf\", which is no value of a record",
        ),
        (
            with("0.0600,1", "1e300,1"),
            "time_s is \"1e300\", which is no value of a record",
        ),
        (
            with("2.0,0.7", "nan,0.7"),
            "A_rad is \"nan\", which is no value of a record",
        ),
        // Also in a column that is only shown.
        (
            with("recovery,,", "recovery,-,"),
            "s is \"-\", which is no value of a record",
        ),
        (
            with("0.0600,1", "0.0300,1"),
            "0.03 s, where the row of 0.0600 s is due",
        ),
        (
            with("0.0600,1", "0.0800,1"),
            "0.08 s, where the row of 0.0600 s is due",
        ),
        (
            with("50.000,1,0,0,0,0.3", "50.000,0,0,0,0,0.3"),
            "the root's quaternion has the length 0.0000",
        ),
        (
            with("0.7,1,2,3,4,5,6,1", "0.7,1,2,3,4,5,6,70000"),
            "contacts is \"70000\", and must be 0 to 65535",
        ),
        // A count is never unknown: without it nobody knows whether contacts.csv is whole.
        (
            with("0.7,1,2,3,4,5,6,1", "0.7,1,2,3,4,5,6,"),
            "contacts is \"\", and must be 0 to 65535",
        ),
        (
            with("0.0600,1,", "0.0600,,"),
            "cycle is \"\", and must be 1 to 65535",
        ),
        (
            with("0.0600,1,", "0.0600,0,"),
            "cycle is \"0\", and must be 1 to 65535",
        ),
        (
            with("recovery,,", "swimming,,"),
            "stage is \"swimming\", and must be pull or recovery",
        ),
        (
            with("recovery,,", "pull,1.01,"),
            "s is \"1.01\", and must be 0 to 1",
        ),
    ];
    for (text, damage) in cases {
        let record = of_rows(&text);
        assert_eq!(
            record.shortfalls(&[Part::Rows, Part::Contacts]),
            [format!(
                "rows.csv, line 4: {damage}; 2 of 3 instants are left, up to 0.04 s"
            )]
        );
        assert_eq!((record.rows.len(), record.contacts.len()), (2, 3));
    }
}

#[test]
fn a_row_that_is_missing_or_too_much_is_noticed() {
    let lines: Vec<&str> = ROWS.lines().collect();
    let without_second = [lines[0], lines[1], lines[3], ""].join("\n");
    let record = of_rows(&without_second);
    assert_eq!(record.rows.len(), 1);
    assert_eq!(
        record.cuts[0].to_string(),
        "rows.csv, line 3: 0.06 s, where the row of 0.0400 s is due"
    );
    // What follows without a gap is not the beginning.
    let without_first = [lines[0], lines[2], lines[3], ""].join("\n");
    let refused = read(&[(ROWS_FILE, Some(&without_first))]).unwrap_err();
    assert!(matches!(refused, ReadError::NoRows { .. }), "{refused}");
    // Nothing but headers is no record, though it says so itself.
    let none = run_json().replace("\"rows\": 3", "\"rows\": 0");
    assert!(none.contains("\"rows\": 0"), "{none}");
    let header = format!("{}\n", lines[0]);
    let refused = read(&[(RUN_FILE, Some(&none)), (ROWS_FILE, Some(&header))]).unwrap_err();
    assert!(matches!(refused, ReadError::NoRows { .. }), "{refused}");
    let more = format!("{ROWS}{}\n", lines[3].replace("0.0600", "0.0800"));
    let record = of_rows(&more);
    assert_eq!(record.rows.len(), 3);
    assert_eq!(
        record.cuts[0].to_string(),
        "rows.csv, line 5: a row more than the 3 that were recorded"
    );
}

#[test]
fn contacts_that_are_missing_shorten_no_rows() {
    let lines: Vec<&str> = CONTACTS.lines().collect();
    let without = |missing: usize| {
        let mut left = lines.clone();
        left.remove(missing);
        left.join("\n") + "\n"
    };
    let cut = CONTACTS[..CONTACTS.len() - 2].to_owned();
    let cases = [
        (without(1), 0, "2: 0 of 1 contacts at 0.02 s"),
        (without(2), 1, "4: 1 of 2 contacts at 0.04 s"),
        (without(4), 2, "5: 0 of 1 contacts at 0.06 s"),
        (cut, 2, "5: the file ends within the line"),
        (
            CONTACTS.replace("0.0600,arm", "0.0600,hat"),
            2,
            "5: body is \"hat\", which is no value of a record",
        ),
        (
            CONTACTS.replace("0.0600,arm", "0.0500,arm"),
            2,
            "5: a contact at 0.05 s more than were recorded",
        ),
        (
            format!("{CONTACTS}0.0600,arm,floor,1,2,3,4,5,6\n"),
            3,
            "6: a contact at 0.06 s more than were recorded",
        ),
    ];
    for (text, known, said) in cases {
        let record = of_contacts(&text);
        assert_eq!(record.rows.len(), 3, "{said}");
        assert_eq!(record.contact_counts.len(), known, "{said}");
        let counted: usize = record.contact_counts.iter().sum();
        assert_eq!(record.contacts.len(), counted, "{said}");
        assert_eq!(record.shortfalls(&[Part::Rows]), [""; 0]);
        assert_eq!(
            record.shortfalls(&[Part::Contacts]),
            [format!(
                "contacts.csv, line {said}; contacts of {known} of 3 instants are left"
            )]
        );
    }
    let record = read(&[(CONTACTS_FILE, None)]).unwrap();
    assert_eq!((record.rows.len(), record.contacts.len()), (3, 0));
    assert_eq!(
        record.shortfalls(&[Part::Contacts]),
        ["contacts.csv, line 1: there is no such file; contacts of 0 of 3 instants are left"]
    );
}

#[test]
fn what_is_no_record_is_refused_with_a_reason() {
    let said = |changes: &[(&str, Option<&str>)]| {
        let folder = folder(changes);
        let message = Recorded::read(folder.path()).unwrap_err().to_string();
        without_place(&message, folder.path())
    };
    let version = env!("CARGO_PKG_VERSION");
    let run = |from: &str, to: &str| run_json().replace(from, to);
    let inside = run(
        "\"command\": \"crawl run\"",
        "\"command\": \"reproduce\", \"artefacts\": [\"pulls/a/model.json\", \"pulls/a/rows.csv\", \"run.json\"]",
    );
    let header = ROWS.lines().next().unwrap().to_owned() + "\n";
    let cases = [
        said(&[(RUN_FILE, None)]),
        said(&[(RUN_FILE, Some("{"))]),
        said(&[(RUN_FILE, Some("{}"))]),
        said(&[(RUN_FILE, Some(&run("crawl run", "optimize")))]),
        said(&[(RUN_FILE, Some(&run("\"crawl run\"", "7")))]),
        said(&[(RUN_FILE, Some(&inside))]),
        said(&[(RUN_FILE, Some(&run(version, "9.9.9")))]),
        said(&[(RUN_FILE, Some(&run("\"record\"", "\"length\"")))]),
        said(&[(RUN_FILE, Some(&run("\"format\": 3", "\"format\": 4")))]),
        said(&[(RUN_FILE, Some(&run("0.02", "0.0")))]),
        said(&[(RUN_FILE, Some(&run("[\"contacts\"]", "[]")))]),
        said(&[(MODEL_FILE, None)]),
        said(&[(
            MODEL_FILE,
            Some(&MODEL.replace("\"parent\": 0", "\"parent\": 1")),
        )]),
        said(&[(MODEL_FILE, Some(&MODEL.replace("[0, 0, 1]", "[0, 0, 2]")))]),
        said(&[(ROWS_FILE, None)]),
        said(&[(ROWS_FILE, Some(&header))]),
        said(&[(ROWS_FILE, Some(&ROWS.replace("toe_n", "foot_n")))]),
        said(&[(RUN_FILE, Some(&run("[\"A_nm\"]", "[]")))]),
        said(&[(CONTACTS_FILE, Some(""))]),
    ];
    let expected = [
        "RUN is not a result folder of prone: it holds no run.json",
        "RUN/run.json: EOF while parsing an object at line 1 column 1",
        "RUN is not a result folder of prone: its run.json does not say that prone wrote it",
        "RUN is not a recorded run, but a result of `prone optimize`; `prone crawl run --record` makes one",
        "RUN is not a result folder of prone: its run.json names no command",
        "RUN is not a recorded run, but a result of `prone reproduce`; recorded runs in it: RUN/pulls/a",
        &format!(
            "RUN/run.json was written by prone 9.9.9, this is prone {version}, which reads its own results only: make it anew"
        ),
        &format!(
            "RUN/run.json: the record has format 1, written by prone {version} of commit c; this build of prone reads format 3: record it anew"
        ),
        &format!(
            "RUN/run.json: the record has format 4, written by prone {version} of commit c; this build of prone reads format 3: record it anew"
        ),
        "RUN/run.json: row_step_s 0 is outside 0..10 s",
        "RUN/run.json: record.channels lists contacts.csv without the column contacts of rows.csv",
        "RUN is not a recorded run: it has no model.json",
        "RUN/model.json: body arm does not follow its parent",
        "RUN/model.json: the axis of A has not the length 1",
        "RUN is not a recorded run: it has no rows.csv",
        "RUN has no whole row: rows.csv, line 2: the table ends after 0 of 3 rows",
        "RUN/rows.csv has no column toe_n",
        "RUN/rows.csv: record.channels of run.json does not list the column A_nm",
        "RUN/contacts.csv has no column body",
    ];
    assert_eq!(cases, expected);
    let nowhere = Recorded::read(Path::new("/no/such/run")).unwrap_err();
    assert_eq!(
        nowhere.to_string(),
        "/no/such/run is not a result folder of prone: there is no such folder"
    );
}

#[test]
fn what_needs_no_table_is_read_without() {
    let home = folder(&[(ROWS_FILE, None), (CONTACTS_FILE, None), (MODEL_FILE, None)]);
    let run = RecordInfo::read(home.path()).unwrap();
    assert_eq!((run.head.command, run.record.rows), (Command::Crawl, 3));
    let crawl = run.options.crawl().unwrap();
    assert_eq!(crawl.steering.as_deref(), Some("none"));
    assert_eq!(run.options.scene_text(), None);
}

/// A script that reads `regime` finds it; a program reads the origin.
#[test]
fn a_record_is_read_as_it_is_written() {
    let simulated = r#"{"kind": "simulated", "engine": "E 1", "name": "locomotion",
        "friction": 0.7, "impratio": 10.0, "effort_limit": "l", "stops": "s", "servo": "g",
        "time_step_s": 0.0025,
        "command_step_s": 0.01, "settle_s": 1.0, "solref": [0.02, 1.0],
        "solimp": [0.9, 0.99, 0.001, 0.5, 2.0], "integrator": "i", "solver": "Newton",
        "solver_iterations": 100, "solver_tolerance": 1e-8, "cone": "elliptic",
        "gravity_m_s2": [0.0, 0.0, -9.81], "joint_damping_nms_rad": {"A": 0.1},
        "servos": {"A": {"law": "dc-motor", "joints": ["A"], "stiffness_nm_rad": 80.0,
        "supply_torque_nm": 1.0, "current_torque_nm": 2.0, "back_emf_nms_rad": 0.1,
        "assumed": false}, "B": {"law": "velocity", "joints": ["B"], "gain_nms_rad": 4.0, "rate_per_s": 20.0,
        "speed_rad_s": 3.0, "limit_nm": 30.0}}}"#;
    let info_of = |text: &str| RecordInfo::read(folder(&[(RUN_FILE, Some(text))]).path()).unwrap();
    let info = info_of(&run_json().replace(sample::ORIGIN, simulated));
    let written = serde_json::to_value(&info).unwrap();
    assert_eq!(written["regime"]["name"], "locomotion");
    assert_eq!(written["origin"]["kind"], "simulated");
    assert_eq!(written["origin"]["time_step_s"], 0.0025);
    assert_eq!(written["options"]["until_past_mm"], serde_json::Value::Null);
    assert_eq!(info_of(&written.to_string()), info);
}

/// What a record holds is said by its command, not by a key that happens to be there.
#[test]
fn a_pull_is_known_by_its_command() {
    let crawl = r#"{"time_scale": 1.0, "scene_text": null, "steering": "none"}"#;
    let pull =
        r#"{"time_scale": 1.0, "scene_text": null, "duration_s": 5.0, "start_posture": "p"}"#;
    let read = |command: Command, options: &str| {
        let run = run_json().replace("crawl run", command.name());
        let home = folder(&[(RUN_FILE, Some(&run.replace(crawl, options)))]);
        let read = RecordInfo::read(home.path());
        read.map_err(|error| without_place(&error.to_string(), home.path()))
    };
    for command in [Command::Pull, Command::ReproducePull] {
        let info = read(command, pull).unwrap();
        assert_eq!(info.kind(), Kind::Pull);
        assert!(matches!(&info.options, Options::Pull(_)));
        let written = serde_json::to_string(&info.options).unwrap();
        assert_eq!(written, pull.replace(": ", ":").replace(", ", ","));
    }
    let unsaid = read(Command::Pull, crawl).unwrap_err();
    assert_eq!(unsaid, "RUN/run.json: options: missing field `duration_s`");
    for command in [Command::Crawl, Command::ReproduceCrawl, Command::Robot] {
        let info = read(command, pull).unwrap();
        assert_eq!(info.kind() == Kind::Driven, command == Command::Robot);
        assert!(info.options.crawl().is_some());
    }
}

/// A column in another unit, or of another kind, would be read as what it is not.
#[test]
fn what_run_json_says_of_a_column_is_checked() {
    let said = |from: &str, to: &str| {
        let run = run_json();
        assert!(run.contains(from), "{from}");
        let home = folder(&[(RUN_FILE, Some(&run.replacen(from, to, 1)))]);
        let refused = Recorded::read(home.path()).unwrap_err();
        without_place(&refused.to_string(), home.path())
    };
    let lost = said("\"row_step_s\": 0.02, ", "");
    assert_eq!(lost, "RUN/run.json: record: missing field `row_step_s`");
    let channels = "RUN/run.json: record.channels";
    let cases = [
        (
            r#""is": "instant", "unit": "mm""#,
            r#""is": "instant", "unit": "m""#,
            "x_mm of rows.csv is in mm, not in m",
        ),
        (
            r#"["A_rad"], "is": "instant""#,
            r#"["A_rad"], "is": "command""#,
            "A_rad of rows.csv is \"instant\", not \"command\"",
        ),
        (
            r#"["A_cmd_rad"], "is": "command""#,
            r#"["A_cmd_rad"], "is": "instant""#,
            "A_cmd_rad of rows.csv is \"command\", not \"instant\"",
        ),
        (
            r#"["fx_n", "fy_n", "fz_n"], "is": "mean over the row", "unit": "N""#,
            r#"["fx_n", "fy_n", "fz_n"], "is": "mean over the row", "unit": "kN""#,
            "fx_n of contacts.csv is in N, not in kN",
        ),
        (
            r#"["A_nm"]"#,
            r#"["A_nm", "A_nm"]"#,
            "A_nm of rows.csv is listed twice",
        ),
    ];
    for (from, to, expected) in cases {
        assert_eq!(said(from, to), format!("{channels}: {expected}"));
    }
}

/// Both tables have what is listed, and nothing else.
#[test]
fn columns_that_are_not_listed_or_stand_twice_are_refused() {
    let said = |file: &'static str, text: &str| {
        let home = folder(&[(file, Some(text))]);
        let refused = Recorded::read(home.path()).unwrap_err();
        without_place(&refused.to_string(), home.path())
    };
    let wider = |table: &str, name: &str| {
        let mut lines = table.lines().map(|line| format!("{line},0\n"));
        format!(
            "{},{name}\n",
            lines.next().unwrap().trim_end_matches(",0\n")
        ) + &lines.collect::<String>()
    };
    let unlisted = "record.channels of run.json does not list the column";
    let cases = [
        (ROWS_FILE, wider(ROWS, "heat"), format!("{unlisted} heat")),
        (
            CONTACTS_FILE,
            wider(CONTACTS, "heat"),
            format!("{unlisted} heat"),
        ),
        (
            ROWS_FILE,
            wider(ROWS, "A_rad"),
            "the column A_rad is there twice".to_owned(),
        ),
        (
            ROWS_FILE,
            wider(ROWS, "time_s"),
            "the column time_s is there twice".to_owned(),
        ),
        (
            CONTACTS_FILE,
            wider(CONTACTS, "fx_n"),
            "the column fx_n is there twice".to_owned(),
        ),
    ];
    for (file, text, expected) in cases {
        assert_eq!(said(file, &text), format!("RUN/{file}: {expected}"));
    }
}

#[test]
fn errors_of_run_json_name_the_key() {
    let said = |from: &str, to: &str| {
        let run = run_json();
        assert!(run.contains(from), "{from}");
        let home = folder(&[(RUN_FILE, Some(&run.replacen(from, to, 1)))]);
        RecordInfo::read(home.path()).unwrap_err().to_string()
    };
    for (from, to, expected) in [
        (
            "\"rows\": 3",
            "\"rows\": \"three\"",
            "record.rows: invalid type: string \"three\", expected usize",
        ),
        (
            "\"time_scale\": 1.0",
            "\"time_scale\": []",
            "options.time_scale: invalid type: sequence, expected f64",
        ),
        (
            "\"folder\": \"f\"",
            "\"folder\": 7",
            "robot.folder: invalid type: integer `7`, expected a string",
        ),
        (
            "\"is\": \"instant\"",
            "\"is\": \"median\"",
            "record.is: unknown variant `median`, expected one of `mean over the row`, `sum over the row`, `instant`, `command`",
        ),
        (
            "\"name\": \"level\"",
            "\"title\": 1",
            "scene: missing field `name`",
        ),
        ("\"scene\":", "\"scenery\":", "missing field `scene`"),
        ("\"kind\": \"imported\"", "\"kind\": \"told\"", "origin"),
    ] {
        let said = said(from, to);
        assert!(said.contains(&format!("run.json: {expected}")), "{said}");
    }
}

/// The head and the extent of a record as the release before wrote them.
#[test]
fn a_record_of_the_release_before_is_refused_by_name_and_format() {
    let version = env!("CARGO_PKG_VERSION");
    let old = format!(
        r#"{{"program": "prone", "version": "{version}", "commit": "d813b9b", "command": "crawl run",
        "engine": "MuJoCo 3.17.0", "robot": {{"name": "NAO", "folder": "robots/nao", "sha256": "s"}},
        "gait": {{"name": "g", "description": "d", "file": "g.toml", "mapping": "m", "arm": "a", "text": ""}},
        "scene": {{"name": "level", "obstacles": 0, "friction_left": 0.7, "friction_right": 0.7,
        "slope_deg": 0.0, "rough": false}}, "regime": {{"name": "locomotion"}},
        "options": {{"time_scale": 1.0, "scene_text": null, "steering": "none"}},
        "record": {{"rows": 3, "row_step_s": 0.02}}}}"#
    );
    let home = folder(&[(RUN_FILE, Some(&old))]);
    let said = Recorded::read(home.path()).unwrap_err().to_string();
    assert_eq!(
        without_place(&said, home.path()),
        format!(
            "RUN/run.json: the record has format 1, written by prone {version} of commit d813b9b; \
             this build of prone reads format 3: record it anew"
        )
    );
}

/// As a robot may leave it: no commands, no root, no forces, no contacts, torques with gaps, and
/// rows when they came.
#[test]
fn what_was_not_recorded_is_nan_and_no_damage() {
    let channels = r#"[
        {"table": "rows.csv", "columns": ["A_rad"], "is": "instant", "unit": "rad"},
        {"table": "rows.csv", "columns": ["A_nm"], "is": "instant", "unit": "N·m"}]"#;
    let run = run_json()
        .replace(sample::CHANNELS, channels)
        .replace("\"row_step_s\": 0.02", "\"row_step_s\": null");
    let rows = "time_s,A_rad,A_nm\n0.01,0.1,1.5\n0.03,0.2,\n0.08,0.3,1.0\n";
    let changes = |rows: &'static str| {
        let home = folder(&[
            (RUN_FILE, Some(&run)),
            (ROWS_FILE, Some(rows)),
            (CONTACTS_FILE, None),
        ]);
        Recorded::read(home.path())
    };
    let record = changes(rows).unwrap();
    assert_eq!(
        (record.joints.as_slice(), record.rows.len()),
        (&["A".to_owned()][..], 3)
    );
    assert_eq!(record.cuts, []);
    assert_eq!((record.stages.len(), record.contact_counts.len()), (0, 0));
    assert_eq!(
        record.unrecorded(),
        [
            "the pose of the root was not recorded",
            "the command of the joints was not recorded",
            "the torque of A is missing in 1 of 3 instants",
            "the ground's force on every part was not recorded",
            "contacts were not recorded",
        ]
    );
    let row = &record.rows[1];
    assert!(row.motor_torque_nm[0].is_nan() && row.command.as_slice()[0].is_nan());
    assert!(row.ground_n.iter().all(|force| force.is_nan()));
    assert_eq!((row.ground_from_root, row.cycle), (None, 1));
    assert!(record.has_all_angles());
    assert_eq!(record.ground_from_bodies(row), [None, None]);
    assert!(record.parent_from_bodies(row)[1].is_some());
    // (0.3 - 0.1) rad over 0.07 s.
    assert!((record.joint_speeds()[1][0] - 0.2 / 0.07).abs() < 1e-12);
    // Rows that are lost are still known, and so are rows in disorder.
    let cut = |rows| changes(rows).unwrap().cuts[0].to_string();
    assert_eq!(
        cut("time_s,A_rad,A_nm\n0.01,0.1,1.5\n0.03,0.2,\n"),
        "rows.csv, line 4: the table ends after 2 of 3 rows"
    );
    assert_eq!(
        cut("time_s,A_rad,A_nm\n0.01,0.1,1.5\n0.01,0.2,\n0.08,0.3,1.0\n"),
        "rows.csv, line 3: 0.01 s, which does not follow 0.01 s of the row before"
    );
}

/// A hinge of the model that no column is of.
#[test]
fn a_joint_without_columns_is_said() {
    let record = read(&[(MODEL_FILE, Some(&MODEL.replace("\"A\"", "\"B\"")))]).unwrap();
    assert_eq!(record.joints, ["A", "B"]);
    assert!(!record.has_all_angles());
    assert_eq!(record.missing_angle(), Some(("B", 0.02)));
    assert_eq!(record.unrecorded()[0], "the angle of B was not recorded");
}

/// A message with the folder's own name in it.
fn without_place(message: &str, folder: &Path) -> String {
    message.replace(&folder.display().to_string(), "RUN")
}
