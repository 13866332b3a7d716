//! What a setting of a search or of its confirmation changes.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What a setting changes. Records carry it as the words that it is printed with.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub enum SettingKind {
    /// Nothing.
    #[default]
    AsItIs,
    /// Slow, on slippery ground: a corner of earlier searches, whose records are read.
    SlowSlippery,
    /// Fast, on sticky ground: the other one.
    FastSticky,
    /// Half the largest turn command.
    HalfTurning,
    /// The largest turn command.
    Turning,
    /// Friction that differs from side to side, and joints that are off.
    Uneven {
        /// Friction at the left.
        left: f64,
        /// Friction at the right.
        right: f64,
    },
    /// The same, with joints that are off by what a seed draws.
    UnevenBySeed {
        /// Friction at the left.
        left: f64,
        /// Friction at the right.
        right: f64,
        /// The seed.
        seed: u64,
    },
    /// Another friction.
    Friction(f64),
    /// Another time scale.
    TimeScale(f64),
    /// Engine steps of 1 ms.
    FineSteps,
    /// Stiffer servos.
    StiffServos,
    /// Softer servos.
    SoftServos,
    /// Another stiffness of the servos: what it is multiplied by.
    Stiffness(f64),
    /// Other masses: what they are multiplied by.
    Masses(f64),
    /// Gears with some play, degrees.
    Backlash(f64),
    /// Commands that are late, by up to so many ms.
    LateCommands(f64),
    /// Another duration of the pull, s.
    PullOf(f64),
}

impl fmt::Display for SettingKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AsItIs => f.write_str("as it is"),
            Self::SlowSlippery => f.write_str("slow, slippery"),
            Self::FastSticky => f.write_str("fast, sticky"),
            Self::HalfTurning => f.write_str("turning by half"),
            Self::Turning => f.write_str("turning"),
            Self::Uneven { left, right } => {
                write!(f, "friction {left} and {right}, joints off")
            }
            Self::UnevenBySeed { left, right, seed } => {
                write!(f, "friction {left} and {right}, joints off by seed {seed}")
            }
            Self::Friction(friction) => write!(f, "friction {friction}"),
            Self::TimeScale(scale) => write!(f, "time scale {scale}"),
            Self::FineSteps => f.write_str("1 ms steps"),
            Self::StiffServos => f.write_str("stiff servos"),
            Self::SoftServos => f.write_str("soft servos"),
            Self::Stiffness(factor) => write!(f, "stiffness times {factor}"),
            Self::Masses(factor) => write!(f, "masses times {factor}"),
            Self::Backlash(degrees) => write!(f, "backlash of {degrees}°"),
            Self::LateCommands(ms) => write!(f, "commands late by up to {ms} ms"),
            Self::PullOf(seconds) => write!(f, "pull of {seconds} s"),
        }
    }
}

impl From<SettingKind> for String {
    fn from(kind: SettingKind) -> Self {
        kind.to_string()
    }
}

impl TryFrom<String> for SettingKind {
    type Error = String;

    fn try_from(name: String) -> Result<Self, String> {
        let plain = [
            Self::AsItIs,
            Self::SlowSlippery,
            Self::FastSticky,
            Self::HalfTurning,
            Self::Turning,
            Self::FineSteps,
            Self::StiffServos,
            Self::SoftServos,
        ];
        let plain = plain.into_iter().find(|kind| kind.to_string() == name);
        let kind = plain.or_else(|| with_numbers(&name));
        kind.ok_or_else(|| format!("there is no setting {name:?}"))
    }
}

/// A kind whose words hold numbers.
fn with_numbers(name: &str) -> Option<SettingKind> {
    if let Some(sides) = name.strip_suffix(", joints off") {
        let (left, right) = sides.strip_prefix("friction ")?.split_once(" and ")?;
        return Some(SettingKind::Uneven {
            left: left.parse().ok()?,
            right: right.parse().ok()?,
        });
    }
    if let Some((sides, seed)) = name.split_once(", joints off by seed ") {
        let (left, right) = sides.strip_prefix("friction ")?.split_once(" and ")?;
        return Some(SettingKind::UnevenBySeed {
            left: left.parse().ok()?,
            right: right.parse().ok()?,
            seed: seed.parse().ok()?,
        });
    }
    if let Some(friction) = name.strip_prefix("friction ") {
        return Some(SettingKind::Friction(friction.parse().ok()?));
    }
    if let Some(scale) = name.strip_prefix("time scale ") {
        return Some(SettingKind::TimeScale(scale.parse().ok()?));
    }
    if let Some(factor) = name.strip_prefix("stiffness times ") {
        return Some(SettingKind::Stiffness(factor.parse().ok()?));
    }
    if let Some(factor) = name.strip_prefix("masses times ") {
        return Some(SettingKind::Masses(factor.parse().ok()?));
    }
    if let Some(degrees) = name.strip_prefix("backlash of ") {
        let degrees = degrees.strip_suffix('°')?;
        return Some(SettingKind::Backlash(degrees.parse().ok()?));
    }
    if let Some(ms) = name.strip_prefix("commands late by up to ") {
        let ms = ms.strip_suffix(" ms")?;
        return Some(SettingKind::LateCommands(ms.parse().ok()?));
    }
    let seconds = name.strip_prefix("pull of ")?.strip_suffix(" s")?;
    Some(SettingKind::PullOf(seconds.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_is_read_back_from_its_words() {
        let (left, right) = (0.5, 0.9);
        for kind in [
            SettingKind::AsItIs,
            SettingKind::SlowSlippery,
            SettingKind::FastSticky,
            SettingKind::HalfTurning,
            SettingKind::Turning,
            SettingKind::Uneven { left, right },
            SettingKind::UnevenBySeed {
                left,
                right,
                seed: 3,
            },
            SettingKind::Friction(0.4),
            SettingKind::Friction(1.0),
            SettingKind::TimeScale(1.7),
            SettingKind::FineSteps,
            SettingKind::StiffServos,
            SettingKind::SoftServos,
            SettingKind::Stiffness(2.0),
            SettingKind::Masses(1.1),
            SettingKind::Backlash(1.0),
            SettingKind::LateCommands(20.0),
            SettingKind::PullOf(3.0),
        ] {
            assert_eq!(SettingKind::try_from(kind.to_string()), Ok(kind));
        }
        for name in ["", "as it was", "friction", "friction x", "pull of 3"] {
            assert!(SettingKind::try_from(name.to_owned()).is_err(), "{name:?}");
        }
    }
}
