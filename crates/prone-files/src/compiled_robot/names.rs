//! Bodies and joints by name.

use std::collections::BTreeMap;

use prone::robot::{BodyId, JointId, Robot};

use super::place::{Place, Violation};

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

/// Name of a body of a robot.
pub(super) fn body_name(robot: &Robot, BodyId(index): BodyId) -> String {
    robot.bodies[index].name.clone()
}

/// Name of a joint of a robot.
pub(super) fn joint_name(robot: &Robot, JointId(index): JointId) -> String {
    robot.joints[index].name.clone()
}
