//! The corners in which a cycle has to hold: ways in which a robot and its floor may differ from the
//! model, one definition for passages, searches and confirmations.
//!
//! [`all`] has them in a fixed order. First come the sixteen of *uneven* ground: friction that differs
//! from side to side, and joints that are all off by up to 1°; seed by seed, with the slippery side at
//! the left and then at the right. Then each of the others comes alone: friction, masses, stiffness of
//! the servos, backlash, late commands. In all of them a cycle that can be steered is to hold its
//! heading, as it would be crawled; how is the business of whoever crawls.
//!
//! Everything else is as in the regime `locomotion`. `prone crawl run` has an option for each of
//! them, so that any corner can be crawled again by itself.

use std::fmt;

use prone::gait::cycle::TimeScale;
use prone::regime::{MotorServo, Regime};
use prone::robot::{JointAngles, JointId, Robot, SideLayout};
use prone::scene::{Scene, SideFriction};
use prone_optim::Random;
use prone_record::frontier::SettingKind;
use prone_sim::driven::LateCommands;
use prone_sim::{LoadedRobot, World, WorldError};

use super::setting::{Role, Setting, SettingSpec};

/// Friction on both sides of uneven ground.
pub const UNEVEN: [SideFriction; 2] = [
    SideFriction {
        left: 0.5,
        right: 0.9,
    },
    SideFriction {
        left: 0.9,
        right: 0.5,
    },
];

/// Largest calibration error of a joint on uneven ground, degrees.
pub const OFFSET_DEG: f64 = 1.0;

/// Seeds of these errors: one to so many.
const SEEDS: u64 = 8;

/// Seed of the delays of late commands.
const LATE_SEED: u64 = 1;

/// Longest delay of late commands, ms.
const LATE_MS: f64 = 20.0;

/// Corners that come alone, in their order.
const ALONE: [Corner; 8] = [
    Corner::Friction(0.4),
    Corner::Friction(1.0),
    Corner::Masses(0.9),
    Corner::Masses(1.1),
    Corner::Stiffness(0.5),
    Corner::Stiffness(2.0),
    Corner::Backlash { degrees: 1.0 },
    Corner::LATE,
];

/// One way in which a robot and its floor may differ from the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Corner {
    /// Friction that differs from side to side, and joints that are off by up to [`OFFSET_DEG`].
    Uneven {
        /// The friction.
        friction: SideFriction,
        /// Seed of the calibration errors.
        seed: u64,
    },
    /// Another friction, the same on both sides.
    Friction(f64),
    /// Masses and inertias of the robot, times a factor.
    Masses(f64),
    /// Stiffness of its servos, times a factor.
    Stiffness(f64),
    /// Gears with some play.
    Backlash {
        /// From one edge to the other, degrees.
        degrees: f64,
    },
    /// Commands that reach the servos late.
    LateCommands {
        /// Longest delay, ms.
        ms: f64,
        /// Seed of the delays.
        seed: u64,
    },
}

/// All corners, in their order.
pub fn all() -> impl Iterator<Item = Corner> {
    let seeds = 1..=SEEDS;
    let uneven = seeds.flat_map(|seed| UNEVEN.map(|friction| Corner::Uneven { friction, seed }));
    uneven.chain(ALONE)
}

/// Corners as settings of a robot in a scene. Corners that differ in calibration errors alone share one
/// compiled model.
///
/// # Errors
/// [`WorldError`] where the engine refuses one of them.
pub fn settings(
    robot: &LoadedRobot,
    scene: &Scene,
    corners: impl IntoIterator<Item = Corner>,
    asked: Asked,
) -> Result<Vec<Setting>, WorldError> {
    let mut settings: Vec<Setting> = Vec::new();
    for corner in corners {
        let spec = corner.spec(robot.robot(), asked);
        let same =
            |it: &&Setting| it.spec.regime == spec.regime && it.spec.friction == spec.friction;
        let setting = match settings.iter().find(same) {
            Some(like) => Setting {
                world: World::clone(&like.world),
                spec,
            },
            None => spec.compile_in(robot, scene.clone())?,
        };
        settings.push(setting);
    }
    Ok(settings)
}

/// Of every joint an angle drawn evenly from ±`largest`, rad: first of those of arms and legs that a
/// pull moves, left then right, then of all others in the model's order. Joints that one motor turns
/// are off by the same angle, that of the first of them.
pub fn offsets(robot: &Robot, largest: f64, seed: u64) -> JointAngles {
    let mut random = Random::new(seed);
    let mut offsets = JointAngles::zero(robot);
    let chain = robot.chain.sides().map(SideLayout::commanded_joints);
    let chain: Vec<JointId> = chain.into_iter().flatten().collect();
    let all = (0..robot.joints.len()).map(JointId);
    let others = all.filter(|joint| !chain.contains(joint));
    let order: Vec<JointId> = chain.iter().copied().chain(others).collect();
    for joint in order {
        offsets[joint] = largest * (2.0 * random.uniform() - 1.0);
    }
    for joints in &robot.shared_motors {
        for joint in joints {
            offsets[*joint] = offsets[joints[0]];
        }
    }
    offsets
}

