//! Unfinished work that is torn, foreign, damaged, old or in use.

use std::collections::BTreeMap;

use proptest::prelude::*;
use serde_json::json;

use super::*;

type Part = (usize, [f64; 2]);
type State = Vec<u64>;

fn plan(source: &str) -> BTreeMap<&'static str, String> {
    BTreeMap::from([("source", source.to_owned()), ("robot", "é".to_owned())])
}

fn journal(result: &Path, opening: Opening) -> Result<(Journal<Part>, Vec<Part>), ResumptionError> {
    Journal::open(Work::TorqueMap, result, &plan("statics"), opening)
}

fn snapshot(
    result: &Path,
    plan: &Value,
    opening: Opening,
) -> Result<(Snapshot<State>, Earlier<State>), ResumptionError> {
    Snapshot::open(Work::Search, result, plan, opening)
}

fn refusal<T>(refused: Result<T, ResumptionError>, home: &Path) -> String {
    let refused = refused.err().unwrap().to_string();
    refused.replace(&home.display().to_string(), "home")
}

/// A part whose numbers have many digits.
fn part(index: usize) -> Part {
    (index, [1.0 / (index as f64 + 3.0), -0.0])
}

/// Does the parts of a piece of work that are missing: the result.
fn finish(result: &Path) -> Vec<Part> {
    let (mut journal, mut parts) = journal(result, Opening::Resume).unwrap();
    for index in 0..5 {
        if parts.iter().all(|(done, _)| *done != index) {
            journal.append(&part(index)).unwrap();
            parts.push(part(index));
        }
    }
    journal.flush().unwrap();
    parts.sort_by_key(|(index, _)| *index);
    parts
}

/// Killed anywhere: whole lines count, the next one is not glued to a torn one, and the end is the
/// same to the bit.
#[test]
fn identity_a_journal_cut_at_any_byte_ends_in_the_same_result() {
    let home = tempfile::tempdir().unwrap();
    let result = home.path().join("map.csv");
    let path = Work::TorqueMap.beside(&result);
    let whole = finish(&result);
    let bytes = fs::read(&path).unwrap();
    let text = |parts: &[Part]| serde_json::to_string(parts).unwrap();
    for length in 0..=bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        let lines = bytes[..length].iter().filter(|byte| **byte == b'\n');
        let (held, parts) = journal(&result, Opening::Resume).unwrap();
        assert_eq!(
            parts.len(),
            lines.count().saturating_sub(1),
            "{length} bytes"
        );
        drop(held);
        assert_eq!(text(&finish(&result)), text(&whole), "{length} bytes");
        assert_eq!(fs::read(&path).unwrap(), bytes, "{length} bytes");
    }
    let (held, parts) = journal(&result, Opening::Restart).unwrap();
    assert!(parts.is_empty());
    held.remove().unwrap();
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 0);
}

/// A snapshot is never torn by a kill; what a machine that went down left is told from nothing.
#[test]
fn identity_a_snapshot_cut_at_any_byte_is_whole_or_nothing() {
    let home = tempfile::tempdir().unwrap();
    let result = home.path().join("deep/result/");
    let plan = json!({ "seed": 1, "time": 0.1 + 0.2 });
    let (mut kept, earlier) = snapshot(&result, &plan, Opening::Resume).unwrap();
    assert_eq!(earlier, Earlier::Nothing);
    kept.write(&vec![1, 2]).unwrap();
    kept.write(&vec![3, 5, 8]).unwrap();
    let path = kept.path().to_owned();
    assert_eq!(path, home.path().join("deep/result.checkpoint.json"));
    drop(kept);
    let bytes = fs::read(&path).unwrap();
    for length in 0..=bytes.len() {
        fs::write(&path, &bytes[..length]).unwrap();
        let (_held, earlier) = snapshot(&result, &plan, Opening::Resume).unwrap();
        let expected = if length == bytes.len() {
            Earlier::State(vec![3, 5, 8])
        } else {
            Earlier::Torn
        };
        assert_eq!(earlier, expected, "{length} bytes");
    }
    let (mut kept, earlier) = snapshot(&result, &plan, Opening::Restart).unwrap();
    assert_eq!(earlier, Earlier::Discarded { readable: true });
    assert_eq!(fs::read(&path).unwrap(), bytes, "until something is kept");
    kept.keep(&vec![1]).unwrap();
    kept.keep(&vec![2]).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert!(text.ends_with(",[1]]\n"), "{text}: too soon for another");
    kept.remove().unwrap();
    drop(kept);
    assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 0);
}

