//! A scene's solid parts as geoms of the engine.

use glam::DQuat;
use mujoco_rs::prelude::*;

use prone::scene::{Heights, Marker, Obstacle, ObstacleKind, Roughness, Scene};

use super::{GeomRole, add_world_geom};
use crate::camera;
use crate::engine_numbers::real_first;

/// The engine's name for the grid of heights.
const ROUGH: &str = "rough ground";

/// How far the rough ground reaches below the floor, m: the engine's grid needs a base.
const BASE: f64 = 0.05;

/// Half the thickness of the marker's disc, m.
const DISC_HALF_THICKNESS: f64 = 0.001;

const WOOD: [f32; 4] = [0.72, 0.58, 0.42, 1.0];
const STONE: [f32; 4] = [0.60, 0.60, 0.58, 1.0];
const RED: [f32; 4] = [0.85, 0.06, 0.08, 1.0];
/// Of plates and panels, which a robot is seen through.
const GLASS: [f32; 4] = [0.35, 0.55, 0.75, 0.35];

/// What a scene adds to the world, in the order in which it is added.
pub(super) struct Scenery<'a> {
    pub(super) scene: &'a Scene,
    rough: Option<(&'a Roughness, Heights)>,
    obstacles: Vec<Obstacle>,
}

impl<'a> Scenery<'a> {
    pub(super) fn from_scene(scene: &'a Scene) -> Self {
        let rough = scene.floor.roughness.as_ref();
        Self {
            scene,
            rough: rough.map(|rough| (rough, rough.heights())),
            obstacles: scene.obstacles(),
        }
    }

    /// Of the world's geoms: the floor, then all that [`Self::add_to`] adds.
    pub(super) fn roles(&self) -> Vec<GeomRole> {
        let rough = self.rough.iter().map(|_| GeomRole::Floor);
        let obstacles = (0..self.obstacles.len()).map(GeomRole::Obstacle);
        let marker = self.scene.marker.iter().map(|_| GeomRole::Marker);
        std::iter::once(GeomRole::Floor)
            .chain(rough)
            .chain(obstacles)
            .chain(marker)
            .collect()
    }

    pub(super) fn add_to(&self, spec: &mut MjSpec, friction: [f64; 3]) -> Result<(), MjEditError> {
        if let Some((rough, heights)) = &self.rough {
            add_rough(spec, rough, heights, friction)?;
        }
        for obstacle in &self.obstacles {
            add_obstacle(spec, obstacle, friction);
        }
        if let Some(marker) = &self.scene.marker {
            add_marker(spec, marker, friction);
        }
        Ok(())
    }
}

/// Bumps on the plane, which stays below: where they are flat, both carry.
fn add_rough(
    spec: &mut MjSpec,
    rough: &Roughness,
    heights: &Heights,
    friction: [f64; 3],
) -> Result<(), MjEditError> {
    let highest = heights.highest();
    // The engine wants shares of the highest point, as single precision.
    #[expect(clippy::cast_possible_truncation, reason = "a share of one")]
    let shares: Vec<f32> = heights
        .metres
        .iter()
        .map(|h| (h / highest) as f32)
        .collect();
    let points = |count: usize| i32::try_from(count).expect("a checked scene has few points");
    let grid = spec.add_hfield();
    grid.set_name(ROUGH)?;
    grid.with_nrow(points(heights.rows))
        .with_ncol(points(heights.columns))
        .with_size([rough.length / 2.0, rough.width / 2.0, highest, BASE])
        .set_userdata(&shares);
    add_world_geom(spec, friction)
        .with_type(MjtGeomBase::mjGEOM_HFIELD)
        .with_hfieldname(ROUGH)
        .with_pos([rough.from_x + rough.length / 2.0, 0.0, 0.0])
        .with_rgba(STONE);
    Ok(())
}

fn add_obstacle(spec: &mut MjSpec, obstacle: &Obstacle, friction: [f64; 3]) {
    let (colour, group) = match obstacle.kind {
        ObstacleKind::Plate | ObstacleKind::Panel => (GLASS, camera::GLASS_GROUP),
        ObstacleKind::PlateLeg | ObstacleKind::Ramp => (WOOD, 0),
    };
    add_world_geom(spec, friction)
        .with_type(MjtGeomBase::mjGEOM_BOX)
        .with_size(obstacle.half_edges.to_array())
        .with_pos(obstacle.ground_from_box.origin().metres().to_array())
        .with_quat(real_first(obstacle.ground_from_box.rotation()))
        .with_rgba(colour)
        .with_group(group);
}

fn add_marker(spec: &mut MjSpec, marker: &Marker, friction: [f64; 3]) {
    // A cylinder's axis is z: laid along x, then turned to its heading.
    let turn =
        DQuat::from_rotation_z(marker.facing) * DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2);
    add_world_geom(spec, friction)
        .with_type(MjtGeomBase::mjGEOM_CYLINDER)
        .with_size([marker.radius, DISC_HALF_THICKNESS, 0.0])
        .with_pos(marker.position.metres().to_array())
        .with_quat(real_first(turn))
        .with_rgba(RED)
        .with_contype(0)
        .with_conaffinity(0);
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use mujoco_rs::prelude::MjData;

    use super::*;
    use crate::{LoadedRobot, RobotFiles, World};
    use prone::regime::Regime;
    use prone_files::shipped;

    /// A ray from above meets the ground where the grid of heights says.
    #[test]
    fn identity_the_engine_has_each_height_in_its_place() {
        let rough = Roughness {
            height: 0.02,
            spacing: 0.1,
            from_x: 2.0,
            length: 1.2,
            width: 1.0,
            seed: 5,
        };
        let mut scene = Scene::level();
        scene.floor.roughness = Some(rough);
        let loaded = LoadedRobot::load(RobotFiles::shipped(&shipped::NAO)).unwrap();
        let world = World::in_scene(&loaded, Regime::LOCOMOTION, &scene).unwrap();
        assert_eq!(world.geom_roles[..2], [GeomRole::Floor; 2]);
        let mut data = MjData::new(Arc::clone(&world.model));
        data.forward();
        let heights = rough.heights();
        for (index, height) in heights.metres.iter().enumerate() {
            let (row, column) = (index / heights.columns, index % heights.columns);
            if [0, heights.columns - 1].contains(&column) || [0, heights.rows - 1].contains(&row) {
                continue; // the border, where a ray may pass beside it
            }
            let x = rough.from_x + column as f64 * 0.1;
            let y = row as f64 * 0.1 - 0.5;
            // 1e-7 m aside: a ray through a corner of triangles may miss them all.
            let from = [x + 1e-7, y + 2e-7, 1.0];
            let (geoms, distances) =
                data.multi_ray(&from, &[[0.0, 0.0, -1.0]], None, true, None, 2.0, None);
            assert!(geoms[0].is_some());
            // 1e-6 m: single precision, and the slope over 1e-7 m.
            let found = 1.0 - distances[0];
            assert!(
                (found - height).abs() < 1e-6,
                "{row} {column}: {found} {height}"
            );
        }
    }
}
