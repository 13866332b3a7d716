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

use prone::foreign_text::{Quoted, escaped_lines, is_hidden};
use prone::gait::{Gait, LimitsPolicy};
use prone::mapping::{ArmMode, MappingVariant};

use crate::curve_table::{self, CurveTable};
use crate::error::{FileError, Source};
use crate::plain_name::is_plain;

/// Tables that a gait file has at its top and a cycle file has not.
const OF_PULLS: [&str; 3] = ["knee", "hip", "upper_arm"];

/// Whether a text is that of a gait file, whole or not: it has a curve of a chain angle.
pub(crate) fn is_pull(text: &str) -> bool {
    let table = toml::from_str::<toml::Table>(text);
    table.is_ok_and(|table| OF_PULLS.iter().any(|key| table.contains_key(*key)))
}

/// Reads a gait from the text of a gait file; `file` is the name that errors carry.
pub fn parse(file: &str, text: &str) -> Result<Gait, FileError> {
    let source = Source { file, text };
    let gait: GaitFile = source.parse()?;
    check_name(source, &gait.name)?;
    Ok(Gait {
        name: gait.name.get_ref().clone(),
        description: gait.description,
        knee: gait.knee.read(source)?,
        hip: gait.hip.read(source)?,
        upper_arm: gait.upper_arm.read(source)?,
        mapping: gait.mapping,
        arm: gait.arm,
        limits: gait.limits,
    })
}

/// Whether a name may become part of file names.
pub(crate) fn check_name(source: Source<'_>, name: &Spanned<String>) -> Result<(), FileError> {
    let text = name.get_ref();
    if !is_plain(text) {
        return Err(source.error(
            name.span(),
            format!("a gait's name is made of letters, digits, - and _ (it becomes part of file names), not {}", Quoted(text)),
        ));
    }
    Ok(())
}

/// A gait as the text of a gait file: angles in radians with every digit, so that [`parse`] gives
/// the same gait. `header` becomes comment lines at the top.
pub fn write(gait: &Gait, header: &str) -> String {
    let head = Head {
        name: &gait.name,
        description: &gait.description,
        chain: Some((gait.mapping, gait.arm)),
        limits: gait.limits,
    };
    let mut text = write_head(&head, header);
    for (table, curve) in [
        ("knee", &gait.knee),
        ("hip", &gait.hip),
        ("upper_arm", &gait.upper_arm),
    ] {
        text.push_str(&["\n[", table, "]\n", &curve_table::write(curve), "\n"].concat());
    }
    text
}

/// What stands at the top of a gait or cycle file.
pub(crate) struct Head<'a> {
    pub(crate) name: &'a str,
    pub(crate) description: &'a str,
    /// Of what has a closed chain.
    pub(crate) chain: Option<(MappingVariant, ArmMode)>,
    pub(crate) limits: LimitsPolicy,
}

/// Header, name, description, mapping, arms and limits.
pub(crate) fn write_head(head: &Head<'_>, header: &str) -> String {
    let mut text = String::new();
    for line in escaped_lines(header).lines() {
        text.push_str(format!("# {line}").trim_end());
        text.push('\n');
    }
    let limits = match head.limits {
        LimitsPolicy::Refuse => "refuse",
        LimitsPolicy::Clamp => "clamp",
    };
    let mut values = vec![("name", head.name), ("description", head.description)];
    if let Some((mapping, arm)) = &head.chain {
        values.push(("mapping", mapping.name()));
        values.push(("arm", arm.name()));
    }
    values.push(("limits", limits));
    for (key, value) in values {
        text.push_str(&[key, " = ", &quoted(value), "\n"].concat());
    }
    text
}