proptest! {
    #[test]
    fn identity_numbers_keep_their_bits(numbers in prop::array::uniform2(prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO)) {
        let home = tempfile::tempdir().unwrap();
        let result = home.path().join("map.csv");
        let (mut held, _) = journal(&result, Opening::Resume).unwrap();
        held.append(&(5, numbers)).unwrap();
        held.flush().unwrap();
        drop(held);
        let (_held, parts) = journal(&result, Opening::Resume).unwrap();
        for (read, written) in parts[0].1.into_iter().zip(numbers) {
            prop_assert_eq!(read.to_bits(), written.to_bits());
        }
    }
}

#[test]
fn limit_lines_are_on_disk_batch_by_batch() {
    let home = tempfile::tempdir().unwrap();
    let result = home.path().join("map.csv");
    let (mut held, _) = journal(&result, Opening::Resume).unwrap();
    let path = held.path().to_owned();
    let lines = || fs::read_to_string(&path).unwrap().lines().count();
    assert_eq!(lines(), 1);
    for appended in 1..=32 {
        held.append(&part(0)).unwrap();
        assert_eq!(lines(), if appended == 32 { 33 } else { 1 });
    }
}

#[test]
fn of_many_differences_the_most_telling_is_said() {
    let plan = |objective: &str, seed: u64, hip_mm: f64| {
        json!({
            "name": format!("best-{objective}"),
            "pricing": {"aim": {"clearance": {"hip_mm": hip_mm}, "objective": objective}},
            "seed": seed,
        })
    };
    let then = plan("torque", 1, 13.7);
    for (now, key) in [
        (plan("heat", 2, 12.1), "pricing.aim.objective"),
        (plan("torque", 2, 12.1), "seed"),
        (plan("torque", 1, 12.1), "pricing.aim.clearance.hip_mm"),
    ] {
        assert_eq!(difference(&then, &now).unwrap().0, key);
    }
    assert_eq!(difference(&then, &then), None);
}

#[test]
fn limit_another_plan_is_refused_with_what_differs() {
    let home = tempfile::tempdir().unwrap();
    let result = home.path().join("map.csv");
    drop(Journal::<Part>::open(Work::TorqueMap, &result, &plan("map"), Opening::Resume).unwrap());
    assert_eq!(
        refusal(journal(&result, Opening::Resume), home.path()),
        "home/map.csv.partial is the journal of another torque-map build: source was \"map\", and is \"statics\" now; --restart discards it"
    );
    assert!(journal(&result, Opening::Restart).is_ok());

    let result = home.path().join("result");
    let then = json!({ "seed": 1, "pricing": { "objective": "torque", "per": "phase" } });
    let (mut kept, _) = snapshot(&result, &then, Opening::Resume).unwrap();
    kept.write(&vec![1]).unwrap();
    drop(kept);
    for (now, differs) in [
        (
            json!({ "seed": 1, "pricing": { "objective": "heat", "per": "phase" } }),
            "pricing.objective was \"torque\", and is \"heat\" now",
        ),
        (
            json!({ "seed": 1 }),
            "pricing was {\"objective\":\"torque\",\"per\":\"phase\"}, and is null now",
        ),
        (
            json!({ "seed": 1, "pricing": { "objective": "torque", "per": "phase" }, "runs": 2 }),
            "runs was null, and is 2 now",
        ),
    ] {
        assert_eq!(
            refusal(snapshot(&result, &now, Opening::Resume), home.path()),
            format!(
                "home/result.checkpoint.json is the checkpoint of another search: {differs}; without --resume it is replaced"
            )
        );
    }
    // A file that was given the name of one of the other kind.
    let path = Work::Search.beside(&result);
    fs::copy(&path, home.path().join("map.csv.partial")).unwrap();
    assert_eq!(
        refusal(
            journal(&home.path().join("map.csv"), Opening::Resume),
            home.path()
        ),
        "home/map.csv.partial is the journal of another torque-map build: work was \"search\", and is \"torque-map build\" now; --restart discards it"
    );
}

