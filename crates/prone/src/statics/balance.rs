//! The pitch at which a rigid body comes to rest: the local minimum of H(φ), equation (1) of
//! [`super`].
//!
//! H is the largest of smooth functions. Going downhill from the start gives an interval with H
//! falling at its lower end and rising at its upper one. There the part that is lowest at either
//! end is known, and the φ at which the two are level is the next guess: it is the minimum, or
//! another part is lower there and replaces one of them. A few rounds suffice, as in a hull.

use glam::DVec3;

use super::RestError;
use super::outline::Part;
use crate::frames::{Point, Root};

/// Stride of the walk downhill, rad. A rest that half this tilt would end is passed over.
const STRIDE: f64 = 0.02;

/// Strides in a full turn, within which every body has a minimum.
const TURN: usize = 315;

/// Rounds of narrowing down; bisection alone would need 45 from one stride to rounding.
const ROUNDS: usize = 100;

/// Heights closer than this are one height, m: well above rounding, far below any machining.
const LEVEL: f64 = 1e-9;

/// An interval of pitch this small is a point, rad.
const POINT: f64 = 1e-14;

/// A body at rest.
#[derive(Debug, Clone, Copy)]
pub(super) struct Equilibrium {
    /// Turn of the root about +y, rad.
    pub(super) pitch: f64,
    /// Height of the centre of mass, m.
    pub(super) height: f64,
    /// Rear and front contact; the same twice where the body rocks on one.
    pub(super) contacts: [Contact; 2],
}

/// A touching point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// Index in [`crate::robot::Robot::shapes`].
    pub(super) shape: usize,
    /// In the root frame.
    pub(super) point: DVec3,
    /// How far it is ahead of the centre of mass, m.
    pub(super) ahead: f64,
}

/// d of the module's header.
pub(super) fn down(pitch: f64) -> DVec3 {
    let (sin, cos) = pitch.sin_cos();
    DVec3::new(sin, 0.0, -cos)
}

/// e of the module's header.
pub(super) fn forward(pitch: f64) -> DVec3 {
    let (sin, cos) = pitch.sin_cos();
    DVec3::new(cos, 0.0, sin)
}

/// The part that touches at some pitch.
#[derive(Clone, Copy)]
struct Touch {
    pitch: f64,
    part: usize,
    height: f64,
    ahead: f64,
}

/// The parts that may carry, and what they carry.
struct Body<'p> {
    parts: Vec<&'p Part>,
    centre: DVec3,
}

/// Rolls a body from a pitch to rest.
pub(super) fn settle(
    parts: &[Part],
    carries: impl Fn(&Part) -> bool,
    centre: Point<Root>,
    start: f64,
) -> Result<Equilibrium, RestError> {
    let body = Body {
        parts: parts.iter().filter(|part| carries(part)).collect(),
        centre: centre.metres(),
    };
    if body.parts.is_empty() {
        return Err(RestError::NothingCarries);
    }
    let (falling, rising) = body.walk_downhill(start).ok_or(RestError::NotFinite)?;
    let pitch = body.narrow(falling, rising);
    Ok(body.at_rest(pitch))
}

