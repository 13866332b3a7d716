//! Gait files: three curves over the phase, a mapping and a limits policy.
//!
//! ```toml
//! name = "arched"
//! description = "lifts the hips in the middle of the pull"
//! mapping = "exact"        # or "original"
//! arm = "flat-forearm"     # or "fixed"
//! limits = "refuse"        # or "clamp"
//!
//! [knee]                   # θ3
//! constant_deg = 16.5
//! [hip]                    # θ4: a cubic, highest power first
//! polynomial_rad = [1.8796, -0.1365, -1.7434, 0.47997]
//! [upper_arm]              # α
//! linear_deg = [-30, -90]
//! ```
//!
//! A curve is exactly one of `constant_…`, `linear_…`, `polynomial_…`, `through_… = [[s, value],
//! …]` (natural cubic spline) and `b_spline_… = { degree, control }` (clamped, uniform), each
//! with `_deg` or `_rad`.

use serde::Deserialize;
use toml::Spanned;

use prone::gait::{Curve, CurveError, Gait, LimitsPolicy};
use prone::mapping::{ArmMode, MappingVariant};

use crate::error::{FileError, Source};

/// Reads a gait from the text of a gait file; `file` is the name that errors carry.
///
/// # Errors
/// [`FileError`] with line and column.
pub fn parse(file: &str, text: &str) -> Result<Gait, FileError> {
    let source = Source { file, text };
    let gait: GaitFile = source.parse()?;
    let name = gait.name.get_ref();
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    if name.is_empty() || !name.chars().all(plain) {
        return Err(source.error(
            gait.name.span(),
            format!("a gait's name is made of letters, digits, - and _ (it becomes part of file names), not {name:?}"),
        ));
    }
    let curve = |curve: CurveFile| {
        let span = curve.span();
        curve
            .into_curve()
            .map_err(|error| source.error(span, error))
    };
    Ok(Gait {
        name: name.clone(),
        description: gait.description,
        knee: curve(gait.knee)?,
        hip: curve(gait.hip)?,
        upper_arm: curve(gait.upper_arm)?,
        mapping: gait.mapping.into(),
        arm: gait.arm.into(),
        limits: gait.limits.into(),
    })
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct GaitFile {
    name: Spanned<String>,
    #[serde(default)]
    description: String,
    #[serde(default)]
    mapping: MappingName,
    #[serde(default)]
    arm: ArmName,
    #[serde(default)]
    limits: LimitsName,
    knee: CurveFile,
    hip: CurveFile,
    upper_arm: CurveFile,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum MappingName {
    #[default]
    Exact,
    Original,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum ArmName {
    #[default]
    FlatForearm,
    Fixed,
}

#[derive(Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum LimitsName {
    #[default]
    Refuse,
    Clamp,
}

#[derive(Debug, Deserialize)]
#[serde(rename_all = "snake_case")]
enum CurveFile {
    ConstantDeg(Spanned<f64>),
    ConstantRad(Spanned<f64>),
    LinearDeg(Spanned<[f64; 2]>),
    LinearRad(Spanned<[f64; 2]>),
    PolynomialDeg(Spanned<Vec<f64>>),
    PolynomialRad(Spanned<Vec<f64>>),
    ThroughDeg(Spanned<Vec<(f64, f64)>>),
    ThroughRad(Spanned<Vec<(f64, f64)>>),
    BSplineDeg(Spanned<BSplineFile>),
    BSplineRad(Spanned<BSplineFile>),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct BSplineFile {
    degree: usize,
    control: Vec<f64>,
}

impl CurveFile {
    /// Where the numbers stand in the file.
    fn span(&self) -> std::ops::Range<usize> {
        match self {
            Self::ConstantDeg(value) | Self::ConstantRad(value) => value.span(),
            Self::LinearDeg(ends) | Self::LinearRad(ends) => ends.span(),
            Self::PolynomialDeg(numbers) | Self::PolynomialRad(numbers) => numbers.span(),
            Self::ThroughDeg(points) | Self::ThroughRad(points) => points.span(),
            Self::BSplineDeg(spline) | Self::BSplineRad(spline) => spline.span(),
        }
    }

    fn into_curve(self) -> Result<Curve, CurveError> {
        let radians = |degrees: Vec<f64>| degrees.into_iter().map(f64::to_radians).collect();
        match self {
            Self::ConstantDeg(value) => Curve::constant(value.into_inner().to_radians()),
            Self::ConstantRad(value) => Curve::constant(value.into_inner()),
            Self::LinearDeg(ends) => {
                let [from, to] = ends.into_inner().map(f64::to_radians);
                Curve::linear(from, to)
            }
            Self::LinearRad(ends) => {
                let [from, to] = ends.into_inner();
                Curve::linear(from, to)
            }
            Self::PolynomialDeg(numbers) => Curve::polynomial(radians(numbers.into_inner())),
            Self::PolynomialRad(numbers) => Curve::polynomial(numbers.into_inner()),
            Self::ThroughDeg(points) => {
                let points = points.into_inner().into_iter();
                Curve::through(points.map(|(s, value)| (s, value.to_radians())).collect())
            }
            Self::ThroughRad(points) => Curve::through(points.into_inner()),
            Self::BSplineDeg(spline) => {
                let BSplineFile { degree, control } = spline.into_inner();
                Curve::b_spline(degree, radians(control))
            }
            Self::BSplineRad(spline) => {
                let BSplineFile { degree, control } = spline.into_inner();
                Curve::b_spline(degree, control)
            }
        }
    }
}

impl From<MappingName> for MappingVariant {
    fn from(name: MappingName) -> Self {
        match name {
            MappingName::Exact => Self::Exact,
            MappingName::Original => Self::Original,
        }
    }
}

impl From<ArmName> for ArmMode {
    fn from(name: ArmName) -> Self {
        match name {
            ArmName::FlatForearm => Self::FlatForearm,
            ArmName::Fixed => Self::Fixed,
        }
    }
}

impl From<LimitsName> for LimitsPolicy {
    fn from(name: LimitsName) -> Self {
        match name {
            LimitsName::Refuse => Self::Refuse,
            LimitsName::Clamp => Self::Clamp,
        }
    }
}

#[cfg(test)]
mod tests {
    use insta::assert_snapshot;

    use super::*;

    const GOOD: &str = r#"
name = "arched"
[knee]
constant_deg = 16.5
[hip]
polynomial_rad = [1.8796, -0.1365, -1.7434, 0.47997]
[upper_arm]
linear_deg = [-30, -90]
"#;

    fn error(text: &str) -> String {
        parse("gait.toml", text).unwrap_err().to_string()
    }

    #[test]
    fn a_gait_is_read_in_radians_with_the_safe_defaults() {
        let gait = parse("gait.toml", GOOD).unwrap();
        assert_eq!(gait.limits, LimitsPolicy::Refuse);
        assert_eq!(gait.mapping, MappingVariant::Exact);
        assert_eq!(gait.arm, ArmMode::FlatForearm);
        let end = gait.parameters(1.0);
        assert!((end.upper_arm + std::f64::consts::FRAC_PI_2).abs() < 1e-12);
        assert!((end.hip - 0.47967).abs() < 1e-12, "the cubic at s = 1");
        assert!((end.knee - 16.5_f64.to_radians()).abs() < 1e-15);
    }

    #[test]
    fn every_form_of_curve_is_read() {
        for (form, at_half) in [
            ("constant_rad = 0.2", 0.2),
            ("linear_rad = [0.2, 0.4]", 0.3),
            ("polynomial_deg = [180, 0]", std::f64::consts::FRAC_PI_2),
            ("through_rad = [[0, 0.0], [0.5, 1.0], [1, 0.0]]", 1.0),
            (
                "through_deg = [[0, 0.0], [0.5, 180.0], [1, 0.0]]",
                std::f64::consts::PI,
            ),
            ("b_spline_rad = { degree = 1, control = [0.0, 1.0] }", 0.5),
            (
                "b_spline_deg = { degree = 1, control = [0.0, 180.0] }",
                std::f64::consts::FRAC_PI_2,
            ),
        ] {
            let text = GOOD.replace("constant_deg = 16.5", form);
            let gait = parse("gait.toml", &text).unwrap();
            assert!((gait.knee.value(0.5) - at_half).abs() < 1e-12, "{form}");
        }
    }

    #[test]
    fn errors_point_at_the_place() {
        assert_snapshot!(error("name = \"a\"\nknee = {"), @"");
        assert_snapshot!(error(&GOOD.replace("constant_deg = 16.5", "konstant_deg = 16.5")), @"");
        assert_snapshot!(error(&GOOD.replace("16.5", "nan")), @"");
        assert_snapshot!(error(&GOOD.replace("\"arched\"", "\"../arched\"")), @"");
        assert_snapshot!(error(&GOOD.replace("name =", "gravity = 2\nname =")), @"");
        assert_snapshot!(error(&GOOD.replace("[upper_arm]\nlinear_deg = [-30, -90]\n", "")), @"");
        assert_snapshot!(error(&format!("limits = \"stop\"{GOOD}")), @"");
    }
}
