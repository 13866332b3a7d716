use prone::gait::LimitsPolicy;
use prone::gait::cycle::Easing;

use super::*;
use crate::shipped;

/// A cycle with a pull, which turns in it.
const PULLS: &str = r#"
name = "pulls"
limits = "clamp"

[pull]
duration_s = 1.0
[pull.knee]
constant_deg = 20
[pull.hip]
constant_deg = 20
[pull.upper_arm]
linear_deg = [-30, -90]

[[recovery]]
name = "fold"
time_s = 0.5
joints_deg = { LHipPitch = -25, LKneePitch = 50 }

[[recovery]]
name = "lift"
time_s = 0.4
easing = "linear"
joints_deg = { LShoulderPitch = -115 }

[approach]
time_s = 0.6

[steering]
limit_deg = 12
spread = 1.0
joints = { LHipRoll = -1, RHipRoll = -1 }
"#;

/// A cycle without one, which is steered at its waypoints.
const ROUND: &str = r#"
name = "round"
description = "goes round"

[[waypoint]]
time_s = 0.5
joints_deg = { LHipPitch = -25, LShoulderPitch = -30 }
turn = { LShoulderPitch = 0.5 }

[[waypoint]]
time_s = 0.4
easing = "linear"
joints_rad = { LShoulderPitch = -1.0 }

[[waypoint]]
name = "push"
time_s = 0.3
joints_deg = { LShoulderPitch = -60 }
turn = { LHipPitch = -0.25, LShoulderPitch = 0.125 }
shift = { LShoulderPitch = -2 }

[steering]
limit_deg = 12
shift_limit_deg = 6
dead_band_deg = 1.5
"#;

/// The example in the documentation of the format.
#[test]
fn the_documented_example_is_a_cycle() {
    let lines = include_str!("../cycle_file.rs").lines();
    let example = lines
        .map(|line| line.strip_prefix("//!").unwrap_or(line).trim_start())
        .skip_while(|line| *line != "```toml")
        .skip(1)
        .take_while(|line| *line != "```");
    let text = example.collect::<Vec<_>>().join("\n");
    let cycle = parse("example.toml", &text).unwrap();
    assert_eq!(cycle.name, "low");
    assert!(cycle.pull.is_some() && cycle.waypoints.iter().any(|it| !it.turn.is_empty()));
}

#[test]
fn what_is_written_reads_as_the_same_cycle() {
    let shipped = shipped::cycle_names().map(|name| shipped::cycle(name).unwrap().unwrap());
    let ours = [PULLS, ROUND].map(|text| parse("ours.toml", text).unwrap());
    for cycle in shipped.chain(ours) {
        let text = write(&cycle, "a header");
        assert!(text.starts_with("# a header\n"));
        assert!(is_cycle(&text));
        let again = parse("again.toml", &text).unwrap();
        assert_eq!(again, cycle, "{}", cycle.name);
        assert_eq!(write(&again, "a header"), text, "{}", cycle.name);
    }
}

#[test]
fn a_cycle_without_a_pull_is_what_its_file_says() {
    let cycle = parse("round.toml", ROUND).unwrap();
    assert_eq!((cycle.pull, cycle.limits), (None, LimitsPolicy::Refuse));
    let names: Vec<&str> = cycle.waypoints.iter().map(|it| it.name.as_str()).collect();
    assert_eq!(
        names,
        ["1", "2", "push"],
        "by their place where they have no name"
    );
    let [first, second, push] = &cycle.waypoints[..] else {
        panic!("three waypoints");
    };
    assert!((first.joints["LHipPitch"] + 25_f64.to_radians()).abs() < 1e-12);
    assert_eq!(second.approach.easing, Easing::Linear);
    assert!((second.joints["LShoulderPitch"] + 1.0).abs() < f64::EPSILON);
    assert!(second.turn.is_empty() && second.shift.is_empty());
    let factors = |map: &std::collections::BTreeMap<String, f64>| {
        map.iter()
            .map(|(joint, factor)| (joint.clone(), *factor))
            .collect::<Vec<_>>()
    };
    let named = |joint: &str, factor: f64| (joint.to_owned(), factor);
    assert_eq!(
        factors(&push.turn),
        [named("LHipPitch", -0.25), named("LShoulderPitch", 0.125)]
    );
    assert_eq!(factors(&push.shift), [named("LShoulderPitch", -2.0)]);
    let steering = cycle.steering.unwrap();
    for (found, degrees) in [
        (steering.limit, 12.0_f64),
        (steering.shift_limit, 6.0),
        (steering.dead_band, 1.5),
        (steering.spread, 0.0),
    ] {
        assert!((found - degrees.to_radians()).abs() < 1e-12, "{found}");
    }
}

