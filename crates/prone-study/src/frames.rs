//! Frames of the simulated robot: five pictures over one pull, one below the other.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use glam::DVec3;
use rayon::prelude::*;

use prone_sim::camera::{self, Camera, Picture, PictureError};
use prone_sim::{Snapshot, World};

use crate::figures::Figure;

/// Size of one frame, pixels.
const FRAME: (usize, usize) = (800, 300);

/// Vertical field of view that shows a lying robot and the length of its stride in a frame of
/// that shape, rad.
const FIELD_OF_VIEW: f64 = 0.38;

/// Height of the point that the camera looks at, m: half that of a lying robot.
const MIDDLE: f64 = 0.08;

/// Frames of one gait.
pub(crate) struct Frames {
    pub(crate) figure: Figure,
    pub(crate) png: Vec<u8>,
}

/// Takes the pictures from a camera that stays where it is, so that the advance shows.
pub(crate) fn of(
    world: &World,
    gait: &str,
    duration_s: f64,
    snapshots: &[Snapshot],
) -> Result<Frames, PictureError> {
    let middle = snapshots
        .get(snapshots.len() / 2)
        .map_or(DVec3::ZERO, |snapshot| {
            let centre = world.centre_of_mass(snapshot).metres();
            DVec3::new(centre.x, centre.y, MIDDLE)
        });
    let camera = Camera {
        vertical_fov: FIELD_OF_VIEW,
        ..Camera::right_side(middle)
    };
    let pictures: Vec<Picture> = snapshots
        .par_iter()
        .map(|snapshot| camera::ray_cast(&mut world.at(snapshot), &camera, FRAME))
        .collect();
    let png = stack(&pictures).png()?;
    let number = if gait == "optimal" { "35" } else { "27" };
    let percents: Vec<String> = (0..snapshots.len())
        .map(|index| format!("{} %", index * 100 / (snapshots.len() - 1).max(1)))
        .collect();
    let instants = percents.join(", ");
    Ok(Frames {
        figure: Figure {
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
            svg: svg(&png, &percents),
        },
        png,
    })
}

fn stack(pictures: &[Picture]) -> Picture {
    Picture {
        width: FRAME.0,
        height: FRAME.1 * pictures.len(),
        rgb: pictures
            .iter()
            .flat_map(|picture| picture.rgb.iter().copied())
            .collect(),
    }
}

/// The pictures with their instants written beside them.
fn svg(png: &[u8], percents: &[String]) -> String {
    let (width, frame_height) = FRAME;
    let height = frame_height * percents.len();
    let labels: String = percents
        .iter()
        .enumerate()
        .map(|(index, percent)| {
            let baseline = index * frame_height + 30;
            format!(
                r##"<text x="14" y="{baseline}" font-family="sans-serif" font-size="20" fill="#222">{percent}</text>"##
            )
        })
        .collect();
    format!(
        r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}"><image width="{width}" height="{height}" href="data:image/png;base64,{}"/>{labels}</svg>"#,
        BASE64.encode(png)
    )
}
