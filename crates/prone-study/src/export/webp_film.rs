//! Pictures as an animated WebP without loss.
//!
//! The pictures are encoded by the `image-webp` crate, which writes no animations; the container
//! around them is RIFF with the chunks `VP8X`, `ANIM` and one `ANMF` per picture
//! (<https://developers.google.com/speed/webp/docs/riff_container>).

use image_webp::{ColorType, EncodingError, WebPEncoder};
use prone_sim::camera::Picture;

use super::film::{Clock, Reel};
use super::moved::{Corner, Moved};

/// Ticks per second in which a frame's time is told.
const TICKS: f64 = 1000.0;

/// `VP8X`: pictures with opacity; an animation.
const FLAGS: u8 = 0x10 | 0x02;

/// What a RIFF file and a chunk begin with: a name and a length.
const CHUNK_HEAD: usize = 8;

/// An animation while it is made; it plays again and again.
pub struct WebpReel {
    size: (usize, usize),
    frames: Vec<u8>,
    clock: Clock,
}

/// A picture, or what changed in it.
pub struct WebpFrame {
    left: usize,
    top: usize,
    width: usize,
    height: usize,
    /// A chunk of its own: `VP8L`.
    chunk: Vec<u8>,
}

impl WebpReel {
    /// Begins an animation.
    pub fn new(size: (usize, usize), fps: f64) -> Self {
        Self {
            size,
            frames: Vec::new(),
            clock: Clock::new(fps, TICKS),
        }
    }

    /// The file.
    pub fn finish(self) -> Vec<u8> {
        let (width, height) = self.size;
        let mut body = b"WEBP".to_vec();
        let mut head = vec![FLAGS, 0, 0, 0];
        head.extend(three_bytes(width - 1));
        head.extend(three_bytes(height - 1));
        body.extend(chunk(*b"VP8X", &head));
        // A white background, and no end of repetitions.
        body.extend(chunk(*b"ANIM", &[255, 255, 255, 255, 0, 0]));
        body.extend(self.frames);
        chunk(*b"RIFF", &body)
    }
}

impl Reel for WebpReel {
    type Frame = WebpFrame;
    type Error = EncodingError;

    fn frame(before: Option<&Picture>, now: &Picture) -> Result<WebpFrame, EncodingError> {
        let moved = Moved::between(before, now, Corner::Even);
        let mut file = Vec::new();
        let side = |pixels: usize| u32::try_from(pixels).unwrap_or(u32::MAX);
        WebPEncoder::new(&mut file).encode(
            &moved.rgba,
            side(moved.width),
            side(moved.height),
            ColorType::Rgba8,
        )?;
        Ok(WebpFrame {
            left: moved.left,
            top: moved.top,
            width: moved.width,
            height: moved.height,
            // A still of this kind is one chunk after the head of the file and its kind.
            chunk: file.split_off(CHUNK_HEAD + 4),
        })
    }

    fn take(&mut self, frame: WebpFrame) -> Result<(), EncodingError> {
        let mut body = Vec::with_capacity(16 + frame.chunk.len());
        body.extend(three_bytes(frame.left / 2));
        body.extend(three_bytes(frame.top / 2));
        body.extend(three_bytes(frame.width - 1));
        body.extend(three_bytes(frame.height - 1));
        body.extend(three_bytes(self.clock.tell()));
        body.push(0); // laid over what is there, and left there
        body.extend(frame.chunk);
        self.frames.extend(chunk(*b"ANMF", &body));
        Ok(())
    }
}

/// Name, length and content, filled up to an even length.
fn chunk(name: [u8; 4], content: &[u8]) -> Vec<u8> {
    let mut chunk = name.to_vec();
    let length = u32::try_from(content.len()).unwrap_or(u32::MAX);
    chunk.extend(length.to_le_bytes());
    chunk.extend(content);
    if !content.len().is_multiple_of(2) {
        chunk.push(0);
    }
    chunk
}

/// Sizes are checked before they come here.
fn three_bytes(number: usize) -> [u8; 3] {
    let [a, b, c, ..] = number.to_le_bytes();
    [a, b, c]
}
