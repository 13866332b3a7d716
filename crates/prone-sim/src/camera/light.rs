//! The lamps of the studio, and how much of their light reaches a point.
//!
//! There is one key lamp, a disc, and light from all around: the sky above, the floor's reflection
//! below. Both are many small lamps, of which each pixel of a square tile tries only a few; the
//! mean over any square of that size has tried each lamp once (interleaved sampling: Keller and
//! Heidrich 2001). That gives soft shadows for a few rays per pixel, and no noise.

use std::f64::consts::TAU;

use glam::DVec3;

use super::trace::{Hit, Tracer};
use super::{Camera, SMOOTH_COSINE, square};

/// The edge of a tile, pixels; odd, so that a square of this size has a pixel in its middle.
const TILE: usize = 5;
/// A second, smaller mean rounds off the steps that a square leaves in the rim of a shadow; it
/// reaches over this many pixels to each side.
const FEATHER: usize = 1;
const PIXELS_PER_TILE: usize = TILE * TILE;
/// Lamps of the surroundings that one pixel tries; about half of them are behind its surface.
const SURROUNDING_LAMPS_PER_PIXEL: usize = 5;
const SURROUNDING_LAMPS: usize = PIXELS_PER_TILE * SURROUNDING_LAMPS_PER_PIXEL;
/// From the target to every lamp, m: many robots away, so that light is nearly parallel.
const LAMP_DISTANCE: f64 = 8.0;
/// The radius of the key lamp, m: as seen from the target 5°, a soft box in the photographer's
/// terms. It sets how soft shadows are.
const KEY_RADIUS: f64 = 0.7;
/// Points this far from the plane of the pixel do not share its light, m.
const SAME_SURFACE: f64 = 0.02;

/// The share of the light, 0..=1, that reaches a point unhindered.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Openness {
    /// Of the key lamp.
    pub key: f64,
    /// Of the light from all around.
    pub surroundings: f64,
}

impl Openness {
    /// All of it.
    pub(super) const FULL: Self = Self {
        key: 1.0,
        surroundings: 1.0,
    };
}

/// The lamps around one target.
pub(super) struct Studio {
    /// Unit vector from the target to the middle of the key lamp.
    pub toward_key: DVec3,
    key: [DVec3; PIXELS_PER_TILE],
    surroundings: [DVec3; SURROUNDING_LAMPS],
}

impl Studio {
    /// Sets up the lamps for a camera: the key lamp hangs high over the camera's left shoulder, so
    /// that every picture has its light from the upper left.
    pub(super) fn around(camera: &Camera) -> Self {
        let [ahead, right, _] = camera.axes();
        let ahead_on_floor = ahead
            .reject_from(DVec3::Z)
            .try_normalize()
            .unwrap_or(DVec3::X);
        let toward_key = (1.5 * DVec3::Z - 0.8 * right - 0.15 * ahead_on_floor).normalize();
        let (across, along) = toward_key.any_orthonormal_pair();
        let key = std::array::from_fn(|lamp| {
            let (x, y) = sunflower(lamp, PIXELS_PER_TILE);
            let on_disc = KEY_RADIUS * (x * across + y * along);
            camera.target + LAMP_DISTANCE * toward_key + on_disc
        });
        let surroundings = std::array::from_fn(|lamp| {
            camera.target + LAMP_DISTANCE * on_sphere(lamp, SURROUNDING_LAMPS)
        });
        Self {
            toward_key,
            key,
            surroundings,
        }
    }

    /// How much of the light reaches what each pixel shows; a pixel without a hit is open.
    pub(super) fn openness(
        &self,
        tracer: &mut Tracer<'_>,
        hits: &[Option<Hit>],
        width: usize,
    ) -> Vec<Openness> {
        let key = shares(&self.key, tracer, hits, width);
        let surroundings = shares(&self.surroundings, tracer, hits, width);
        let both = key.into_iter().zip(surroundings);
        both.map(|(key, surroundings)| Openness { key, surroundings })
            .collect()
    }
}

