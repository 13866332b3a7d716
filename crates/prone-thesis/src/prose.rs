//! Sentences of the report as data, with the numbers of the record filled in: what a sentence says of
//! a robot is that robot's.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use serde::Deserialize;

use crate::robot_numbers::RobotNumbers;
use crate::run_info::RunInfo;

/// What stands in the place of a number that a record does not have.
const UNKNOWN: &str = "an unknown number of";

/// `prose.json`.
#[derive(Debug, Default, Deserialize)]
pub(crate) struct Prose {
    pub(crate) contacts: String,
    pub(crate) mappings: String,
    pub(crate) clamps: String,
    pub(crate) stride: String,
    of_robots: Vec<OfRobot>,
}

/// Sentences that are true of one family of robots.
#[derive(Debug, Deserialize)]
pub(crate) struct OfRobot {
    family: String,
    pub(crate) clamps: String,
    pub(crate) table: String,
    pub(crate) differences: Vec<String>,
}

/// Numbers by the names that stand for them in a sentence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Numbers(BTreeMap<&'static str, String>);

impl Prose {
    /// The sentences that ship; a test excludes that they do not parse.
    pub(crate) fn shipped() -> &'static Self {
        static PROSE: OnceLock<Prose> = OnceLock::new();
        PROSE.get_or_init(|| serde_json::from_str(include_str!("prose.json")).unwrap_or_default())
    }

    /// What is said of a family of robots alone.
    pub(crate) fn of_robot(&self, family: Option<&str>) -> Option<&OfRobot> {
        self.of_robots
            .iter()
            .find(|it| Some(it.family.as_str()) == family)
    }
}

impl Numbers {
    /// Those of a reproduction.
    pub(crate) fn new(info: &RunInfo, robot: Option<&RobotNumbers>) -> Self {
        let options = &info.options;
        let mut numbers = BTreeMap::from([
            ("friction", options.friction.to_string()),
            (
                "command_step_ms",
                format!("{:.0}", options.control_step_s * 1e3),
            ),
        ]);
        let mut known = Vec::new();
        if let Some(robot) = robot {
            known.extend([
                ("mass_kg", robot.mass_kg, 3),
                ("lowest_centre_mm", robot.lowest_centre_mm, 0),
                ("sunk_mm", robot.sunk_mm, 0),
                ("ankle_deg", robot.own.ankle_deg, 1),
                ("roll_deg", robot.own.roll_deg, 2),
                ("ankle_tighter_deg", robot.ankle_tighter_deg, 2),
            ]);
        }
        if let Some((robot, published)) = robot.and_then(|robot| Some((robot, robot.published?))) {
            known.extend([
                ("published_ankle_deg", published.ankle_deg, 0),
                ("published_roll_deg", published.roll_deg, 0),
                ("nearer_mm", published.trunk_mm - robot.own.trunk_mm, 1),
            ]);
        }
        let known = known.into_iter();
        numbers.extend(known.map(|(name, value, decimals)| (name, format!("{value:.decimals$}"))));
        Self(numbers)
    }

    /// A sentence with its numbers.
    pub(crate) fn fill(&self, sentence: &str) -> String {
        let mut filled = String::new();
        let mut rest = sentence;
        while let Some((before, behind)) = rest.split_once('{') {
            filled.push_str(before);
            let (name, after) = behind.split_once('}').unwrap_or((behind, ""));
            filled.push_str(self.0.get(name).map_or(UNKNOWN, String::as_str));
            rest = after;
        }
        filled + rest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sentences(prose: &Prose) -> impl Iterator<Item = &String> {
        let of_robots = prose.of_robots.iter();
        let of_robots =
            of_robots.flat_map(|it| it.differences.iter().chain([&it.clamps, &it.table]));
        [
            &prose.contacts,
            &prose.mappings,
            &prose.clamps,
            &prose.stride,
        ]
        .into_iter()
        .chain(of_robots)
    }

    /// Every name in a sentence is one that a reproduction has a number for.
    #[test]
    fn every_sentence_can_be_filled() {
        let names = [
            "friction",
            "command_step_ms",
            "mass_kg",
            "lowest_centre_mm",
            "sunk_mm",
            "ankle_deg",
            "roll_deg",
            "ankle_tighter_deg",
            "published_ankle_deg",
            "published_roll_deg",
            "nearer_mm",
        ];
        let numbers = Numbers(names.map(|name| (name, "7".to_owned())).into());
        let mut count = 0;
        for sentence in sentences(Prose::shipped()) {
            let filled = numbers.fill(sentence);
            assert!(!filled.contains(UNKNOWN), "{filled}");
            assert!(!filled.contains(['{', '}']), "{filled}");
            count += 1;
        }
        assert!(count > 10, "{count} sentences");
    }

    #[test]
    fn a_number_that_is_not_there_is_not_made_up() {
        let numbers = Numbers([("a", "3".to_owned())].into());
        assert_eq!(
            numbers.fill("{a} and {b} mm"),
            format!("3 and {UNKNOWN} mm")
        );
        assert_eq!(numbers.fill("none"), "none");
        assert!(Prose::shipped().of_robot(Some("other")).is_none());
        assert!(Prose::shipped().of_robot(None).is_none());
        assert!(Prose::shipped().of_robot(Some("nao")).is_some());
    }
}