#[test]
fn limit_strangers_are_never_overwritten() {
    let home = tempfile::tempdir().unwrap();
    let at = |name: &str| home.path().join(name);
    let words = "{\"plan\":{\"program\":\"jog\"},\"search\":[]}\n";
    for ending in ["checkpoint.json", "partial"] {
        fs::write(at(&format!("notes.{ending}")), words).unwrap();
        std::os::unix::fs::symlink("notes", at(&format!("link.{ending}"))).unwrap();
        fs::create_dir(at(&format!("folder.{ending}"))).unwrap();
    }
    for opening in [Opening::Resume, Opening::Restart] {
        for name in ["notes", "link", "folder"] {
            assert_eq!(
                refusal(journal(&at(name), opening), home.path()),
                format!(
                    "home/{name}.partial is no journal of prone, and would be overwritten: move it away"
                )
            );
            assert_eq!(
                refusal(snapshot(&at(name), &json!({}), opening), home.path()),
                format!(
                    "home/{name}.checkpoint.json is no checkpoint of prone, and would be overwritten: move it away"
                )
            );
        }
    }
    for ending in ["checkpoint.json", "partial"] {
        let notes = at(&format!("notes.{ending}"));
        assert_eq!(fs::read_to_string(notes).unwrap(), words);
    }
    assert_eq!(fs::read_dir(home.path()).unwrap().count(), 6);
}

#[test]
fn limit_other_formats_are_refused_by_name_and_can_be_discarded() {
    let home = tempfile::tempdir().unwrap();
    let result = home.path().join("result");
    let journals = [
        (
            "# prone torque-map journal 1 {\"alpha\":\"-90..-30 deg\"}\n18,open\n",
            "the first format of journals",
        ),
        (
            "{\"format\":\"prone unfinished work\",\"format_version\":2,\"plan\":{}}\n",
            "format 2",
        ),
    ];
    for (text, format) in journals {
        fs::write(Work::TorqueMap.beside(&result), text).unwrap();
        assert_eq!(
            refusal(journal(&result, Opening::Resume), home.path()),
            format!(
                "home/result.partial is in {format}, which this version of prone cannot go on from: finish it with the version that wrote it; --restart discards it"
            )
        );
        assert!(journal(&result, Opening::Restart).is_ok());
    }
    let path = Work::Search.beside(&result);
    let old =
        "{\"plan\":{\"command\":\"optimize\",\"program\":\"prone\"},\"search\":{\"runs\":[]}}";
    fs::write(&path, old).unwrap();
    assert_eq!(
        refusal(snapshot(&result, &json!({}), Opening::Resume), home.path()),
        "home/result.checkpoint.json is in the first format of checkpoints, which this version of prone cannot go on from: finish it with the version that wrote it; without --resume it is replaced"
    );
    let (_kept, earlier) = snapshot(&result, &json!({}), Opening::Restart).unwrap();
    assert_eq!(earlier, Earlier::Discarded { readable: false });
    assert_eq!(fs::read_to_string(&path).unwrap(), old);
}

#[test]
fn limit_damaged_lines_are_named() {
    let home = tempfile::tempdir().unwrap();
    let result = home.path().join("map.csv");
    let path = Work::TorqueMap.beside(&result);
    finish(&result);
    let text = fs::read_to_string(&path).unwrap();
    let third = text.lines().nth(2).unwrap();
    for line in [
        "",
        "\0\0\0",
        "18,open",
        &third.replace("0.25", "0.35"),
        &third.replace("]]]", "]]"),
        &format!("[\"{}\",7]", checksum("7")),
    ] {
        assert_ne!(line, third);
        fs::write(&path, text.replace(third, line)).unwrap();
        assert_eq!(
            refusal(journal(&result, Opening::Resume), home.path()),
            format!(
                "home/map.csv.partial, line 3: `{line}` is damaged, or no part of this torque-map build; --restart discards it"
            )
        );
    }
    assert!(journal(&result, Opening::Restart).is_ok());
    fs::write(&path, format!("{MAGIC}1,no json\n")).unwrap();
    let refused = refusal(journal(&result, Opening::Resume), home.path());
    assert!(
        refused.starts_with("home/map.csv.partial, line 1: "),
        "{refused}"
    );
}

