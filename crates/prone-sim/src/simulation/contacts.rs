//! What the robot touches.

use prone::robot::BodyId;

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
    simulation: &'s Simulation<'s>,
    index: usize,
}

impl Contact<'_> {
    /// Normal force, N.
    pub(super) fn normal(&self) -> f64 {
        let [normal, ..] = self.simulation.data.contact_force(self.index);
        normal
    }
}

impl Simulation<'_> {
    /// The robot's contacts with obstacles after the last step, ramps included.
    pub fn obstacle_contacts(&self) -> Vec<ObstacleContact> {
        self.contacts()
            .filter_map(|contact| match contact.with {
                GeomRole::Obstacle(obstacle) => Some(ObstacleContact {
                    body: contact.body,
                    obstacle,
                    normal: contact.normal(),
                }),
                GeomRole::Robot(_) | GeomRole::Floor | GeomRole::Marker => None,
            })
            .collect()
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
