//! How near the parts of a robot come to one another.
//!
//! The robot's colliding shapes do not touch one another in the simulation, so nothing there stops
//! a hand on its way through the head. Here the distance of shapes is measured, in a posture alone:
//! no floor, no time.
//!
//! Compared are the shapes of different limbs: arms with head, arms with legs, left with right arm,
//! left with right leg. A limb begins where it leaves what it shares with the others: with the body
//! next to the trunk below the hips or the shoulders.
//!
//! Of all other bodies, trunk and pelvis too, those are compared that are no neighbours. Two bodies
//! are neighbours where one is the other's parent, or where any shape of one touches a shape of the
//! other with every joint at zero: on most models the two sides of a joint overlap there by design,
//! and would in most postures. On the NAO these are, beside parents: head and trunk, trunk and thighs,
//! pelvis and thighs, shins and feet, upper arms and forearms. A pair that remains overlaps in less than one
//! in twenty of all postures within the stops, evenly drawn.
//!
//! The engine measures ([`MjData::geom_distance`]), whatever a shape may touch. Between spheres and
//! capsules that is exact, to other shapes it is iterated, to about 1e-6 m. Overlapping shapes have
//! a negative distance, how far one must move to be free. Between two capsules this is exact only
//! until their axes cross.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::DVec3;
use mujoco_rs::prelude::*;

use prone::robot::{BodyId, JointAngles, JointId, Robot};

use crate::engine_numbers::{FREE_JOINT, collides, robot_body};
use crate::world::World;

/// Farther apart the engine does not look, m: a robot's coordinates are within 10 m, and no robot
/// has a hundred links in a row.
const FARTHEST: f64 = 1e3;
/// What the engine's iterated distances are surely off by no more than, m.
const ITERATED: f64 = 1e-5;

/// Measures postures of the robot of one world.
#[derive(Debug, Clone)]
pub struct SelfCollision {
    robot: Arc<Robot>,
    data: MjData<Arc<MjModel>>,
    /// Pairs of shapes that may meet, as indices in [`Robot::shapes`].
    pairs: Vec<[usize; 2]>,
    /// The engine's geom of every shape.
    geoms: Vec<usize>,
    /// Radius of a ball about each shape's origin that holds it, m.
    radii: Vec<f64>,
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

/// Which limbs are compared, whatever their shapes do at zero.
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

/// The nearest pair so far.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    /// m.
    pub(crate) distance: f64,
    /// Its place in [`SelfCollision::pairs`].
    pair: usize,
    /// The posture's place in the sequence.
    index: usize,
}

