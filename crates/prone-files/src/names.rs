//! Names that nothing has: what was asked for, and what may have been meant.
//!
//! Gaits, scenes, robots and the parts of a robot are refused by the same error, so that every one
//! of them comes with the name that is nearest. Near is what takes few edits: one in three letters
//! of what was asked for, and three at most. Two letters in each other's place are one edit; small
//! and capital letters are the same. Where nothing is near, a name that begins with what was asked
//! for is taken.

use std::fmt;
use std::path::Path;

use strsim::osa_distance;

use prone::foreign_text::Quoted;
use prone::gait::cycle::CycleError;

/// Most edits between what was asked for and what may have been meant.
const MOST_EDITS: usize = 3;

/// Longest text that may mean a name, bytes.
const LONGEST: usize = 200;

/// Fewest letters of which a longer name is the continuation.
const FEWEST_LETTERS: usize = 3;

/// What a name is the name of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NameKind {
    /// A pull alone or a whole cycle.
    Gait,
    /// A pull alone.
    Pull,
    /// A whole cycle.
    Cycle,
    /// A scene.
    Scene,
    /// A robot.
    Robot,
    /// A joint of a robot.
    Joint,
    /// A body of a robot's model.
    Body,
    /// A site of a robot's model.
    Site,
    /// A motor of a `robot.toml`.
    Motor,
    /// A posture of a `robot.toml`.
    Posture,
}

/// A name that nothing has.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownName {
    /// What it should be the name of.
    pub kind: NameKind,
    /// What was asked for.
    pub asked: String,
    /// Where it was looked for, if that is one place: a robot's name, or a model's file.
    pub place: Option<String>,
    /// The folder of the robot whose own names are among those that are known.
    pub robot: Option<String>,
    /// What may have been meant, if a known name is near.
    pub nearest: Option<String>,
    /// The names that there are.
    pub known: Box<[String]>,
}

impl NameKind {
    /// What it is, in a word.
    pub const fn noun(self) -> &'static str {
        match self {
            Self::Gait => "gait",
            Self::Pull => "pull",
            Self::Cycle => "cycle",
            Self::Scene => "scene",
            Self::Robot => "robot",
            Self::Joint => "joint",
            Self::Body => "body",
            Self::Site => "site",
            Self::Motor => "motor",
            Self::Posture => "posture",
        }
    }

    /// Whether what it names may be named by the path of its file instead.
    const fn may_be_a_file(self) -> bool {
        matches!(self, Self::Gait | Self::Pull | Self::Cycle | Self::Scene)
    }

    /// Whether `prone list` has it.
    const fn is_listed(self) -> bool {
        self.may_be_a_file() || matches!(self, Self::Robot)
    }
}

impl UnknownName {
    /// A name that is none of those that are known.
    pub fn new<N: Into<String>>(
        kind: NameKind,
        asked: &str,
        known: impl IntoIterator<Item = N>,
    ) -> Self {
        let known: Box<[String]> = known.into_iter().map(Into::into).collect();
        let meant = if kind.may_be_a_file() {
            stem(asked)
        } else {
            asked
        };
        Self {
            kind,
            asked: asked.to_owned(),
            place: None,
            robot: None,
            // To tell how near a long text is takes its length squared; no name is as long.
            nearest: Some(meant)
                .filter(|meant| meant.len() <= LONGEST)
                .and_then(|meant| nearest(meant, &known))
                .map(str::to_owned),
            known,
        }
    }

    /// The same, looked for in one place alone.
    #[must_use]
    pub fn within(self, place: &str) -> Self {
        Self {
            place: Some(place.to_owned()),
            ..self
        }
    }

    /// The same, looked for among the names of a robot's own too, which lie in its folder.
    #[must_use]
    pub fn with_those_of(self, robot: &Path) -> Self {
        Self {
            robot: Some(robot.display().to_string()),
            ..self
        }
    }

    /// The joint that a cycle names and its robot has not, where that is what is wrong.
    pub fn from_cycle(error: &CycleError) -> Option<Self> {
        let CycleError::UnknownJoint {
            robot,
            joint,
            known,
            ..
        } = error
        else {
            return None;
        };
        Some(Self::new(NameKind::Joint, joint, known).within(robot))
    }

    /// What may have been meant, as the end of a sentence; empty if nothing is near.
    pub fn hint(&self) -> String {
        let nearest = self.nearest.as_ref();
        nearest.map_or_else(String::new, |nearest| {
            format!("; did you mean {nearest:?}?")
        })
    }

    /// The [`UnknownName::hint`] of a cycle that is refused; empty where no name is what is wrong.
    pub fn hint_for_cycle(error: &CycleError) -> String {
        Self::from_cycle(error).map_or_else(String::new, |unknown| unknown.hint())
    }

