//! Cycle files: a whole crawl cycle, pull and recovery.
//!
//! ```toml
//! name = "low"
//! mapping = "original"     # these three as in a gait file
//! arm = "flat-forearm"
//! limits = "clamp"
//!
//! [pull]                   # the closed chain
//! duration_s = 1.0
//! [pull.knee]              # θ3, θ4 and α: curves as in a gait file
//! constant_deg = 20
//! [pull.hip]
//! constant_deg = 20
//! [pull.upper_arm]
//! linear_deg = [-30, -90]
//! [pull.joints.HeadPitch]  # joints outside the chain
//! linear_deg = [5, 28]
//!
//! [[recovery]]             # a waypoint; the other leg's and arm's joints mirror
//! name = "fold"
//! time_s = 0.5
//! easing = "smoothstep"    # or "linear"
//! joints_deg = { LHipPitch = -25, LKneePitch = 50 }
//!
//! [approach]               # from the last waypoint to the pull's first posture
//! time_s = 0.5
//!
//! [steering]
//! limit_deg = 12
//! spread = 1.0
//! joints = { LHipRoll = -1, RHipRoll = -1 }
//! ```

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;
use toml::Spanned;

use prone::gait::cycle::{Approach, Cycle, Easing, Steering, Waypoint};
use prone::gait::{Gait, LimitsPolicy, PhaseDuration};
use prone::mapping::{ArmMode, MappingVariant};

use crate::curve_table::{self, CurveTable};
use crate::error::{FileError, Source, line_and_column};
use crate::gait_file::{self, ArmName, LimitsName, MappingName};

/// Largest angle of a joint in a file, degrees.
const LARGEST_DEG: f64 = 360.0;
/// Largest turn command, degrees: beyond it the sines of the steering's geometry are not small.
const LARGEST_TURN_DEG: f64 = 30.0;
/// Largest factor of a turn command.
const LARGEST_FACTOR: f64 = 10.0;

/// Whether a text is that of a cycle file and not of a gait file: it has a `[pull]`.
pub fn is_cycle(text: &str) -> bool {
    toml::from_str::<toml::Table>(text).is_ok_and(|table| table.contains_key("pull"))
}

/// Reads a cycle from the text of a cycle file; `file` is the name that errors carry.
pub fn parse(file: &str, text: &str) -> Result<Cycle, FileError> {
    let source = Source { file, text };
    let table: CycleFile = source.parse()?;
    gait_file::check_name(source, &table.name)?;
    let pull = table.pull;
    let seconds = *pull.duration_s.get_ref();
    let pull_duration =
        PhaseDuration::new(seconds).map_err(|error| source.error(pull.duration_s.span(), error))?;
    let mut company = BTreeMap::new();
    for (joint, curve) in pull.joints {
        company.insert(joint, curve.read(source)?);
    }
    let mut recovery = Vec::with_capacity(table.recovery.len());
    for waypoint in table.recovery {
        recovery.push(source.waypoint(waypoint)?);
    }
    Ok(Cycle {
        rest: 0.0,
        pull: Gait {
            name: table.name.into_inner(),
            description: table.description,
            knee: pull.knee.read(source)?,
            hip: pull.hip.read(source)?,
            upper_arm: pull.upper_arm.read(source)?,
            mapping: table.mapping,
            arm: table.arm,
            limits: table.limits,
        },
        pull_duration,
        company,
        recovery,
        approach: source.approach(&table.approach.time_s, table.approach.easing)?,
        steering: match table.steering {
            None => None,
            Some(steering) => Some(source.steering(steering)?),
        },
    })
}

/// The line, from 1, on which a part of a cycle stands in the text of its file: a waypoint's name,
/// or the table of `pull`, `steering` or `extension`, which `[approach]` leads to. Nothing where the
/// file has no such part.
pub fn line_of(text: &str, place: &str) -> Option<usize> {
    let table: CycleFile = toml::from_str(text).ok()?;
    let waypoints = table.recovery.iter();
    let mut names = waypoints.map(|waypoint| &waypoint.name);
    if let Some(name) = names.find(|name| name.get_ref() == place) {
        return Some(line_and_column(text, name.span().start).0);
    }
    let header = match place {
        "extension" => "[approach",
        "pull" => "[pull",
        "steering" => "[steering",
        _ => return None,
    };
    let mut lines = text.lines();
    let index = lines.position(|line| line.trim_start().starts_with(header))?;
    Some(index + 1)
}

