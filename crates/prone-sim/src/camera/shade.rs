//! The colours of geoms, floor and backdrop, as linear light.

use glam::DVec3;
use mujoco_rs::prelude::{MjModel, MjtGeomBase};

use super::Lens;
use super::light::{Openness, Studio};
use super::picture::linear_from_srgb;
use super::trace::{GLASS_GROUP, Hit};
use crate::engine_numbers::WORLD_BODY;

/// Light of the key lamp on a surface that faces it: slightly warm.
const KEY: DVec3 = DVec3::new(0.80, 0.77, 0.72);
/// Light from above on a surface that faces up: slightly cool.
const SKY: DVec3 = DVec3::new(0.40, 0.43, 0.47);
/// Light from the floor on a surface that faces down.
const BOUNCE: DVec3 = DVec3::new(0.25, 0.24, 0.23);
/// The backdrop at the horizon, into which the floor fades.
const HORIZON: DVec3 = DVec3::new(0.83, 0.85, 0.88);
/// The backdrop from `ZENITH_SINE` upwards.
const ZENITH: DVec3 = DVec3::new(0.52, 0.62, 0.75);
/// The sine of the elevation at which the backdrop stops changing.
const ZENITH_SINE: f64 = 0.5;
/// The share of light that plastic reflects at right angles (index of refraction 1.5).
const REFLECTION_AT_RIGHT_ANGLES: f64 = 0.04;

/// The floor between its lines.
const FLOOR: DVec3 = DVec3::new(0.66, 0.68, 0.70);
/// The floor fades into the backdrop between these multiples of the camera's distance.
const FADE: [f64; 2] = [1.2, 4.0];
/// The lines on the floor.
const GRIDS: [Grid; 2] = [
    Grid {
        spacing: 0.1,
        width: 0.0016,
        darkness: 0.30,
    },
    Grid {
        spacing: 0.5,
        width: 0.0036,
        darkness: 0.50,
    },
];

/// Lines on the floor along x and y, one of each through the origin.
struct Grid {
    /// From line to line, m.
    spacing: f64,
    /// Of one line, m.
    width: f64,
    /// The share of the floor's colour that a line takes away.
    darkness: f64,
}

/// How one geom looks.
pub(super) struct Look {
    is_floor: bool,
    /// Whether it is a plate or a panel of a scene.
    pub is_glass: bool,
    pub colour: DVec3,
    /// How much it covers where it is glass, 0..=1.
    pub alpha: f64,
    /// Strength of highlights, 0..=1, and how narrow they are, 0..=1: the engine's scales.
    specular: f64,
    shininess: f64,
    /// Light of its own, in shares of the colour.
    emission: f64,
}

impl Look {
    fn new(model: &MjModel, geom: usize) -> Self {
        let own = model.geom_rgba()[geom];
        let (rgba, [specular, shininess, emission]) =
            match usize::try_from(model.geom_matid()[geom]) {
                Ok(material) => {
                    let scales = [
                        model.mat_specular()[material],
                        model.mat_shininess()[material],
                        model.mat_emission()[material],
                    ];
                    (model.mat_rgba()[material], scales.map(f64::from))
                }
                // The engine's defaults for a geom without a material.
                Err(_) => (own, [0.5, 0.5, 0.0]),
            };
        let [red, green, blue, _] = rgba.map(f64::from);
        Self {
            is_floor: model.geom_type()[geom] == MjtGeomBase::mjGEOM_PLANE,
            is_glass: model.geom_group()[geom] == GLASS_GROUP
                && model.geom_bodyid()[geom] == WORLD_BODY,
            colour: DVec3::new(red, green, blue).map(linear_from_srgb),
            alpha: own[3].into(),
            specular,
            shininess,
            emission,
        }
    }
}

/// What colouring a ray needs to know beside the ray.
pub(super) struct View {
    /// By the engine's number of the geom.
    pub looks: Vec<Look>,
    pub studio: Studio,
    pub lens: Lens,
}

impl View {
    pub(super) fn new(model: &MjModel, studio: Studio, lens: Lens) -> Self {
        let geoms = 0..model.geom_type().len();
        Self {
            looks: geoms.map(|geom| Look::new(model, geom)).collect(),
            studio,
            lens,
        }
    }

    /// 1 where a ray found anything but a floor, else 0.
    pub(super) fn cover(&self, hit: Option<&Hit>) -> f64 {
        let is_subject = hit.is_some_and(|hit| !self.looks[hit.geom].is_floor);
        f64::from(u8::from(is_subject))
    }

