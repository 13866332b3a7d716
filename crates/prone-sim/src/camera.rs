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
//! 4. the silhouette is darkened, so that a white robot stands out on white paper;
//! 5. plates and panels of a scene are laid over it as tinted glass (`glass`).
//!
//! Nothing is random and nothing depends on a clock: the same state gives the same bytes.

mod glass;
mod light;
mod picture;
mod shade;
mod trace;

use std::sync::Arc;

use glam::{DMat3, DVec3};
use mujoco_rs::prelude::{MjData, MjModel};

use prone::robot::{BodyId, Robot};

pub use picture::{Picture, PictureError};

use crate::engine_numbers::robot_body;
use light::{Openness, Studio};
use shade::View;
pub(crate) use trace::GLASS_GROUP;
use trace::{Hit, SOLID, Tracer};

/// Rays per pixel beside an edge.
const RAYS_PER_EDGE_PIXEL: usize = 16;
/// Normals whose cosine is below this belong to two sides of an edge: 15°.
const SMOOTH_COSINE: f64 = 0.966;
/// The share of light that the line around the robot takes away.
const OUTLINE_DARKNESS: f64 = 0.45;

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
    /// How far behind its place in the model a camera of the robot takes its pictures, m: that place
    /// may be on the face, which touches the floor when the head is pitched down.
    const EYE_DEPTH: f64 = 0.005;

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

    /// The first camera of the robot's model where it is now; `None` for a model without one.
    ///
    /// `data` must be up to date.
    pub fn eye(data: &MjData<Arc<MjModel>>) -> Option<Self> {
        let model = data.model();
        // The engine keeps a matrix row by row.
        let ground_from_eye = DMat3::from_cols_array(data.cam_xmat().first()?).transpose();
        // In the engine a camera looks along -z, with +y up.
        let DMat3 { y_axis, z_axis, .. } = ground_from_eye;
        let position = DVec3::from_array(*data.cam_xpos().first()?) + Self::EYE_DEPTH * z_axis;
        Some(Self {
            position,
            target: position - z_axis,
            vertical_fov: model.cam_fovy().first()?.to_radians(),
            up: y_axis,
            inside: robot_body(*model.cam_bodyid().first()?),
        })
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
    let lens = Lens::new(camera, size);
    let view = View::new(data.model(), Studio::around(camera), lens);
    let mut tracer = Tracer::new(data, camera.inside);

    let row_of_hits = |row| view.lens.cast(&mut tracer, SOLID, row, 0..width, &[MIDDLE]);
    let hits: Vec<Option<Hit>> = (0..height)
        .flat_map(row_of_hits)
        .map(|(_, hit)| hit)
        .collect();
    let openness = view.studio.openness(&mut tracer, &hits, width);
    let mut frame = Frame {
        view,
        hits,
        openness,
        colours: Vec::new(),
        cover: Vec::new(),
    };
    frame.colour_pixels();
    frame.refine_edges(&mut tracer);
    frame.darken_outline();
    frame.lay_glass(&mut tracer);
    Picture::from_linear(size, &frame.colours)
}

/// A place in a pixel, from its upper left corner, (0..1, 0..1).
type Place = (f64, f64);

const MIDDLE: Place = (0.5, 0.5);

/// Turns a place in the picture into a direction in the ground frame.
struct Lens {
    width: usize,
    height: usize,
    position: DVec3,
    /// From the camera to its target, m.
    distance: f64,
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
            distance: camera.position.distance(camera.target),
            ahead,
            right: right * pixel,
            down: -up * pixel,
        }
    }

    /// The angle that one pixel covers, rad.
    fn pixel_angle(&self) -> f64 {
        self.right.length()
    }

    /// The unit direction through a place of a pixel.
    fn direction(&self, column: usize, row: usize, (right, down): Place) -> DVec3 {
        let from_middle_right = column as f64 + right - self.width as f64 / 2.0;
        let from_middle_down = row as f64 + down - self.height as f64 / 2.0;
        (self.ahead + from_middle_right * self.right + from_middle_down * self.down).normalize()
    }

    /// Casts rays through the same places of some pixels of a row: their directions and what each
    /// meets in the groups, pixel by pixel.
    fn cast(
        &self,
        tracer: &mut Tracer<'_>,
        groups: [u8; 6],
        row: usize,
        columns: impl Iterator<Item = usize>,
        places: &[Place],
    ) -> Vec<(DVec3, Option<Hit>)> {
        let directions: Vec<DVec3> = columns
            .flat_map(|column| places.iter().map(move |&place| (column, place)))
            .map(|(column, place)| self.direction(column, row, place))
            .collect();
        let hits = tracer.hits(groups, self.position, &directions);
        directions.into_iter().zip(hits).collect()
    }
}

/// The picture while it is made; every vector holds one value per pixel, row by row.
struct Frame {
    view: View,
    hits: Vec<Option<Hit>>,
    openness: Vec<Openness>,
    colours: Vec<DVec3>,
    /// The share of the pixel, 0..=1, that shows anything but a floor or the backdrop.
    cover: Vec<f64>,
}

