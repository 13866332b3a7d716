//! What the program computes today, to the ninth digit: the cheap part of `.ci/values.py`, which
//! compares everything to the last one.
//!
//! Each file in `values/` says what is typed, and what then stands where in the printed JSON. The
//! numbers were printed by the build that the commit of each file was made with. A change that moves one on
//! purpose replaces it here, and says in the changelog why it moved.

mod program;

use std::path::Path;

use serde_json::{Map, Value};

use program::prone;

/// Of the larger of the two numbers. Builds of both profiles print the same digits on one machine; the
/// C library of another may round a sine otherwise, which two cycles carry on. What a changed formula
/// moves is far more than that.
const TOLERANCE: f64 = 1e-9;

#[test]
fn regression_a_cycle_under_the_table() {
    assert_holds("crawl-hip-10-table");
}

#[test]
fn regression_two_cycles_held_to_their_heading_on_uneven_friction() {
    assert_holds("crawl-hip-10-held");
}

#[test]
fn regression_the_plan_of_the_nominal_gait() {
    assert_holds("gait-nominal");
}

#[test]
fn regression_the_plan_of_a_cycle() {
    assert_holds("gait-thesis-nominal");
}

#[test]
fn regression_heat_of_the_nominal_gait_by_statics() {
    assert_holds("cost-nominal-statics");
}

#[test]
fn regression_torque_of_the_optimal_gait_by_simulation() {
    assert_holds("cost-optimal-dynamics");
}

/// Types what a file says, and holds what is printed against its values.
fn assert_holds(name: &str) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/values/{name}.json"));
    let text = std::fs::read_to_string(&file).unwrap();
    let expected: Value = serde_json::from_str(&text).unwrap();
    let typed: Vec<&str> = expected["typed"].as_str().unwrap().split(' ').collect();
    let done = prone(&typed);
    let message = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{message}");
    let printed: Value = serde_json::from_slice(&done.stdout).unwrap();
    let different = differences(expected["values"].as_object().unwrap(), &printed);
    assert!(different.is_empty(), "{}", different.join("\n"));
}

/// The places, as JSON pointers, where another value is printed, with both.
fn differences(expected: &Map<String, Value>, printed: &Value) -> Vec<String> {
    assert!(!expected.is_empty(), "there is nothing to compare");
    let moved = expected.iter().filter_map(|(place, then)| {
        let now = printed.pointer(place).unwrap_or(&Value::Null);
        (!same(then, now)).then(|| format!("{place}: {then} | {now}"))
    });
    moved.collect()
}

fn same(then: &Value, now: &Value) -> bool {
    match (then.as_f64(), now.as_f64()) {
        (Some(a), Some(b)) => (a - b).abs() <= TOLERANCE * a.abs().max(b.abs()),
        _ => then == now,
    }
}

#[test]
fn a_number_that_has_moved_is_found() {
    let expected = |text: &str| serde_json::from_str::<Map<String, Value>>(text).unwrap();
    let printed: Value = serde_json::from_str(r#"{ "a": [1.000001, "x"], "b": null }"#).unwrap();
    let same = expected(r#"{ "/a/0": 1.0000010000001, "/a/1": "x", "/b": null }"#);
    assert!(differences(&same, &printed).is_empty());
    let moved = expected(r#"{ "/a/0": 1.000002, "/a/1": "y", "/c": 0 }"#);
    assert_eq!(differences(&moved, &printed).len(), 3);
}