/// Why a distance is not known.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SelfCollisionError {
    /// There are no two shapes to compare.
    #[error("robot {robot} has no two colliding shapes of bodies that could meet")]
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
        let geoms = geoms(&world.model, &robot);
        let bounds = world.model.geom_rbound();
        let mut collision = Self {
            data: MjData::new(Arc::clone(&world.model)),
            pairs: limb_pairs(&robot),
            radii: geoms.iter().map(|&geom| bounds[geom]).collect(),
            geoms,
            robot,
        };
        collision.add_bodies()?;
        if collision.pairs.is_empty() {
            return Err(SelfCollisionError::NoPairs {
                robot: collision.robot.name.clone(),
            });
        }
        Ok(collision)
    }

    /// Adds all pairs of shapes whose bodies are no neighbours.
    fn add_bodies(&mut self) -> Result<(), SelfCollisionError> {
        let robot = Arc::clone(&self.robot);
        self.place(&JointAngles::zero(&robot), 0)?;
        let count = robot.shapes.len();
        let all = (0..count).flat_map(|one| (one + 1..count).map(move |other| [one, other]));
        let all: Vec<[usize; 2]> = all.collect();
        let bodies = |pair: [usize; 2]| pair.map(|shape| robot.shapes[shape].body);
        let mut touching = BTreeSet::new();
        for &pair in &all {
            if self.distance(pair) <= 0.0 {
                touching.insert(bodies(pair).map(|body| body.0));
            }
        }
        let neighbours = |[one, other]: [BodyId; 2]| {
            let parent_of = |body: BodyId| robot.bodies[body.0].parent;
            one == other
                || parent_of(one) == Some(other)
                || parent_of(other) == Some(one)
                || touching.contains(&[one.0, other.0])
                || touching.contains(&[other.0, one.0])
        };
        let known: BTreeSet<[usize; 2]> = self.pairs.iter().map(|&pair| sorted(pair)).collect();
        let new = all
            .into_iter()
            .filter(|pair| !known.contains(pair) && !neighbours(bodies(*pair)));
        self.pairs.extend(new);
        Ok(())
    }

    /// The nearest pair in a sequence of postures: of equals the first pair in its first posture.
    /// What happens between two postures is not seen, and limits are not looked at.
    ///
    /// # Errors
    /// [`SelfCollisionError`] where a posture is none of this robot, or there is none.
    pub fn scan<'a>(
        &mut self,
        postures: impl IntoIterator<Item = &'a JointAngles>,
    ) -> Result<Nearest, SelfCollisionError> {
        let mut best: Option<Found> = None;
        for (index, posture) in postures.into_iter().enumerate() {
            best = Some(self.nearer(best, posture, index)?);
        }
        let found = best.ok_or(SelfCollisionError::NoPostures)?;
        Ok(self.named(found))
    }

    /// The nearer of `best` and the nearest pair of a posture at a place of its sequence.
    pub(crate) fn nearer(
        &mut self,
        best: Option<Found>,
        posture: &JointAngles,
        index: usize,
    ) -> Result<Found, SelfCollisionError> {
        self.place(posture, index)?;
        let mut best = best.unwrap_or(Found {
            distance: f64::INFINITY,
            pair: 0,
            index,
        });
        for pair in 0..self.pairs.len() {
            if self.at_least_apart(self.pairs[pair]) > best.distance + ITERATED {
                continue;
            }
            let distance = self.distance(self.pairs[pair]);
            let order = distance.total_cmp(&best.distance);
            if order.then(pair.cmp(&best.pair)).is_lt() {
                best = Found {
                    distance,
                    pair,
                    index,
                };
            }
        }
        Ok(best)
    }

    /// A pair by the names of its shapes.
    pub(crate) fn named(&self, found: Found) -> Nearest {
        let [one, other] =
            self.pairs[found.pair].map(|shape| self.robot.shapes[shape].name.clone());
        Nearest {
            shapes: (one, other),
            distance_m: found.distance,
            index: found.index,
        }
    }

    /// Distance of a pair where the geoms are placed, m.
    fn distance(&mut self, pair: [usize; 2]) -> f64 {
        let [one, other] = pair.map(|shape| self.geoms[shape]);
        self.data.geom_distance(one, other, FARTHEST, None)
    }

    /// Distance of the balls that hold the shapes of a pair, m: theirs is no less.
    fn at_least_apart(&self, pair: [usize; 2]) -> f64 {
        let places = self.data.geom_xpos();
        let [one, other] = pair.map(|shape| DVec3::from_array(places[self.geoms[shape]]));
        let [radius, other_radius] = pair.map(|shape| self.radii[shape]);
        one.distance(other) - radius - other_radius
    }

    /// How near each pair comes, m, and in which posture: the first of equals.
    #[cfg(test)]
    fn distances<'a>(
        &mut self,
        postures: impl IntoIterator<Item = &'a JointAngles>,
    ) -> Result<Vec<(f64, usize)>, SelfCollisionError> {
        let mut nearest = vec![(f64::INFINITY, 0); self.pairs.len()];
        let mut count = 0;
        for (index, posture) in postures.into_iter().enumerate() {
            self.place(posture, index)?;
            for (pair, nearest) in nearest.iter_mut().enumerate() {
                let distance = self.distance(self.pairs[pair]);
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

/// Pairs of shapes of different limbs.
fn limb_pairs(robot: &Robot) -> Vec<[usize; 2]> {
    let limbs = limbs(robot);
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
    pairs
}

/// A pair with the smaller number first.
fn sorted([one, other]: [usize; 2]) -> [usize; 2] {
    [one.min(other), one.max(other)]
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
