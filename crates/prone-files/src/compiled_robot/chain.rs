//! The chain of a document, and what was published of it.

use serde::{Deserialize, Serialize};

use prone::chain::ClosedChain;
use prone::frames::{Link, Point};
use prone::robot::{BodyId, ChainLayout, FixedArm, PublishedChain, Robot, SideLayout};

use super::names::{Names, body_name, joint_name};
use super::place::{Place, Violation, optional};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ChainDocument {
    pub(super) left: SideDocument,
    pub(super) right: SideDocument,
    pub(super) span_m: f64,
    pub(super) projected_upper_arm_m: f64,
    #[serde(deserialize_with = "Option::deserialize")]
    published: Option<PublishedDocument>,
    #[serde(deserialize_with = "Option::deserialize")]
    fixed_arm: Option<FixedArmDocument>,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SideDocument {
    pub(super) toe: PointDocument,
    ankle: String,
    knee: String,
    hip: String,
    shoulder: String,
    shoulder_roll: String,
    pub(super) elbow: PointDocument,
    forearm: [String; 2],
    forearm_direction: [f64; 3],
}

/// A point of a body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PointDocument {
    body: String,
    pub(super) position_m: [f64; 3],
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PublishedDocument {
    /// l1 to l5.
    links_m: [f64; 5],
    span_m: f64,
    ankle_offset_rad: f64,
    shoulder_roll_rad: f64,
}

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FixedArmDocument {
    shoulder_roll_rad: f64,
    forearm_rad: [f64; 2],
}

impl ChainDocument {
    pub(super) fn new(robot: &Robot) -> Self {
        let chain = &robot.chain;
        Self {
            left: SideDocument::new(robot, &chain.left),
            right: SideDocument::new(robot, &chain.right),
            span_m: chain.span,
            projected_upper_arm_m: chain.projected_upper_arm,
            published: chain.published.as_ref().map(PublishedDocument::new),
            fixed_arm: chain.fixed_arm.as_ref().map(FixedArmDocument::new),
        }
    }

    pub(super) fn read(&self, at: Place<'_>, names: &Names<'_>) -> Result<ChainLayout, Violation> {
        let length = |key, metres| at.key(key).length(metres);
        let (published, fixed) = (at.key("published"), at.key("fixed_arm"));
        Ok(ChainLayout {
            left: self.left.read(at.key("left"), names)?,
            right: self.right.read(at.key("right"), names)?,
            span: length("span_m", self.span_m)?,
            projected_upper_arm: length("projected_upper_arm_m", self.projected_upper_arm_m)?,
            published: optional(self.published.as_ref(), |it| it.read(published))?,
            fixed_arm: optional(self.fixed_arm.as_ref(), |it| it.read(fixed))?,
        })
    }
}

impl SideDocument {
    fn new(robot: &Robot, side: &SideLayout) -> Self {
        let joint = |id| joint_name(robot, id);
        Self {
            toe: PointDocument::new(robot, side.toe),
            ankle: joint(side.ankle),
            knee: joint(side.knee),
            hip: joint(side.hip),
            shoulder: joint(side.shoulder),
            shoulder_roll: joint(side.shoulder_roll),
            elbow: PointDocument::new(robot, side.elbow),
            forearm: side.forearm.map(joint),
            forearm_direction: side.forearm_direction.to_array(),
        }
    }

    fn read(&self, at: Place<'_>, names: &Names<'_>) -> Result<SideLayout, Violation> {
        let joint = |key, name: &str| names.joint(at.key(key), name);
        let (forearm, [upper, lower]) = (at.key("forearm"), &self.forearm);
        let direction = at.key("forearm_direction");
        Ok(SideLayout {
            toe: self.toe.read(at.key("toe"), names)?,
            ankle: joint("ankle", &self.ankle)?,
            knee: joint("knee", &self.knee)?,
            hip: joint("hip", &self.hip)?,
            shoulder: joint("shoulder", &self.shoulder)?,
            shoulder_roll: joint("shoulder_roll", &self.shoulder_roll)?,
            elbow: self.elbow.read(at.key("elbow"), names)?,
            forearm: [
                names.joint(Place::Element(&forearm, 0), upper)?,
                names.joint(Place::Element(&forearm, 1), lower)?,
            ],
            forearm_direction: direction.direction(self.forearm_direction)?,
        })
    }
}

impl PointDocument {
    fn new(robot: &Robot, (body, point): (BodyId, Point<Link>)) -> Self {
        Self {
            body: body_name(robot, body),
            position_m: point.metres().to_array(),
        }
    }

    fn read(&self, at: Place<'_>, names: &Names<'_>) -> Result<(BodyId, Point<Link>), Violation> {
        let body = names.body(at.key("body"), &self.body)?;
        Ok((body, at.key("position_m").point(self.position_m)?))
    }
}

impl PublishedDocument {
    fn new(published: &PublishedChain) -> Self {
        Self {
            links_m: published.chain.links(),
            span_m: published.chain.span,
            ankle_offset_rad: published.ankle_offset,
            shoulder_roll_rad: published.shoulder_roll,
        }
    }

    fn read(&self, at: Place<'_>) -> Result<PublishedChain, Violation> {
        let angle = |key, radians| at.key(key).angle(radians);
        let links = at.key("links_m");
        let [l1, l2, l3, l4, l5] = links.array(self.links_m, |at, metres| at.length(metres))?;
        Ok(PublishedChain {
            chain: ClosedChain {
                toe_to_ankle: l1,
                ankle_to_knee: l2,
                knee_to_hip: l3,
                hip_to_shoulder: l4,
                shoulder_to_elbow: l5,
                span: at.key("span_m").length(self.span_m)?,
            },
            ankle_offset: angle("ankle_offset_rad", self.ankle_offset_rad)?,
            shoulder_roll: angle("shoulder_roll_rad", self.shoulder_roll_rad)?,
        })
    }
}

impl FixedArmDocument {
    const fn new(fixed: &FixedArm) -> Self {
        Self {
            shoulder_roll_rad: fixed.shoulder_roll,
            forearm_rad: fixed.forearm,
        }
    }

    fn read(&self, at: Place<'_>) -> Result<FixedArm, Violation> {
        let roll = at.key("shoulder_roll_rad");
        let forearm = at.key("forearm_rad");
        Ok(FixedArm {
            shoulder_roll: roll.angle(self.shoulder_roll_rad)?,
            forearm: forearm.array(self.forearm_rad, |at, radians| at.angle(radians))?,
        })
    }
}
