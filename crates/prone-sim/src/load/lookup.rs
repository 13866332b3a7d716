//! Looks names and numbers of `robot.toml` up: is the name in the model, is the number usable?
//! Every refusal points into the file.

use std::fmt::Display;

use prone::robot::{Body, BodyId, Joint, JointId, Range, bounds};
use prone_files::FileError;
use prone_files::names::{NameKind, UnknownName};
use prone_files::robot_file::{Name, Placed, RobotFile};

use super::model::{Parts, Site};

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

    /// The place of a name among those that the model has; where it is none of them, the error says
    /// the nearest one.
    fn find<'n>(
        &self,
        place: &Name,
        kind: NameKind,
        mut known: impl Iterator<Item = &'n str> + Clone,
    ) -> Result<usize, FileError> {
        let name = place.get_ref();
        let all = known.clone();
        if let Some(index) = known.position(|known| known == name) {
            return Ok(index);
        }
        let unknown = UnknownName::new(kind, name, all).within(self.mjcf);
        Err(self.error(place, unknown))
    }

    pub(super) fn joint(&self, name: &Name, joints: &[Joint]) -> Result<JointId, FileError> {
        let known = joints.iter().map(|joint| joint.name.as_str());
        self.find(name, NameKind::Joint, known).map(JointId)
    }

    pub(super) fn body(&self, name: &Name, bodies: &[Body]) -> Result<BodyId, FileError> {
        let known = bodies.iter().map(|body| body.name.as_str());
        self.find(name, NameKind::Body, known).map(BodyId)
    }

    pub(super) fn site<'p>(&self, name: &Name, parts: &'p Parts) -> Result<&'p Site, FileError> {
        let known = parts.sites.keys().map(String::as_str);
        self.find(name, NameKind::Site, known)?;
        Ok(&parts.sites[name.get_ref()])
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
