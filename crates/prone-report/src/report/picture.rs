//! Pictures for the page: 256 colours chosen for each, which makes a ray-cast picture less than half as
//! large and leaves no visible bands.

use std::io::Cursor;

use resvg::tiny_skia::Pixmap;

/// How coarsely colours are chosen, 1 to 30: fine enough for smooth floors.
const COARSENESS: i32 = 10;

/// Most pixels of a picture: those of a large screen, twice. Ours have half a million.
const MOST_PIXELS: u64 = 16_000_000;

/// A PNG file with a palette from any PNG file.
pub(super) fn with_palette(png: &[u8]) -> Result<Vec<u8>, String> {
    check_size(png)?;
    let picture = Pixmap::decode_png(png).map_err(|error| error.to_string())?;
    let (width, height) = (picture.width(), picture.height());
    let sides = u16::try_from(width)
        .ok()
        .zip(u16::try_from(height).ok())
        .ok_or_else(|| format!("{width} × {height} pixels are too many"))?;
    let mut rgba = picture.take_demultiplied();
    let frame = gif::Frame::from_rgba_speed(sides.0, sides.1, &mut rgba, COARSENESS);
    encode((width, height), &frame).map_err(|error| error.to_string())
}

/// Refuses a picture whose pixels would fill the memory, by its head.
fn check_size(png: &[u8]) -> Result<(), String> {
    let mut decoder = png::Decoder::new(Cursor::new(png));
    let head = decoder
        .read_header_info()
        .map_err(|error| error.to_string())?;
    let (width, height) = (head.width, head.height);
    if u64::from(width) * u64::from(height) > MOST_PIXELS {
        return Err(format!(
            "{width} × {height} pixels are more than {MOST_PIXELS}"
        ));
    }
    Ok(())
}

fn encode(
    (width, height): (u32, u32),
    frame: &gif::Frame<'_>,
) -> Result<Vec<u8>, png::EncodingError> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Indexed);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_palette(frame.palette.clone().unwrap_or_default());
    encoder.set_compression(png::Compression::High);
    // Neighbouring entries of a palette are no neighbouring colours.
    encoder.set_filter(png::Filter::NoFilter);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&frame.buffer)?;
    writer.finish()?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cyclic redundancy check of a chunk of a PNG.
    fn checksum(chunk: &[u8]) -> u32 {
        let byte = |sum: u32, byte: &u8| {
            (0..8).fold(sum ^ u32::from(*byte), |sum, _| {
                (sum >> 1) ^ (0xedb8_8320 * (sum & 1))
            })
        };
        !chunk.iter().fold(!0, byte)
    }

    #[test]
    fn a_picture_keeps_its_size_and_its_colours() {
        let mut picture = Pixmap::new(64, 32).unwrap();
        for (index, pixel) in picture.data_mut().chunks_exact_mut(4).enumerate() {
            let shade = u8::try_from(index % 64).unwrap() * 4;
            pixel.copy_from_slice(&[shade, 255 - shade, 40, 255]);
        }
        let small = with_palette(&picture.encode_png().unwrap()).unwrap();
        let back = Pixmap::decode_png(&small).unwrap();
        assert_eq!((back.width(), back.height()), (64, 32));
        for (ours, theirs) in back.data().iter().zip(picture.data()) {
            assert!(ours.abs_diff(*theirs) <= 8, "{ours} {theirs}");
        }
        assert!(with_palette(b"GIF89a").is_err());
        // A head of 30,000 × 30,000 pixels, whose data would be unpacked to gigabytes.
        let mut bomb = picture.encode_png().unwrap();
        bomb[16..24].copy_from_slice(&[0, 0, 0x75, 0x30, 0, 0, 0x75, 0x30]);
        let crc = checksum(&bomb[12..29]);
        bomb[29..33].copy_from_slice(&crc.to_be_bytes());
        let refused = with_palette(&bomb).unwrap_err();
        assert_eq!(refused, "30000 × 30000 pixels are more than 16000000");
    }
}
