//! Frames of the simulated robot: five pictures over one pull, one below the other.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use glam::DVec3;
use rayon::prelude::*;

use prone_sim::camera::{self, Camera, Picture, PictureError};
use prone_sim::{Snapshot, World};

use prone_report::figures::{Figure, FigureError, raster};

use crate::watch::Watch;

/// Size of one frame, pixels.
const FRAME: (usize, usize) = (800, 300);

/// Vertical field of view that shows a lying robot and the length of its stride in a frame of
/// that shape, rad.
const FIELD_OF_VIEW: f64 = 0.155;

/// Size of the title picture, pixels, and its vertical field of view, rad.
const COVER: (usize, usize) = (960, 432);
const COVER_FIELD_OF_VIEW: f64 = 0.17;

/// Height of the point that the camera looks at, m, at scale 1: half that of a lying robot.
const MIDDLE: f64 = 0.08;

/// Why there are no frames.
#[derive(Debug, thiserror::Error)]
pub enum FramesError {
    /// A picture cannot be encoded.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// The instants cannot be written on it.
    #[error(transparent)]
    Labels(#[from] FigureError),
    /// [`Watch::stop`] said so.
    #[error("stopped")]
    Stopped,
}

/// Frames of one gait.
pub struct Frames {
    /// What is said about them, with the pictures in its SVG.
    pub figure: Figure,
    /// The same as PNG.
    pub png: Vec<u8>,
}

/// Takes the pictures from a camera that stays where it is, so that the advance shows.
pub fn of(
    world: &World,
    number: &'static str,
    gait: &str,
    duration_s: f64,
    snapshots: &[Snapshot],
    watch: &dyn Watch,
) -> Result<Frames, FramesError> {
    let scale = camera::scale(world.robot());
    let middle = snapshots
        .get(snapshots.len() / 2)
        .map_or(DVec3::ZERO, |snapshot| {
            let centre = world.centre_of_mass(snapshot).metres();
            DVec3::new(centre.x, centre.y, MIDDLE * scale)
        });
    let camera = Camera {
        vertical_fov: FIELD_OF_VIEW,
        ..Camera::right_side(middle, scale)
    };
    let picture = |snapshot| {
        unless(watch, || {
            camera::ray_cast(&mut world.at(snapshot), &camera, FRAME)
        })
    };
    let pictures = snapshots.par_iter().map(picture);
    let pictures: Vec<Picture> = pictures.collect::<Result<_, FramesError>>()?;
    let percents: Vec<String> = (0..snapshots.len())
        .map(|index| format!("{} %", index * 100 / (snapshots.len() - 1).max(1)))
        .collect();
    let instants = percents.join(", ");
    let figure = Figure {
        stem: format!("fig-{number}-{gait}-frames"),
        number,
        title: format!("The simulated robot, {gait} gait"),
        caption: format!(
            "The robot at {instants} of a {duration_s} s pull with the {gait} gait (top to \
             bottom), ray cast from the simulation. It crawls to the right; lines on the \
             floor are 100 mm apart, heavy ones 500 mm. The camera does not move."
        ),
        alt: format!(
            "Five pictures of the simulated robot lying on its belly, then carried forward \
             on toes and forearms, at {instants} of the pull."
        ),
        svg: String::new(),
    };
    stacked(&pictures, &percents, figure)
}

/// Figure 22: the robot before a pull.
pub fn start(
    world: &World,
    gait: &str,
    posture: &str,
    snapshot: &Snapshot,
    watch: &dyn Watch,
) -> Result<Frames, FramesError> {
    let figure = Figure {
        stem: format!("fig-22-{gait}-start"),
        number: "22",
        title: "The simulated robot before a pull".to_owned(),
        caption: format!(
            "The posture from which our pulls begin: {posture}, laid on the belly and held for a \
             second, ray cast from the simulation. The floor still carries the trunk, between toes \
             behind it and forearms ahead of it. Lines on the floor are 100 mm apart, heavy \
             ones 500 mm."
        ),
        alt: "The simulated robot from its right, flat on its belly, legs behind it on the toes, \
              forearms on the floor ahead of the shoulders."
            .to_owned(),
        svg: String::new(),
    };
    let picture = unless(watch, || from_the_right(world, snapshot))?;
    stacked(&[picture], &[String::new()], figure)
}

/// Takes a picture, unless the work is to end.
pub(crate) fn unless(
    watch: &dyn Watch,
    take: impl FnOnce() -> Picture,
) -> Result<Picture, FramesError> {
    if watch.stop() {
        return Err(FramesError::Stopped);
    }
    Ok(take())
}

/// Pictures of one size, one below the other, each with its label in the corner, as the drawing of a
/// figure that has none yet.
pub(crate) fn stacked(
    pictures: &[Picture],
    labels: &[String],
    figure: Figure,
) -> Result<Frames, FramesError> {
    let stack = stack(pictures);
    let labels = label_elements(labels, stack.height / pictures.len().max(1));
    let size = (stack.width, stack.height);
    let bare = stack.png()?;
    Ok(Frames {
        figure: Figure {
            svg: svg(size, &picture_element(size, &bare), &labels),
            ..figure
        },
        png: raster::png_over(&svg(size, "", &labels), size, &stack.rgb)?,
    })
}

/// One larger picture, for a title page.
pub fn cover(
    world: &World,
    snapshot: &Snapshot,
    watch: &dyn Watch,
) -> Result<Vec<u8>, FramesError> {
    Ok(unless(watch, || from_the_right(world, snapshot))?.png()?)
}

fn from_the_right(world: &World, snapshot: &Snapshot) -> Picture {
    let centre = world.centre_of_mass(snapshot).metres();
    let scale = camera::scale(world.robot());
    let middle = DVec3::new(centre.x, centre.y, MIDDLE * scale);
    let camera = Camera {
        vertical_fov: COVER_FIELD_OF_VIEW,
        ..Camera::right_side(middle, scale)
    };
    camera::ray_cast(&mut world.at(snapshot), &camera, COVER)
}

/// A camera that looks at a target from a direction and a distance, m, and shows so much height
/// there, m.
pub(crate) fn towards(target: DVec3, from: DVec3, distance: f64, height: f64) -> Camera {
    Camera {
        position: target + distance * from.normalize(),
        target,
        vertical_fov: field_of_view(height, distance),
        up: DVec3::Z,
        inside: None,
    }
}

/// The angle that shows a height at a distance, rad.
pub(crate) fn field_of_view(height: f64, distance: f64) -> f64 {
    2.0 * (height / 2.0 / distance).atan()
}

/// The pictures one below the other.
fn stack(pictures: &[Picture]) -> Picture {
    Picture {
        width: pictures.first().map_or(0, |picture| picture.width),
        height: pictures.iter().map(|picture| picture.height).sum(),
        rgb: pictures
            .iter()
            .flat_map(|picture| picture.rgb.iter().copied())
            .collect(),
    }
}

/// The instant of each frame, in its corner.
fn label_elements(labels: &[String], height: usize) -> Vec<String> {
    let labels = labels.iter().enumerate().map(|(index, label)| {
        let baseline = index * height + 32;
        format!(
            r##"<text x="14" y="{baseline}" font-family="DejaVu Sans, Verdana, sans-serif" font-size="20" fill="#222">{label}</text>"##
        )
    });
    labels.collect()
}

fn picture_element((width, height): (usize, usize), png: &[u8]) -> String {
    let data = BASE64.encode(png);
    format!(r#"<image width="{width}" height="{height}" href="data:image/png;base64,{data}"/>"#)
}

fn svg((width, height): (usize, usize), picture: &str, labels: &[String]) -> String {
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}">{picture}{}</svg>"#,
        labels.concat()
    )
}
