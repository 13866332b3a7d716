//! Journals that are torn, foreign, damaged or in use.

use proptest::prelude::*;

use super::*;

fn identity(source: &str) -> Identity {
    let pairs = [("source", source), ("step", "2.5 deg")];
    pairs
        .map(|(name, value)| (name.to_owned(), value.to_owned()))
        .into()
}

fn held(number: f64) -> Entry {
    Entry::Held {
        torques: JointTorques::from_array([number, -number, 0.1 + 0.2, 1e-300]),
        contacts: ContactForces::from_array([number.abs(), 0.0, 1.0 / 3.0, 5e-324]),
    }
}

/// Opens the journal of `statics` with ten rows.
fn open(path: &Path, opening: Opening) -> Result<(Journal, Vec<Option<Entry>>), JournalError> {
    Journal::open(path, &identity("statics"), 10, opening)
}

fn refusal(path: &Path, opening: Opening) -> String {
    let home = path.parent().unwrap().display().to_string();
    let refused = open(path, opening).unwrap_err().to_string();
    refused.replace(&home, "home")
}

/// A journal with rows 3, 1 and 7.
fn filled(path: &Path) {
    let (mut journal, entries) = open(path, Opening::Resume).unwrap();
    assert_eq!(entries, [None; 10]);
    journal.append(3, &held(0.7)).unwrap();
    journal.append(1, &Entry::Masked(Mask::Open)).unwrap();
    journal.append(7, &Entry::Masked(Mask::Failed)).unwrap();
    journal.flush().unwrap();
}

fn rows(entries: &[Option<Entry>]) -> Vec<usize> {
    let rows = entries.iter().enumerate();
    rows.filter_map(|(row, entry)| entry.map(|_| row)).collect()
}

#[test]
fn rows_are_taken_over_and_discarded_on_request() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("map.csv.partial");
    filled(&path);
    let (journal, entries) = open(&path, Opening::Resume).unwrap();
    assert_eq!(entries[3], Some(held(0.7)));
    assert_eq!(entries[1], Some(Entry::Masked(Mask::Open)));
    assert_eq!(entries[7], Some(Entry::Masked(Mask::Failed)));
    assert_eq!(rows(&entries), [1, 3, 7]);
    drop(journal);
    let (journal, entries) = open(&path, Opening::Restart).unwrap();
    assert_eq!(rows(&entries), [0; 0]);
    journal.remove().unwrap();
    assert!(!path.exists());
}

proptest! {
    #[test]
    fn identity_numbers_keep_their_bits(numbers in prop::array::uniform8(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO)) {
        let home = tempfile::tempdir().unwrap();
        let path = home.path().join("journal");
        let [a, b, c, d, forces @ ..] = numbers;
        let entry = Entry::Held {
            torques: JointTorques::from_array([a, b, c, d]),
            contacts: ContactForces::from_array(forces),
        };
        let (mut journal, _) = open(&path, Opening::Resume).unwrap();
        journal.append(5, &entry).unwrap();
        journal.flush().unwrap();
        drop(journal);
        let (_journal, entries) = open(&path, Opening::Resume).unwrap();
        let Some(Entry::Held { torques, contacts }) = entries[5] else { panic!("no row") };
        let read = torques.to_array().into_iter().chain(contacts.to_array());
        for (read, written) in read.zip(numbers) {
            prop_assert_eq!(read.to_bits(), written.to_bits());
        }
    }
}

/// Killed anywhere: whole lines count, and the next row is not glued to a torn one.
#[test]
fn limit_a_torn_journal_loses_its_last_line_only() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("journal");
    filled(&path);
    let whole = fs::read(&path).unwrap();
    let ends: Vec<usize> = (0..whole.len()).filter(|at| whole[*at] == b'\n').collect();
    for length in 0..=whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        let (mut journal, entries) = open(&path, Opening::Resume).unwrap();
        let lines = ends.iter().filter(|end| **end < length).count();
        assert_eq!(
            rows(&entries).len(),
            lines.saturating_sub(1),
            "{length} bytes"
        );
        journal.append(9, &held(2.0)).unwrap();
        journal.flush().unwrap();
        drop(journal);
        let (_journal, entries) = open(&path, Opening::Resume).unwrap();
        assert_eq!(entries[9], Some(held(2.0)), "{length} bytes");
    }
}

#[test]
fn limit_rows_are_on_disk_batch_by_batch() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("journal");
    let (mut journal, _) = open(&path, Opening::Resume).unwrap();
    let lines = || fs::read_to_string(&path).unwrap().lines().count();
    assert_eq!(lines(), 1);
    for appended in 1..=BATCH {
        journal.append(0, &held(1.0)).unwrap();
        let expected = if appended == BATCH { 1 + BATCH } else { 1 };
        assert_eq!(lines(), expected);
    }
}

#[test]
fn limit_another_build_s_journal_is_refused_unless_restarted() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("journal");
    drop(Journal::open(&path, &identity("simulation"), 10, Opening::Resume).unwrap());
    assert_eq!(
        refusal(&path, Opening::Resume),
        "home/journal is the journal of another build, with source simulation in place of statics; take that one up, or discard it with --restart"
    );
    assert!(open(&path, Opening::Restart).is_ok());
}

#[test]
fn limit_strangers_are_never_overwritten() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    fs::write(at("notes"), "# prone torque-map notes\n").unwrap();
    std::os::unix::fs::symlink("notes", at("link")).unwrap();
    fs::create_dir(at("folder")).unwrap();
    for opening in [Opening::Resume, Opening::Restart] {
        for name in ["notes", "link", "folder"] {
            let expected = format!(
                "home/{name} is no journal of a torque map, and would be overwritten: move it away"
            );
            assert_eq!(refusal(&at(name), opening), expected);
        }
    }
    assert_eq!(
        fs::read_to_string(at("notes")).unwrap(),
        "# prone torque-map notes\n"
    );
    assert_eq!(
        refusal(&at("none/journal"), Opening::Resume),
        "cannot open home/journal: No such file or directory (os error 2)"
    );
}

#[test]
fn limit_damaged_lines_are_named() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("journal");
    for line in [
        "10,open",
        "-1,open",
        "1,mirrored",
        "1",
        "",
        "1,1,2,3,4,5,6,7",
        "1,1,2,3,4,5,6,7,NaN",
        "\0\0\0",
    ] {
        drop(fs::remove_file(&path));
        filled(&path);
        let text = fs::read_to_string(&path).unwrap();
        fs::write(&path, format!("{text}{line}\n4,open\n")).unwrap();
        assert_eq!(
            refusal(&path, Opening::Resume),
            format!(
                "home/journal, line 5: `{line}` is no row of this build; --restart discards the journal"
            )
        );
        assert!(open(&path, Opening::Restart).is_ok());
    }
    fs::write(&path, format!("{MAGIC}not json\n")).unwrap();
    assert!(refusal(&path, Opening::Resume).starts_with("home/journal, line 1: "));
}

#[test]
fn limit_a_living_build_keeps_its_journal() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("journal");
    let living = open(&path, Opening::Resume).unwrap();
    for opening in [Opening::Resume, Opening::Restart] {
        assert_eq!(
            refusal(&path, opening),
            "another build is writing home/journal"
        );
    }
    drop(living);
    assert!(open(&path, Opening::Resume).is_ok());
}
