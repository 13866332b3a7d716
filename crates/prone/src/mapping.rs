//! From chain angles to a robot's joints, and back.
//!
//! The chain's angles are measured from toe to elbow, a robot's joints from its trunk outwards,
//! each with its own zero and sign. Both are read from the robot ([`SideGeometry`]): at zero
//! joint angles link i has the relative angle θi⁰, and a pitch joint about ±y turns it by ∓q on
//! the trunk's far side (arm) and by ±q on the near side (leg):
//!
//! ```text
//! q_ankle = σ (θ2 − θ2⁰),  q_knee = σ (θ3 − θ3⁰),  q_hip = σ (θ4 − θ4⁰)       (1)
//! q_shoulder = −σ (θ5 − θ5⁰(r)),   σ = ±1 for an axis of ±y                   (2)
//! ```
//!
//! The upper arm is spread by the shoulder roll r, which sets the projected length l5(r) and its
//! zero angle. With the trunk at φ = θ1+…+θ4 the root is turned by φ⁰ − φ about +y, and a flat
//! forearm solves for the two elbow hinges a, b:
//!
//! ```text
//! R(shoulder) R(roll) R(a) R(b) f⁰ = R_y(φ⁰ − φ)ᵀ x̂                            (3)
//! ```
//!
//! exactly (Paden and Kahan's second subproblem, module `forearm`).
//!
//! Two variants, by name: [`MappingVariant::Exact`] takes every length, zero and the roll from
//! the robot; [`MappingVariant::Original`] takes lengths, ankle zero and roll as published, which
//! is how the published recordings were made.

mod forearm;
mod geometry;
mod kinematics;

pub use geometry::{GeometryError, SideGeometry};
pub use kinematics::check_kinematics;

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use crate::chain::{ChainAngles, ClosedChain, ClosureError};
use crate::robot::{JointAngles, Range, Robot};

/// Which chain and which offsets a mapping uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum MappingVariant {
    /// Lengths, zeros and roll from the robot's geometry.
    #[default]
    Exact,
    /// Lengths, ankle zero and roll as published.
    Original,
}

/// What the forearms do while the elbows are planted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ArmMode {
    /// They lie flat and point in the direction of travel.
    #[default]
    FlatForearm,
    /// Roll and elbow joints stay at fixed angles.
    Fixed,
}

impl MappingVariant {
    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Original => "original",
        }
    }
}

impl ArmMode {
    /// Name in files and records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FlatForearm => "flat-forearm",
            Self::Fixed => "fixed",
        }
    }
}

/// Turns chain angles into joint angles of one robot.
#[derive(Debug, Clone, PartialEq)]
pub struct Mapping {
    chain: ClosedChain,
    sides: [Side; 2],
    fixed_forearm: Option<[[f64; 2]; 2]>,
}

#[derive(Debug, Clone, PartialEq)]
struct Side {
    geometry: SideGeometry,
    /// θ2⁰ as the variant has it.
    ankle_zero: f64,
    /// How far the upper arm is spread outwards, rad.
    outward: f64,
    spread: Spread,
}

/// An upper arm's roll, and the zero angle θ5⁰ that goes with it, rad.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Spread {
    roll: f64,
    shoulder_zero: f64,
}

/// Why a mapping cannot be made, or a posture not be reached by it.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum MappingError {
    /// The robot's chain is not a sagittal one.
    #[error(transparent)]
    Geometry(#[from] GeometryError),
    /// The `original` mapping needs a published chain.
    #[error("robot {robot} has no published chain, which the mapping `original` needs")]
    NoPublishedChain {
        /// The robot's name.
        robot: String,
    },
    /// The fixed-arm mode needs the angles.
    #[error("robot {robot} has no fixed-arm angles, which the arm mode `fixed` needs")]
    NoFixedArm {
        /// The robot's name.
        robot: String,
    },
    /// The robot's own kinematics do not follow the planar chain.
    #[error(
        "the {side} {point} leaves the sagittal chain by {off_mm:.3} mm when the joints move: its joints and sites are not those of one limb, or left and right differ"
    )]
    DoesNotClose {
        /// `left` or `right`.
        side: &'static str,
        /// The first point, from the toe on, that is off.
        point: &'static str,
        /// By how much, mm.
        off_mm: f64,
    },
    /// The chain does not close.
    #[error(transparent)]
    Closure(#[from] ClosureError),
    /// The elbow's two hinges cannot point the forearm forward.
    #[error("the forearm cannot point forward: its hinges miss the direction by {miss:.4}")]
    ForearmOutOfReach {
        /// How much of the unit direction lies outside their reach.
        miss: f64,
    },
}