/// A cycle as the text of a cycle file: angles in radians with every digit, so that [`parse`]
/// gives the same cycle. `header` becomes comment lines at the top.
pub fn write(cycle: &Cycle, header: &str) -> String {
    let mut text = gait_file::write_head(&cycle.pull, header);
    // Writing to a string cannot fail.
    let _ = write!(
        text,
        "\n[pull]\nduration_s = {:?}\n",
        cycle.pull_duration.seconds()
    );
    for (key, curve) in gait_file::curves(&cycle.pull) {
        let _ = write!(text, "\n[pull.{key}]\n{}\n", curve_table::write(curve));
    }
    for (joint, curve) in &cycle.company {
        let _ = write!(
            text,
            "\n[pull.joints.{joint}]\n{}\n",
            curve_table::write(curve)
        );
    }
    for waypoint in &cycle.recovery {
        let Approach { seconds, easing } = waypoint.approach;
        let _ = write!(
            text,
            "\n[[recovery]]\nname = {}\ntime_s = {seconds:?}\neasing = \"{}\"\njoints_rad = {}\n",
            gait_file::quoted(&waypoint.name),
            easing.name(),
            inline(&waypoint.joints)
        );
    }
    let Approach { seconds, easing } = cycle.approach;
    let _ = write!(
        text,
        "\n[approach]\ntime_s = {seconds:?}\neasing = \"{}\"\n",
        easing.name()
    );
    if let Some(steering) = &cycle.steering {
        let _ = write!(
            text,
            "\n[steering]\nlimit_rad = {:?}\nspread = {:?}\njoints = {}\n",
            steering.limit,
            steering.spread,
            inline(&steering.joints)
        );
    }
    text
}

