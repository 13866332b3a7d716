//! Figure 28: the robot before, under and past what it crawls under, one instant below the other.

use glam::DVec3;
use rayon::prelude::*;

use prone_sim::World;
use prone_sim::camera::{self, Camera, Picture};
use prone_sim::crawl::Crawl;

use crate::frames::{Frames, FramesError, Wording, stacked};

/// How many instants are shown.
const INSTANTS: usize = 6;

/// Width of a frame, pixels.
const WIDTH: usize = 1200;

/// Room ahead of and behind the root over the whole way, m: a robot stretched out, and a little.
const BEHIND: f64 = 0.45;
const AHEAD: f64 = 0.45;

/// What a frame shows above and below its middle together, m: somewhat more than the thesis' table.
const HEIGHT: f64 = 0.5;

/// Height of the point in the middle of a frame, m.
const MIDDLE: f64 = 0.16;

/// How far away the camera stands, in widths of what it shows: far, so that it sees all parts of
/// the way from nearly the same side.
const DISTANCE: f64 = 2.5;

/// How far above the horizontal, in the same measure as one to the side: low, so that it sees
/// under the plate.
const RISE: f64 = 0.13;

/// Takes the pictures from the robot's right with a camera that stays where it is; nothing without
/// rows.
pub(crate) fn sequence(
    world: &World,
    gait: &str,
    crawl: &Crawl,
) -> Result<Option<Frames>, FramesError> {
    let (Some(first), Some(last)) = (crawl.rows.first(), crawl.rows.last()) else {
        return Ok(None);
    };
    let xs = crawl
        .rows
        .iter()
        .map(|row| row.ground_from_root.origin().x());
    let (low, high) = xs.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
        (low.min(x), high.max(x))
    });
    let (low, high) = (low - BEHIND, high + AHEAD);
    let width = high - low;
    let y = f64::midpoint(
        first.ground_from_root.origin().metres().y,
        last.ground_from_root.origin().metres().y,
    );
    let target = DVec3::new(f64::midpoint(low, high), y, MIDDLE);
    let direction = DVec3::new(0.0, -1.0, RISE).normalize();
    let distance = DISTANCE * width;
    let camera = Camera {
        position: target + distance * direction,
        target,
        vertical_fov: 2.0 * (HEIGHT / 2.0 / distance).atan(),
        up: DVec3::Z,
        inside: None,
    };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "some hundred pixels"
    )]
    let size = (WIDTH, (WIDTH as f64 * HEIGHT / width).round() as usize);
    let count = INSTANTS.min(crawl.rows.len());
    let instants: Vec<usize> = (0..count)
        .map(|index| index * (crawl.rows.len() - 1) / (count - 1).max(1))
        .collect();
    let pictures: Vec<Picture> = instants
        .par_iter()
        .map(|&index| camera::ray_cast(&mut world.at(&crawl.snapshots[index]), &camera, size))
        .collect();
    let labels: Vec<String> = instants
        .iter()
        .map(|&index| {
            let row = &crawl.rows[index];
            format!("{:.1} s, cycle {}", row.time, row.cycle + 1)
        })
        .collect();
    let scene = &world.scene().name;
    let said = labels.join("; ");
    let wording = Wording {
        stem: format!("fig-28-{gait}-sequence"),
        number: "28",
        title: format!("The simulated robot, {gait}, scene {scene}"),
        caption: format!(
            "The robot at {said} (top to bottom) of a crawl of {} cycles with {gait}, ray cast from \
             our simulation. It crawls to the right; plates and panels are drawn as glass, lines on \
             the floor are 100 mm apart, heavy ones 500 mm. The camera does not move.",
            crawl.cycles.len()
        ),
        alt: format!(
            "{count} pictures of the simulated robot crawling to the right on its belly, at {said}."
        ),
    };
    Ok(Some(stacked(&pictures, &labels, wording)?))
}
