//! Limits of a document's joints that depend on the angle of another joint.

use serde::{Deserialize, Serialize};

use prone::robot::{CoupledLimit, Range, Robot, bounds};

use super::names::{Names, joint_name};
use super::place::{Place, Violation};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct CoupledLimitDocument {
    joint: String,
    by: String,
    /// Angle of `by`, then lower and upper limit of `joint` there.
    table_rad: Vec<[f64; 3]>,
}

impl CoupledLimitDocument {
    pub(super) fn new(robot: &Robot, limit: &CoupledLimit) -> Self {
        let lines = limit.table.iter();
        Self {
            joint: joint_name(robot, limit.joint),
            by: joint_name(robot, limit.by),
            table_rad: lines
                .map(|(at, range)| [*at, range.lower, range.upper])
                .collect(),
        }
    }

    pub(super) fn read(&self, at: Place<'_>, names: &Names<'_>) -> Result<CoupledLimit, Violation> {
        let joint = names.joint(at.key("joint"), &self.joint)?;
        let by = names.joint(at.key("by"), &self.by)?;
        let place = at.key("table_rad");
        let table = place.each(&self.table_rad, |at, _, &[angle, lower, upper]| {
            let range: Range = at.range([lower, upper], bounds::ANGLE)?;
            Ok((at.angle(angle)?, range))
        })?;
        CoupledLimit::new(joint, by, table).map_err(|error| place.violation(error))
    }
}