fn inline(numbers: &BTreeMap<String, f64>) -> String {
    let pairs: Vec<_> = numbers
        .iter()
        .map(|(key, value)| format!("{key} = {value:?}"))
        .collect();
    format!("{{ {} }}", pairs.join(", "))
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CycleFile {
    name: Spanned<String>,
    #[serde(default)]
    description: String,
    #[serde(default, with = "MappingName")]
    mapping: MappingVariant,
    #[serde(default, with = "ArmName")]
    arm: ArmMode,
    #[serde(default, with = "LimitsName")]
    limits: LimitsPolicy,
    pull: PullTable,
    #[serde(default)]
    recovery: Vec<WaypointTable>,
    approach: ApproachTable,
    steering: Option<SteeringTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct PullTable {
    duration_s: Spanned<f64>,
    knee: CurveTable,
    hip: CurveTable,
    upper_arm: CurveTable,
    #[serde(default)]
    joints: BTreeMap<String, CurveTable>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct WaypointTable {
    name: Spanned<String>,
    time_s: Spanned<f64>,
    #[serde(default, with = "EasingName")]
    easing: Easing,
    #[serde(default)]
    joints_deg: BTreeMap<String, Spanned<f64>>,
    #[serde(default)]
    joints_rad: BTreeMap<String, Spanned<f64>>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct ApproachTable {
    time_s: Spanned<f64>,
    #[serde(default, with = "EasingName")]
    easing: Easing,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct SteeringTable {
    limit_deg: Option<Spanned<f64>>,
    limit_rad: Option<Spanned<f64>>,
    spread: Spanned<f64>,
    #[serde(default)]
    joints: BTreeMap<String, Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(remote = "Easing", rename_all = "kebab-case")]
enum EasingName {
    Smoothstep,
    Linear,
}

impl Source<'_> {
    fn waypoint(self, table: WaypointTable) -> Result<Waypoint, FileError> {
        if table.name.get_ref().trim().is_empty() {
            return Err(self.error(table.name.span(), "a waypoint needs a name"));
        }
        let mut joints = BTreeMap::new();
        for (joint, angle) in table.joints_deg {
            let degrees = self.within(&angle, &joint, LARGEST_DEG)?;
            joints.insert(joint, degrees.to_radians());
        }
        for (joint, angle) in table.joints_rad {
            let radians = self.within(&angle, &joint, LARGEST_DEG.to_radians())?;
            if joints.insert(joint.clone(), radians).is_some() {
                let twice = format!("{joint} is given twice, in degrees and in radians");
                return Err(self.error(angle.span(), twice));
            }
        }
        Ok(Waypoint {
            name: table.name.into_inner(),
            approach: self.approach(&table.time_s, table.easing)?,
            joints,
        })
    }

    fn approach(self, time: &Spanned<f64>, easing: Easing) -> Result<Approach, FileError> {
        let seconds = *time.get_ref();
        let (least, most) = Cycle::STRETCH_SECONDS;
        if !(least..=most).contains(&seconds) {
            let message = format!("time_s must be {least} to {most} s, not {seconds}");
            return Err(self.error(time.span(), message));
        }
        Ok(Approach { seconds, easing })
    }

    fn steering(self, table: SteeringTable) -> Result<Steering, FileError> {
        let limit = match (table.limit_deg, table.limit_rad) {
            (Some(degrees), None) => self
                .positive(&degrees, "limit_deg", LARGEST_TURN_DEG)?
                .to_radians(),
            (None, Some(radians)) => {
                self.positive(&radians, "limit_rad", LARGEST_TURN_DEG.to_radians())?
            }
            _ => {
                let span = table.spread.span();
                let message = "[steering] needs one of limit_deg and limit_rad";
                return Err(self.error(span, message));
            }
        };
        let mut joints = BTreeMap::new();
        for (joint, factor) in table.joints {
            let value = self.within(&factor, &joint, LARGEST_FACTOR)?;
            joints.insert(joint, value);
        }
        Ok(Steering {
            limit,
            spread: self.within(&table.spread, "spread", LARGEST_FACTOR)?,
            joints,
        })
    }

    fn within(self, number: &Spanned<f64>, what: &str, largest: f64) -> Result<f64, FileError> {
        let value = *number.get_ref();
        if (-largest..=largest).contains(&value) {
            return Ok(value);
        }
        let message = format!("{what} must be within -{largest}..{largest}, not {value}");
        Err(self.error(number.span(), message))
    }

    fn positive(self, number: &Spanned<f64>, what: &str, largest: f64) -> Result<f64, FileError> {
        let value = *number.get_ref();
        if value > 0.0 && value <= largest {
            return Ok(value);
        }
        let message = format!("{what} must be above 0, up to {largest}, not {value}");
        Err(self.error(number.span(), message))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shipped;

    #[test]
    fn what_is_written_reads_as_the_same_cycle() {
        for name in shipped::cycle_names() {
            let cycle = shipped::cycle(name).unwrap().unwrap();
            let text = write(&cycle, "a header");
            assert!(text.starts_with("# a header\n"));
            assert_eq!(parse("again.toml", &text).unwrap(), cycle, "{name}");
        }
    }

    #[test]
    fn parts_have_their_lines() {
        let text = &shipped::gait_file("low-175").unwrap().text;
        for (place, line) in [
            ("pull", "[pull]"),
            ("steering", "[steering]"),
            ("extension", "[approach]"),
            ("lift", "name = \"lift\""),
        ] {
            let index = line_of(text, place).unwrap() - 1;
            assert_eq!(text.lines().nth(index), Some(line));
        }
        assert_eq!(line_of(text, "jump"), None);
        assert_eq!(line_of("[", "pull"), None);
    }

    #[test]
    fn errors_name_line_value_and_bound() {
        let good = &shipped::gait_file("low-175").unwrap().text;
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
            assert!(good.contains(from), "{from}");
            let text = good.replacen(from, to, 1);
            let error = parse("cycle.toml", &text).unwrap_err();
            assert!(error.message.contains(message), "{error}");
            let line = text.lines().nth(error.line - 1).unwrap();
            assert!(
                line.contains(to.trim_matches(['[', ']'])),
                "{error} points at {line}"
            );
        }
    }
}
