//! A thin dark line around the robot, so that it stands out in print.

use glam::DVec3;

/// The share of light that the line takes away.
const DARKNESS: f64 = 0.45;

/// Darkens the pixels on the border between subject and background.
///
/// `cover` is the share of each pixel that shows the subject. Its mean over 3 × 3 pixels, c, runs
/// from 0 to 1 across a border, and 4c(1 − c) is a line about two pixels wide wherever the border
/// lies within its pixel.
pub(super) fn draw(colours: &mut [DVec3], cover: &[f64], width: usize) {
    let height = cover.len() / width.max(1);
    for (pixel, colour) in colours.iter_mut().enumerate() {
        let mean = mean_around(cover, (width, height), (pixel % width, pixel / width));
        *colour *= 1.0 - DARKNESS * 4.0 * mean * (1.0 - mean);
    }
}

fn mean_around(
    values: &[f64],
    (width, height): (usize, usize),
    (column, row): (usize, usize),
) -> f64 {
    let mut sum = 0.0;
    let mut count = 0.0;
    for row in row.saturating_sub(1)..(row + 2).min(height) {
        for column in column.saturating_sub(1)..(column + 2).min(width) {
            sum += values[row * width + column];
            count += 1.0;
        }
    }
    sum / count
}