#[test]
fn a_gait_is_no_cycle_and_a_cycle_is_one_with_or_without_a_pull() {
    assert!(is_cycle(PULLS) && is_cycle(ROUND));
    assert!(!is_cycle(&shipped::gait_file("nominal").unwrap().text));
    assert!(!is_cycle("[[waypoint"));
}

#[test]
fn parts_have_their_lines() {
    for (text, place, line) in [
        (PULLS, "pull", "[pull]"),
        (PULLS, "steering", "[steering]"),
        (PULLS, "extension", "[approach]"),
        (PULLS, "lift", "name = \"lift\""),
        (ROUND, "1", "time_s = 0.5"),
        (ROUND, "2", "time_s = 0.4"),
        (ROUND, "push", "name = \"push\""),
        (ROUND, "steering", "[steering]"),
    ] {
        let index = line_of(text, place).unwrap() - 1;
        assert_eq!(text.lines().nth(index), Some(line));
    }
    for (text, place) in [
        (PULLS, "jump"),
        (ROUND, "pull"),
        (ROUND, "extension"),
        (ROUND, "3"),
    ] {
        assert_eq!(line_of(text, place), None, "{place}");
    }
    assert_eq!(line_of("[", "pull"), None);
}

#[test]
fn errors_name_line_value_and_bound() {
    for (from, to, message) in [
        (
            "duration_s = 1.0",
            "duration_s = 0",
            "a phase of 0 s is outside 0.1..600 s",
        ),
        (
            "time_s = 0.5",
            "time_s = -0.5",
            "time_s must be 0.05 to 60 s, not -0.5",
        ),
        (
            "time_s = 0.5",
            "time_s = nan",
            "time_s must be 0.05 to 60 s, not NaN",
        ),
        (
            "limit_deg = 12",
            "limit_deg = 90",
            "limit_deg must be above 0, up to 30, not 90",
        ),
        (
            "spread = 1.0",
            "spread = inf",
            "spread must be within -10..10, not inf",
        ),
        ("[approach]", "[aproach]", "unknown field `aproach`"),
        (
            "LHipPitch = -25",
            "LHipPitch = -2500",
            "LHipPitch must be within -360..360, not -2500",
        ),
    ] {
        refused(PULLS, from, to, message);
    }
}

/// A text in which `from` is replaced is refused with that message, on the line of what replaced it.
#[track_caller]
fn refused(good: &str, from: &str, to: &str, message: &str) {
    assert!(good.contains(from), "{from}");
    let text = good.replacen(from, to, 1);
    let error = parse("cycle.toml", &text).unwrap_err();
    assert!(error.message.contains(message), "{error}");
    let line = text.lines().nth(error.line - 1).unwrap();
    let wrong = to.lines().last().unwrap_or_default();
    assert!(
        line.contains(wrong.trim_matches(['[', ']'])),
        "{error} points at {line}"
    );
}

