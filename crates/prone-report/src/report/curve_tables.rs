//! What gaits are made of, as tables.

use maud::{Markup, html};

use super::html_table::table;
use prone_record::curves_info::{CurveInfo, CurvesInfo};

/// The parameters, in the order of [`CurvesInfo::to_array`].
pub const NAMES: [&str; 3] = ["θ3", "θ4", "α"];

/// What a gait that was found is made of.
pub(super) fn found(gait: &str, run: &str, curves: &CurvesInfo) -> Markup {
    let caption = html! {
        strong { "Gait parameters, " (gait) "." } " Ours, found by the search in " (run) "; rad, s from 0 to 1."
    };
    let rows = NAMES.into_iter().zip(curves.to_array());
    let rows =
        rows.map(|(name, curve)| html! { th scope="row" { (name) } td { (numbers(curve)) } });
    table(caption, &["parameter", "curve"], rows)
}

/// c₃ to c₀ of a polynomial of degree 3 or less.
pub fn cubic(curve: &CurveInfo) -> Option<[f64; 4]> {
    let CurveInfo::Polynomial { coefficients_rad } = curve else {
        return None;
    };
    let mut cubic = [0.0; 4];
    let missing = cubic.len().checked_sub(coefficients_rad.len())?;
    cubic[missing..].copy_from_slice(coefficients_rad);
    Some(cubic)
}

/// A curve's numbers in words.
pub fn numbers(curve: &CurveInfo) -> String {
    let list = |values: &[f64]| {
        let values: Vec<String> = values.iter().copied().map(coefficient).collect();
        values.join(", ")
    };
    match curve {
        CurveInfo::Polynomial { coefficients_rad } => {
            format!(
                "polynomial, highest power first: {}",
                list(coefficients_rad)
            )
        }
        CurveInfo::BSpline {
            degree,
            control_rad,
        } => format!("B-spline of degree {degree} through {}", list(control_rad)),
        CurveInfo::Through { points } => {
            let points: Vec<String> = points
                .iter()
                .map(|(s, value)| format!("{} at {s:.3}", coefficient(*value)))
                .collect();
            format!("cubic through {}", points.join(", "))
        }
    }
}

/// A coefficient, rad.
pub fn coefficient(value: f64) -> String {
    sign(&format!("{value:.5}"))
}

/// The minus sign, as wide as a plus, and none before zero.
pub fn sign(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text.to_owned(),
    }
}
