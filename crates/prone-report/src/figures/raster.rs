//! From SVG to PNG, with the embedded fonts only.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use super::{FigureError, font, style};

/// Rasterises `svg` at `scale` pixels per unit.
///
/// # Errors
/// [`FigureError`] where the SVG is malformed, or the size of no use.
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>, FigureError> {
    let tree = parse(svg)?;
    let (width, height) = (tree.size().width(), tree.size().height());
    let pixels = blank(width * scale, height * scale, scale)?;
    drawn(&tree, scale, pixels)
}

/// Draws `svg` over a picture of the same size, 8-bit RGB by rows, and encodes both as PNG.
///
/// # Errors
/// [`FigureError`] where the SVG is malformed, or the size of no use.
pub fn png_over(
    svg: &str,
    (width, height): (usize, usize),
    rgb: &[u8],
) -> Result<Vec<u8>, FigureError> {
    let tree = parse(svg)?;
    let mut pixels = blank(width as f32, height as f32, 1.0)?;
    for (pixel, rgb) in pixels.data_mut().chunks_mut(4).zip(rgb.chunks(3)) {
        pixel[..3].copy_from_slice(rgb);
        pixel[3] = u8::MAX;
    }
    drawn(&tree, 1.0, pixels)
}

fn parse(svg: &str) -> Result<Tree, FigureError> {
    let options = Options {
        fontdb: font::database(),
        font_family: style::FONT_FAMILY.to_owned(),
        ..Options::default()
    };
    Ok(Tree::from_str(svg, &options)?)
}

/// The drawing over what is in the picture, as PNG.
fn drawn(tree: &Tree, scale: f32, mut pixels: Pixmap) -> Result<Vec<u8>, FigureError> {
    let transform = Transform::from_scale(scale, scale);
    resvg::render(tree, transform, &mut pixels.as_mut());
    let png = pixels.encode_png();
    png.map_err(|error| FigureError::Encode(error.to_string()))
}

fn blank(width: f32, height: f32, scale: f32) -> Result<Pixmap, FigureError> {
    /// Longest side of a picture; a larger one is a mistaken scale.
    const LONGEST: f32 = 20_000.0;
    let side = |length: f32| {
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "checked"
        )]
        (1.0..=LONGEST)
            .contains(&length)
            .then_some(length.ceil() as u32)
    };
    let sides = side(width).zip(side(height));
    let pixmap = sides.and_then(|(width, height)| Pixmap::new(width, height));
    pixmap.ok_or(FigureError::Scale { scale })
}