impl Mapping {
    /// The mapping of a robot.
    ///
    /// # Errors
    /// [`MappingError`] where the robot lacks what the variant or the arm mode needs.
    pub fn new(robot: &Robot, variant: MappingVariant, arm: ArmMode) -> Result<Self, MappingError> {
        let layout = &robot.chain;
        let [left, right] = layout
            .sides()
            .map(|side| SideGeometry::from_layout(robot, side));
        let [left, right] = [left?, right?];
        let published = match variant {
            MappingVariant::Exact => None,
            MappingVariant::Original => {
                Some(
                    layout
                        .published
                        .ok_or_else(|| MappingError::NoPublishedChain {
                            robot: robot.name.clone(),
                        })?,
                )
            }
        };
        let outward = match published {
            Some(published) => published.shoulder_roll,
            None => left.roll_for(layout.projected_upper_arm)?,
        };
        let fixed = match arm {
            ArmMode::FlatForearm => None,
            ArmMode::Fixed => Some(layout.fixed_arm.ok_or_else(|| MappingError::NoFixedArm {
                robot: robot.name.clone(),
            })?),
        };
        let mirror = left.mirror_signs(&right);
        let fixed_forearm = fixed.map(|fixed| {
            let [upper, lower] = fixed.forearm;
            [[upper, lower], [upper * mirror[0], lower * mirror[1]]]
        });
        let chain = match published {
            Some(published) => published.chain,
            None => left.closed_chain(layout.span, outward),
        };
        let sides = [left, right].map(|geometry| {
            let outward = fixed.map_or(outward, |fixed| fixed.shoulder_roll.abs());
            Side {
                ankle_zero: published.map_or(geometry.zero_angles[0], |p| -p.ankle_offset),
                outward,
                spread: Spread::from_outward(&geometry, outward),
                geometry,
            }
        });
        Ok(Self {
            chain,
            sides,
            fixed_forearm,
        })
    }

    /// The closed chain that belongs to this mapping.
    pub const fn chain(&self) -> &ClosedChain {
        &self.chain
    }

    /// Joint angles of both sides for chain angles; joints outside the chain stay at zero, and
    /// limits are not looked at.
    ///
    /// # Errors
    /// [`MappingError::ForearmOutOfReach`].
    pub fn joint_angles(
        &self,
        robot: &Robot,
        chain: &ChainAngles,
    ) -> Result<JointAngles, MappingError> {
        self.spread_joint_angles(robot, chain, [0.0; 2])
    }

    /// [`Mapping::joint_angles`] with the left and the right arm spread further outwards than the
    /// mapping has them, rad; a steered crawl spreads one and draws in the other.
    ///
    /// The planar chain stays as it is, so that a spread arm plants its elbow a little nearer.
    ///
    /// # Errors
    /// [`MappingError::ForearmOutOfReach`].
    pub fn spread_joint_angles(
        &self,
        robot: &Robot,
        chain: &ChainAngles,
        further: [f64; 2],
    ) -> Result<JointAngles, MappingError> {
        let spread = [0, 1].map(|index| self.sides[index].spread(further[index]));
        let mut joints = self.limb_angles(robot, chain, &spread);
        for (index, layout) in robot.chain.sides().into_iter().enumerate() {
            let forearm = if let Some(fixed) = self.fixed_forearm {
                fixed[index]
            } else {
                let ranges = layout.forearm.map(|id| robot.joints[id.0].range);
                self.sides[index].flat_forearm(
                    chain.trunk(),
                    joints[layout.shoulder],
                    spread[index].roll,
                    ranges,
                )?
            };
            for (id, angle) in layout.forearm.into_iter().zip(forearm) {
                joints[id] = angle;
            }
        }
        Ok(joints)
    }

