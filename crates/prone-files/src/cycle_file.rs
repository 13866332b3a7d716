//! Cycle files: a whole crawl cycle.
//!
//! ```toml
//! name = "low"
//! mapping = "original"     # these three as in a gait file; the first two belong to a pull
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
//! [pull.joints.HeadPitch]  # joints that move beside it
//! linear_deg = [5, 28]
//!
//! [[recovery]]             # a waypoint; the other leg's and arm's joints mirror
//! name = "fold"
//! time_s = 0.5
//! easing = "smoothstep"    # or "linear"
//! joints_deg = { LHipPitch = -25, LKneePitch = 50 }
//! turn = { LHipRoll = 0.2 } # what a turn command adds, times this
//! shift = { LShoulderPitch = -0.2 } # and what a shift command adds
//!
//! [approach]               # from the last waypoint to the pull's first posture
//! time_s = 0.5
//!
//! [steering]
//! limit_deg = 12
//! shift_limit_deg = 12     # where waypoints have a shift
//! dead_band_deg = 1        # what of a command friction swallows at the waypoints
//! spread = 1.0             # in the pull
//! joints = { LHipRoll = -1, RHipRoll = -1 }
//! ```
//!
//! A cycle without a pull has `[[waypoint]]`s instead of `[[recovery]]`, and no `[approach]`: it goes
//! round through its waypoints, and the last one is where it begins. They need no name.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::Deserialize;
use toml::Spanned;

use prone::gait::cycle::{Approach, Cycle, Easing, Pull, Steering, Waypoint};
use prone::gait::{LimitsPolicy, PhaseDuration};
use prone::mapping::{ArmMode, MappingVariant};

use crate::curve_table::{self, CurveTable};
use crate::error::{FileError, Source, line_and_column};
use crate::gait_file::{self, ArmName, Head, LimitsName, MappingName};

/// Largest angle of a joint in a file, degrees.
const LARGEST_DEG: f64 = 360.0;
/// Largest turn command, degrees: beyond it the sines of the steering's geometry are not small.
const LARGEST_TURN_DEG: f64 = 30.0;
/// Largest factor of a turn command.
const LARGEST_FACTOR: f64 = 10.0;

/// Tables that a cycle file has and a gait file has not.
const OF_CYCLES: [&str; 3] = ["pull", "recovery", "waypoint"];

/// Whether a text is that of a cycle file and not of a gait file: it has a pull or waypoints.
pub fn is_cycle(text: &str) -> bool {
    let table = toml::from_str::<toml::Table>(text);
    table.is_ok_and(|table| OF_CYCLES.iter().any(|key| table.contains_key(*key)))
}

/// Reads a cycle from the text of a cycle file; `file` is the name that errors carry.
pub fn parse(file: &str, text: &str) -> Result<Cycle, FileError> {
    let source = Source { file, text };
    let table: CycleFile = source.parse()?;
    gait_file::check_name(source, &table.name)?;
    let alone = table.pull.is_none();
    let (waypoints, unused, key) = if alone {
        (table.waypoint, table.recovery, "[[recovery]]")
    } else {
        (table.recovery, table.waypoint, "[[waypoint]]")
    };
    if let Some(waypoint) = unused.first() {
        let message = if alone {
            format!(
                "{key} leads back to a pull, and there is no [pull]; a cycle without one has [[waypoint]]"
            )
        } else {
            format!("{key} is for cycles without a [pull]; the way back to one is [[recovery]]")
        };
        return Err(source.error(waypoint.time_s.span(), message));
    }
    let waypoints = waypoints.into_iter().enumerate();
    let waypoints = waypoints.map(|(index, waypoint)| source.waypoint(index, waypoint));
    let waypoints: Vec<Waypoint> = waypoints.collect::<Result<_, _>>()?;
    let steered = |it: &&Waypoint| !it.turn.is_empty() || !it.shift.is_empty();
    let turned = waypoints.iter().find(steered);
    if let (Some(waypoint), None) = (turned, &table.steering) {
        let message = format!(
            "waypoint {} is steered; [steering] with its limit_deg is missing",
            waypoint.name
        );
        return Err(source.error(table.name.span(), message));
    }
    let pull = match (table.pull, table.approach) {
        (Some(pull), Some(approach)) => {
            let approach = source.approach(&approach.time_s, approach.easing)?;
            Some(source.pull(pull, table.mapping, table.arm, approach)?)
        }
        (Some(pull), None) => {
            let message = "missing [approach]: it leads to the pull's first posture";
            return Err(source.error(pull.duration_s.span(), message));
        }
        (None, approach) => {
            let key = [
                approach.map(|it| (it.time_s.span(), "[approach]")),
                table.mapping.map(|it| (it.span(), "mapping")),
                table.arm.map(|it| (it.span(), "arm")),
            ];
            if let Some((span, key)) = key.into_iter().flatten().next() {
                let message = format!("{key} belongs to a pull, and there is no [pull]");
                return Err(source.error(span, message));
            }
            None
        }
    };
    let steering = table.steering.map(|it| source.steering(it, pull.is_some()));
    Ok(Cycle {
        name: table.name.into_inner(),
        description: table.description,
        limits: table.limits,
        pull,
        waypoints,
        rest: 0.0,
        steering: steering.transpose()?,
    })
}

