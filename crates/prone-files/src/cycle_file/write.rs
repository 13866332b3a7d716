//! A cycle as the text of a cycle file.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use prone::gait::cycle::{Approach, Cycle, Pull};

use crate::curve_table;
use crate::gait_file::{self, Head};

/// A cycle as the text of a cycle file: angles in radians with every digit, so that [`super::parse`]
/// gives the same cycle. `header` becomes comment lines at the top.
pub fn write(cycle: &Cycle, header: &str) -> String {
    let head = Head {
        name: &cycle.name,
        description: &cycle.description,
        chain: cycle.pull.as_ref().map(|pull| (pull.mapping, pull.arm)),
        limits: cycle.limits,
    };
    let mut text = gait_file::write_head(&head, header);
    if let Some(pull) = &cycle.pull {
        write_pull(&mut text, pull);
    }
    let key = if cycle.pull.is_some() {
        "recovery"
    } else {
        "waypoint"
    };
    // Writing to a string cannot fail.
    for waypoint in &cycle.waypoints {
        let Approach { seconds, easing } = waypoint.approach;
        let _ = write!(
            text,
            "\n[[{key}]]\nname = {}\ntime_s = {seconds:?}\neasing = \"{}\"\njoints_rad = {}\n",
            gait_file::quoted(&waypoint.name),
            easing.name(),
            inline(&waypoint.joints)
        );
        if !waypoint.turn.is_empty() {
            let _ = writeln!(text, "turn = {}", inline(&waypoint.turn));
        }
        if !waypoint.shift.is_empty() {
            let _ = writeln!(text, "shift = {}", inline(&waypoint.shift));
        }
    }
    if let Some(pull) = &cycle.pull {
        let Approach { seconds, easing } = pull.approach;
        let _ = write!(
            text,
            "\n[approach]\ntime_s = {seconds:?}\neasing = \"{}\"\n",
            easing.name()
        );
    }
    if let Some(steering) = &cycle.steering {
        let _ = write!(text, "\n[steering]\nlimit_rad = {:?}\n", steering.limit);
        if steering.shift_limit > 0.0 {
            let _ = writeln!(text, "shift_limit_rad = {:?}", steering.shift_limit);
        }
        if steering.dead_band > 0.0 {
            let _ = writeln!(text, "dead_band_rad = {:?}", steering.dead_band);
        }
        if cycle.pull.is_some() {
            let _ = write!(
                text,
                "spread = {:?}\njoints = {}\n",
                steering.spread,
                inline(&steering.joints)
            );
        }
    }
    text
}

fn write_pull(text: &mut String, pull: &Pull) {
    let _ = write!(
        text,
        "\n[pull]\nduration_s = {:?}\n",
        pull.duration.seconds()
    );
    for (key, curve) in [
        ("knee", &pull.knee),
        ("hip", &pull.hip),
        ("upper_arm", &pull.upper_arm),
    ] {
        let _ = write!(text, "\n[pull.{key}]\n{}\n", curve_table::write(curve));
    }
    for (joint, curve) in &pull.company {
        let _ = write!(
            text,
            "\n[pull.joints.{joint}]\n{}\n",
            curve_table::write(curve)
        );
    }
}

fn inline(numbers: &BTreeMap<String, f64>) -> String {
    let pairs: Vec<_> = numbers
        .iter()
        .map(|(key, value)| format!("{key} = {value:?}"))
        .collect();
    format!("{{ {} }}", pairs.join(", "))
}
