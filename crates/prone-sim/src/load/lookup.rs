//! Looks names and numbers of `robot.toml` up: is the name in the model, is the number usable?
//! Every refusal points into the file.

use std::fmt::Display;

use strsim::levenshtein;

use prone::frames::{Link, Point};
use prone::robot::{BodyId, JointId, Range, bounds};
use prone_files::FileError;
use prone_files::robot_file::{Name, Placed, RobotFile};

use super::model::Parts;

/// The TOML file that errors point into, and the model's name for their text.
pub(super) struct Lookup<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
    pub(super) mjcf: &'a str,
}

impl Lookup<'_> {
    pub(super) fn error<T>(&self, place: &Placed<T>, message: impl Display) -> FileError {
        RobotFile::error_at(self.file, self.text, place, &message.to_string())
    }

    /// An error for a name that the model lacks, with the nearest one that it has.
    pub(super) fn unknown<'n>(
        &self,
        place: &Name,
        kind: &str,
        known: impl Iterator<Item = &'n str>,
    ) -> FileError {
        let name = place.get_ref();
        let nearest = known.min_by_key(|candidate| levenshtein(candidate, name));
        let hint = match nearest {
            Some(nearest) if levenshtein(nearest, name) <= 3 => {
                format!("; did you mean {nearest}?")
            }
            _ => String::new(),
        };
        self.error(
            place,
            format!("{kind} {name} is not in {}{hint}", self.mjcf),
        )
    }

    pub(super) fn joint(&self, name: &Name, parts: &Parts) -> Result<JointId, FileError> {
        let mut joints = parts.joints.iter();
        joints
            .position(|joint| joint.name == *name.get_ref())
            .map(JointId)
            .ok_or_else(|| {
                self.unknown(name, "joint", parts.joints.iter().map(|j| j.name.as_str()))
            })
    }

    pub(super) fn body(&self, name: &Name, parts: &Parts) -> Result<BodyId, FileError> {
        let mut bodies = parts.bodies.iter();
        bodies
            .position(|body| body.name == *name.get_ref())
            .map(BodyId)
            .ok_or_else(|| self.unknown(name, "body", parts.bodies.iter().map(|b| b.name.as_str())))
    }

    pub(super) fn site(
        &self,
        name: &Name,
        parts: &Parts,
    ) -> Result<(BodyId, Point<Link>), FileError> {
        parts
            .sites
            .get(name.get_ref())
            .copied()
            .ok_or_else(|| self.unknown(name, "site", parts.sites.keys().map(String::as_str)))
    }

    /// A positive number up to `largest`.
    pub(super) fn positive<T>(
        &self,
        place: &Placed<T>,
        what: &str,
        value: f64,
        largest: f64,
    ) -> Result<f64, FileError> {
        if value > 0.0 && value <= largest {
            return Ok(value);
        }
        let message = if value > largest && value.is_finite() {
            format!("{what} must be at most {largest}, not {value}")
        } else {
            format!("{what} must be positive and finite, not {value}")
        };
        Err(self.error(place, message))
    }

    /// A number from 0 to `largest`; NaN is in no range.
    pub(super) fn within<T>(
        &self,
        place: &Placed<T>,
        what: &str,
        value: f64,
        largest: f64,
    ) -> Result<f64, FileError> {
        if (0.0..=largest).contains(&value) {
            return Ok(value);
        }
        let message = format!("{what} must be within 0..{largest}, not {value}");
        Err(self.error(place, message))
    }

    /// A range of angles, rad.
    pub(super) fn range<T>(&self, place: &Placed<T>, range: Range) -> Result<Range, FileError> {
        let Range { lower, upper } = range;
        if lower < upper && lower >= -bounds::ANGLE && upper <= bounds::ANGLE {
            return Ok(range);
        }
        let message = format!("a range needs -2π <= lower < upper <= 2π, not {lower}..{upper}");
        Err(self.error(place, message))
    }

    /// A length in mm, as metres.
    pub(super) fn length<T>(
        &self,
        place: &Placed<T>,
        what: &str,
        mm: f64,
    ) -> Result<f64, FileError> {
        Ok(self.positive(place, what, mm, bounds::LENGTH * 1e3)? * 1e-3)
    }

    /// An angle in degrees, as radians.
    pub(super) fn angle(&self, place: &Name, what: &str, degrees: f64) -> Result<f64, FileError> {
        let radians = degrees.to_radians();
        if radians.abs() <= bounds::ANGLE {
            return Ok(radians);
        }
        let message = format!("{what} must be within -360..360, not {degrees}");
        Err(self.error(place, message))
    }
}
