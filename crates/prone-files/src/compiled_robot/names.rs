//! Bodies and joints by name.

use std::collections::BTreeMap;

use prone::robot::{BodyId, JointId, Robot};

use super::place::{Place, Violation};
use crate::part_name::{self, PartNameError};

/// The place of each of some distinct names in their list.
pub(super) type Index<'a> = BTreeMap<&'a str, usize>;

/// The places of bodies and joints.
pub(super) struct Names<'a> {
    pub(super) bodies: Index<'a>,
    pub(super) joints: Index<'a>,
}

impl Names<'_> {
    pub(super) fn body(&self, at: Place<'_>, name: &str) -> Result<BodyId, Violation> {
        let id = self.bodies.get(name).copied().map(BodyId);
        id.ok_or_else(|| at.violation(format!("{name:?} is none of the bodies")))
    }

    pub(super) fn joint(&self, at: Place<'_>, name: &str) -> Result<JointId, Violation> {
        let id = self.joints.get(name).copied().map(JointId);
        id.ok_or_else(|| at.violation(format!("{name:?} is none of the joints")))
    }
}

/// Where each name of a list is; a list has at most so many, and none twice.
pub(super) fn index<'a, D>(
    at: Place<'_>,
    list: &'a [D],
    most: usize,
    name: fn(&D) -> &str,
) -> Result<Index<'a>, Violation> {
    if list.len() > most {
        return Err(at.violation(format!("{} are more than {most}", list.len())));
    }
    let mut names = Index::new();
    for (index, name) in list.iter().map(name).enumerate() {
        if names.insert(name, index).is_some() {
            let element = Place::Element(&at, index);
            return Err(element
                .key("name")
                .violation(format!("{name:?} is there twice")));
        }
    }
    Ok(names)
}

/// Checks names of parts: each by itself, and that no two are alike.
pub(super) fn check_parts(
    at: Place<'_>,
    kind: &'static str,
    names: &Index<'_>,
    check: fn(&str) -> Result<(), PartNameError>,
) -> Result<(), Violation> {
    let named = |index, error: PartNameError| {
        let element = Place::Element(&at, index);
        element.key("name").violation(error)
    };
    let mut ordered: Vec<(usize, &str)> =
        names.iter().map(|(name, index)| (*index, *name)).collect();
    ordered.sort_unstable();
    for (index, name) in &ordered {
        check(name).map_err(|error| named(*index, error))?;
    }
    let all = ordered.iter().map(|(_, name)| *name);
    part_name::check_distinct(kind, all).map_err(|(place, error)| named(ordered[place].0, error))
}

/// Name of a body of a robot.
pub(super) fn body_name(robot: &Robot, BodyId(index): BodyId) -> String {
    robot.bodies[index].name.clone()
}

/// Name of a joint of a robot.
pub(super) fn joint_name(robot: &Robot, JointId(index): JointId) -> String {
    robot.joints[index].name.clone()
}
