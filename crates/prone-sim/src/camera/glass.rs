//! What stands before the robot and must not hide it: plates and panels, as tinted glass.
//!
//! The rest of the picture does not know of it. It throws no shadow, and one layer is drawn.

use super::light::Openness;
use super::trace::{GLASS, Hit, Tracer};
use super::{Frame, Place};

/// A turned square of rays in a pixel, so that flat edges get all their steps.
const PLACES: [Place; 4] = [
    (0.375, 0.125),
    (0.875, 0.375),
    (0.125, 0.625),
    (0.625, 0.875),
];
/// The share of light that an edge of the glass takes away beside its tint.
const EDGE: f64 = 0.35;

impl Frame {
    /// Lays glass over a finished picture.
    pub(super) fn lay_glass(&mut self, tracer: &mut Tracer<'_>) {
        let view = &self.view;
        if !view.looks.iter().any(|look| look.is_glass) {
            return;
        }
        let width = view.lens.width;
        for row in 0..view.lens.height {
            let rays = view.lens.cast(tracer, GLASS, row, 0..width, &PLACES);
            for (column, rays) in rays.chunks(PLACES.len()).enumerate() {
                let pixel = row * width + column;
                let behind = self.hits[pixel].map_or(f64::INFINITY, |hit| hit.distance);
                let before = |hit: &&Hit| view.looks[hit.geom].is_glass && hit.distance < behind;
                let hits = rays.iter().filter_map(|(_, hit)| hit.as_ref());
                let seen: Vec<&Hit> = hits.filter(before).collect();
                let Some(first) = seen.first() else {
                    continue;
                };
                let share = seen.len() as f64 / PLACES.len() as f64;
                let whole = seen.len() == PLACES.len();
                let even = seen
                    .iter()
                    .all(|hit| hit.geom == first.geom && hit.normal.dot(first.normal) > 0.99);
                let look = &view.looks[first.geom];
                let tint = look.colour * view.diffuse_light(first.normal, Openness::FULL);
                let colour = &mut self.colours[pixel];
                *colour = colour.lerp(tint, look.alpha * share);
                if !(whole && even) {
                    *colour *= 1.0 - EDGE;
                }
            }
        }
    }
}
