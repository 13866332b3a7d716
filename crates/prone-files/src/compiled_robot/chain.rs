//! The chain of a document, and what was published of it.

use prone::chain::ClosedChain;
use prone::frames::{Link, Point};
use prone::robot::{BodyId, ChainLayout, FixedArm, PublishedChain, SideLayout, bounds};

use super::document::{
    ChainDocument, FixedArmDocument, PointDocument, PublishedDocument, SideDocument,
};
use super::names::Names;
use super::place::{Place, Violation};

pub(super) fn read(
    place: Place<'_>,
    document: &ChainDocument,
    names: &Names<'_>,
) -> Result<ChainLayout, Violation> {
    let ChainDocument {
        left,
        right,
        span_m,
        projected_upper_arm_m,
        published,
        fixed_arm,
    } = document;
    let arm = place.key("projected_upper_arm_m");
    Ok(ChainLayout {
        left: side(place.key("left"), left, names)?,
        right: side(place.key("right"), right, names)?,
        span: place.key("span_m").positive(*span_m, bounds::LENGTH)?,
        projected_upper_arm: arm.positive(*projected_upper_arm_m, bounds::LENGTH)?,
        published: published
            .as_ref()
            .map(|published| read_published(place.key("published"), published))
            .transpose()?,
        fixed_arm: fixed_arm
            .as_ref()
            .map(|fixed| read_fixed_arm(place.key("fixed_arm"), fixed))
            .transpose()?,
    })
}

fn side(
    place: Place<'_>,
    document: &SideDocument,
    names: &Names<'_>,
) -> Result<SideLayout, Violation> {
    let SideDocument {
        toe,
        ankle,
        knee,
        hip,
        shoulder,
        shoulder_roll,
        elbow,
        forearm: [upper, lower],
        forearm_direction,
    } = document;
    let joint = |key, name: &str| names.joint(place.key(key), name);
    let forearm = place.key("forearm");
    let direction = place.key("forearm_direction");
    Ok(SideLayout {
        toe: point(place.key("toe"), toe, names)?,
        ankle: joint("ankle", ankle)?,
        knee: joint("knee", knee)?,
        hip: joint("hip", hip)?,
        shoulder: joint("shoulder", shoulder)?,
        shoulder_roll: joint("shoulder_roll", shoulder_roll)?,
        elbow: point(place.key("elbow"), elbow, names)?,
        forearm: [
            names.joint(forearm.index(0), upper)?,
            names.joint(forearm.index(1), lower)?,
        ],
        forearm_direction: direction.direction(*forearm_direction)?,
    })
}

fn point(
    place: Place<'_>,
    document: &PointDocument,
    names: &Names<'_>,
) -> Result<(BodyId, Point<Link>), Violation> {
    let PointDocument { body, position_m } = document;
    let body = names.body(place.key("body"), body)?;
    Ok((body, place.key("position_m").point(*position_m)?))
}

fn read_published(
    place: Place<'_>,
    document: &PublishedDocument,
) -> Result<PublishedChain, Violation> {
    let PublishedDocument {
        links_m,
        span_m,
        ankle_offset_rad,
        shoulder_roll_rad,
    } = document;
    let links = place.key("links_m");
    for (index, length) in links_m.iter().enumerate() {
        links.index(index).positive(*length, bounds::LENGTH)?;
    }
    let [l1, l2, l3, l4, l5] = *links_m;
    Ok(PublishedChain {
        chain: ClosedChain {
            toe_to_ankle: l1,
            ankle_to_knee: l2,
            knee_to_hip: l3,
            hip_to_shoulder: l4,
            shoulder_to_elbow: l5,
            span: place.key("span_m").positive(*span_m, bounds::LENGTH)?,
        },
        ankle_offset: place.key("ankle_offset_rad").angle(*ankle_offset_rad)?,
        shoulder_roll: place.key("shoulder_roll_rad").angle(*shoulder_roll_rad)?,
    })
}

fn read_fixed_arm(place: Place<'_>, document: &FixedArmDocument) -> Result<FixedArm, Violation> {
    let FixedArmDocument {
        shoulder_roll_rad,
        forearm_rad: [upper, lower],
    } = *document;
    let forearm = place.key("forearm_rad");
    Ok(FixedArm {
        shoulder_roll: place.key("shoulder_roll_rad").angle(shoulder_roll_rad)?,
        forearm: [
            forearm.index(0).angle(upper)?,
            forearm.index(1).angle(lower)?,
        ],
    })
}
