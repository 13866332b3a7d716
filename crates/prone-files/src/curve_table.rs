//! `[knee]`, `[hip]`, `[upper_arm]`: one curve, in degrees or radians.

use std::fmt;
use std::ops::Range;

use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use toml::Spanned;

use prone::gait::{Curve, CurveError, CurveForm};

use crate::error::{FileError, Source};
use crate::exactly::Exactly;

/// The keys of a curve; a table holds exactly one.
const KEYS: &[&str] = &[
    "constant_deg",
    "constant_rad",
    "linear_deg",
    "linear_rad",
    "polynomial_deg",
    "polynomial_rad",
    "through_deg",
    "through_rad",
    "b_spline_deg",
    "b_spline_rad",
];

/// A curve as it stands in a file.
#[derive(Debug)]
pub(crate) struct CurveTable {
    form: Form,
    unit: Unit,
    /// Where its numbers stand.
    span: Range<usize>,
}

#[derive(Debug, Clone, Copy)]
enum Unit {
    Degrees,
    Radians,
}

#[derive(Debug)]
enum Form {
    Constant(f64),
    Linear([f64; 2]),
    Polynomial(Vec<f64>),
    /// Phase and value.
    Through(Vec<[f64; 2]>),
    BSpline(BSpline),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct BSpline {
    degree: usize,
    control: Vec<f64>,
}

impl CurveTable {
    /// The curve in radians; an error points at the numbers, and names them as the file has them.
    pub(crate) fn read(self, source: Source<'_>) -> Result<Curve, FileError> {
        let (unit, largest) = (self.unit, self.form.largest());
        let radians = |value: f64| unit.radians(value);
        let all = |values: Vec<f64>| values.into_iter().map(radians).collect();
        let curve = match self.form {
            Form::Constant(value) => Curve::constant(radians(value)),
            Form::Linear([from, to]) => Curve::linear(radians(from), radians(to)),
            Form::Polynomial(coefficients) => Curve::polynomial(all(coefficients)),
            Form::Through(points) => {
                let points = points.into_iter();
                Curve::through(points.map(|[s, value]| (s, radians(value))).collect())
            }
            Form::BSpline(BSpline { degree, control }) => Curve::b_spline(degree, all(control)),
        };
        let named = curve.map_err(|error| match error {
            CurveError::Overflow { .. } => CurveError::Overflow { largest },
            other => other,
        });
        named.map_err(|error| source.error(self.span, error))
    }
}

impl Unit {
    fn radians(self, value: f64) -> f64 {
        match self {
            Self::Degrees => value.to_radians(),
            Self::Radians => value,
        }
    }
}

impl Form {
    /// The number of the largest magnitude.
    fn largest(&self) -> f64 {
        let larger = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
        match self {
            Self::Constant(value) => *value,
            Self::Linear(ends) => ends.iter().fold(0.0, larger),
            Self::Polynomial(numbers) => numbers.iter().fold(0.0, larger),
            Self::Through(points) => points.iter().flatten().fold(0.0, larger),
            Self::BSpline(spline) => spline.control.iter().fold(0.0, larger),
        }
    }
}

/// One line of a table that reads as the same curve.
pub(crate) fn write(curve: &Curve) -> String {
    // `{:?}` is the shortest text that reads as the same number.
    match curve.form() {
        CurveForm::Polynomial(coefficients) => match coefficients[..] {
            [value] => format!("constant_rad = {value:?}"),
            _ => format!("polynomial_rad = {coefficients:?}"),
        },
        CurveForm::BSpline { degree, control } => {
            format!("b_spline_rad = {{ degree = {degree}, control = {control:?} }}")
        }
        CurveForm::Through(points) => {
            let points: Vec<_> = points.iter().map(|(s, value)| [s, value]).collect();
            format!("through_rad = {points:?}")
        }
    }
}

impl<'de> Deserialize<'de> for CurveTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(OneKey)
    }
}

struct OneKey;

impl<'de> Visitor<'de> for OneKey {
    type Value = CurveTable;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a table with one of {}", KEYS.join(", "))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut table: A) -> Result<CurveTable, A::Error> {
        let wrong =
            |what: &str| A::Error::custom(format!("{what}; it is one of {}", KEYS.join(", ")));
        let Some(key) = table.next_key()? else {
            return Err(wrong("a curve is missing"));
        };
        let curve = value(key, &mut table)?;
        match table.next_key::<Key>()? {
            None => Ok(curve),
            Some(second) => Err(wrong(&format!(
                "a curve is given twice, as {} and as {}",
                key.0, second.0
            ))),
        }
    }
}

/// One of [`KEYS`]. Refused here, an unknown key is pointed at itself, not at its table.
#[derive(Clone, Copy)]
struct Key(&'static str);

impl<'de> Deserialize<'de> for Key {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let given = String::deserialize(deserializer)?;
        let known = KEYS.iter().find(|known| **known == given);
        known
            .map(|known| Self(known))
            .ok_or_else(|| D::Error::unknown_field(&given, KEYS))
    }
}

fn value<'de, A: MapAccess<'de>>(Key(key): Key, table: &mut A) -> Result<CurveTable, A::Error> {
    let (name, unit) = match key.strip_suffix("_deg") {
        Some(name) => (name, Unit::Degrees),
        None => (key.trim_end_matches("_rad"), Unit::Radians),
    };
    let (form, span) = match name {
        "constant" => placed(table.next_value()?, Form::Constant),
        "linear" => placed(table.next_value()?, |Exactly(ends)| Form::Linear(ends)),
        "polynomial" => placed(table.next_value()?, Form::Polynomial),
        "through" => placed(table.next_value()?, |points: Vec<Exactly<f64, 2>>| {
            Form::Through(points.into_iter().map(|Exactly(pair)| pair).collect())
        }),
        _ => placed(table.next_value()?, Form::BSpline),
    };
    Ok(CurveTable { form, unit, span })
}

fn placed<T>(value: Spanned<T>, form: impl FnOnce(T) -> Form) -> (Form, Range<usize>) {
    let span = value.span();
    (form(value.into_inner()), span)
}