impl Body<'_> {
    /// Equations (1) and (2) for one part.
    fn touch(&self, part: usize, pitch: f64) -> Touch {
        let down = down(pitch);
        let point = self.parts[part].touching(down) - self.centre;
        Touch {
            pitch,
            part,
            height: point.dot(down),
            ahead: point.dot(forward(pitch)),
        }
    }

    /// The lowest part.
    fn lowest(&self, pitch: f64) -> Touch {
        let down = down(pitch);
        let (mut lowest, mut farthest) = (0, f64::NEG_INFINITY);
        for (index, part) in self.parts.iter().enumerate() {
            let reach = part.reach(down);
            if reach > farthest {
                (lowest, farthest) = (index, reach);
            }
        }
        self.touch(lowest, pitch)
    }

    /// An interval in whose lower end H falls and in whose upper end it rises; `None` for NaN.
    fn walk_downhill(&self, start: f64) -> Option<(Touch, Touch)> {
        let mut here = self.lowest(start);
        let uphill = here.ahead.signum();
        for _ in 0..TURN {
            let next = self.lowest(here.pitch - uphill * STRIDE);
            if next.ahead * uphill <= 0.0 {
                return Some(if uphill > 0.0 {
                    (next, here)
                } else {
                    (here, next)
                });
            }
            here = next;
        }
        None
    }

    /// The pitch of the minimum in such an interval.
    fn narrow(&self, mut falling: Touch, mut rising: Touch) -> f64 {
        for _ in 0..ROUNDS {
            if rising.pitch - falling.pitch < POINT {
                break;
            }
            let guess = if falling.part == rising.part {
                f64::midpoint(falling.pitch, rising.pitch)
            } else {
                self.level(&falling, &rising)
            };
            let lowest = self.lowest(guess);
            let [rear, front] = [falling.part, rising.part].map(|part| self.touch(part, guess));
            let both_lowest = lowest.height - rear.height.min(front.height) < POINT;
            if both_lowest && rear.ahead <= 0.0 && front.ahead >= 0.0 {
                return guess;
            }
            // Level on both, but on the same side of them: the minimum is on the curve of one.
            let middle = match both_lowest {
                true if rear.ahead > 0.0 => rear,
                true => front,
                false => lowest,
            };
            if middle.ahead > 0.0 {
                rising = middle;
            } else {
                falling = middle;
            }
        }
        f64::midpoint(falling.pitch, rising.pitch)
    }

    /// The pitch at which two parts are level: Newton's method, kept in the interval.
    fn level(&self, falling: &Touch, rising: &Touch) -> f64 {
        let (mut low, mut high) = (falling.pitch, rising.pitch);
        let mut pitch = f64::midpoint(low, high);
        for _ in 0..ROUNDS {
            let (rear, front) = (
                self.touch(falling.part, pitch),
                self.touch(rising.part, pitch),
            );
            let lower_by = rear.height - front.height;
            if lower_by > 0.0 {
                low = pitch;
            } else {
                high = pitch;
            }
            let newton = pitch + lower_by / (front.ahead - rear.ahead);
            let next = if (low..=high).contains(&newton) {
                newton
            } else {
                f64::midpoint(low, high)
            };
            if (next - pitch).abs() < POINT {
                return next;
            }
            pitch = next;
        }
        pitch
    }

    /// Of all points on the floor, the nearest behind and the nearest ahead of the centre of mass.
    fn at_rest(&self, pitch: f64) -> Equilibrium {
        let lowest = self.lowest(pitch);
        let touches = |side: fn(f64) -> bool| {
            let touch = |part| self.touch(part, pitch);
            (0..self.parts.len())
                .map(touch)
                .filter(|touch| touch.height > lowest.height - LEVEL && side(touch.ahead))
                .min_by(|a, b| a.ahead.abs().total_cmp(&b.ahead.abs()))
        };
        // A side without a touch: the body rocks on the one part.
        let rear = touches(|ahead| ahead <= 0.0).unwrap_or(lowest);
        let front = touches(|ahead| ahead > 0.0).unwrap_or(lowest);
        Equilibrium {
            pitch,
            height: lowest.height,
            contacts: [self.contact(&rear), self.contact(&front)],
        }
    }

    /// A contact; where a shape touches along an edge across the robot, its middle.
    fn contact(&self, touch: &Touch) -> Contact {
        let down = down(touch.pitch);
        let shape = self.parts[touch.part].shape;
        let (mut sum, mut count) = (DVec3::ZERO, 0.0);
        let parts = self.parts.iter().enumerate();
        for (index, part) in parts.filter(|(_, part)| part.shape == shape) {
            let other = self.touch(index, touch.pitch);
            let same_place = (other.ahead - touch.ahead).abs() < LEVEL
                && (other.height - touch.height).abs() < LEVEL;
            if same_place {
                sum += part.touching(down);
                count += 1.0;
            }
        }
        Contact {
            shape,
            point: sum / count,
            ahead: touch.ahead,
        }
    }
}
