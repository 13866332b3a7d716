//! Pictures of the simulated robot, ray cast on the CPU through the engine: no GPU, no window.
//!
//! Lengths are metres, angles radians. Points and directions are in the ground frame: x forward,
//! y left, z up. Colours are linear light until [`Picture`] encodes them as sRGB.
//!
//! All rays of one call to the engine start at one point, so that its bounding volumes can rule
//! out most geoms at once. Rays to a lamp therefore run backwards, from the lamp. The steps:
//!
//! 1. one ray per pixel from the camera finds geom, point and normal (`trace`);
//! 2. rays from the lamps find how much of the light reaches each of these points (`light`);
//! 3. pixels beside an edge are cast again with more rays, and every ray is coloured (`shade`);
//! 4. the silhouette is darkened, so that a white robot stands out on white paper (`outline`);
//! 5. plates and panels of a scene are laid over it as tinted glass (`glass`).
//!
//! Nothing is random and nothing depends on a clock: the same state gives the same bytes.

mod eye;
mod glass;
mod light;
mod outline;
mod picture;
mod shade;
mod trace;

use std::sync::Arc;

use glam::DVec3;
use mujoco_rs::prelude::{MjData, MjModel};

use prone::robot::{BodyId, Robot};

pub use picture::{Picture, PictureError};

use light::{Openness, Studio};
use shade::{Looks, View};
pub(crate) use trace::GLASS_GROUP;
use trace::{Hit, Tracer};

/// Rays per pixel beside an edge.
const RAYS_PER_EDGE_PIXEL: u32 = 16;
/// Normals whose cosine is below this belong to two sides of an edge: 15°.
const SMOOTH_COSINE: f64 = 0.966;

/// Length of the lying robot for which the lengths of pictures are written, here and in `prone-study`,
/// m.
const DRAWN_FOR: f64 = 0.6;

/// How much larger a robot is than the one that pictures are written for: lengths that frame it are
/// multiplied by this, angles are not.
pub fn scale(robot: &Robot) -> f64 {
    robot.lying_length / DRAWN_FOR
}

/// Where a picture is taken from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Where the camera stands, m, in the ground frame.
    pub position: DVec3,
    /// What is in the middle of the picture, m, in the ground frame.
    pub target: DVec3,
    /// The angle between the lower and the upper edge of the picture, rad.
    pub vertical_fov: f64,
    /// What points up in the picture, in the ground frame.
    pub up: DVec3,
    /// The part of the robot that it is built into, which it does not see.
    pub inside: Option<BodyId>,
}

impl Camera {
    /// How far the ready-made cameras stand from their target at scale 1, m: far enough that the
    /// near arm does not look longer than the far one.
    const DISTANCE: f64 = 2.4;
    /// The field of view from the side, rad: a picture of 16:9 is 0.90 m wide at the target, around
    /// a robot 0.6 m long.
    const SIDE_FOV: f64 = 0.21;
    /// The field of view from the corner, rad: the near hand is closer and lower in the picture.
    const CORNER_FOV: f64 = 0.25;

    /// From the robot's right and slightly above: the robot crawls to the right.
    ///
    /// `middle` is the middle of the robot, m, in the ground frame; `scale` is its [`scale`].
    pub fn right_side(middle: DVec3, scale: f64) -> Self {
        Self::from_direction(middle, DVec3::new(0.05, -1.0, 0.20), scale, Self::SIDE_FOV)
    }

    /// From the front, the right and above: both arms and the head are visible.
    ///
    /// `middle` is the middle of the robot, m, in the ground frame; `scale` is its [`scale`].
    pub fn three_quarter(middle: DVec3, scale: f64) -> Self {
        Self::from_direction(
            middle,
            DVec3::new(0.75, -0.80, 0.45),
            scale,
            Self::CORNER_FOV,
        )
    }

    fn from_direction(target: DVec3, direction: DVec3, scale: f64, vertical_fov: f64) -> Self {
        Self {
            position: target + Self::DISTANCE * scale * direction.normalize(),
            target,
            vertical_fov,
            up: DVec3::Z,
            inside: None,
        }
    }

