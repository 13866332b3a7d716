use super::*;
use sample::{CONTACTS, ROWS, folder};

#[path = "../../../../prone-record/src/recorded/sample.rs"]
mod sample;

#[test]
fn a_whole_record_is_taken_whole() {
    let folder = folder(&[]);
    let run = read(folder.path()).unwrap();
    assert_eq!((run.title(), run.rows()), ("g · level", 3));
    assert_eq!(run.shortfalls(), [""; 0]);
    assert_eq!(
        run.stages,
        [(0, "pull".to_owned()), (2, "recovery".to_owned())]
    );
    assert_eq!(run.channels["y_mm"], Packed::Constant { constant: 0.0 });
    assert!(!run.channels.contains_key("stage"));
    assert_eq!(run.model["bodies"][0]["position"][0], 0.1);
    let contacts = run.contacts.unwrap();
    assert_eq!(contacts.counts, pack::counts([1, 2, 1]));
    assert_eq!(contacts.bodies, pack::counts([1, 0, 1, 1]));
    assert_eq!(contacts.others, pack::counts([0, 1, 0, 0]));
    assert_eq!(contacts.names, ["floor", "plate 1"]);
    assert_eq!(
        contacts.channels["fy_n"],
        Packed::Constant { constant: 5.0 }
    );
    // What a record does not say is not among what the page says of it.
    let facts: Vec<&str> = run.facts.iter().map(|(name, _)| *name).collect();
    assert_eq!(
        facts,
        [
            "gait",
            "robot",
            "scene",
            "steering",
            "recorded on",
            "recorded by"
        ]
    );
}

#[test]
fn what_stands_before_a_break_is_shown_and_said() {
    let cut = folder(&[("rows.csv", Some(&ROWS[..ROWS.len() - 4]))]);
    let run = read(cut.path()).unwrap();
    assert_eq!(run.rows(), 2);
    assert_eq!(
        run.shortfalls(),
        ["rows.csv, line 4: the file ends within the line; 2 of 3 instants are left, up to 0.04 s"]
    );
    assert_eq!(run.contacts.unwrap().counts, pack::counts([1, 2]));
    // Rows without their contacts have none to show.
    let cut = folder(&[("contacts.csv", Some(&CONTACTS[..CONTACTS.len() - 3]))]);
    let run = read(cut.path()).unwrap();
    assert_eq!((run.rows(), run.shortfalls().len()), (3, 1));
    assert_eq!(run.contacts.unwrap().counts, pack::counts([1, 2, 0]));
    let missing = folder(&[("contacts.csv", None)]);
    let run = read(missing.path()).unwrap();
    assert_eq!((run.rows(), run.shortfalls().len()), (3, 1));
    assert_eq!(run.contacts, None);
}