/// What a corner is for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asked {
    /// How many cycles; the last one is measured.
    pub cycles: usize,
    /// What is asked of the cycle.
    pub role: Role,
}

impl Corner {
    /// Commands that are late, as the corner set has them.
    pub const LATE: Self = Self::LateCommands {
        ms: LATE_MS,
        seed: LATE_SEED,
    };

    /// What it is called in records.
    pub const fn kind(self) -> SettingKind {
        match self {
            Self::Uneven {
                friction: SideFriction { left, right },
                seed,
            } => SettingKind::UnevenBySeed { left, right, seed },
            Self::Friction(friction) => SettingKind::Friction(friction),
            Self::Masses(factor) => SettingKind::Masses(factor),
            Self::Stiffness(factor) => SettingKind::Stiffness(factor),
            Self::Backlash { degrees } => SettingKind::Backlash(degrees),
            Self::LateCommands { ms, .. } => SettingKind::LateCommands(ms),
        }
    }

    /// What it changes, in a sentence.
    pub fn sentence(self) -> String {
        match self {
            Self::Uneven {
                friction: SideFriction { left, right },
                seed,
            } => format!(
                "Friction is {left} at the left and {right} at the right, and each joint is off by up to {OFFSET_DEG}°, drawn by seed {seed}."
            ),
            Self::Friction(friction) => format!("Friction is {friction} on both sides."),
            Self::Masses(factor) => {
                format!("All masses and inertias of the robot are {factor} times its model's.")
            }
            Self::Stiffness(factor) => {
                format!("The servos are {factor} times as stiff as the robot's are taken to be.")
            }
            Self::Backlash { degrees } => format!("Every gear has {degrees}° of play."),
            Self::LateCommands { ms, seed } => format!(
                "The servos get a command every {} ms, each late by up to {ms} ms, drawn by seed {seed}.",
                LateCommands::SLOW * 1e3
            ),
        }
    }

    /// Friction by side, in place of the regime's.
    pub const fn friction(self) -> Option<SideFriction> {
        match self {
            Self::Uneven { friction, .. } => Some(friction),
            Self::Friction(friction) => Some(SideFriction {
                left: friction,
                right: friction,
            }),
            _ => None,
        }
    }

    /// What every commanded angle of a robot is off by, rad.
    pub fn offsets(self, robot: &Robot) -> Option<JointAngles> {
        match self {
            Self::Uneven { seed, .. } => Some(offsets(robot, OFFSET_DEG.to_radians(), seed)),
            _ => None,
        }
    }

    /// How late commands reach the servos.
    pub fn late(self) -> Option<LateCommands> {
        match self {
            Self::LateCommands { ms, seed } => Some(LateCommands::slow(ms, seed)),
            _ => None,
        }
    }

    /// Contacts, masses and motors.
    pub fn regime(self) -> Regime {
        let regime = Regime::LOCOMOTION;
        match self {
            Self::Masses(mass_factor) => Regime {
                mass_factor,
                ..regime
            },
            Self::Stiffness(stiffness_factor) => regime.with_motors(MotorServo {
                stiffness_factor,
                ..MotorServo::ROBOT
            }),
            Self::Backlash { degrees } => regime.with_motors(MotorServo {
                backlash: degrees.to_radians(),
                ..MotorServo::ROBOT
            }),
            Self::Uneven { .. } | Self::Friction(_) | Self::LateCommands { .. } => regime,
        }
    }

    /// The corner as a setting of a robot.
    pub fn spec(self, robot: &Robot, asked: Asked) -> SettingSpec {
        SettingSpec {
            kind: self.kind(),
            regime: self.regime(),
            friction: self.friction(),
            scale: TimeScale::ONE,
            pull: None,
            offsets: self.offsets(robot),
            late: self.late(),
            cycles: asked.cycles,
            turn: 0.0,
            held: true,
            role: asked.role,
        }
    }
}

/// The name of a corner for machines, which no two share and which never changes.
impl fmt::Display for Corner {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Uneven {
                friction: SideFriction { left, right },
                seed,
            } => write!(f, "uneven-{left}-{right}-seed-{seed}"),
            Self::Friction(friction) => write!(f, "friction-{friction}"),
            Self::Masses(factor) => write!(f, "mass-{factor}"),
            Self::Stiffness(factor) => write!(f, "stiffness-{factor}"),
            Self::Backlash { degrees } => write!(f, "backlash-{degrees}-deg"),
            Self::LateCommands { ms, .. } => write!(f, "late-{ms}-ms"),
        }
    }
}

#[cfg(test)]
mod tests;
