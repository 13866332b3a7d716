//! Pictures as an animated GIF: 256 colours per picture, chosen for what changed in it.

use std::borrow::Cow;

use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use prone_sim::camera::Picture;

use super::film::{Clock, Reel};
use super::moved::{Corner, Moved};

/// The most frames per second that viewers show: a frame of 1/100 s they stretch to 1/10 s.
pub const FASTEST: f64 = 50.0;

/// Ticks per second in which a frame's time is told.
const TICKS: f64 = 100.0;

/// How coarsely colours are chosen: the crate's middle, fast and without visible bands.
const COARSENESS: i32 = 10;

/// An animation while it is made; it plays again and again.
pub struct GifReel {
    encoder: Encoder<Vec<u8>>,
    clock: Clock,
}

impl GifReel {
    /// Begins an animation.
    ///
    /// # Errors
    /// [`EncodingError`] for a size that the format does not have.
    pub fn new((width, height): (usize, usize), fps: f64) -> Result<Self, EncodingError> {
        let mut encoder = Encoder::new(Vec::new(), short(width), short(height), &[])?;
        encoder.set_repeat(Repeat::Infinite)?;
        Ok(Self {
            encoder,
            clock: Clock::new(fps, TICKS),
        })
    }

    /// The file.
    pub fn finish(self) -> Result<Vec<u8>, EncodingError> {
        self.encoder.into_inner()
    }
}

impl Reel for GifReel {
    type Frame = Frame<'static>;
    type Error = EncodingError;

    fn frame(before: Option<&Picture>, now: &Picture) -> Result<Self::Frame, EncodingError> {
        let mut moved = Moved::between(before, now, Corner::Any);
        let (width, height) = (short(moved.width), short(moved.height));
        let mut frame = Frame::from_rgba_speed(width, height, &mut moved.rgba, COARSENESS);
        (frame.left, frame.top) = (short(moved.left), short(moved.top));
        frame.dispose = DisposalMethod::Keep;
        frame.make_lzw_pre_encoded();
        frame.buffer = Cow::Owned(frame.buffer.into_owned());
        Ok(frame)
    }

    fn take(&mut self, mut frame: Self::Frame) -> Result<(), EncodingError> {
        frame.delay = short(self.clock.tell());
        self.encoder.write_lzw_pre_encoded_frame(&frame)
    }
}

/// Sizes are checked before they come here, and a frame is not shown for minutes.
fn short(number: usize) -> u16 {
    u16::try_from(number).unwrap_or(u16::MAX)
}
