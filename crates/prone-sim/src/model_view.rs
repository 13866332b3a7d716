//! A world as bodies, shapes and boxes: all that someone else needs to draw it.

use glam::{DQuat, DVec3};
use mujoco_rs::prelude::*;

use prone::robot::BodyId;

use crate::engine_numbers::{collides, rotation};
use crate::world::{GeomRole, World};

/// A shape of the robot as the engine has it, whether it collides or is only seen.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeView {
    /// The body that it is fixed to.
    pub body: BodyId,
    /// `sphere`, `capsule`, `cylinder`, `ellipsoid` or `box`; long axis along z.
    pub kind: &'static str,
    /// Radius and half-length along z, half-axes, or half-edges, as many as the kind has, m.
    pub size: Vec<f64>,
    /// Its middle in the body, m.
    pub position: DVec3,
    /// Its turn in the body.
    pub rotation: DQuat,
    /// Red, green, blue, opacity, 0 to 1.
    pub colour: [f64; 4],
    /// The engine's group: 0 to 2 are drawn.
    pub group: i32,
    /// Whether it collides.
    pub collides: bool,
}

/// How hard a body is to turn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InertiaView {
    /// About the axes of `rotation`, through the centre of mass, kg·m².
    pub principal: DVec3,
    /// From the principal axes to the body's own.
    pub rotation: DQuat,
}

impl World {
    /// Inertia of each of the robot's bodies, in their order.
    pub fn inertia_views(&self) -> Vec<InertiaView> {
        let moments = self.model.body_inertia().iter();
        let turns = self.model.body_iquat().iter();
        moments
            .zip(turns)
            .skip(1) // the world
            .map(|(&principal, &turn)| InertiaView {
                principal: DVec3::from_array(principal),
                rotation: rotation(turn),
            })
            .collect()
    }

    /// The robot's shapes, in the order of the engine's model. A kind that the engine has and this
    /// list has not, such as a mesh, is left out.
    pub fn shape_views(&self) -> Vec<ShapeView> {
        let model = &self.model;
        let shapes = self.geom_roles.iter().enumerate();
        let views = shapes.filter_map(|(index, role)| {
            let GeomRole::Robot(body) = *role else {
                return None;
            };
            let [x, y, z] = model.geom_size()[index];
            let (kind, size) = match model.geom_type()[index] {
                MjtGeomBase::mjGEOM_SPHERE => ("sphere", vec![x]),
                MjtGeomBase::mjGEOM_CAPSULE => ("capsule", vec![x, y]),
                MjtGeomBase::mjGEOM_CYLINDER => ("cylinder", vec![x, y]),
                MjtGeomBase::mjGEOM_ELLIPSOID => ("ellipsoid", vec![x, y, z]),
                MjtGeomBase::mjGEOM_BOX => ("box", vec![x, y, z]),
                _ => return None,
            };
            Some(ShapeView {
                body,
                kind,
                size,
                position: DVec3::from_array(model.geom_pos()[index]),
                rotation: rotation(model.geom_quat()[index]),
                colour: self.colour(index),
                group: model.geom_group()[index],
                collides: collides(model, index),
            })
        });
        views.collect()
    }

    /// Of its material where it has one, else its own.
    fn colour(&self, geom: usize) -> [f64; 4] {
        let material = usize::try_from(self.model.geom_matid()[geom]);
        let rgba = match material {
            Ok(material) => self.model.mat_rgba()[material],
            Err(_) => self.model.geom_rgba()[geom],
        };
        rgba.map(f64::from)
    }
}
