//! What the robot touches.

use std::collections::BTreeMap;

use glam::{DMat3, DVec3};

use prone::frames::Point;
use prone::robot::{BodyId, ContactGroup};
use prone::scene::ContactForce;

use super::Simulation;
use crate::world::GeomRole;

/// A contact of the robot with anything but itself.
pub(crate) struct Contact<'s> {
    pub(crate) body: BodyId,
    pub(crate) with: GeomRole,
    simulation: &'s Simulation,
    index: usize,
}

impl Contact<'_> {
    /// Normal force, N.
    pub(crate) fn normal(&self) -> f64 {
        let [normal, ..] = self.simulation.data.contact_force(self.index);
        normal
    }

    /// The contact with its force on the robot in the ground frame.
    fn force(&self) -> ContactForce {
        let data = &self.simulation.data;
        let contact = &data.contact()[self.index];
        let [normal, across, along, ..] = data.contact_force(self.index);
        // Rows of the engine's frame are its axes; the first leads from the first geom to the
        // second, and the force is that on the second.
        let ground_from_contact = DMat3::from_cols_array(&contact.frame);
        let on_second = ground_from_contact * DVec3::new(normal, across, along);
        ContactForce {
            body: self.body,
            obstacle: match self.with {
                GeomRole::Obstacle(obstacle) => Some(obstacle),
                GeomRole::Robot(_) | GeomRole::Floor | GeomRole::Marker => None,
            },
            at: Point::new(DVec3::from_array(contact.pos)),
            force: match self.simulation.role(contact.geom[1]) {
                Some(GeomRole::Robot(_)) => on_second,
                _ => -on_second,
            },
        }
    }
}

/// Sums of contact forces over engine steps, of which means are made.
#[derive(Debug, Clone, Default)]
pub(crate) struct ContactSums {
    steps: usize,
    ground: [f64; ContactGroup::COUNT],
    /// By body and obstacle: sum of forces, sum of places times the forces' sizes, sum of these.
    met: BTreeMap<(BodyId, Option<usize>), (DVec3, DVec3, f64)>,
}

impl ContactSums {
    /// Adds what the ground carries after an engine step, which is returned by [`ContactGroup::ALL`],
    /// N, and what every body meets where that is kept.
    pub(crate) fn add(
        &mut self,
        simulation: &Simulation,
        kept: Kept,
    ) -> [f64; ContactGroup::COUNT] {
        self.steps += 1;
        let ground = simulation.ground_contact();
        for (sum, force) in self.ground.iter_mut().zip(ground) {
            *sum += force;
        }
        if kept == Kept::Ground {
            return ground;
        }
        for contact in simulation.contacts() {
            let ContactForce {
                body,
                obstacle,
                at,
                force,
            } = contact.force();
            let (sum, place, weight) = self.met.entry((body, obstacle)).or_default();
            let size = force.length();
            *sum += force;
            *place += at.metres() * size;
            *weight += size;
        }
        ground
    }

    /// Mean normal force of the ground by [`ContactGroup::ALL`], N.
    pub(crate) fn ground(&self) -> [f64; ContactGroup::COUNT] {
        self.ground.map(|sum| sum / self.steps as f64)
    }

    /// Mean force of each body's contact with floor or obstacle, at the mean of its places weighted
    /// by force.
    pub(crate) fn forces(&self) -> Vec<ContactForce> {
        let met = self.met.iter().filter(|(_, (_, _, weight))| *weight > 0.0);
        let means = met.map(|(&(body, obstacle), &(sum, place, weight))| ContactForce {
            body,
            obstacle,
            at: Point::new(place / weight),
            force: sum / self.steps as f64,
        });
        means.collect()
    }
}

/// What is kept of contacts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kept {
    /// What the ground carries.
    Ground,
    /// What every body meets as well.
    EachBody,
}

impl Simulation {
    /// What the world does to the robot after the last step, contact by contact.
    pub fn contact_forces(&self) -> Vec<ContactForce> {
        self.contacts().map(|contact| contact.force()).collect()
    }

    /// Normal force of the ground now by [`ContactGroup::ALL`], both sides together, N. Parts of the
    /// robot that press on one another do not count, nor does what it bumps into.
    pub fn ground_contact(&self) -> [f64; ContactGroup::COUNT] {
        let mut forces = [0.0; ContactGroup::COUNT];
        for contact in self.contacts() {
            if self.world.is_ground(contact.with) {
                let body = &self.robot().bodies[contact.body.0];
                forces[body.contact_group as usize] += contact.normal();
            }
        }
        forces
    }

    /// What a geom of a contact is; `None` where the engine has no geom there.
    fn role(&self, geom: i32) -> Option<GeomRole> {
        let geom = usize::try_from(geom).ok()?;
        Some(self.world.geom_roles[geom])
    }

    /// The robot's contacts with anything but itself.
    pub(crate) fn contacts(&self) -> impl Iterator<Item = Contact<'_>> {
        let contacts = self.data.contact().iter().enumerate();
        contacts.filter_map(|(index, contact)| {
            let [one, other] = contact.geom.map(|geom| self.role(geom));
            let (body, with) = match (one?, other?) {
                (GeomRole::Robot(_), GeomRole::Robot(_)) => return None,
                (GeomRole::Robot(body), with) | (with, GeomRole::Robot(body)) => (body, with),
                _ => return None,
            };
            Some(Contact {
                body,
                with,
                simulation: self,
                index,
            })
        })
    }
}
