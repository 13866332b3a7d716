//! What of a picture differs from the one before.

use prone_sim::camera::Picture;

/// The part of a picture that changed: a rectangle, in which what did not change is transparent.
pub(super) struct Moved {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) width: usize,
    pub(super) height: usize,
    /// Red, green, blue, opacity of each pixel, row by row.
    pub(super) rgba: Vec<u8>,
}

impl Moved {
    /// Compares two pictures of one size; without one before, everything has changed. `corner` says
    /// where the rectangle may begin.
    pub(super) fn between(before: Option<&Picture>, now: &Picture, corner: Corner) -> Self {
        let changed = |column: usize, row: usize| {
            let at = 3 * (row * now.width + column);
            before.is_none_or(|before| before.rgb[at..at + 3] != now.rgb[at..at + 3])
        };
        let (mut left, mut top, mut right, mut bottom) = (now.width, now.height, 0, 0);
        for row in 0..now.height {
            for column in (0..now.width).filter(|&column| changed(column, row)) {
                (left, right) = (left.min(column), right.max(column + 1));
                (top, bottom) = (top.min(row), row + 1);
            }
        }
        if right == 0 {
            // An animation has no frame without a pixel.
            (left, top, right, bottom) = (0, 0, 1, 1);
        }
        if matches!(corner, Corner::Even) {
            (left, top) = (left & !1, top & !1);
        }
        let mut rgba = Vec::with_capacity(4 * (right - left) * (bottom - top));
        for row in top..bottom {
            for column in left..right {
                if changed(column, row) {
                    let at = 3 * (row * now.width + column);
                    rgba.extend_from_slice(&now.rgb[at..at + 3]);
                    rgba.push(u8::MAX);
                } else {
                    rgba.extend([0; 4]);
                }
            }
        }
        Self {
            left,
            top,
            width: right - left,
            height: bottom - top,
            rgba,
        }
    }
}

/// Where a rectangle may begin.
#[derive(Debug, Clone, Copy)]
pub(super) enum Corner {
    /// At any pixel.
    Any,
    /// At even pixels.
    Even,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_did_not_change_is_left_out() {
        let before = Picture {
            width: 4,
            height: 3,
            rgb: vec![7; 36],
        };
        let mut now = before.clone();
        now.rgb[3 * (4 + 1)] = 8;
        now.rgb[3 * (8 + 3)] = 8;
        let moved = Moved::between(Some(&before), &now, Corner::Any);
        assert_eq!(
            (moved.left, moved.top, moved.width, moved.height),
            (1, 1, 3, 2)
        );
        let opacity: Vec<u8> = moved.rgba.chunks(4).map(|pixel| pixel[3]).collect();
        assert_eq!(opacity, [255, 0, 0, 0, 0, 255]);
        let even = Moved::between(Some(&before), &now, Corner::Even);
        assert_eq!((even.left, even.top, even.width, even.height), (0, 0, 4, 3));
        let same = Moved::between(Some(&now), &now, Corner::Any);
        assert_eq!(same.rgba, [0; 4]);
        assert_eq!(Moved::between(None, &now, Corner::Any).rgba.len(), 48);
    }
}
