//! How near a robot's limbs come to one another.
//!
//! The robot's colliding shapes do not touch one another in the simulation, so nothing there stops
//! a hand on its way through the head. Here the distance of every two shapes of different limbs is
//! measured, in a posture alone: no floor, no time.
//!
//! A limb begins where it leaves what it shares with the others: with the body next to the trunk
//! below the hips or the shoulders. Compared are arms with head, arms with legs, left with right
//! arm, left with right leg. Trunk and pelvis are not: on many models a limb's first shapes overlap
//! with them in every posture, by design.
//!
//! The engine measures ([`MjData::geom_distance`]), whatever a shape may touch. Between spheres and
//! capsules that is exact, to other shapes it is iterated, to about 1e-6 m. Overlapping shapes have
//! a negative distance, how far one must move to be free. Between two capsules this is exact only
//! until their axes cross.

use std::sync::Arc;

use mujoco_rs::prelude::*;

use prone::robot::{BodyId, JointAngles, JointId, Robot};

use crate::engine_numbers::{FREE_JOINT, collides, robot_body};
use crate::world::World;

/// Farther apart the engine does not look, m: a robot's coordinates are within 10 m, and no robot
/// has a hundred links in a row.
const FARTHEST: f64 = 1e3;

/// Measures postures of the robot of one world.
#[derive(Debug, Clone)]
pub struct SelfCollision {
    robot: Arc<Robot>,
    data: MjData<Arc<MjModel>>,
    /// Pairs of shapes that may meet, as indices in [`Robot::shapes`].
    pairs: Vec<[usize; 2]>,
    /// The engine's geom of every shape.
    geoms: Vec<usize>,
}

/// A part of the robot that moves by itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Limb {
    Head,
    LeftArm,
    RightArm,
    LeftLeg,
    RightLeg,
}

/// Which limbs are compared.
const LIMB_PAIRS: [(Limb, Limb); 8] = [
    (Limb::LeftArm, Limb::Head),
    (Limb::RightArm, Limb::Head),
    (Limb::LeftArm, Limb::RightArm),
    (Limb::LeftLeg, Limb::RightLeg),
    (Limb::LeftArm, Limb::LeftLeg),
    (Limb::LeftArm, Limb::RightLeg),
    (Limb::RightArm, Limb::LeftLeg),
    (Limb::RightArm, Limb::RightLeg),
];

/// The two shapes of a sequence of postures that come nearest to one another.
#[derive(Debug, Clone, PartialEq)]
pub struct Nearest {
    /// Their names.
    pub shapes: (String, String),
    /// Between their surfaces, m; negative where they overlap.
    pub distance_m: f64,
    /// The posture's place in the sequence.
    pub index: usize,
}

/// Why a distance is not known.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SelfCollisionError {
    /// The limbs have no shapes.
    #[error("robot {robot} has no two limbs with colliding shapes")]
    NoPairs {
        /// The robot's name.
        robot: String,
    },
    /// A posture of another robot.
    #[error("posture {index} has {count} joint angles, robot {robot} has {expected} joints")]
    JointCount {
        /// Its place in the sequence.
        index: usize,
        /// How many it has.
        count: usize,
        /// How many it needs.
        expected: usize,
        /// The robot's name.
        robot: String,
    },
    /// An angle is not a number.
    #[error("{joint} {angle} rad at posture {index} is no angle")]
    NotFinite {
        /// The joint's name.
        joint: String,
        /// What was given.
        angle: f64,
        /// The posture's place in the sequence.
        index: usize,
    },
    /// Nothing to scan.
    #[error("a sequence without postures has no smallest distance")]
    NoPostures,
}

impl SelfCollision {
    /// Finds the shapes that may meet.
    ///
    /// # Errors
    /// [`SelfCollisionError::NoPairs`].
    pub fn new(world: &World) -> Result<Self, SelfCollisionError> {
        let robot = world.shared_robot();
        let limbs = limbs(&robot);
        let shapes_of = |limb: Limb| -> Vec<usize> {
            let belongs = |&shape: &usize| limbs[robot.shapes[shape].body.0] == Some(limb);
            (0..robot.shapes.len()).filter(belongs).collect()
        };
        let mut pairs = Vec::new();
        for (one, other) in LIMB_PAIRS {
            for first in shapes_of(one) {
                pairs.extend(shapes_of(other).into_iter().map(|second| [first, second]));
            }
        }
        if pairs.is_empty() {
            return Err(SelfCollisionError::NoPairs {
                robot: robot.name.clone(),
            });
        }
        Ok(Self {
            data: MjData::new(Arc::clone(&world.model)),
            geoms: geoms(&world.model, &robot),
            robot,
            pairs,
        })
    }

