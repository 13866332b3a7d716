//! A place in a JSON document, and what may stand there.

use std::fmt;
use std::ops::RangeInclusive;

use glam::{DQuat, DVec3};

use prone::frames::{Frame, Point, Transform};
use prone::robot::{Range, bounds};

use super::document::PoseDocument;

/// Longest name, bytes.
const LONGEST_NAME: usize = 256;

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
pub(super) struct Place<'a> {
    within: Option<&'a Place<'a>>,
    step: Step,
}

#[derive(Debug, Clone, Copy)]
enum Step {
    Key(&'static str),
    Index(usize),
}

impl fmt::Display for Place<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.within, self.step) {
            (None, Step::Key(key)) => f.write_str(key),
            (None, Step::Index(index)) => write!(f, "[{index}]"),
            (Some(within), Step::Key(key)) => write!(f, "{within}.{key}"),
            (Some(within), Step::Index(index)) => write!(f, "{within}[{index}]"),
        }
    }
}

impl Place<'_> {
    pub(super) const fn root(key: &'static str) -> Place<'static> {
        Place {
            within: None,
            step: Step::Key(key),
        }
    }

    /// The value of a key.
    pub(super) const fn key(&self, key: &'static str) -> Place<'_> {
        Place {
            within: Some(self),
            step: Step::Key(key),
        }
    }

    /// An element of an array.
    pub(super) const fn index(&self, index: usize) -> Place<'_> {
        Place {
            within: Some(self),
            step: Step::Index(index),
        }
    }

    pub(super) fn violation(&self, message: impl fmt::Display) -> Violation {
        Violation {
            place: self.to_string(),
            message: message.to_string(),
        }
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

    /// An angle within a turn.
    pub(super) fn angle(&self, radians: f64) -> Result<f64, Violation> {
        self.within(radians, -bounds::ANGLE..=bounds::ANGLE)
    }

    /// Coordinates, m.
    pub(super) fn coordinates(&self, metres: [f64; 3]) -> Result<DVec3, Violation> {
        for (index, value) in metres.into_iter().enumerate() {
            let place = self.index(index);
            place.within(value, -bounds::LENGTH..=bounds::LENGTH)?;
        }
        Ok(DVec3::from_array(metres))
    }

    /// Lengths, m.
    pub(super) fn lengths(&self, metres: [f64; 3]) -> Result<DVec3, Violation> {
        for (index, value) in metres.into_iter().enumerate() {
            self.index(index).positive(value, bounds::LENGTH)?;
        }
        Ok(DVec3::from_array(metres))
    }

    pub(super) fn point<F: Frame>(&self, metres: [f64; 3]) -> Result<Point<F>, Violation> {
        Ok(Point::new(self.coordinates(metres)?))
    }

    /// A unit vector.
    pub(super) fn direction(&self, vector: [f64; 3]) -> Result<DVec3, Violation> {
        let vector = DVec3::from_array(vector);
        self.unit("vector", vector.length())?;
        Ok(vector)
    }

    pub(super) fn pose<A: Frame, B: Frame>(
        &self,
        pose: &PoseDocument,
    ) -> Result<Transform<A, B>, Violation> {
        let PoseDocument {
            position_m,
            quaternion_wxyz: [w, x, y, z],
        } = *pose;
        let position = self.key("position_m").coordinates(position_m)?;
        let turn = DQuat::from_xyzw(x, y, z, w);
        let place = self.key("quaternion_wxyz");
        place.unit("quaternion", turn.length())?;
        Ok(Transform::new(turn, position))
    }

    /// The length of a unit vector or quaternion; NaN is none.
    fn unit(&self, what: &str, length: f64) -> Result<(), Violation> {
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

    /// How many of something there are.
    pub(super) fn count(&self, count: usize, most: usize) -> Result<(), Violation> {
        if count <= most {
            return Ok(());
        }
        Err(self.violation(format!("{count} are more than {most}")))
    }

    pub(super) fn name(&self, name: &str) -> Result<String, Violation> {
        match name.len() {
            0 => Err(self.violation("a name is empty")),
            1..=LONGEST_NAME => Ok(name.to_owned()),
            bytes => Err(self.violation(format!(
                "a name of {bytes} bytes is longer than {LONGEST_NAME}"
            ))),
        }
    }
}
