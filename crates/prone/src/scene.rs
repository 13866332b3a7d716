//! What a robot crawls on, under and towards: a scene as data.
//!
//! Convention: x = 0 is the robot's foremost point when it starts, +x its heading, y to its left,
//! z = 0 the floor. Everything but the marker is symmetric about y = 0. Lengths are metres, angles
//! radians. What is solid is a box ([`Scene::obstacles`]), the rough ground a grid of heights
//! ([`Roughness::heights`]); `prone-sim` gives both to the engine.

mod check;
mod contact;
mod obstacle;
mod rough;

pub use check::{Item, LOWEST_CEILING, MOST_POINTS, Quantity, SceneError, taken_for_metres};
pub use contact::{ContactForce, obstacle_name};
pub use obstacle::{Obstacle, ObstacleKind};
pub use rough::{Heights, Roughness};

use crate::frames::{Ground, Point};

/// A floor and what stands on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Name in records.
    pub name: String,
    /// One sentence.
    pub description: String,
    /// What it crawls on.
    pub floor: Floor,
    /// What it crawls under.
    pub plates: Vec<Plate>,
    /// Upright boards across the way.
    pub panels: Vec<Panel>,
    /// What it crawls up.
    pub ramps: Vec<Ramp>,
    /// What it looks for.
    pub marker: Option<Marker>,
}

/// The ground.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Floor {
    /// Friction by the robot's sides; `None` leaves it to the contact regime.
    pub friction: Option<SideFriction>,
    /// Uphill towards +x, rad. It tilts gravity instead of the floor, so that heights above the
    /// floor keep their meaning.
    pub slope: f64,
    /// A stretch of bumps.
    pub roughness: Option<Roughness>,
}

/// Sliding friction between the ground and the limbs of one side of the robot, wherever they
/// touch it. Trunk and head have the mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SideFriction {
    /// Of the left arm and leg.
    pub left: f64,
    /// Of the right arm and leg.
    pub right: f64,
}

/// A horizontal slab that the robot crawls under.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plate {
    /// x of its near edge.
    pub start: f64,
    /// Along x.
    pub length: f64,
    /// Along y, half of it on either side.
    pub width: f64,
    /// Of its underside above the floor.
    pub height: f64,
    /// Of the slab.
    pub thickness: f64,
    /// What it stands on.
    pub legs: Legs,
}

/// What a plate stands on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Legs {
    /// One post at each corner, flush with the edges.
    Four,
    /// Nothing: it hangs.
    None,
}

/// An upright board across x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Panel {
    /// x of its near face.
    pub start: f64,
    /// Along y, half of it on either side.
    pub width: f64,
    /// Height of its lower edge above the floor.
    pub lower_edge: f64,
    /// Height of its upper edge above the floor.
    pub upper_edge: f64,
    /// Along x.
    pub thickness: f64,
}

/// A slope that begins on the floor and ends in the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ramp {
    /// x where its surface leaves the floor.
    pub start: f64,
    /// Along its surface.
    pub length: f64,
    /// Of its surface with the floor, rad.
    pub angle: f64,
    /// Along y, half of it on either side.
    pub width: f64,
}

/// A red disc for the robot's camera; nothing collides with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Marker {
    /// Its centre.
    pub position: Point<Ground>,
    /// Of the disc.
    pub radius: f64,
    /// Heading of the disc's normal, rad about +z: 0 faces +x, π faces the robot that starts.
    pub facing: f64,
}

impl Scene {
    /// Near edge of the plate of [`Scene::under_plate`]: the robot begins outside.
    pub const CLEAR_START: f64 = 0.05;

    /// A level floor with the friction of the contact regime, and nothing on it.
    pub fn level() -> Self {
        Self {
            name: "level".to_owned(),
            description: "a level floor".to_owned(),
            floor: Floor::default(),
            plates: Vec::new(),
            panels: Vec::new(),
            ramps: Vec::new(),
            marker: None,
        }
    }

    /// A level floor under one plate with legs whose underside is at `height`.
    pub fn under_plate(height: f64, length: f64) -> Self {
        Self {
            name: "under-plate".to_owned(),
            description: format!("{length} m under a plate at {height} m"),
            plates: vec![Plate {
                start: Self::CLEAR_START,
                length,
                width: Plate::WIDTH,
                height,
                thickness: Plate::THICKNESS,
                legs: Legs::Four,
            }],
            ..Self::level()
        }
    }

    /// Whether it is the scene of [`Scene::level`], under whatever name.
    pub fn is_plain(&self) -> bool {
        let named = Self {
            name: self.name.clone(),
            description: self.description.clone(),
            ..Self::level()
        };
        *self == named
    }
}

impl SideFriction {
    /// That of trunk and head.
    pub const fn mean(self) -> f64 {
        f64::midpoint(self.left, self.right)
    }
}

impl Plate {
    /// Unless said otherwise: about three times the width of a child-sized humanoid's crawl.
    pub const WIDTH: f64 = 1.0;
    /// Unless said otherwise: a common board.
    pub const THICKNESS: f64 = 0.018;
    /// Edge of a leg's square section.
    pub const LEG: f64 = 0.02;
}

impl Panel {
    /// Unless said otherwise.
    pub const WIDTH: f64 = Plate::WIDTH;
    /// Unless said otherwise: thin plywood.
    pub const THICKNESS: f64 = 0.01;
}

impl Ramp {
    /// Unless said otherwise.
    pub const WIDTH: f64 = Plate::WIDTH;
    /// Of the board that it is made of, below its surface.
    pub const THICKNESS: f64 = 0.018;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plain_scene_is_level_under_any_name() {
        let mut scene = Scene::level();
        scene.name = "kitchen".to_owned();
        assert!(scene.is_plain());
        scene.floor.slope = 0.01;
        assert!(!scene.is_plain());
        assert!(!Scene::under_plate(0.2, 1.5).is_plain());
    }

    #[test]
    fn a_plate_by_height_and_length_is_a_valid_scene() {
        let scene = Scene::under_plate(0.2, 1.5);
        assert_eq!(scene.check(), Ok(()));
        let kinds: Vec<_> = scene.obstacles().iter().map(|o| o.kind.name()).collect();
        assert_eq!(
            kinds,
            ["plate", "plate leg", "plate leg", "plate leg", "plate leg"]
        );
    }
}