/// The share of the light of some lamps that reaches what each pixel shows. Every pixel of a tile
/// tries as many of the lamps, and all tiles try the same.
fn shares(
    lamps: &[DVec3],
    tracer: &mut Tracer<'_>,
    hits: &[Option<Hit>],
    width: usize,
) -> Vec<f64> {
    let mut lights = vec![Light::default(); hits.len()];
    for place in 0..PIXELS_PER_TILE {
        let pixels: Vec<(usize, &Hit)> = hits
            .iter()
            .enumerate()
            .filter(|&(pixel, _)| place_in_tile(pixel, width) == place)
            .filter_map(|(pixel, hit)| Some((pixel, hit.as_ref()?)))
            .collect();
        for &lamp in lamps.iter().skip(place).step_by(PIXELS_PER_TILE) {
            try_lamp(tracer, lamp, &pixels, &mut lights);
        }
    }
    let lights = sum_around(hits, &lights, width, TILE / 2);
    let lights = sum_around(hits, &lights, width, FEATHER);
    lights.into_iter().map(Light::share).collect()
}

/// Light at a point: the sum, over lamps of strength 1, of the cosine at the surface.
#[derive(Debug, Clone, Copy, Default)]
struct Light {
    /// What arrived.
    arrived: f64,
    /// What would have arrived without obstacles.
    sent: f64,
}

impl Light {
    fn add(&mut self, other: Self) {
        self.arrived += other.arrived;
        self.sent += other.sent;
    }

    fn share(self) -> f64 {
        if self.sent > 0.0 {
            self.arrived / self.sent
        } else {
            1.0
        }
    }
}

/// Sends a lamp's light to those of the pixels whose surface faces it.
fn try_lamp(tracer: &mut Tracer<'_>, lamp: DVec3, pixels: &[(usize, &Hit)], lights: &mut [Light]) {
    let cosine = |hit: &Hit| hit.normal.dot((lamp - hit.point).normalize());
    let (facing, points): (Vec<(usize, f64)>, Vec<DVec3>) = pixels
        .iter()
        .map(|&(pixel, hit)| ((pixel, cosine(hit)), hit.point))
        .filter(|&((_, cosine), _)| cosine > 0.0)
        .unzip();
    for ((pixel, cosine), seen) in facing.into_iter().zip(tracer.in_sight(lamp, &points)) {
        lights[pixel].add(Light {
            arrived: if seen { cosine } else { 0.0 },
            sent: cosine,
        });
    }
}

/// Adds up the square around each pixel, as far as it shows the same surface; the square reaches
/// over `reach` pixels to each side.
fn sum_around(hits: &[Option<Hit>], lights: &[Light], width: usize, reach: usize) -> Vec<Light> {
    let sum = |(pixel, hit): (usize, &Option<Hit>)| {
        let mut sum = Light::default();
        let Some(hit) = hit else {
            return sum;
        };
        for other in square(pixel, reach, width, hits.len()) {
            if hits[other].is_some_and(|other| same_surface(hit, &other)) {
                sum.add(lights[other]);
            }
        }
        sum
    };
    hits.iter().enumerate().map(sum).collect()
}

fn same_surface(a: &Hit, b: &Hit) -> bool {
    a.geom == b.geom
        && a.normal.dot(b.normal) > SMOOTH_COSINE
        && (b.point - a.point).dot(a.normal).abs() < SAME_SURFACE
}

fn place_in_tile(pixel: usize, width: usize) -> usize {
    (pixel / width) % TILE * TILE + (pixel % width) % TILE
}

/// Evenly spread points in the unit disc (Vogel's sunflower).
fn sunflower(index: usize, count: usize) -> (f64, f64) {
    let radius = ((index as f64 + 0.5) / count as f64).sqrt();
    let (sin, cos) = (index as f64 * golden_angle()).sin_cos();
    (radius * cos, radius * sin)
}

/// Evenly spread points on the unit sphere (Fibonacci's sphere).
fn on_sphere(index: usize, count: usize) -> DVec3 {
    let z = 1.0 - (2.0 * index as f64 + 1.0) / count as f64;
    let (sin, cos) = (index as f64 * golden_angle()).sin_cos();
    let radius = (1.0 - z * z).sqrt();
    DVec3::new(radius * cos, radius * sin, z)
}

/// The turn that splits a circle in the golden ratio, rad.
fn golden_angle() -> f64 {
    TAU * (1.0 - 2.0 / (1.0 + 5.0_f64.sqrt()))
}