#[test]
fn errors_in_waypoints_and_their_steering_name_line_value_and_bound() {
    for (from, to, message) in [
        (
            "turn = { LShoulderPitch = 0.5 }",
            "turn = { LShoulderPitch = 11 }",
            "LShoulderPitch must be within -10..10, not 11",
        ),
        (
            "shift = { LShoulderPitch = -2 }",
            "shift = { LShoulderPitch = nan }",
            "LShoulderPitch must be within -10..10, not NaN",
        ),
        (
            "shift_limit_deg = 6",
            "shift_limit_deg = -1",
            "shift_limit_deg must be 0 to 30, not -1",
        ),
        (
            "dead_band_deg = 1.5",
            "dead_band_deg = 31",
            "dead_band_deg must be 0 to 30, not 31",
        ),
        (
            "dead_band_deg = 1.5",
            "dead_band_rad = 0.1\ndead_band_deg = 1.5",
            "[steering] has both dead_band_deg and dead_band_rad",
        ),
        (
            "shift_limit_deg = 6",
            "shift_limit_rad = 0.1\nshift_limit_deg = 6",
            "[steering] has both shift_limit_deg and shift_limit_rad",
        ),
        (
            "name = \"push\"",
            "name = \" \"",
            "a waypoint's name is empty",
        ),
        (
            "joints_rad = { LShoulderPitch = -1.0 }",
            "joints_deg = { LShoulderPitch = -60 }\njoints_rad = { LShoulderPitch = -1.0 }",
            "LShoulderPitch is given twice, in degrees and in radians",
        ),
        (
            "dead_band_deg = 1.5",
            "spread = 1.0",
            "act in a pull, and there is no [pull]",
        ),
        (
            "dead_band_deg = 1.5",
            "joints = { LHipRoll = -1 }",
            "`turn` of a waypoint acts there",
        ),
        (
            "description = \"goes round\"",
            "mapping = \"original\"",
            "mapping belongs to a pull, and there is no [pull]",
        ),
        (
            "description = \"goes round\"",
            "arm = \"flat-forearm\"",
            "arm belongs to a pull, and there is no [pull]",
        ),
        (
            "[steering]",
            "[approach]\ntime_s = 0.6\n[steering]",
            "[approach] belongs to a pull, and there is no [pull]",
        ),
    ] {
        let text = ROUND.replacen(from, to, 1);
        assert_ne!(text, ROUND, "{from}");
        let error = parse("cycle.toml", &text).unwrap_err();
        assert!(error.message.contains(message), "{error}");
        // Each is on one of the lines that were put in.
        let line = text.lines().nth(error.line - 1).unwrap();
        assert!(to.lines().any(|it| it == line), "{error} points at {line}");
    }
}

/// Which kind of waypoint goes with a pull is said by what the file lacks or has too much.
#[test]
fn recoveries_lead_to_a_pull_and_waypoints_go_round() {
    let alone = ROUND.replace("[[waypoint]]", "[[recovery]]");
    let error = parse("cycle.toml", &alone).unwrap_err();
    assert_eq!(
        error.message,
        "[[recovery]] leads back to a pull, and there is no [pull]; a cycle without one has [[waypoint]]"
    );
    assert_eq!(alone.lines().nth(error.line - 1), Some("time_s = 0.5"));
    let both = PULLS.replace("[[recovery]]", "[[waypoint]]");
    let error = parse("cycle.toml", &both).unwrap_err();
    assert_eq!(
        error.message,
        "[[waypoint]] is for cycles without a [pull]; the way back to one is [[recovery]]"
    );
    assert_eq!(both.lines().nth(error.line - 1), Some("time_s = 0.5"));
    let (without, _) = PULLS.split_once("[approach]").unwrap();
    let error = parse("cycle.toml", without).unwrap_err();
    assert_eq!(
        error.message,
        "missing [approach]: it leads to the pull's first posture"
    );
    assert_eq!(
        without.lines().nth(error.line - 1),
        Some("duration_s = 1.0")
    );
}

/// What is steered has a limit.
#[test]
fn a_steered_waypoint_asks_for_steering() {
    let (without, _) = ROUND.split_once("[steering]").unwrap();
    let error = parse("cycle.toml", without).unwrap_err();
    assert_eq!(
        error.message,
        "waypoint 1 is steered; [steering] with its limit_deg is missing"
    );
    assert_eq!(
        without.lines().nth(error.line - 1),
        Some("name = \"round\"")
    );
}