    /// The unit vectors ahead, to the right and up in the picture.
    ///
    /// A camera that looks straight along its `up` has the robot's forward at the top of its picture;
    /// a camera that stands on its target looks forward.
    fn axes(&self) -> [DVec3; 3] {
        let ahead = (self.target - self.position)
            .try_normalize()
            .unwrap_or(DVec3::X);
        let right = ahead.cross(self.up).try_normalize().unwrap_or(DVec3::NEG_Y);
        [ahead, right, right.cross(ahead)]
    }
}

/// Takes a picture of `size` (width, height) pixels.
///
/// Geoms of groups 0 to 2 are visible, as in the engine's own viewer; planes are drawn as a floor
/// with lines every 100 mm and stronger lines every 500 mm. Transparency is not drawn but for the
/// plates and panels of a scene; a fully transparent geom is invisible.
///
/// `data` must be up to date: call `forward()` after changing the pose. It is borrowed mutably
/// because the engine casts rays with scratch memory of its own; the state does not change.
pub fn ray_cast(data: &mut MjData<Arc<MjModel>>, camera: &Camera, size: (usize, usize)) -> Picture {
    let (width, height) = size;
    let looks = Looks::of(data.model());
    let has_glass = Looks::has_glass(data.model());
    let lens = Lens::new(camera, size);
    let studio = Studio::around(camera);
    let mut tracer = Tracer::new(data, camera.inside);

    let hits = first_hits(&mut tracer, &lens);
    let openness = studio.openness(&mut tracer, &hits, width);
    let view = View {
        looks: &looks,
        studio: &studio,
        camera,
        pixel_angle: lens.pixel_angle(),
    };
    let mut frame = Frame {
        width,
        height,
        hits,
        openness,
        colours: Vec::new(),
        cover: Vec::new(),
    };
    frame.colour_pixels(&view, &lens);
    frame.refine_edges(&mut tracer, &view, &lens);
    outline::draw(&mut frame.colours, &frame.cover, width);
    if has_glass {
        glass::draw(&mut frame, &mut tracer, &view, &lens);
    }
    Picture::from_linear(size, &frame.colours)
}

/// One ray through the middle of each pixel, row by row.
fn first_hits(tracer: &mut Tracer<'_>, lens: &Lens) -> Vec<Option<Hit>> {
    let mut hits = Vec::with_capacity(lens.width * lens.height);
    for row in 0..lens.height {
        let directions: Vec<DVec3> = (0..lens.width)
            .map(|column| lens.direction(column, row, (0.5, 0.5)))
            .collect();
        hits.extend(tracer.hits(lens.position, &directions));
    }
    hits
}

/// Turns a place in the picture into a direction in the ground frame.
struct Lens {
    width: usize,
    height: usize,
    position: DVec3,
    ahead: DVec3,
    /// One pixel to the right, at distance 1 ahead.
    right: DVec3,
    /// One pixel down, at distance 1 ahead.
    down: DVec3,
}

impl Lens {
    fn new(camera: &Camera, (width, height): (usize, usize)) -> Self {
        let pixel = 2.0 * (camera.vertical_fov / 2.0).tan() / height.max(1) as f64;
        let [ahead, right, up] = camera.axes();
        Self {
            width,
            height,
            position: camera.position,
            ahead,
            right: right * pixel,
            down: -up * pixel,
        }
    }

    /// The angle that one pixel covers, rad.
    fn pixel_angle(&self) -> f64 {
        self.right.length()
    }

    /// The unit direction through a pixel, at the offset (0..1, 0..1) from its upper left corner.
    fn direction(&self, column: usize, row: usize, (right, down): (f64, f64)) -> DVec3 {
        let from_middle_right = column as f64 + right - self.width as f64 / 2.0;
        let from_middle_down = row as f64 + down - self.height as f64 / 2.0;
        (self.ahead + from_middle_right * self.right + from_middle_down * self.down).normalize()
    }
}

/// The picture while it is made; every vector holds one value per pixel, row by row.
struct Frame {
    width: usize,
    height: usize,
    hits: Vec<Option<Hit>>,
    openness: Vec<Openness>,
    colours: Vec<DVec3>,
    /// The share of the pixel, 0..=1, that shows anything but a floor or the backdrop.
    cover: Vec<f64>,
}