#[test]
fn limit_two_writers_at_once() {
    let home = tempfile::tempdir().unwrap();
    let result = home.path().join("result");
    let living = journal(&result, Opening::Resume).unwrap();
    for opening in [Opening::Resume, Opening::Restart] {
        assert_eq!(
            refusal(journal(&result, opening), home.path()),
            "another build of this map is at work: it holds home/result"
        );
    }
    drop(living);
    let living = snapshot(&result, &json!({}), Opening::Resume).unwrap();
    let linked = home.path().join("linked");
    fs::create_dir(&result).unwrap();
    std::os::unix::fs::symlink("result", &linked).unwrap();
    for name in [&result, &linked] {
        assert_eq!(
            refusal(snapshot(name, &json!({}), Opening::Restart), home.path()),
            "another search for this folder is at work: it holds home/result"
        );
    }
    drop(living);
    assert!(snapshot(&linked, &json!({}), Opening::Resume).is_ok());
}

#[test]
fn limit_a_journal_needs_its_folder() {
    let home = tempfile::tempdir().unwrap();
    let lost = refusal(
        journal(&home.path().join("none/map.csv"), Opening::Resume),
        home.path(),
    );
    assert_eq!(
        lost,
        "cannot lock home/none/map.csv: No such file or directory (os error 2)"
    );
}

/// A finished work leaves its state in its result folder; unfinished work beside it comes first.
#[test]
fn a_finished_search_is_resumed_from_its_result_folder() {
    let home = tempfile::tempdir().unwrap();
    let result = home.path().join("result");
    fs::create_dir(&result).unwrap();
    let statics = json!({ "source": "statics" });
    let path = result.join(STATE_FILE);
    let done: State = vec![1, 2, 3];
    fs::write(&path, text(Work::Search, &statics, &done).unwrap()).unwrap();
    let earlier = |plan: &Value, opening| snapshot(&result, plan, opening).map(|(_, it)| it);
    let found = earlier(&statics, Opening::Resume).unwrap();
    assert_eq!(found, Earlier::State(done.clone()));
    // Begun anew, it does not count.
    let found = earlier(&statics, Opening::Restart).unwrap();
    assert_eq!(found, Earlier::Nothing);
    let refused = refusal(
        earlier(&json!({ "source": "dynamics" }), Opening::Resume),
        home.path(),
    );
    let said = "source was \"statics\", and is \"dynamics\" now";
    assert!(refused.contains(said), "{refused}");
    assert!(refused.contains(STATE_FILE), "{refused}");
    let (mut unfinished, _) = snapshot(&result, &statics, Opening::Restart).unwrap();
    unfinished.write(&vec![4]).unwrap();
    drop(unfinished);
    let found = earlier(&statics, Opening::Resume).unwrap();
    assert_eq!(found, Earlier::State(vec![4]));
    Work::Search.beside(&result).metadata().unwrap();
    fs::remove_file(Work::Search.beside(&result)).unwrap();
    // A changed number is noticed there too.
    let kept = fs::read_to_string(&path).unwrap();
    fs::write(&path, kept.replace("[1,2,3]", "[1,2,4]")).unwrap();
    let refused = refusal(earlier(&statics, Opening::Resume), home.path());
    assert!(refused.contains("line 2"), "{refused}");
    // So is what was cut: beginning anew would replace the result.
    for cut in [0, 10, kept.len() - 5] {
        fs::write(&path, &kept[..cut]).unwrap();
        let refused = refusal(earlier(&statics, Opening::Resume), home.path());
        assert!(refused.contains("is damaged"), "{refused}");
    }
}
