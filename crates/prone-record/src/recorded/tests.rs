use super::sample::{CONTACTS, MODEL, ROWS, folder, run_json};
use super::*;

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
        RecordedRun::read(home.path()).unwrap().robot.version_name()
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
    assert!((record.rows[1].ground_from_root.origin().x() - 0.2).abs() < 1e-12);
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
    let arm = record.ground_from_bodies(&record.rows[1])[1];
    assert!((arm.origin().x() - 0.4).abs() < 1e-12);
    assert!((arm.rotate(glam::DVec3::X) - glam::DVec3::Y).length() < 1e-6);
}

/// Each row has one thing wrong in its last line; two rows are left, and three contacts.
#[test]
fn rows_end_where_they_are_damaged() {
    let last = "0.0600,1,recovery,,300.000,0.000,50.000,1,0,0,0,0.3,2.0,0.7,1,2,3,4,1\n";
    assert!(ROWS.ends_with(last));
    let with = |from: &str, to: &str| ROWS.replace(from, to);
    let cases = [
        (
            ROWS[..ROWS.len() - 20].to_owned(),
            "the file ends within the line",
        ),
        (ROWS.replace(last, ""), "the table ends after 2 of 3 rows"),
        (
            with(",0.7,1,2,3,4,1", ""),
            "13 cells, where the header has 19",
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
        (
            with("2.0,0.7", "2.0,"),
            "A_nm is \"\", which is no value of a record",
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
            with("0.7,1,2,3,4,1", "0.7,1,2,3,4,70000"),
            "contacts is \"70000\", which is no value of a record",
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
        said(&[(RUN_FILE, Some(&run("0.02", "0.0")))]),
        said(&[(MODEL_FILE, None)]),
        said(&[(
            MODEL_FILE,
            Some(&MODEL.replace("\"parent\": 0", "\"parent\": 1")),
        )]),
        said(&[(MODEL_FILE, Some(&MODEL.replace("[0, 0, 1]", "[0, 0, 2]")))]),
        said(&[(MODEL_FILE, Some(&MODEL.replace("\"A\"", "\"B\"")))]),
        said(&[(ROWS_FILE, None)]),
        said(&[(ROWS_FILE, Some(&header))]),
        said(&[(ROWS_FILE, Some(&ROWS.replace("toe_n", "foot_n")))]),
        said(&[(CONTACTS_FILE, Some(""))]),
    ];
    let expected = [
        "RUN is not a recorded run: it has no run.json",
        "RUN/run.json: EOF while parsing an object at line 1 column 1",
        "RUN is not a recorded run: its run.json does not say that prone wrote it",
        "RUN is not a recorded run, but a result of `prone optimize`; `prone crawl run --record` makes one",
        "RUN is not a recorded run, but a result of another command; `prone crawl run --record` makes one",
        "RUN is not a recorded run, but a result of `prone reproduce`; recorded runs in it: RUN/pulls/a",
        &format!(
            "RUN was recorded by prone 9.9.9, this is prone {version}, which reads its own records only: record it anew"
        ),
        &format!(
            "RUN was recorded by an earlier build of prone {version}, which did not say how many rows there are: record it anew"
        ),
        "RUN/run.json: row_step_s 0 is outside 0..10 s",
        "RUN is not a recorded run: it has no model.json",
        "RUN/model.json: body arm does not follow its parent",
        "RUN/model.json: the axis of A has not the length 1",
        "RUN/model.json: rows.csv has no joint B",
        "RUN is not a recorded run: it has no rows.csv",
        "RUN has no whole row: rows.csv, line 2: the table ends after 0 of 3 rows",
        "RUN/rows.csv has no column toe_n",
        "RUN/contacts.csv has no column body",
    ];
    assert_eq!(cases, expected);
    let nowhere = Recorded::read(Path::new("/no/such/run")).unwrap_err();
    assert_eq!(
        nowhere.to_string(),
        "/no/such/run is not a recorded run: there is no such folder"
    );
}

#[test]
fn what_needs_no_table_is_read_without() {
    let home = folder(&[(ROWS_FILE, None), (CONTACTS_FILE, None), (MODEL_FILE, None)]);
    let run = RecordedRun::read(home.path()).unwrap();
    assert_eq!((run.command, run.record.rows), (Command::Crawl, 3));
    assert_eq!(run.said("/options/steering").unwrap(), "none");
    assert_eq!(run.said("/options/scene_text"), None);
}

/// A message with the folder's own name in it.
fn without_place(message: &str, folder: &Path) -> String {
    message.replace(&folder.display().to_string(), "RUN")
}