    /// Equations (1) and (2) and the roll, in (−π, π]; all other joints, the forearms' included,
    /// at zero.
    fn limb_angles(&self, robot: &Robot, chain: &ChainAngles, spread: &[Spread; 2]) -> JointAngles {
        let mut joints = JointAngles::zero(robot);
        let sides = self.sides.iter().zip(spread).zip(robot.chain.sides());
        for ((side, spread), layout) in sides {
            let [_, zero_knee, zero_hip] = side.geometry.zero_angles;
            let sign = side.geometry.pitch_signs;
            joints[layout.ankle] = wrap(sign[0] * (chain.ankle - side.ankle_zero));
            joints[layout.knee] = wrap(sign[1] * (chain.knee - zero_knee));
            joints[layout.hip] = wrap(sign[2] * (chain.hip - zero_hip));
            joints[layout.shoulder] = wrap(-sign[3] * (chain.shoulder - spread.shoulder_zero));
            joints[layout.shoulder_roll] = spread.roll;
        }
        joints
    }

    /// The same with the mapping's own roll.
    fn unspread_limb_angles(&self, robot: &Robot, chain: &ChainAngles) -> JointAngles {
        self.limb_angles(robot, chain, &[0, 1].map(|index| self.sides[index].spread))
    }

    /// Pitch of the root (its turn about +y, rad) in a chain posture.
    pub fn root_pitch(&self, chain: &ChainAngles) -> f64 {
        self.sides[0].geometry.trunk_zero - chain.trunk()
    }

    /// The shoulder roll joint angle of the left side, rad.
    pub const fn shoulder_roll(&self) -> f64 {
        self.sides[0].spread.roll
    }

    /// The ankle joint angle minus θ2, left side, rad.
    pub fn ankle_offset(&self) -> f64 {
        -self.sides[0].ankle_zero
    }
}

impl Spread {
    /// Of an upper arm that is spread outwards by an angle, rad.
    fn from_outward(geometry: &SideGeometry, outward: f64) -> Self {
        Self {
            roll: geometry.outward_sign * outward,
            shoulder_zero: geometry.upper_arm(outward).1 - geometry.trunk_zero,
        }
    }
}

impl Side {
    /// The arm spread further outwards, rad.
    fn spread(&self, further: f64) -> Spread {
        // Compared, not subtracted: most gaits spread nothing, and the geometry is not asked then.
        if further == 0.0 {
            return self.spread;
        }
        Spread::from_outward(&self.geometry, self.outward + further)
    }

    /// Equation (3) for a trunk angle, a shoulder joint angle and a shoulder roll, rad.
    fn flat_forearm(
        &self,
        trunk: f64,
        shoulder: f64,
        roll: f64,
        ranges: [Range; 2],
    ) -> Result<[f64; 2], MappingError> {
        let geometry = &self.geometry;
        let root_pitch = geometry.trunk_zero - trunk;
        let forward_in_root = DQuat::from_rotation_y(-root_pitch) * DVec3::X;
        let arm = DQuat::from_axis_angle(geometry.shoulder_axis, shoulder)
            * DQuat::from_axis_angle(geometry.roll_axis, roll);
        let target = arm.inverse() * forward_in_root;
        forearm::point(geometry.forearm_axes, geometry.forearm_zero, target, ranges)
    }
}

/// The same angle in (−π, π]; NaN stays NaN.
fn wrap(angle: f64) -> f64 {
    let turns = (angle / TAU - 0.5).ceil();
    angle - turns * TAU
}

#[cfg(test)]
mod tests;