/// A text as a TOML string, with an escape for each letter that is not to be seen.
pub(crate) fn quoted(text: &str) -> String {
    if !text.contains(|letter| letter != '\n' && is_hidden(letter)) {
        return toml::Value::from(text).to_string();
    }
    let letter = |letter| match letter {
        '"' | '\\' => format!("\\{letter}"),
        letter if is_hidden(letter) => format!("\\U{:08x}", u32::from(letter)),
        letter => letter.to_string(),
    };
    format!("\"{}\"", text.chars().map(letter).collect::<String>())
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct GaitFile {
    name: Spanned<String>,
    #[serde(default)]
    description: String,
    #[serde(default, with = "MappingName")]
    mapping: MappingVariant,
    #[serde(default, with = "ArmName")]
    arm: ArmMode,
    #[serde(default, with = "LimitsName")]
    limits: LimitsPolicy,
    knee: CurveTable,
    hip: CurveTable,
    upper_arm: CurveTable,
}

#[derive(Deserialize)]
#[serde(remote = "MappingVariant", rename_all = "kebab-case")]
pub(crate) enum MappingName {
    Exact,
    Original,
}

#[derive(Deserialize)]
#[serde(remote = "ArmMode", rename_all = "kebab-case")]
pub(crate) enum ArmName {
    FlatForearm,
    Fixed,
}

#[derive(Deserialize)]
#[serde(remote = "LimitsPolicy", rename_all = "kebab-case")]
pub(crate) enum LimitsName {
    Refuse,
    Clamp,
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
    fn what_is_written_is_read_again() {
        for form in [
            "constant_rad = 0.1",
            "linear_deg = [1, 7]",
            "polynomial_rad = [1.8796, -0.1365, -1.7434, 0.47997]",
            "through_deg = [[0, 1.1], [0.3, 7], [1, -2]]",
            "b_spline_rad = { degree = 3, control = [0.1, 1e-17, -3.0, 0.7, 0.30000000000000004] }",
        ] {
            let mut gait = parse("a.toml", &GOOD.replace("constant_deg = 16.5", form)).unwrap();
            gait.limits = LimitsPolicy::Clamp;
            gait.mapping = MappingVariant::Original;
            gait.description = "a \"quoted\" word, a \\ and\na line".to_owned();
            assert_eq!(parse("b.toml", &write(&gait, "")).unwrap(), gait);
            gait.description += "\u{1b}[2J \u{9b} \u{202e} \u{e0041}";
            let text = write(&gait, "first line\u{1b}\n\nthird line");
            assert!(!text.contains(|it| it != '\n' && is_hidden(it)), "{text:?}");
            let text = text.replacen("\\u{1b}", "", 1);
            assert!(text.starts_with("# first line\n#\n# third line\nname = \"arched\"\n"));
            assert_eq!(parse("b.toml", &text).unwrap(), gait, "{text}");
        }
    }

    #[test]
    fn errors_point_at_the_place() {
        assert_snapshot!(error("name = \"a\"\nknee = {"), @"gait.toml:2:9: unclosed inline table, expected `}`");
        assert_snapshot!(error(&GOOD.replace("constant_deg = 16.5", "konstant_deg = 16.5")), @"gait.toml:4:1: unknown field `konstant_deg`, expected one of `constant_deg`, `constant_rad`, `linear_deg`, `linear_rad`, `polynomial_deg`, `polynomial_rad`, `through_deg`, `through_rad`, `b_spline_deg`, `b_spline_rad`");
        assert_snapshot!(error(&GOOD.replace("16.5", "nan")), @"gait.toml:4:16: NaN is not a finite number");
        assert_snapshot!(error(&GOOD.replace("\"arched\"", "\"../arched\"")), @r#"gait.toml:2:8: a gait's name is made of letters, digits, - and _ (it becomes part of file names), not "../arched""#);
        assert_snapshot!(error(&GOOD.replace("name =", "gravity = 2\nname =")), @"gait.toml:2:1: unknown field `gravity`, expected one of `name`, `description`, `mapping`, `arm`, `limits`, `knee`, `hip`, `upper_arm`");
        assert_snapshot!(error(&GOOD.replace("[upper_arm]\nlinear_deg = [-30, -90]\n", "")), @"gait.toml:1:1: missing field `upper_arm`");
        assert_snapshot!(error(&format!("limits = \"stop\"{GOOD}")), @"gait.toml:1:10: unknown variant `stop`, expected `refuse` or `clamp`");
    }

    #[test]
    fn overlong_arrays_and_odd_tables_point_at_the_place() {
        let knee = |curve: &str| error(&GOOD.replace("constant_deg = 16.5", curve));
        assert_snapshot!(knee("linear_deg = [1, 2, 3]"), @"gait.toml:4:14: invalid length 3, expected an array of exactly 2 values");
        assert_snapshot!(knee("through_rad = [[0, 0], [0.5, 1, 2], [1, 0]]"), @"gait.toml:4:24: invalid length 3, expected an array of exactly 2 values");
        assert_snapshot!(knee("through_rad = [[0, 0], [1]]"), @"gait.toml:4:24: invalid length 1, expected an array of exactly 2 values");
        assert_snapshot!(knee(""), @"gait.toml:3:1: a curve is missing; it is one of constant_deg, constant_rad, linear_deg, linear_rad, polynomial_deg, polynomial_rad, through_deg, through_rad, b_spline_deg, b_spline_rad");
        assert_snapshot!(knee("constant_deg = 1\nlinear_deg = [1, 2]"), @"gait.toml:3:1: a curve is given twice, as constant_deg and as linear_deg; it is one of constant_deg, constant_rad, linear_deg, linear_rad, polynomial_deg, polynomial_rad, through_deg, through_rad, b_spline_deg, b_spline_rad");
        assert_snapshot!(knee("constant_deg = 1\nconstant = 1"), @"gait.toml:5:1: unknown field `constant`, expected one of `constant_deg`, `constant_rad`, `linear_deg`, `linear_rad`, `polynomial_deg`, `polynomial_rad`, `through_deg`, `through_rad`, `b_spline_deg`, `b_spline_rad`");
        assert_snapshot!(knee("b_spline_deg = { degree = 1, control = [0, 1], knots = [] }"), @"gait.toml:4:48: unknown field `knots`, expected `degree` or `control`");
    }

    #[test]
    fn curves_that_overflow_name_a_number_of_the_file() {
        let knee = |curve: &str| error(&GOOD.replace("constant_deg = 16.5", curve));
        assert_snapshot!(knee("linear_rad = [-1e308, 1.5e308]"), @"gait.toml:4:14: numbers as large as 1.5e308 make the curve overflow");
        assert_snapshot!(knee("b_spline_rad = { degree = 1, control = [1e308, 1.2e308, 1e308] }"), @"gait.toml:4:16: numbers as large as 1.2e308 make the curve overflow");
        assert_snapshot!(knee("through_deg = [[0, 0], [1e-308, 900], [1, 0]]"), @"gait.toml:4:15: the curve through these points overflows between the phases 0.0 and 1e-308");
        assert_snapshot!(knee("constant_deg = inf"), @"gait.toml:4:16: inf is not a finite number");
    }
}