    /// The colour that a ray of unit direction `direction` brings back.
    pub(super) fn colour(&self, direction: DVec3, hit: Option<&Hit>, open: Openness) -> DVec3 {
        let Some(hit) = hit else {
            return backdrop(direction);
        };
        let look = &self.looks[hit.geom];
        if look.is_floor {
            self.floor(direction, hit, open)
        } else {
            self.surface(direction, hit, look, open)
        }
    }

    /// A plastic surface: diffuse light, a highlight, and the backdrop's reflection.
    fn surface(&self, direction: DVec3, hit: &Hit, look: &Look, open: Openness) -> DVec3 {
        let normal = hit.normal;
        let facing = (-direction).dot(normal).clamp(0.0, 1.0);
        let diffuse = look.colour * (self.diffuse_light(normal, open) + look.emission);

        let halfway = (self.studio.toward_key - direction).normalize_or_zero();
        let sharpness = 8.0 + 112.0 * look.shininess;
        let highlight = KEY * open.key * normal.dot(halfway).max(0.0).powf(sharpness);

        // Fresnel in Schlick's form.
        let reflection = REFLECTION_AT_RIGHT_ANGLES
            + (1.0 - REFLECTION_AT_RIGHT_ANGLES) * (1.0 - facing).powi(5);
        let mirrored = backdrop(direction - 2.0 * direction.dot(normal) * normal);
        diffuse
            + look.specular * (0.5 * highlight + 0.5 * reflection * open.surroundings * mirrored)
    }

    fn floor(&self, direction: DVec3, hit: &Hit, open: Openness) -> DVec3 {
        let lit = FLOOR * (1.0 - self.lines(direction, hit)) * self.diffuse_light(hit.normal, open);
        let distance = hit.distance / self.lens.distance;
        lit.lerp(backdrop(direction), smooth_step(FADE, distance))
    }

    /// Light on a matt white surface.
    pub(super) fn diffuse_light(&self, normal: DVec3, open: Openness) -> DVec3 {
        let upward = 0.5 + 0.5 * normal.z;
        let key = normal.dot(self.studio.toward_key).max(0.0);
        BOUNCE.lerp(SKY, upward) * open.surroundings + KEY * key * open.key
    }

    /// How much the floor's lines darken what a pixel shows of the floor, 0..=1.
    fn lines(&self, direction: DVec3, hit: &Hit) -> f64 {
        let across = hit.distance * self.lens.pixel_angle();
        let along = across / direction.dot(hit.normal).abs().max(1e-3);
        let heading = direction.reject_from(hit.normal).normalize_or(DVec3::X);
        let extent = |cosine: f64, sine: f64| (along * cosine).hypot(across * sine);
        let (extent_x, extent_y) = (extent(heading.x, heading.y), extent(heading.y, heading.x));
        let dark = |grid: &Grid| {
            let x = grid.share(hit.point.x, extent_x);
            let y = grid.share(hit.point.y, extent_y);
            grid.darkness * (x + y - x * y)
        };
        GRIDS.iter().map(dark).fold(0.0, f64::max)
    }
}

impl Grid {
    /// The share of the interval of length `extent` around `middle` that lies on lines.
    fn share(&self, middle: f64, extent: f64) -> f64 {
        let extent = extent.max(1e-6);
        // The length of line between 0 and `end`; the lines begin at multiples of the spacing.
        let line_until = |end: f64| {
            let periods = (end / self.spacing).floor();
            periods * self.width + (end - periods * self.spacing).min(self.width)
        };
        let start = middle - extent / 2.0 + self.width / 2.0;
        (line_until(start + extent) - line_until(start)) / extent
    }
}

fn backdrop(direction: DVec3) -> DVec3 {
    HORIZON.lerp(ZENITH, smooth_step([0.0, ZENITH_SINE], direction.z))
}

/// 0 below the first edge, 1 above the second, smooth between.
fn smooth_step([start, end]: [f64; 2], value: f64) -> f64 {
    let share = ((value - start) / (end - start)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

#[cfg(test)]
mod tests {
    use super::Grid;

    const GRID: Grid = Grid {
        spacing: 0.1,
        width: 0.002,
        darkness: 1.0,
    };

    #[test]
    fn one_period_holds_one_line() {
        for middle in [-0.26, -0.0003, 0.0, 0.07] {
            // 1e-12: rounding.
            assert!((GRID.share(middle, GRID.spacing) - 0.02).abs() < 1e-12);
        }
    }

    #[test]
    fn lines_are_centered_on_multiples_of_the_spacing() {
        for line in [-0.3, 0.0, 0.2] {
            assert!((GRID.share(line, 0.002) - 1.0).abs() < 1e-9);
            assert!((GRID.share(line + 0.001, 0.002) - 0.5).abs() < 1e-9);
            assert!(GRID.share(line + 0.05, 0.002).abs() < 1e-9);
        }
    }
}