/// The line, from 1, on which a part of a cycle stands in the text of its file: a waypoint's name,
/// or the table of `pull`, `steering` or `extension`, which `[approach]` leads to. Nothing where the
/// file has no such part.
pub fn line_of(text: &str, place: &str) -> Option<usize> {
    let table: CycleFile = toml::from_str(text).ok()?;
    let waypoints = table.recovery.iter().chain(&table.waypoint).enumerate();
    for (index, waypoint) in waypoints {
        let (name, span) = match &waypoint.name {
            Some(name) => (name.get_ref().clone(), name.span()),
            None => (usual_name(index), waypoint.time_s.span()),
        };
        if name == place {
            return Some(line_and_column(text, span.start).0);
        }
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

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct CycleFile {
    name: Spanned<String>,
    #[serde(default)]
    description: String,
    mapping: Option<Spanned<MappingText>>,
    arm: Option<Spanned<ArmText>>,
    #[serde(default, with = "LimitsName")]
    limits: LimitsPolicy,
    pull: Option<PullTable>,
    #[serde(default)]
    recovery: Vec<WaypointTable>,
    #[serde(default)]
    waypoint: Vec<WaypointTable>,
    approach: Option<ApproachTable>,
    steering: Option<SteeringTable>,
}

#[derive(Debug, Deserialize)]
struct MappingText(#[serde(with = "MappingName")] MappingVariant);

#[derive(Debug, Deserialize)]
struct ArmText(#[serde(with = "ArmName")] ArmMode);

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
    name: Option<Spanned<String>>,
    time_s: Spanned<f64>,
    #[serde(default, with = "EasingName")]
    easing: Easing,
    #[serde(default)]
    joints_deg: BTreeMap<String, Spanned<f64>>,
    #[serde(default)]
    joints_rad: BTreeMap<String, Spanned<f64>>,
    #[serde(default)]
    turn: BTreeMap<String, Spanned<f64>>,
    #[serde(default)]
    shift: BTreeMap<String, Spanned<f64>>,
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
    shift_limit_deg: Option<Spanned<f64>>,
    shift_limit_rad: Option<Spanned<f64>>,
    dead_band_deg: Option<Spanned<f64>>,
    dead_band_rad: Option<Spanned<f64>>,
    spread: Option<Spanned<f64>>,
    #[serde(default)]
    joints: BTreeMap<String, Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(remote = "Easing", rename_all = "kebab-case")]
enum EasingName {
    Smoothstep,
    Linear,
}

/// Name of a waypoint that has none, by its place from 0.
fn usual_name(index: usize) -> String {
    (index + 1).to_string()
}

impl Source<'_> {
    fn pull(
        self,
        table: PullTable,
        mapping: Option<Spanned<MappingText>>,
        arm: Option<Spanned<ArmText>>,
        approach: Approach,
    ) -> Result<Pull, FileError> {
        let duration = PhaseDuration::new(*table.duration_s.get_ref())
            .map_err(|error| self.error(table.duration_s.span(), error))?;
        let mut company = BTreeMap::new();
        for (joint, curve) in table.joints {
            company.insert(joint, curve.read(self)?);
        }
        Ok(Pull {
            knee: table.knee.read(self)?,
            hip: table.hip.read(self)?,
            upper_arm: table.upper_arm.read(self)?,
            mapping: mapping.map_or_else(MappingVariant::default, |it| it.into_inner().0),
            arm: arm.map_or_else(ArmMode::default, |it| it.into_inner().0),
            duration,
            company,
            approach,
        })
    }

    fn waypoint(self, index: usize, table: WaypointTable) -> Result<Waypoint, FileError> {
        if let Some(name) = table
            .name
            .as_ref()
            .filter(|it| it.get_ref().trim().is_empty())
        {
            return Err(self.error(name.span(), "a waypoint's name is empty"));
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
        let name = table.name.map(Spanned::into_inner);
        Ok(Waypoint {
            name: name.unwrap_or_else(|| usual_name(index)),
            approach: self.approach(&table.time_s, table.easing)?,
            joints,
            turn: self.factors(table.turn)?,
            shift: self.factors(table.shift)?,
        })
    }

    /// Factors of a command, by joint.
    fn factors(
        self,
        table: BTreeMap<String, Spanned<f64>>,
    ) -> Result<BTreeMap<String, f64>, FileError> {
        let factors = table.into_iter().map(|(joint, factor)| {
            let value = self.within(&factor, &joint, LARGEST_FACTOR)?;
            Ok((joint, value))
        });
        factors.collect()
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

    fn steering(self, table: SteeringTable, has_pull: bool) -> Result<Steering, FileError> {
        let limit = match (&table.limit_deg, &table.limit_rad) {
            (Some(degrees), None) => self
                .positive(degrees, "limit_deg", LARGEST_TURN_DEG)?
                .to_radians(),
            (None, Some(radians)) => {
                self.positive(radians, "limit_rad", LARGEST_TURN_DEG.to_radians())?
            }
            (Some(number), Some(_)) => {
                let message = "[steering] has both limit_deg and limit_rad";
                return Err(self.error(number.span(), message));
            }
            (None, None) => {
                let header = self.text.find("[steering").unwrap_or_default();
                let message = "[steering] needs one of limit_deg and limit_rad";
                return Err(self.error(header..header, message));
            }
        };
        let dead_band =
            self.degrees_or_radians((&table.dead_band_deg, &table.dead_band_rad), "dead_band")?;
        let in_pull = table
            .spread
            .as_ref()
            .or_else(|| table.joints.values().next());
        if let Some(number) = in_pull.filter(|_| !has_pull) {
            let message = "spread and joints of [steering] act in a pull, and there is no [pull]; \
                           `turn` of a waypoint acts there";
            return Err(self.error(number.span(), message));
        }
        let shift_limit = self.degrees_or_radians(
            (&table.shift_limit_deg, &table.shift_limit_rad),
            "shift_limit",
        )?;
        let spread = table.spread.as_ref();
        let spread = spread.map(|it| self.within(it, "spread", LARGEST_FACTOR));
        Ok(Steering {
            limit,
            dead_band,
            spread: spread.transpose()?.unwrap_or_default(),
            joints: self.factors(table.joints)?,
            shift_limit,
        })
    }

    /// An angle that is given in degrees or in radians, or not at all, which is 0; rad.
    fn degrees_or_radians(
        self,
        given: (&Option<Spanned<f64>>, &Option<Spanned<f64>>),
        what: &str,
    ) -> Result<f64, FileError> {
        match given {
            (None, None) => Ok(0.0),
            (Some(degrees), None) => {
                let degrees =
                    self.not_negative(degrees, &format!("{what}_deg"), LARGEST_TURN_DEG)?;
                Ok(degrees.to_radians())
            }
            (None, Some(radians)) => {
                let largest = LARGEST_TURN_DEG.to_radians();
                self.not_negative(radians, &format!("{what}_rad"), largest)
            }
            (Some(number), Some(_)) => {
                let message = format!("[steering] has both {what}_deg and {what}_rad");
                Err(self.error(number.span(), message))
            }
        }
    }

    fn not_negative(
        self,
        number: &Spanned<f64>,
        what: &str,
        largest: f64,
    ) -> Result<f64, FileError> {
        let value = *number.get_ref();
        if (0.0..=largest).contains(&value) {
            return Ok(value);
        }
        let message = format!("{what} must be 0 to {largest}, not {value}");
        Err(self.error(number.span(), message))
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