impl Frame {
    /// Colours each pixel by the ray through its middle.
    fn colour_pixels(&mut self) {
        let (view, width) = (&self.view, self.view.lens.width);
        for (pixel, (hit, &openness)) in self.hits.iter().zip(&self.openness).enumerate() {
            let direction = view.lens.direction(pixel % width, pixel / width, MIDDLE);
            self.colours
                .push(view.colour(direction, hit.as_ref(), openness));
            self.cover.push(view.cover(hit.as_ref()));
        }
    }

    /// Replaces the pixels beside an edge by the mean of many rays.
    fn refine_edges(&mut self, tracer: &mut Tracer<'_>) {
        let places: [Place; RAYS_PER_EDGE_PIXEL] = std::array::from_fn(place_in_pixel);
        let Lens { width, height, .. } = self.view.lens;
        for row in 0..height {
            let pixels = row * width..(row + 1) * width;
            let edges: Vec<usize> = pixels.filter(|&pixel| self.is_edge(pixel)).collect();
            let columns = edges.iter().map(|pixel| pixel % width);
            let lens = &self.view.lens;
            let rays = lens.cast(tracer, SOLID, row, columns, &places);
            for (pixel, rays) in edges.into_iter().zip(rays.chunks(RAYS_PER_EDGE_PIXEL)) {
                let mut colour = DVec3::ZERO;
                let mut cover = 0.0;
                for (direction, hit) in rays {
                    let openness = self.openness_beside(pixel, hit.as_ref());
                    colour += self.view.colour(*direction, hit.as_ref(), openness);
                    cover += self.view.cover(hit.as_ref());
                }
                self.colours[pixel] = colour / RAYS_PER_EDGE_PIXEL as f64;
                self.cover[pixel] = cover / RAYS_PER_EDGE_PIXEL as f64;
            }
        }
    }

    /// Darkens the pixels on the border between subject and background: a thin line around the
    /// robot, so that it stands out in print.
    ///
    /// The mean of the cover over 3 × 3 pixels, c, runs from 0 to 1 across a border, and 4c(1 − c) is
    /// a line about two pixels wide wherever the border lies within its pixel.
    fn darken_outline(&mut self) {
        for pixel in 0..self.colours.len() {
            let (mut sum, mut count) = (0.0, 0.0);
            for other in self.neighbourhood(pixel) {
                sum += self.cover[other];
                count += 1.0;
            }
            let mean = sum / count;
            self.colours[pixel] *= 1.0 - OUTLINE_DARKNESS * 4.0 * mean * (1.0 - mean);
        }
    }

    /// Whether a pixel and one of its neighbours show different surfaces.
    fn is_edge(&self, pixel: usize) -> bool {
        self.neighbourhood(pixel)
            .any(|other| match (&self.hits[pixel], &self.hits[other]) {
                (None, None) => false,
                (Some(a), Some(b)) => a.geom != b.geom || a.normal.dot(b.normal) < SMOOTH_COSINE,
                _ => true,
            })
    }

    /// The light that reaches a point seen within a pixel: that of the pixel in the neighbourhood
    /// which shows the same geom under the closest normal, else that of the pixel itself.
    fn openness_beside(&self, pixel: usize, hit: Option<&Hit>) -> Openness {
        let alike = |other: usize| {
            let (hit, there) = (hit?, self.hits[other].as_ref()?);
            (hit.geom == there.geom).then(|| (hit.normal.dot(there.normal), other))
        };
        let closest = self
            .neighbourhood(pixel)
            .filter_map(alike)
            .max_by(|(a, _), (b, _)| a.total_cmp(b));
        self.openness[closest.map_or(pixel, |(_, other)| other)]
    }

    /// The pixels at most one column and one row away, the pixel itself among them.
    fn neighbourhood(&self, pixel: usize) -> impl Iterator<Item = usize> + use<> {
        square(pixel, 1, self.view.lens.width, self.hits.len())
    }
}

/// The pixels at most `reach` columns and rows away from one, itself among them, row by row; the
/// picture has `count` pixels.
fn square(pixel: usize, reach: usize, width: usize, count: usize) -> impl Iterator<Item = usize> {
    let span =
        |middle: usize, end: usize| middle.saturating_sub(reach)..(middle + reach + 1).min(end);
    let columns = span(pixel % width, width);
    span(pixel / width, count / width)
        .flat_map(move |row| columns.clone().map(move |column| row * width + column))
}

/// The place of a ray in its pixel: Hammersley's points, no two of which share a column or a row, so
/// that edges near the horizontal and the vertical get all their steps.
fn place_in_pixel(ray: usize) -> Place {
    let count = RAYS_PER_EDGE_PIXEL as f64;
    let mirrored = ray.reverse_bits() >> (usize::BITS - RAYS_PER_EDGE_PIXEL.ilog2());
    ((ray as f64 + 0.5) / count, (mirrored as f64 + 0.5) / count)
}

#[cfg(test)]
mod tests;