impl Frame {
    /// Colours each pixel by the ray through its middle.
    fn colour_pixels(&mut self, view: &View<'_>, lens: &Lens) {
        for (pixel, (hit, &openness)) in self.hits.iter().zip(&self.openness).enumerate() {
            let direction = lens.direction(pixel % self.width, pixel / self.width, (0.5, 0.5));
            self.colours
                .push(view.colour(direction, hit.as_ref(), openness));
            self.cover
                .push(f64::from(u8::from(view.looks.is_subject(hit.as_ref()))));
        }
    }

    /// Replaces the pixels beside an edge by the mean of many rays.
    fn refine_edges(&mut self, tracer: &mut Tracer<'_>, view: &View<'_>, lens: &Lens) {
        for row in 0..self.height {
            let columns: Vec<usize> = (0..self.width)
                .filter(|&column| self.is_edge(column, row))
                .collect();
            let directions: Vec<DVec3> = columns
                .iter()
                .flat_map(|&column| {
                    (0..RAYS_PER_EDGE_PIXEL).map(move |ray| (column, place_in_pixel(ray)))
                })
                .map(|(column, place)| lens.direction(column, row, place))
                .collect();
            let hits = tracer.hits(lens.position, &directions);
            let rays = RAYS_PER_EDGE_PIXEL as usize;
            for (column, (hits, directions)) in columns
                .into_iter()
                .zip(hits.chunks(rays).zip(directions.chunks(rays)))
            {
                let mut colour = DVec3::ZERO;
                let mut subjects = 0.0;
                for (hit, &direction) in hits.iter().zip(directions) {
                    let openness = self.openness_beside(column, row, hit.as_ref());
                    colour += view.colour(direction, hit.as_ref(), openness);
                    subjects += f64::from(u8::from(view.looks.is_subject(hit.as_ref())));
                }
                let pixel = row * self.width + column;
                self.colours[pixel] = colour / f64::from(RAYS_PER_EDGE_PIXEL);
                self.cover[pixel] = subjects / f64::from(RAYS_PER_EDGE_PIXEL);
            }
        }
    }

    /// Whether a pixel and one of its neighbours show different surfaces.
    fn is_edge(&self, column: usize, row: usize) -> bool {
        let here = &self.hits[row * self.width + column];
        self.neighbourhood(column, row)
            .any(|pixel| match (here, &self.hits[pixel]) {
                (None, None) => false,
                (Some(a), Some(b)) => a.geom != b.geom || a.normal.dot(b.normal) < SMOOTH_COSINE,
                _ => true,
            })
    }

    /// The light that reaches a point seen within a pixel: that of the pixel in the neighbourhood
    /// which shows the same geom under the closest normal, else that of the pixel itself.
    fn openness_beside(&self, column: usize, row: usize, hit: Option<&Hit>) -> Openness {
        let alike = |pixel: usize| {
            let (hit, other) = (hit?, self.hits[pixel].as_ref()?);
            (hit.geom == other.geom).then(|| (hit.normal.dot(other.normal), pixel))
        };
        let closest = self
            .neighbourhood(column, row)
            .filter_map(alike)
            .max_by(|(a, _), (b, _)| a.total_cmp(b))
            .map_or(row * self.width + column, |(_, pixel)| pixel);
        self.openness[closest]
    }

    /// The pixels at most one column and one row away, the pixel itself among them.
    fn neighbourhood(&self, column: usize, row: usize) -> impl Iterator<Item = usize> + use<> {
        let width = self.width;
        let columns = column.saturating_sub(1)..(column + 2).min(width);
        let rows = row.saturating_sub(1)..(row + 2).min(self.height);
        rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }
}

/// The place of a ray in its pixel, (0..1, 0..1): Hammersley's points, no two of which share a
/// column or a row, so that edges near the horizontal and the vertical get all their steps.
fn place_in_pixel(ray: u32) -> (f64, f64) {
    let count = f64::from(RAYS_PER_EDGE_PIXEL);
    let mirrored = ray.reverse_bits() >> (u32::BITS - RAYS_PER_EDGE_PIXEL.ilog2());
    (
        (f64::from(ray) + 0.5) / count,
        (f64::from(mirrored) + 0.5) / count,
    )
}

#[cfg(test)]
mod tests;
