//! What the robot touches.

use glam::{DMat3, DVec3};

use prone::frames::{Ground, Point};
use prone::robot::BodyId;
use prone::scene::ContactForce;

use super::Simulation;
use crate::world::GeomRole;

/// A contact of the robot with an obstacle of its scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ObstacleContact {
    /// The part of the robot.
    pub body: BodyId,
    /// The obstacle's place in [`prone::scene::Scene::obstacles`].
    pub obstacle: usize,
    /// Normal force, N.
    pub normal: f64,
}

/// A contact of the robot with anything else.
pub(super) struct Contact<'s> {
    pub(super) body: BodyId,
    pub(super) with: GeomRole,
    simulation: &'s Simulation,
    index: usize,
}

impl Contact<'_> {
    /// Normal force, N.
    pub(super) fn normal(&self) -> f64 {
        let [normal, ..] = self.simulation.data.contact_force(self.index);
        normal
    }

    /// Force on the robot in the ground frame, N.
    fn force(&self) -> DVec3 {
        let data = &self.simulation.data;
        let contact = &data.contact()[self.index];
        let [normal, across, along, ..] = data.contact_force(self.index);
        // Rows of the engine's frame are its axes; the first leads from the first geom to the
        // second, and the force is that on the second.
        let ground_from_contact = DMat3::from_cols_array(&contact.frame);
        let on_second = ground_from_contact * DVec3::new(normal, across, along);
        let second =
            usize::try_from(contact.geom[1]).map(|geom| self.simulation.world.geom_roles[geom]);
        if matches!(second, Ok(GeomRole::Robot(_))) {
            on_second
        } else {
            -on_second
        }
    }

    fn at(&self) -> Point<Ground> {
        Point::new(DVec3::from_array(
            self.simulation.data.contact()[self.index].pos,
        ))
    }
}

impl Simulation {
    /// The robot's contacts with obstacles after the last step, ramps included.
    pub fn obstacle_contacts(&self) -> impl Iterator<Item = ObstacleContact> {
        self.contacts().filter_map(|contact| match contact.with {
            GeomRole::Obstacle(obstacle) => Some(ObstacleContact {
                body: contact.body,
                obstacle,
                normal: contact.normal(),
            }),
            GeomRole::Robot(_) | GeomRole::Floor | GeomRole::Marker => None,
        })
    }

    /// What the world does to the robot after the last step, contact by contact.
    pub fn contact_forces(&self) -> Vec<ContactForce> {
        let contacts = self.contacts().map(|contact| ContactForce {
            body: contact.body,
            obstacle: match contact.with {
                GeomRole::Obstacle(obstacle) => Some(obstacle),
                GeomRole::Robot(_) | GeomRole::Floor | GeomRole::Marker => None,
            },
            at: contact.at(),
            force: contact.force(),
        });
        contacts.collect()
    }

    /// The robot's contacts with anything but itself.
    pub(super) fn contacts(&self) -> impl Iterator<Item = Contact<'_>> {
        let contacts = self.data.contact().iter().enumerate();
        contacts.filter_map(|(index, contact)| {
            let role = |geom| Some(self.world.geom_roles[usize::try_from(geom).ok()?]);
            let [one, other] = contact.geom.map(role);
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
