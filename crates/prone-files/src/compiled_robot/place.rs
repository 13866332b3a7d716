//! A place in a JSON document, and what may stand there.

use std::fmt;
use std::ops::RangeInclusive;

use glam::DVec3;

use prone::foreign_text;
use prone::frames::{Frame, Point};
use prone::robot::{Range, bounds};

/// Longest name, bytes.
pub(super) const LONGEST_NAME: usize = 256;

/// Something in a robot's document that no robot has.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {message}")]
pub struct Violation {
    /// Where it stands, as in `robot.bodies[3].mass_kg`.
    pub place: String,
    /// What is wrong, with the bound.
    pub message: String,
}

/// A place, known by the steps that lead to it.
#[derive(Debug, Clone, Copy)]
pub(super) enum Place<'a> {
    /// The value of a key of the whole text.
    Root(&'static str),
    /// The value of a key.
    Key(&'a Place<'a>, &'static str),
    /// An element of an array.
    Element(&'a Place<'a>, usize),
}

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Root(key) => f.write_str(key),
            Self::Key(within, key) => write!(f, "{within}.{key}"),
            Self::Element(within, index) => write!(f, "{within}[{index}]"),
        }
    }
}

impl Place<'_> {
    pub(super) const fn key(&self, key: &'static str) -> Place<'_> {
        Place::Key(self, key)
    }

    pub(super) fn violation(&self, message: impl fmt::Display) -> Violation {
        Violation {
            place: self.to_string(),
            message: message.to_string(),
        }
    }

    /// Reads the elements of an array, each with its place and its index.
    pub(super) fn each<D, T>(
        &self,
        elements: &[D],
        mut read: impl FnMut(Place<'_>, usize, &D) -> Result<T, Violation>,
    ) -> Result<Vec<T>, Violation> {
        let elements = elements.iter().enumerate();
        elements
            .map(|(index, element)| read(Place::Element(self, index), index, element))
            .collect()
    }

    /// Reads the elements of an array of one length.
    pub(super) fn array<const N: usize>(
        &self,
        values: [f64; N],
        read: impl Fn(Place<'_>, f64) -> Result<f64, Violation>,
    ) -> Result<[f64; N], Violation> {
        for (index, value) in values.into_iter().enumerate() {
            read(Place::Element(self, index), value)?;
        }
        Ok(values)
    }

    /// A number within bounds; NaN is in none.
    pub(super) fn within(&self, value: f64, bounds: RangeInclusive<f64>) -> Result<f64, Violation> {
        if bounds.contains(&value) {
            return Ok(value);
        }
        let (least, largest) = bounds.into_inner();
        Err(self.violation(format!("{value:?} is outside {least}..{largest}")))
    }

    /// A positive number up to `largest`.
    pub(super) fn positive(&self, value: f64, largest: f64) -> Result<f64, Violation> {
        if value > 0.0 && value <= largest {
            return Ok(value);
        }
        Err(self.violation(format!("{value:?} is not above 0 and at most {largest}")))
    }

    /// A length, m.
    pub(super) fn length(&self, metres: f64) -> Result<f64, Violation> {
        self.positive(metres, bounds::LENGTH)
    }

    /// An angle within a turn.
    pub(super) fn angle(&self, radians: f64) -> Result<f64, Violation> {
        self.within(radians, -bounds::ANGLE..=bounds::ANGLE)
    }

    /// Lengths, m.
    pub(super) fn lengths(&self, metres: [f64; 3]) -> Result<DVec3, Violation> {
        let metres = self.array(metres, |at, value| at.length(value))?;
        Ok(DVec3::from_array(metres))
    }

    /// A point by its coordinates, m.
    pub(super) fn point<F: Frame>(&self, metres: [f64; 3]) -> Result<Point<F>, Violation> {
        let reach = -bounds::LENGTH..=bounds::LENGTH;
        let metres = self.array(metres, |at, value| at.within(value, reach.clone()))?;
        Ok(Point::new(DVec3::from_array(metres)))
    }

    /// A unit vector.
    pub(super) fn direction(&self, vector: [f64; 3]) -> Result<DVec3, Violation> {
        let vector = DVec3::from_array(vector);
        self.unit("vector", vector.length())?;
        Ok(vector)
    }

    /// The length of a unit vector or quaternion; NaN is none.
    pub(super) fn unit(&self, what: &str, length: f64) -> Result<(), Violation> {
        if (length - 1.0).abs() < bounds::UNIT {
            return Ok(());
        }
        let most = bounds::UNIT;
        Err(self.violation(format!(
            "the {what} has the length {length}, not 1 to {most:e}"
        )))
    }

    /// A range of angles whose ends are at most `largest`.
    pub(super) fn range(&self, ends: [f64; 2], largest: f64) -> Result<Range, Violation> {
        let [lower, upper] = ends;
        if lower < upper && lower >= -largest && upper <= largest {
            return Ok(Range { lower, upper });
        }
        Err(self.violation(format!(
            "a range needs -{largest} <= lower < upper <= {largest}, not {lower:?}..{upper:?}"
        )))
    }

    /// A name that is neither empty nor too long.
    pub(super) fn name(&self, name: &str) -> Result<String, Violation> {
        match name.len() {
            0 => Err(self.violation("a name is empty")),
            _ if name.contains(foreign_text::is_hidden) => {
                let name = foreign_text::Quoted(name);
                Err(self.violation(format!("a name has no letter that is not seen, not {name}")))
            }
            1..=LONGEST_NAME => Ok(name.to_owned()),
            bytes => Err(self.violation(format!(
                "a name of {bytes} bytes is longer than {LONGEST_NAME}"
            ))),
        }
    }
}

/// Reads a part if it is there.
pub(super) fn optional<D, T>(
    part: Option<D>,
    read: impl FnOnce(D) -> Result<T, Violation>,
) -> Result<Option<T>, Violation> {
    part.map(read).transpose()
}
