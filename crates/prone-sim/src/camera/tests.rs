use std::sync::Arc;

use glam::DVec3;
use mujoco_rs::prelude::{MjData, MjModel};

use super::light::Studio;
use super::{Camera, Picture, PictureError, ray_cast};

const SIZE: (usize, usize) = (320, 180);
/// Looks straight ahead from 2 m behind the origin, 0.5 m above the floor.
const AHEAD: Camera = Camera {
    position: DVec3::new(-2.0, 0.0, 0.5),
    target: DVec3::new(0.0, 0.0, 0.5),
    vertical_fov: 0.6,
    up: DVec3::Z,
    inside: None,
};
const RADIUS: f64 = 0.05;

/// A red sphere, which floats above a floor.
fn sphere(center: DVec3, radius: f64) -> MjData<Arc<MjModel>> {
    let [x, y, z] = center.to_array();
    let xml = format!(
        "<mujoco><worldbody>
           <geom name='floor' type='plane' size='0 0 .05' rgba='.5 .5 .5 1'/>
           <geom name='ball' type='sphere' size='{radius}' pos='{x} {y} {z}' rgba='1 0 0 1'/>
         </worldbody></mujoco>"
    );
    let model = MjModel::from_xml_string(&xml).unwrap();
    let mut data = MjData::new(Arc::new(model));
    data.forward();
    data
}

fn pixel(picture: &Picture, column: usize, row: usize) -> [f64; 3] {
    let start = 3 * (row * picture.width + column);
    [0, 1, 2].map(|channel| f64::from(picture.rgb[start + channel]))
}

/// The column and row of a point, by the rule of three for a camera that looks along x.
fn project(point: DVec3) -> (f64, f64) {
    let from_camera = point - AHEAD.position;
    let pixels_per_unit = SIZE.1 as f64 / 2.0 / (AHEAD.vertical_fov / 2.0).tan();
    let column = SIZE.0 as f64 / 2.0 - pixels_per_unit * from_camera.y / from_camera.x;
    let row = SIZE.1 as f64 / 2.0 - pixels_per_unit * from_camera.z / from_camera.x;
    (column, row)
}

/// The pixel that shows a point.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "inside the picture"
)]
fn pixel_of(point: DVec3) -> (usize, usize) {
    let (column, row) = project(point);
    (column as usize, row as usize)
}

#[test]
fn sphere_appears_where_projection_says() {
    let center = DVec3::new(0.3, 0.25, 0.62);
    let picture = ray_cast(&mut sphere(center, RADIUS), &AHEAD, SIZE);
    let (mut columns, mut rows, mut count) = (0.0, 0.0, 0.0);
    for row in 0..SIZE.1 {
        for column in 0..SIZE.0 {
            let [red, green, _] = pixel(&picture, column, row);
            if red > 1.5 * green {
                columns += column as f64 + 0.5;
                rows += row as f64 + 0.5;
                count += 1.0;
            }
        }
    }
    let (column, row) = project(center);
    // The image of a sphere is an ellipse whose centre is not that of the sphere; here the two
    // are less than 0.1 pixel apart, and the threshold for red moves the mean by less than 0.5.
    assert!(
        (columns / count - column).abs() < 0.6,
        "column {} is not {column}",
        columns / count
    );
    assert!(
        (rows / count - row).abs() < 0.6,
        "row {} is not {row}",
        rows / count
    );
    // The radius of the image is that of the sphere, to one pixel: half the outline's width.
    let (left, _) = project(center + DVec3::new(0.0, RADIUS, 0.0));
    let radius = (count / std::f64::consts::PI).sqrt();
    assert!(
        (radius - (column - left)).abs() < 1.0,
        "radius {radius} is not {}",
        column - left
    );
}

