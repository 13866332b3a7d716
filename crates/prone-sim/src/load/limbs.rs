//! The limbs of the chain, refused at the name in `robot.toml` that is in the wrong place.

use prone::robot::{ChainPart, ChainSide, LimbError};
use prone_files::robot_file::{ChainTable, Name, SideTable};

/// The name in the file that a refusal is about, and the refusal in the file's words.
pub(super) fn misplaced<'a>(error: &LimbError, table: &'a ChainTable) -> (&'a Name, String) {
    match *error {
        LimbError::Twice {
            side,
            part,
            first_side,
            first_part,
            ..
        } => {
            let name = name(table, side, part);
            let joint = name.get_ref();
            let message = format!("joint {joint} is the {first_side} {first_part} already");
            (name, message)
        }
        LimbError::Loose { side, outer, inner } => {
            let (name, ancestor) = (name(table, side, outer), name(table, side, inner));
            let message = format!(
                "{} {} does not hang on {} {}",
                described(outer),
                name.get_ref(),
                described(inner),
                ancestor.get_ref()
            );
            (name, message)
        }
        LimbError::Exchanged { part } => {
            let [left, right] = [ChainSide::Left, ChainSide::Right].map(|s| name(table, s, part));
            let (name, other) = (left.get_ref(), right.get_ref());
            let message = format!("{name} of [chain.left] is not to the left of {other}");
            (left, message)
        }
    }
}

/// What `robot.toml` names as a part of the chain.
fn name(table: &ChainTable, side: ChainSide, part: ChainPart) -> &Name {
    let side: &SideTable = match side {
        ChainSide::Left => &table.left,
        ChainSide::Right => &table.right,
    };
    match part {
        ChainPart::Toe => &side.toe,
        ChainPart::Ankle => &side.ankle,
        ChainPart::Knee => &side.knee,
        ChainPart::Hip => &side.hip,
        ChainPart::Shoulder => &side.shoulder,
        ChainPart::ShoulderRoll => &side.shoulder_roll,
        ChainPart::Elbow => &side.elbow,
        ChainPart::UpperForearm => &side.forearm[0],
        ChainPart::LowerForearm => &side.forearm[1],
    }
}

/// A part before a name: the forearm's are joints, which "upper forearm" alone does not say.
fn described(part: ChainPart) -> String {
    match part {
        ChainPart::UpperForearm | ChainPart::LowerForearm => format!("{part} joint"),
        _ => part.to_string(),
    }
}
