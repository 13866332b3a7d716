//! A finished picture, and its encoding.

use glam::DVec3;

/// Above this share of full light, brightness approaches white instead of stopping at it.
const SHOULDER: f64 = 0.75;

/// A picture of 8-bit sRGB colours.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Red, green and blue of each pixel, from the upper left corner, row by row.
    pub rgb: Vec<u8>,
}

/// Why a picture could not be encoded.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// PNG states sizes in 32 bits.
    #[error("a picture of {width} × {height} pixels is too large for PNG")]
    TooLarge {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
    },
    /// The encoder refused, for example because the picture has no pixels or too few bytes.
    #[error("a picture of {width} × {height} pixels could not be written as PNG")]
    Encoding {
        /// Pixels in a row.
        width: usize,
        /// Rows.
        height: usize,
        /// The encoder's reason.
        source: png::EncodingError,
    },
}

impl Picture {
    /// Encodes linear light, one colour per pixel.
    pub(super) fn from_linear((width, height): (usize, usize), colours: &[DVec3]) -> Self {
        let rgb = colours
            .iter()
            .flat_map(DVec3::to_array)
            .map(|light| byte_from_share(srgb_from_linear(shoulder(light))))
            .collect();
        Self { width, height, rgb }
    }

    /// The picture as a PNG file.
    ///
    /// # Errors
    /// If the picture has no pixels, more than 2³¹ − 1 columns or rows, or bytes that do not match
    /// its size.
    pub fn png(&self) -> Result<Vec<u8>, PictureError> {
        let Self { width, height, .. } = *self;
        let (Ok(columns), Ok(rows)) = (u32::try_from(width), u32::try_from(height)) else {
            return Err(PictureError::TooLarge { width, height });
        };
        self.encode(columns, rows)
            .map_err(|source| PictureError::Encoding {
                width,
                height,
                source,
            })
    }

    fn encode(&self, columns: u32, rows: u32) -> Result<Vec<u8>, png::EncodingError> {
        let mut file = Vec::new();
        let mut encoder = png::Encoder::new(&mut file, columns, rows);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        encoder.set_compression(png::Compression::Balanced);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&self.rgb)?;
        writer.finish()?;
        Ok(file)
    }
}

/// Compresses light above the shoulder into what is left below white.
fn shoulder(light: f64) -> f64 {
    if light <= SHOULDER {
        return light.max(0.0);
    }
    let rest = 1.0 - SHOULDER;
    SHOULDER + rest * (1.0 - (-(light - SHOULDER) / rest).exp())
}

/// The transfer function of sRGB (IEC 61966-2-1); both sides are shares of white.
fn srgb_from_linear(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// The inverse of [`srgb_from_linear`].
pub(super) fn linear_from_srgb(srgb: f64) -> f64 {
    if srgb <= 0.040_45 {
        srgb / 12.92
    } else {
        ((srgb + 0.055) / 1.055).powf(2.4)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the value is clamped to 0..=255"
)]
fn byte_from_share(share: f64) -> u8 {
    (255.0 * share).round().clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::{Picture, PictureError, linear_from_srgb, shoulder, srgb_from_linear};

    #[test]
    fn transfer_function_round_trips() {
        for step in 0..=255 {
            let srgb = f64::from(step) / 255.0;
            // The standard rounds its constants, which leaves a step of 1e-8 where they meet.
            assert!((srgb_from_linear(linear_from_srgb(srgb)) - srgb).abs() < 1e-7);
        }
    }

    #[test]
    fn reference_middle_grey() {
        // A reflectance of 21.4 % is sRGB 0.5 (IEC 61966-2-1).
        assert!((srgb_from_linear(0.214_041) - 0.5).abs() < 1e-6);
    }

    #[test]
    fn shoulder_rises_and_stays_below_white() {
        let lights: Vec<f64> = (0..=40)
            .map(|step| shoulder(f64::from(step) / 10.0))
            .collect();
        assert!(
            lights.is_sorted_by(|a, b| a < b) && lights[40] < 1.0,
            "{lights:?}"
        );
    }

    #[test]
    fn bytes_that_do_not_match_the_size_are_refused() {
        let picture = Picture {
            width: 2,
            height: 2,
            rgb: vec![0; 11],
        };
        assert!(matches!(picture.png(), Err(PictureError::Encoding { .. })));
    }
}
