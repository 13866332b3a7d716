//! One way to crawl a cycle: as data, and compiled into a world.

use std::fmt;

use prone::gait::PhaseDuration;
use prone::gait::cycle::TimeScale;
use prone::robot::JointAngles;
use prone::scene::{Scene, SideFriction};
use prone_sim::{LoadedRobot, Regime, World, WorldError};
use serde::{Deserialize, Serialize};

/// What a setting changes. Records carry it as the words that it is printed with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(into = "String", try_from = "String")]
pub enum SettingKind {
    /// Nothing.
    AsItIs,
    /// Slow, on slippery ground: the first of the corners of a search.
    SlowSlippery,
    /// Fast, on sticky ground: the other corner.
    FastSticky,
    /// The largest turn command.
    Turning,
    /// Friction that differs from side to side, and joints that are off.
    Uneven {
        /// Friction at the left.
        left: f64,
        /// Friction at the right.
        right: f64,
    },
    /// Another friction.
    Friction(f64),
    /// Another time scale.
    TimeScale(f64),
    /// Engine steps of 1 ms.
    FineSteps,
    /// Stiffer servos.
    StiffServos,
    /// Servos that command more speed.
    BriskServos,
    /// Another duration of the pull, s.
    PullOf(f64),
}

/// What a setting is for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// Its value counts.
    Value,
    /// It has to advance by at least that share of the first setting's advance.
    Keep(f64),
    /// It has to turn to the left by at least that angle a cycle, rad.
    Turn(f64),
    /// Nothing is asked of it; what it does is reported.
    Beside,
    /// It may not turn by more than an angle a cycle, rad, and has to advance by at least a share of
    /// the first setting's advance.
    Straight {
        /// The angle, rad.
        yaw: f64,
        /// The share.
        keep: f64,
    },
}

/// Share of the advance that is left where it turns as hard as it can.
const TURNING: f64 = 0.5;

/// No setting is called so.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is no setting {name:?}")]
pub struct UnknownSetting {
    /// What was read.
    pub name: String,
}

impl fmt::Display for SettingKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::AsItIs => f.write_str("as it is"),
            Self::SlowSlippery => f.write_str("slow, slippery"),
            Self::FastSticky => f.write_str("fast, sticky"),
            Self::Turning => f.write_str("turning"),
            Self::Uneven { left, right } => {
                write!(f, "friction {left} and {right}, joints off")
            }
            Self::Friction(friction) => write!(f, "friction {friction}"),
            Self::TimeScale(scale) => write!(f, "time scale {scale}"),
            Self::FineSteps => f.write_str("1 ms steps"),
            Self::StiffServos => f.write_str("stiff servos"),
            Self::BriskServos => f.write_str("brisk servos"),
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
    type Error = UnknownSetting;

    fn try_from(name: String) -> Result<Self, UnknownSetting> {
        let plain = [
            Self::AsItIs,
            Self::SlowSlippery,
            Self::FastSticky,
            Self::Turning,
            Self::FineSteps,
            Self::StiffServos,
            Self::BriskServos,
        ];
        let plain = plain.into_iter().find(|kind| kind.to_string() == name);
        let kind = plain.or_else(|| with_numbers(&name));
        kind.ok_or(UnknownSetting { name })
    }
}

impl Role {
    /// Share of the first setting's advance that is asked for, where one is.
    pub const fn keep(self) -> Option<f64> {
        match self {
            Self::Keep(share) | Self::Straight { keep: share, .. } => Some(share),
            Self::Turn(_) => Some(TURNING),
            Self::Value | Self::Beside => None,
        }
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
    if let Some(friction) = name.strip_prefix("friction ") {
        return Some(SettingKind::Friction(friction.parse().ok()?));
    }
    if let Some(scale) = name.strip_prefix("time scale ") {
        return Some(SettingKind::TimeScale(scale.parse().ok()?));
    }
    let seconds = name.strip_prefix("pull of ")?.strip_suffix(" s")?;
    Some(SettingKind::PullOf(seconds.parse().ok()?))
}

/// One way to crawl a cycle, as data: what a worker would be sent.
#[derive(Debug, Clone, PartialEq)]
pub struct SettingSpec {
    /// What it changes.
    pub kind: SettingKind,
    /// Contacts, servos, limits, engine step.
    pub regime: Regime,
    /// Friction by side, in place of the regime's.
    pub friction: Option<SideFriction>,
    /// How slowly.
    pub scale: TimeScale,
    /// How long the pull lasts instead, before the scale.
    pub pull: Option<PhaseDuration>,
    /// What every commanded angle is off by, rad.
    pub offsets: Option<JointAngles>,
    /// How many cycles; the last one is measured.
    pub cycles: usize,
    /// Turn command, in shares of the cycle's limit; the first pull is straight all the same.
    pub turn: f64,
    /// What it is for.
    pub role: Role,
}

/// A setting in the engine.
#[derive(Debug, Clone)]
pub struct Setting {
    /// What it is.
    pub spec: SettingSpec,
    /// The robot on its floor.
    pub world: World,
}

impl SettingSpec {
    /// A robot's world for it.
    ///
    /// # Errors
    /// [`WorldError`].
    pub fn compile(self, robot: &LoadedRobot) -> Result<Setting, WorldError> {
        let mut scene = Scene::level();
        scene.floor.friction = self.friction;
        Ok(Setting {
            world: World::in_scene(robot, self.regime, &scene)?,
            spec: self,
        })
    }
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
            SettingKind::Turning,
            SettingKind::Uneven { left, right },
            SettingKind::Friction(0.4),
            SettingKind::Friction(1.0),
            SettingKind::TimeScale(1.7),
            SettingKind::FineSteps,
            SettingKind::StiffServos,
            SettingKind::BriskServos,
            SettingKind::PullOf(3.0),
        ] {
            assert_eq!(SettingKind::try_from(kind.to_string()), Ok(kind));
        }
        for name in ["", "as it was", "friction", "friction x", "pull of 3"] {
            assert!(SettingKind::try_from(name.to_owned()).is_err(), "{name:?}");
        }
    }
}
