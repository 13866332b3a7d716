//! From SVG to PNG, with the embedded fonts only.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};

use super::{FigureError, font, style};

/// Rasterises `svg` at `scale` pixels per unit.
pub(super) fn png(svg: &str, scale: f32) -> Result<Vec<u8>, FigureError> {
    let options = Options {
        fontdb: font::database(),
        font_family: style::FONT_FAMILY.to_owned(),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options)?;
    let mut pixels = blank(
        tree.size().width() * scale,
        tree.size().height() * scale,
        scale,
    )?;
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut pixels.as_mut(),
    );
    pixels
        .encode_png()
        .map_err(|error| FigureError::Encode(error.to_string()))
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
    let pixmap = side(width)
        .zip(side(height))
        .and_then(|(w, h)| Pixmap::new(w, h));
    pixmap.ok_or(FigureError::Scale { scale })
}
