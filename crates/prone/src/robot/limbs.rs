//! Whether the joints and points of the chain follow one another along the limbs.
//!
//! A joint in the wrong place often still gives some chain. So each joint has one part, lies
//! beyond the one before it on the way from the trunk to toe or forearm, and is on its own side.

use std::fmt;

use super::{BodyId, JointId, Robot, SideLayout};

/// A side of the robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChainSide {
    /// Where +y is.
    Left,
    /// Where −y is.
    Right,
}

/// What a side's chain is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChainPart {
    /// [`SideLayout::toe`].
    Toe,
    /// [`SideLayout::ankle`].
    Ankle,
    /// [`SideLayout::knee`].
    Knee,
    /// [`SideLayout::hip`].
    Hip,
    /// [`SideLayout::shoulder`].
    Shoulder,
    /// [`SideLayout::shoulder_roll`].
    ShoulderRoll,
    /// [`SideLayout::elbow`].
    Elbow,
    /// The first of [`SideLayout::forearm`].
    UpperForearm,
    /// The second of [`SideLayout::forearm`].
    LowerForearm,
}

/// Why the parts of a chain are not those of two legs and two arms.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum LimbError {
    /// One joint has two parts.
    #[error("the joint of the {side} {part} is that of the {first_side} {first_part} already")]
    Twice {
        /// The joint.
        joint: JointId,
        /// Side of the second part.
        side: ChainSide,
        /// The second part.
        part: ChainPart,
        /// Side of the first part.
        first_side: ChainSide,
        /// The first part.
        first_part: ChainPart,
    },
    /// A part does not move with the one that it should hang on.
    #[error("the {side} {outer} does not hang on the {side} {inner}")]
    Loose {
        /// Side of both.
        side: ChainSide,
        /// The part that should be farther out.
        outer: ChainPart,
        /// The part that it should move with.
        inner: ChainPart,
    },
    /// Left and right are exchanged.
    #[error("the left {part} is not to the left of the right one")]
    Exchanged {
        /// The part, of both sides.
        part: ChainPart,
    },
}

impl fmt::Display for ChainSide {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Left => "left",
            Self::Right => "right",
        })
    }
}

impl fmt::Display for ChainPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Toe => "toe",
            Self::Ankle => "ankle",
            Self::Knee => "knee",
            Self::Hip => "hip",
            Self::Shoulder => "shoulder",
            Self::ShoulderRoll => "shoulder_roll",
            Self::Elbow => "elbow",
            Self::UpperForearm => "upper forearm",
            Self::LowerForearm => "lower forearm",
        })
    }
}

/// Checks the chain of a robot whose bodies and joints refer to one another as they should.
///
/// # Errors
/// [`LimbError`], the first one from the left toe on.
pub fn check_limbs(robot: &Robot) -> Result<(), LimbError> {
    let [left, right] = robot.chain.sides();
    let sides = [(ChainSide::Left, left), (ChainSide::Right, right)];
    check_distinct(sides)?;
    // The joints are distinct, so each moves another body; a point may be on the last one's.
    for (side, layout) in sides {
        let body = |part| body_of(robot, layout, part);
        if let Some(&(outer, inner)) = HANGS_ON
            .iter()
            .find(|&&(outer, inner)| !robot.moves_with(body(outer), body(inner)))
        {
            return Err(LimbError::Loose { side, outer, inner });
        }
    }
    // y is to the left.
    let poses = robot.zero_pose();
    let sideways = |id: JointId| poses.anchor(&robot.joints[id.0]).metres().y;
    for (part, left, right) in [
        (ChainPart::Hip, left.hip, right.hip),
        (ChainPart::Shoulder, left.shoulder, right.shoulder),
    ] {
        if sideways(left) <= sideways(right) {
            return Err(LimbError::Exchanged { part });
        }
    }
    Ok(())
}

/// The parts of [`SideLayout::commanded_joints`].
const COMMANDED: [ChainPart; 7] = [
    ChainPart::Ankle,
    ChainPart::Knee,
    ChainPart::Hip,
    ChainPart::Shoulder,
    ChainPart::ShoulderRoll,
    ChainPart::UpperForearm,
    ChainPart::LowerForearm,
];

/// Leg, arm and forearm, from the trunk on: each part and the one that it moves with.
const HANGS_ON: [(ChainPart, ChainPart); 7] = [
    (ChainPart::Knee, ChainPart::Hip),
    (ChainPart::Ankle, ChainPart::Knee),
    (ChainPart::Toe, ChainPart::Ankle),
    (ChainPart::ShoulderRoll, ChainPart::Shoulder),
    (ChainPart::Elbow, ChainPart::ShoulderRoll),
    (ChainPart::UpperForearm, ChainPart::ShoulderRoll),
    (ChainPart::LowerForearm, ChainPart::UpperForearm),
];

fn check_distinct(sides: [(ChainSide, &SideLayout); 2]) -> Result<(), LimbError> {
    let mut seen: Vec<(ChainSide, ChainPart, JointId)> = Vec::new();
    for (side, layout) in sides {
        for (part, joint) in COMMANDED.into_iter().zip(layout.commanded_joints()) {
            if let Some(&(first_side, first_part, _)) =
                seen.iter().find(|(.., other)| *other == joint)
            {
                return Err(LimbError::Twice {
                    joint,
                    side,
                    part,
                    first_side,
                    first_part,
                });
            }
            seen.push((side, part, joint));
        }
    }
    Ok(())
}

/// The body that a part is fixed to, or that its joint moves.
fn body_of(robot: &Robot, side: &SideLayout, part: ChainPart) -> BodyId {
    let joint = match part {
        ChainPart::Toe => return side.toe.0,
        ChainPart::Elbow => return side.elbow.0,
        ChainPart::Ankle => side.ankle,
        ChainPart::Knee => side.knee,
        ChainPart::Hip => side.hip,
        ChainPart::Shoulder => side.shoulder,
        ChainPart::ShoulderRoll => side.shoulder_roll,
        ChainPart::UpperForearm => side.forearm[0],
        ChainPart::LowerForearm => side.forearm[1],
    };
    robot.joints[joint.0].body
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::robot::testing;

    #[test]
    fn limbs_in_order_pass() {
        assert_eq!(check_limbs(&testing::two_armed()), Ok(()));
    }

    #[test]
    fn limit_a_joint_has_one_part() {
        let mut robot = testing::two_armed();
        robot.chain.right.knee = robot.chain.left.hip;
        let error = check_limbs(&robot).unwrap_err().to_string();
        assert_eq!(
            error,
            "the joint of the right knee is that of the left hip already"
        );
    }

    #[test]
    fn limit_a_part_hangs_on_the_one_before_it() {
        let mut robot = testing::two_armed();
        let left = &mut robot.chain.left;
        std::mem::swap(&mut left.knee, &mut left.ankle);
        let error = check_limbs(&robot).unwrap_err().to_string();
        assert_eq!(error, "the left ankle does not hang on the left knee");
        let mut robot = testing::two_armed();
        robot.chain.left.elbow.0 = robot.chain.right.elbow.0;
        let error = check_limbs(&robot).unwrap_err().to_string();
        assert_eq!(
            error,
            "the left elbow does not hang on the left shoulder_roll"
        );
    }

    #[test]
    fn limit_sides_are_not_exchanged() {
        let mut robot = testing::two_armed();
        let chain = &mut robot.chain;
        std::mem::swap(&mut chain.left, &mut chain.right);
        let error = check_limbs(&robot).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the left hip is not to the left of the right one"
        );
    }
}
