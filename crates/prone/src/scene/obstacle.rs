//! What of a scene is solid, as boxes.

use glam::{DQuat, DVec3};

use super::{Legs, Panel, Plate, Ramp, Scene};
use crate::frames::{Geom, Ground, Transform};

/// A box that stands in a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacle {
    /// What it is part of.
    pub kind: ObstacleKind,
    /// Where its middle is and how it is turned.
    pub ground_from_box: Transform<Ground, Geom>,
    /// Half-edges, m.
    pub half_edges: DVec3,
}

/// What an obstacle is part of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ObstacleKind {
    /// The slab of a [`Plate`].
    Plate,
    /// One of its four legs.
    PlateLeg,
    /// A [`Panel`].
    Panel,
    /// A [`Ramp`].
    Ramp,
}

impl ObstacleKind {
    /// Name in records.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Plate => "plate",
            Self::PlateLeg => "plate leg",
            Self::Panel => "panel",
            Self::Ramp => "ramp",
        }
    }

    /// Whether it is there to be crawled on; what touches any other has bumped into it.
    pub const fn is_ground(self) -> bool {
        matches!(self, Self::Ramp)
    }
}

impl Scene {
    /// All obstacles: plates, each followed by its legs, then panels, then ramps.
    pub fn obstacles(&self) -> Vec<Obstacle> {
        let plates = self.plates.iter().flat_map(Plate::obstacles);
        let panels = self.panels.iter().map(Panel::obstacle);
        let ramps = self.ramps.iter().map(Ramp::obstacle);
        plates.chain(panels).chain(ramps).collect()
    }
}

impl Plate {
    /// The slab, then the legs: near right, near left, far right, far left.
    fn obstacles(&self) -> Vec<Obstacle> {
        let half_width = self.width / 2.0;
        let end = self.start + self.length;
        let slab = upright(
            ObstacleKind::Plate,
            DVec3::new(self.start, -half_width, self.height),
            DVec3::new(end, half_width, self.height + self.thickness),
        );
        let legs = match self.legs {
            Legs::None => Vec::new(),
            Legs::Four => [self.start, end - Self::LEG]
                .into_iter()
                .flat_map(|x| [-half_width, half_width - Self::LEG].map(|y| (x, y)))
                .map(|(x, y)| {
                    upright(
                        ObstacleKind::PlateLeg,
                        DVec3::new(x, y, 0.0),
                        DVec3::new(x + Self::LEG, y + Self::LEG, self.height),
                    )
                })
                .collect(),
        };
        std::iter::once(slab).chain(legs).collect()
    }
}

impl Panel {
    fn obstacle(&self) -> Obstacle {
        let half_width = self.width / 2.0;
        upright(
            ObstacleKind::Panel,
            DVec3::new(self.start, -half_width, self.lower_edge),
            DVec3::new(self.start + self.thickness, half_width, self.upper_edge),
        )
    }
}

impl Ramp {
    /// A board whose upper face begins on the floor; its near end dips below it.
    fn obstacle(&self) -> Obstacle {
        // A turn about +y lifts +x where it is negative.
        let rotation = DQuat::from_rotation_y(-self.angle);
        let half_edges = DVec3::new(self.length, self.width, Self::THICKNESS) / 2.0;
        let upper_near_edge = DVec3::new(-half_edges.x, 0.0, half_edges.z);
        let middle = DVec3::X * self.start - rotation * upper_near_edge;
        Obstacle {
            kind: ObstacleKind::Ramp,
            ground_from_box: Transform::new(rotation, middle),
            half_edges,
        }
    }
}

/// A box along the axes between two corners.
fn upright(kind: ObstacleKind, lowest: DVec3, highest: DVec3) -> Obstacle {
    Obstacle {
        kind,
        ground_from_box: Transform::translation(lowest.midpoint(highest)),
        half_edges: (highest - lowest) / 2.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frames::Point;

    /// A corner of the box, by the signs of its coordinates in the box.
    fn corner(obstacle: &Obstacle, signs: [f64; 3]) -> DVec3 {
        let in_box = Point::<Geom>::new(DVec3::from_array(signs) * obstacle.half_edges);
        (obstacle.ground_from_box * in_box).metres()
    }

    #[test]
    fn a_plate_has_its_underside_at_its_height_and_legs_below() {
        let scene = Scene::under_plate(0.2, 1.5);
        let [slab, legs @ ..] = &scene.obstacles()[..] else {
            panic!("a slab");
        };
        // 1e-15: halving and adding of numbers about one.
        assert!((corner(slab, [-1.0; 3]) - DVec3::new(0.05, -0.5, 0.2)).length() < 1e-15);
        assert!((corner(slab, [1.0; 3]) - DVec3::new(1.55, 0.5, 0.218)).length() < 1e-15);
        assert_eq!(legs.len(), 4);
        for leg in legs {
            let (low, high) = (corner(leg, [-1.0; 3]), corner(leg, [1.0; 3]));
            assert!(low.z.abs() < 1e-15 && (high.z - 0.2).abs() < 1e-15);
            // Outside a robot that is 0.9 m wide.
            assert!(low.y > 0.45 || high.y < -0.45, "{low} {high}");
            assert!(low.x > 0.05 - 1e-15 && high.x < 1.55 + 1e-15);
        }
    }

    #[test]
    fn a_ramp_begins_on_the_floor_and_rises() {
        let ramp = Ramp {
            start: 1.1,
            length: 2.0,
            angle: 30_f64.to_radians(),
            width: 0.8,
        };
        let board = ramp.obstacle();
        let near = corner(&board, [-1.0, 1.0, 1.0]);
        assert!(
            (near - DVec3::new(1.1, 0.4, 0.0)).length() < 1e-15,
            "{near}"
        );
        let far = corner(&board, [1.0, -1.0, 1.0]);
        let expected = DVec3::new(1.1 + 3_f64.sqrt(), -0.4, 1.0);
        assert!((far - expected).length() < 1e-15, "{far}");
        // Its near end does not stick out before it.
        assert!(corner(&board, [-1.0, 1.0, -1.0]).z < 0.0);
    }
}
