//! Torque maps as text: the original author's layout, and that of this project, which extends it.
//!
//! Per row fourteen or eighteen comma-separated numbers, angles in rad, torques in N·m, forces in
//! N:
//!
//! ```text
//! θ1 θ2 θ3 θ4 θ5 α | AnklePitch KneePitch HipPitch ShoulderPitch | τ2 τ3 τ4 τ5 | toe elbow torso leg
//! ```
//!
//! The last four are the normal forces that carry the robot, both sides together; the original has
//! none. α outermost (descending), θ3 (ascending), θ4 innermost (descending). The limits of the
//! grid are the extreme values of the columns as printed; its inner nodes are equally spaced
//! between them. The original's numbers carry five digits, ours ten decimals.
//!
//! A line that begins with `#` is a comment. A row without torques has NaN in all four. Its mask is
//! [`Mask::Open`] where θ1, θ2 and θ5 are NaN too, since no chain closes there; else, with eighteen
//! columns, [`Mask::Failed`], and with the original's fourteen [`Mask::Missing`]. A row with
//! θ1 < 0 < θ2 was recorded on the mirrored root of equation (4) and is masked. Contact forces may
//! be NaN where they are not known.
//!
//! [`Mask::Open`]: super::Mask::Open
//! [`Mask::Failed`]: super::Mask::Failed
//! [`Mask::Missing`]: super::Mask::Missing

mod read;
mod write;

pub use read::{ParseError, comments, parse, parse_recorded};
pub use write::write;

/// Names of the columns, in order. Those of the joint angles are the original author's, and part of
/// the format: they mean ankle, knee, hip and shoulder of the chain, whatever a robot calls its joints.
pub const COLUMNS: [&str; 18] = [
    "theta1",
    "theta2",
    "theta3",
    "theta4",
    "theta5",
    "alpha",
    "AnklePitch",
    "KneePitch",
    "HipPitch",
    "ShoulderPitch",
    "tau2",
    "tau3",
    "tau4",
    "tau5",
    "toe",
    "elbow",
    "torso",
    "leg",
];

/// What a comment begins with.
const COMMENT: char = '#';

const TOE: usize = 0;
const ANKLE: usize = 1;
const KNEE: usize = 2;
const HIP: usize = 3;
const SHOULDER: usize = 4;
const UPPER_ARM: usize = 5;
const ANKLE_JOINT: usize = 6;
const FIRST_TORQUE: usize = 10;
const FIRST_FORCE: usize = 14;
