//! Rays through the engine's geoms.

use std::sync::Arc;

use glam::DVec3;
use mujoco_rs::prelude::{MjData, MjModel};

use prone::robot::BodyId;

/// The groups of geoms that are seen as solid, 0 to 2: those that the engine's viewer shows from the
/// start.
pub(super) const SOLID: [u8; 6] = [1, 1, 1, 0, 0, 0];
/// The group of geoms that are glass. The engine's viewer hides it, and so do robots' models.
pub(crate) const GLASS_GROUP: i32 = 5;
/// The same for the engine's rays.
pub(super) const GLASS: [u8; 6] = [0, 0, 0, 0, 0, 1];
/// Farther than this nothing is seen, m.
const HORIZON: f64 = 100.0;
/// A surface this close to the end of a ray is the end of the ray, m.
const CONTACT: f64 = 1e-4;

/// Where a ray first meets a geom.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hit {
    /// The engine's number of the geom.
    pub geom: usize,
    /// In the ground frame, m.
    pub point: DVec3,
    /// Unit vector out of the surface.
    pub normal: DVec3,
    /// From the origin of the ray, m.
    pub distance: f64,
}

/// The engine as a caster of rays; the state does not change.
pub(super) struct Tracer<'a> {
    data: &'a mut MjData<Arc<MjModel>>,
    /// The engine's number of a body that rays from the camera pass through.
    unseen: Option<usize>,
}

impl<'a> Tracer<'a> {
    pub(super) fn new(data: &'a mut MjData<Arc<MjModel>>, unseen: Option<BodyId>) -> Self {
        Self {
            data,
            // The engine's body 0 is the world.
            unseen: unseen.map(|BodyId(body)| body + 1),
        }
    }

    /// Follows unit directions from one origin to the first geom of some groups.
    pub(super) fn hits(
        &mut self,
        groups: [u8; 6],
        origin: DVec3,
        directions: &[DVec3],
    ) -> Vec<Option<Hit>> {
        let arrays: Vec<[f64; 3]> = directions.iter().map(DVec3::to_array).collect();
        let mut normals = vec![[0.0; 3]; arrays.len()];
        let (geoms, distances) = self.data.multi_ray(
            &origin.to_array(),
            &arrays,
            Some(&groups),
            true,
            self.unseen,
            HORIZON,
            Some(&mut normals),
        );
        geoms
            .into_iter()
            .zip(distances)
            .zip(directions.iter().zip(normals))
            .map(|((geom, distance), (&direction, normal))| {
                Some(Hit {
                    geom: geom?,
                    point: origin + distance * direction,
                    normal: DVec3::from_array(normal),
                    distance,
                })
            })
            .collect()
    }

    /// Whether each point is in sight of the origin.
    pub(super) fn in_sight(&mut self, origin: DVec3, points: &[DVec3]) -> Vec<bool> {
        let arrays: Vec<[f64; 3]> = points
            .iter()
            .map(|&point| (point - origin).normalize_or_zero().to_array())
            .collect();
        let (geoms, distances) = self.data.multi_ray(
            &origin.to_array(),
            &arrays,
            Some(&SOLID),
            true,
            None,
            HORIZON,
            None,
        );
        geoms
            .into_iter()
            .zip(distances)
            .zip(points)
            .map(|((geom, distance), &point)| {
                geom.is_none() || distance > origin.distance(point) - CONTACT
            })
            .collect()
    }
}
