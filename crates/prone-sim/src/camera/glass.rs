//! What stands before the robot and must not hide it: plates and panels, as tinted glass.
//!
//! The rest of the picture does not know of it. It throws no shadow, and one layer is drawn.

use glam::DVec3;

use super::light::Openness;
use super::shade::View;
use super::trace::{Hit, Tracer};
use super::{Frame, Lens};

/// Places in a pixel, (0..1, 0..1): a turned square, so that flat edges get all their steps.
const PLACES: [(f64, f64); 4] = [
    (0.375, 0.125),
    (0.875, 0.375),
    (0.125, 0.625),
    (0.625, 0.875),
];
/// The share of light that an edge of the glass takes away beside its tint.
const EDGE: f64 = 0.35;

/// Lays glass over a finished picture.
pub(super) fn draw(frame: &mut Frame, tracer: &mut Tracer<'_>, view: &View<'_>, lens: &Lens) {
    for row in 0..frame.height {
        let places = (0..frame.width).flat_map(|column| PLACES.map(|place| (column, place)));
        let directions: Vec<DVec3> = places
            .map(|(column, place)| lens.direction(column, row, place))
            .collect();
        let hits = tracer.glass_hits(lens.position, &directions);
        for (column, hits) in hits.chunks(PLACES.len()).enumerate() {
            let pixel = row * frame.width + column;
            let behind = frame.hits[pixel].map_or(f64::INFINITY, |hit| hit.distance);
            let before = |hit: &&Hit| view.looks.is_scenery(hit) && hit.distance < behind;
            let seen: Vec<&Hit> = hits.iter().flatten().filter(before).collect();
            let Some(first) = seen.first() else {
                continue;
            };
            let share = seen.len() as f64 / PLACES.len() as f64;
            let whole = seen.len() == PLACES.len();
            let even = seen
                .iter()
                .all(|hit| hit.geom == first.geom && hit.normal.dot(first.normal) > 0.99);
            let (tint, alpha) = view.glass(first);
            let colour = &mut frame.colours[pixel];
            *colour = colour.lerp(tint, alpha * share);
            if !(whole && even) {
                *colour *= 1.0 - EDGE;
            }
        }
    }
}

impl View<'_> {
    /// The colour of a pane and how much it covers.
    fn glass(&self, hit: &Hit) -> (DVec3, f64) {
        let (colour, alpha) = self.looks.tint(hit);
        (
            colour * self.diffuse_light(hit.normal, Openness::FULL),
            alpha,
        )
    }
}