#[test]
fn shadow_is_darker_than_lit_floor() {
    // Two points as far ahead of the camera, both in the middle between lines.
    let shadow = DVec3::new(0.55, -0.15, 0.0);
    let lit = DVec3::new(0.55, 0.85, 0.0);
    let toward_key = Studio::around(&AHEAD).toward_key;
    let center = shadow + toward_key * (0.35 / toward_key.z);
    // Seen at a slant, a pixel is 50 mm of floor: the shadow must be larger than the mean's square.
    let picture = ray_cast(&mut sphere(center, 0.25), &AHEAD, SIZE);
    let brightness = |point| {
        let (column, row) = pixel_of(point);
        pixel(&picture, column, row).iter().sum::<f64>() / 3.0
    };
    // Without the key lamp less than 0.4 of the light is left; sRGB makes 0.66 of that.
    let (dark, bright) = (brightness(shadow), brightness(lit));
    assert!(
        dark < 0.8 * bright,
        "shadow {dark} is not darker than lit floor {bright}"
    );
}

#[test]
fn same_state_gives_same_bytes() {
    let take = || ray_cast(&mut sphere(DVec3::new(0.1, 0.0, 0.3), RADIUS), &AHEAD, SIZE);
    assert_eq!(take(), take());
}

#[test]
fn casting_leaves_the_state_alone() {
    let mut data = sphere(DVec3::new(0.1, 0.0, 0.3), RADIUS);
    let before = (data.time(), data.geom_xpos().to_vec(), data.qpos().to_vec());
    ray_cast(&mut data, &AHEAD, (16, 9));
    assert_eq!(
        (data.time(), data.geom_xpos().to_vec(), data.qpos().to_vec()),
        before
    );
}

#[test]
fn png_decodes_to_the_picture() {
    let picture = ray_cast(&mut sphere(DVec3::new(0.0, 0.0, 0.3), RADIUS), &AHEAD, SIZE);
    let file = picture.png().unwrap();
    let mut reader = png::Decoder::new(std::io::Cursor::new(file))
        .read_info()
        .unwrap();
    let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
    let frame = reader.next_frame(&mut rgb).unwrap();
    assert_eq!((frame.width as usize, frame.height as usize), SIZE);
    assert_eq!(rgb, picture.rgb);
}

#[test]
fn picture_without_pixels_is_no_png() {
    let picture = ray_cast(&mut sphere(DVec3::Z, RADIUS), &AHEAD, (0, 0));
    assert!(matches!(
        picture.png(),
        Err(PictureError::Encoding {
            width: 0,
            height: 0,
            ..
        })
    ));
}

#[test]
fn looking_straight_down_has_forward_at_the_top() {
    let camera = Camera {
        position: DVec3::Z,
        target: DVec3::ZERO,
        vertical_fov: 0.5,
        up: DVec3::Z,
        inside: None,
    };
    assert_eq!(camera.axes(), [DVec3::NEG_Z, DVec3::NEG_Y, DVec3::X]);
}

/// A pane of a scene before the ball tints it and hides nothing; behind the ball it is not seen.
#[test]
fn glass_tints_what_is_behind_it() {
    let at = |pane_x: f64| {
        let xml = format!(
            "<mujoco><worldbody>
               <geom type='sphere' size='.05' pos='0 0 .5' rgba='1 0 0 1'/>
               <geom type='box' size='.001 .2 .2' pos='{pane_x} 0 .5' rgba='0 0 1 .3' group='5'/>
             </worldbody></mujoco>"
        );
        let mut data = MjData::new(Arc::new(MjModel::from_xml_string(&xml).unwrap()));
        data.forward();
        let picture = ray_cast(&mut data, &AHEAD, SIZE);
        let (column, row) = pixel_of(DVec3::new(0.0, 0.0, 0.5));
        pixel(&picture, column, row)
    };
    let (before, behind, away) = (at(-0.5), at(0.5), at(-9.0));
    assert!(
        behind.iter().zip(away).all(|(b, a)| (b - a).abs() < 0.5),
        "hidden: {behind:?} {away:?}"
    );
    assert!(before[2] > away[2] + 20.0, "bluer: {before:?} {away:?}");
    assert!(
        before[0] > 100.0 && before[0] < away[0],
        "still red: {before:?} {away:?}"
    );
}