    /// The nearest pair in a sequence of postures. What happens between two postures is not seen, and
    /// limits are not looked at.
    pub fn scan<'a>(
        &mut self,
        postures: impl IntoIterator<Item = &'a JointAngles>,
    ) -> Result<Nearest, SelfCollisionError> {
        let distances = self.distances(postures)?.into_iter();
        let nearest = distances
            .zip(&self.pairs)
            .min_by(|((one, _), _), ((other, _), _)| one.total_cmp(other));
        let Some(((distance_m, index), pair)) = nearest else {
            unreachable!("there are pairs");
        };
        let [one, other] = pair.map(|shape| self.robot.shapes[shape].name.clone());
        Ok(Nearest {
            shapes: (one, other),
            distance_m,
            index,
        })
    }

    /// How near each pair comes, m, and in which posture: the first of equals.
    fn distances<'a>(
        &mut self,
        postures: impl IntoIterator<Item = &'a JointAngles>,
    ) -> Result<Vec<(f64, usize)>, SelfCollisionError> {
        let mut nearest = vec![(f64::INFINITY, 0); self.pairs.len()];
        let mut count = 0;
        for (index, posture) in postures.into_iter().enumerate() {
            self.place(posture, index)?;
            for (pair, nearest) in self.pairs.iter().zip(&mut nearest) {
                let [one, other] = pair.map(|shape| self.geoms[shape]);
                let distance = self.data.geom_distance(one, other, FARTHEST, None);
                if distance < nearest.0 {
                    *nearest = (distance, index);
                }
            }
            count += 1;
        }
        if count == 0 {
            return Err(SelfCollisionError::NoPostures);
        }
        Ok(nearest)
    }

    /// Moves the engine's geoms to a posture; the root stays where the model has it.
    fn place(&mut self, posture: &JointAngles, index: usize) -> Result<(), SelfCollisionError> {
        let (angles, joints) = (posture.as_slice(), &self.robot.joints);
        if angles.len() != joints.len() {
            return Err(SelfCollisionError::JointCount {
                index,
                count: angles.len(),
                expected: joints.len(),
                robot: self.robot.name.clone(),
            });
        }
        if let Some((joint, &angle)) = joints.iter().zip(angles).find(|(_, q)| !q.is_finite()) {
            return Err(SelfCollisionError::NotFinite {
                joint: joint.name.clone(),
                angle,
                index,
            });
        }
        self.data.qpos_mut()[FREE_JOINT..].copy_from_slice(angles);
        self.data.kinematics();
        Ok(())
    }
}

/// The engine's geom of every shape: both are in the model's order, the world's geoms apart.
fn geoms(model: &MjModel, robot: &Robot) -> Vec<usize> {
    let of_robot =
        |&geom: &usize| collides(model, geom) && robot_body(model.geom_bodyid()[geom]).is_some();
    let geoms: Vec<usize> = (0..model.geom_bodyid().len()).filter(of_robot).collect();
    debug_assert_eq!(geoms.len(), robot.shapes.len());
    debug_assert!(geoms.iter().zip(&robot.shapes).all(|(&geom, shape)| {
        model
            .id_to_name(MjtObjBase::mjOBJ_GEOM, geom)
            .is_none_or(|name| name == shape.name)
    }));
    geoms
}

/// The limb of every body; `None` for trunk and pelvis.
fn limbs(robot: &Robot) -> Vec<Option<Limb>> {
    let [left, right] = robot.chain.sides();
    let body = |joint: JointId| robot.joints[joint.0].body;
    let starts = [
        (Limb::LeftArm, body(left.shoulder)),
        (Limb::RightArm, body(right.shoulder)),
        (Limb::LeftLeg, body(left.hip)),
        (Limb::RightLeg, body(right.hip)),
    ];
    let heads = (0..robot.bodies.len())
        .map(BodyId)
        .filter(|body| robot.bodies[body.0].is_head());
    let ends: Vec<(Limb, BodyId)> = starts
        .into_iter()
        .chain(heads.map(|body| (Limb::Head, body)))
        .collect();
    // A body belongs to a limb if it is on the way to that limb alone, or beyond it.
    let mut limbs: Vec<Option<Limb>> = vec![None; robot.bodies.len()];
    for (index, body) in robot.bodies.iter().enumerate() {
        let beyond = ends
            .iter()
            .filter(|(_, end)| robot.moves_with(*end, BodyId(index)));
        let mut leads_to: Vec<Limb> = beyond.map(|(limb, _)| *limb).collect();
        leads_to.dedup();
        limbs[index] = match (leads_to.as_slice(), body.parent) {
            (&[limb], Some(_)) => Some(limb),
            // Parents come before their children.
            ([], Some(parent)) => limbs[parent.0],
            _ => None,
        };
    }
    limbs
}

#[cfg(test)]
mod tests;
