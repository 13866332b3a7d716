//! Whether the joints and points of the chain follow one another along the limbs.
//!
//! A joint in the wrong place often still gives some chain. So each joint has one part, lies
//! beyond the one before it on the way from the trunk to toe or forearm, and is on its own side.

use std::fmt;

use glam::DVec3;

use super::{BodyId, JointAngles, JointId, Robot, SideLayout};
use crate::frames::{Root, Transform};

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
    check_distinct(&sides)?;
    for (side, layout) in sides {
        for limb in limbs(robot, layout) {
            check_order(robot, side, &limb)?;
        }
    }
    check_sides(robot)
}

const fn joints(side: &SideLayout) -> [(ChainPart, JointId); 7] {
    let [upper, lower] = side.forearm;
    [
        (ChainPart::Ankle, side.ankle),
        (ChainPart::Knee, side.knee),
        (ChainPart::Hip, side.hip),
        (ChainPart::Shoulder, side.shoulder),
        (ChainPart::ShoulderRoll, side.shoulder_roll),
        (ChainPart::UpperForearm, upper),
        (ChainPart::LowerForearm, lower),
    ]
}

fn check_distinct(sides: &[(ChainSide, &SideLayout); 2]) -> Result<(), LimbError> {
    let mut seen: Vec<(ChainSide, ChainPart, JointId)> = Vec::new();
    for (side, layout) in sides {
        for (part, joint) in joints(layout) {
            if let Some(&(first_side, first_part, _)) =
                seen.iter().find(|(.., other)| *other == joint)
            {
                return Err(LimbError::Twice {
                    joint,
                    side: *side,
                    part,
                    first_side,
                    first_part,
                });
            }
            seen.push((*side, part, joint));
        }
    }
    Ok(())
}

/// Leg, arm and forearm: parts with the body that each moves or is fixed to, from the trunk on.
fn limbs(robot: &Robot, side: &SideLayout) -> [Vec<(ChainPart, BodyId)>; 3] {
    let moved = |part, joint: JointId| (part, robot.joints[joint.0].body);
    let [upper, lower] = side.forearm;
    let roll = moved(ChainPart::ShoulderRoll, side.shoulder_roll);
    [
        vec![
            moved(ChainPart::Hip, side.hip),
            moved(ChainPart::Knee, side.knee),
            moved(ChainPart::Ankle, side.ankle),
            (ChainPart::Toe, side.toe.0),
        ],
        vec![
            moved(ChainPart::Shoulder, side.shoulder),
            roll,
            (ChainPart::Elbow, side.elbow.0),
        ],
        vec![
            roll,
            moved(ChainPart::UpperForearm, upper),
            moved(ChainPart::LowerForearm, lower),
        ],
    ]
}

/// The joints are distinct, so each moves another body; a point may be on the last one's.
fn check_order(
    robot: &Robot,
    side: ChainSide,
    limb: &[(ChainPart, BodyId)],
) -> Result<(), LimbError> {
    for pair in limb.windows(2) {
        let [(inner, ancestor), (outer, body)] = *pair else {
            continue;
        };
        if !robot.moves_with(body, ancestor) {
            return Err(LimbError::Loose { side, outer, inner });
        }
    }
    Ok(())
}

/// y is to the left.
fn check_sides(robot: &Robot) -> Result<(), LimbError> {
    let poses = robot.forward_kinematics(
        Transform::<Root, Root>::translation(DVec3::ZERO),
        &JointAngles::zero(robot),
    );
    let sideways = |id: JointId| {
        let joint = &robot.joints[id.0];
        poses.point((joint.body, joint.anchor)).metres().y
    };
    let [left, right] = robot.chain.sides();
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
