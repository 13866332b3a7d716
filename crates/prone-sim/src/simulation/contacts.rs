//! What the robot touches.

use glam::{DMat3, DVec3};

use prone::frames::Point;
use prone::robot::BodyId;
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

    /// Force on the robot in the ground frame, N.
    fn force(&self) -> DVec3 {
        let data = &self.simulation.data;
        let contact = &data.contact()[self.index];
        let [normal, across, along, ..] = data.contact_force(self.index);
        // Rows of the engine's frame are its axes; the first leads from the first geom to the
        // second, and the force is that on the second.
        let ground_from_contact = DMat3::from_cols_array(&contact.frame);
        let on_second = ground_from_contact * DVec3::new(normal, across, along);
        match self.simulation.role(contact.geom[1]) {
            Some(GeomRole::Robot(_)) => on_second,
            _ => -on_second,
        }
    }
}

impl Simulation {
    /// What the world does to the robot after the last step, contact by contact.
    pub fn contact_forces(&self) -> Vec<ContactForce> {
        let contacts = self.contacts().map(|contact| ContactForce {
            body: contact.body,
            obstacle: match contact.with {
                GeomRole::Obstacle(obstacle) => Some(obstacle),
                GeomRole::Robot(_) | GeomRole::Floor | GeomRole::Marker => None,
            },
            at: Point::new(DVec3::from_array(self.data.contact()[contact.index].pos)),
            force: contact.force(),
        });
        contacts.collect()
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