    fn looks_like_a_file(&self) -> bool {
        self.kind.may_be_a_file() && stem(&self.asked) != self.asked
    }
}

impl fmt::Display for UnknownName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let noun = if self.looks_like_a_file() {
            "file"
        } else {
            self.kind.noun()
        };
        write!(f, "there is no {noun} {}", Quoted(&self.asked))?;
        if let Some(place) = &self.place {
            write!(f, " in {place}")?;
        }
        write!(f, "{}", self.hint())?;
        if !self.kind.is_listed() {
            return Ok(());
        }
        if self.nearest.is_none() {
            write!(f, ";")?;
        }
        match &self.robot {
            Some(robot) => write!(f, " `prone list --robot {robot}` shows all"),
            None => write!(f, " `prone list` shows all"),
        }
    }
}

impl std::error::Error for UnknownName {}

/// What would be the name of a file's gait or scene; a plain name is its own.
fn stem(asked: &str) -> &str {
    let stem = match asked.strip_suffix(".toml") {
        Some(path) => path,
        None if asked.contains(['/', '\\']) => asked,
        None => return asked,
    };
    let last = Path::new(stem).file_name();
    last.and_then(|last| last.to_str()).unwrap_or(stem)
}

/// The known name that is nearest, if one is near; of several the first.
fn nearest<'k>(asked: &str, known: &'k [String]) -> Option<&'k str> {
    let asked = asked.to_lowercase();
    let letters = asked.chars().count();
    let edits = |name: &String| osa_distance(&name.to_lowercase(), &asked);
    let most = (letters / 3).clamp(1, MOST_EDITS);
    let near = known.iter().min_by_key(|name| edits(name));
    let near = near.filter(|name| edits(name) <= most);
    let begun = || {
        let mut names = known.iter();
        names.find(|name| {
            letters >= FEWEST_LETTERS && name.to_lowercase().starts_with(asked.as_str())
        })
    };
    near.or_else(begun).map(String::as_str)
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [&str; 4] = ["low-200", "low-175", "low-165", "gentle"];

    fn unknown(asked: &str) -> UnknownName {
        UnknownName::new(NameKind::Cycle, asked, KNOWN)
    }

    #[test]
    fn the_nearest_name_is_offered() {
        for (asked, nearest) in [
            ("low-174", Some("low-175")),
            ("low175", Some("low-175")),
            ("LOW-165", Some("low-165")),
            ("gentel", Some("gentle")),
            ("gnet", None),
            ("low", Some("low-200")),
            ("gallop", None),
            ("lo", None),
            ("x", None),
            ("", None),
        ] {
            assert_eq!(unknown(asked).nearest.as_deref(), nearest, "{asked}");
        }
        assert_eq!(
            unknown("low-174").to_string(),
            "there is no cycle \"low-174\"; did you mean \"low-175\"? `prone list` shows all"
        );
        assert_eq!(
            unknown("gallop").to_string(),
            "there is no cycle \"gallop\"; `prone list` shows all"
        );
    }

    #[test]
    fn a_path_is_called_a_file_and_its_last_part_compared() {
        assert_eq!(
            unknown("gaits/low-175.toml").to_string(),
            "there is no file \"gaits/low-175.toml\"; did you mean \"low-175\"? `prone list` shows all"
        );
        for path in ["..", "/", ".toml", "gallop/"] {
            assert_eq!(unknown(path).nearest, None, "{path}");
        }
        let robot = UnknownName::new(NameKind::Robot, "nao/v6", ["nao", "nao/v4"]);
        assert_eq!(
            robot.to_string(),
            "there is no robot \"nao/v6\"; did you mean \"nao/v4\"? `prone list` shows all"
        );
    }

    #[test]
    fn a_joint_is_looked_for_in_its_robot() {
        let error = CycleError::UnknownJoint {
            cycle: "low".to_owned(),
            place: "waypoint fold".to_owned(),
            robot: "NAO".to_owned(),
            joint: "LHipPich".to_owned(),
            known: ["LHipRoll".to_owned(), "LHipPitch".to_owned()].into(),
        };
        let unknown = UnknownName::from_cycle(&error).unwrap();
        assert_eq!(unknown.hint(), "; did you mean \"LHipPitch\"?");
        assert_eq!(
            unknown.to_string(),
            "there is no joint \"LHipPich\" in NAO; did you mean \"LHipPitch\"?"
        );
        let other = CycleError::FewWaypoints {
            cycle: "low".to_owned(),
            waypoints: 1,
        };
        assert_eq!(UnknownName::from_cycle(&other), None);
    }
}
