//! Bodies and joints by name.

use std::collections::BTreeMap;

use prone::robot::{BodyId, JointId};

use super::document::{BodyDocument, JointDocument};
use super::place::{Place, Violation};

/// Where each name is. Names are distinct: that is checked before.
pub(super) struct Names<'a> {
    bodies: &'a [BodyDocument],
    joints: &'a [JointDocument],
    body_ids: BTreeMap<&'a str, BodyId>,
    joint_ids: BTreeMap<&'a str, JointId>,
}

impl<'a> Names<'a> {
    pub(super) fn of(bodies: &'a [BodyDocument], joints: &'a [JointDocument]) -> Self {
        let body_ids = bodies.iter().enumerate();
        let joint_ids = joints.iter().enumerate();
        Self {
            bodies,
            joints,
            body_ids: body_ids
                .map(|(index, body)| (body.name.as_str(), BodyId(index)))
                .collect(),
            joint_ids: joint_ids
                .map(|(index, joint)| (joint.name.as_str(), JointId(index)))
                .collect(),
        }
    }

    pub(super) fn body(&self, place: Place<'_>, name: &str) -> Result<BodyId, Violation> {
        let id = self.body_ids.get(name).copied();
        id.ok_or_else(|| place.violation(format!("{name:?} is none of the bodies")))
    }

    pub(super) fn joint(&self, place: Place<'_>, name: &str) -> Result<JointId, Violation> {
        let id = self.joint_ids.get(name).copied();
        id.ok_or_else(|| place.violation(format!("{name:?} is none of the joints")))
    }

    /// The joint that a body says it is moved by, if the joint says so too.
    pub(super) fn joint_that_moves(
        &self,
        place: Place<'_>,
        name: &str,
        body: &str,
    ) -> Result<JointId, Violation> {
        let id = self.joint(place, name)?;
        let moved = &self.joints[id.0].body;
        if moved == body {
            return Ok(id);
        }
        Err(place.violation(format!("{name:?} moves {moved:?}, not {body:?}")))
    }

    /// The body that a joint says it moves, if the body says so too.
    pub(super) fn body_moved_by(
        &self,
        place: Place<'_>,
        name: &str,
        joint: &str,
    ) -> Result<BodyId, Violation> {
        let id = self.body(place, name)?;
        match &self.bodies[id.0].joint {
            Some(mover) if mover == joint => Ok(id),
            Some(mover) => {
                Err(place.violation(format!("{name:?} is moved by {mover:?}, not {joint:?}")))
            }
            None => Err(place.violation(format!("{name:?} is moved by no joint, not {joint:?}"))),
        }
    }
}
