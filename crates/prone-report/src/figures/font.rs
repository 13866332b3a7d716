//! The embedded font: widths of texts, and the database the rasteriser reads.
//!
//! A fresh machine has no fonts, so the drawing brings its own: `DejaVu Sans`, which has the Greek
//! and mathematical signs of the labels.

use std::sync::Arc;

use resvg::usvg::fontdb::{Database, Source};
use skrifa::instance::{LocationRef, Size};
use skrifa::{FontRef, MetadataProvider};

/// Thickness of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Weight {
    Regular,
    Bold,
}

impl Weight {
    fn bytes(self) -> &'static [u8] {
        match self {
            Self::Regular => dejavu::sans::regular(),
            Self::Bold => dejavu::sans::bold(),
        }
    }
}

/// Width of `text` at `size`.
pub(super) fn width(text: &str, size: f64, weight: Weight) -> f64 {
    /// Typical width of a letter per size, for a sign the font lacks.
    const TYPICAL: f64 = 0.6;
    let typical = size * TYPICAL;
    let Ok(font) = FontRef::new(weight.bytes()) else {
        return typical * text.chars().count() as f64;
    };
    #[expect(clippy::cast_possible_truncation, reason = "a font size")]
    let metrics = font.glyph_metrics(Size::new(size as f32), LocationRef::default());
    let glyphs = font.charmap();
    let advance = |sign| {
        glyphs
            .map(sign)
            .and_then(|glyph| metrics.advance_width(glyph))
    };
    text.chars()
        .map(|sign| advance(sign).map_or(typical, f64::from))
        .sum()
}

/// The fonts of every drawing and no others, so that all machines rasterise alike.
pub(super) fn database() -> Arc<Database> {
    let mut database = Database::new();
    for weight in [Weight::Regular, Weight::Bold] {
        database.load_font_source(Source::Binary(Arc::new(weight.bytes())));
    }
    database.set_sans_serif_family("DejaVu Sans");
    Arc::new(database)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bold_is_wider_and_width_scales_with_size() {
        let at = |size, weight| width("joint torque", size, weight);
        assert!(at(10.0, Weight::Bold) > at(10.0, Weight::Regular));
        // Advances scale linearly; the font unit is 1/2048 of the size.
        assert!((at(20.0, Weight::Regular) - 2.0 * at(10.0, Weight::Regular)).abs() < 0.1);
    }

    #[test]
    fn every_sign_of_the_labels_is_in_the_font() {
        let font = FontRef::new(Weight::Regular.bytes()).unwrap();
        for sign in "θ₃₄α°²·∫Στ–−%→".chars() {
            assert!(font.charmap().map(sign).is_some(), "{sign}");
        }
    }
}
