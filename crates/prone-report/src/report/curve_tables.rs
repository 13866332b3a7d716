//! What gaits are made of, as tables.

use maud::{Markup, html};

use super::html_table::table;
use prone_record::curves_info::{CurveInfo, CurvesInfo};
use prone_record::tables::number;

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
            let coefficients = list(coefficients_rad);
            format!("polynomial, highest power first: {coefficients}")
        }
        CurveInfo::BSpline {
            degree,
            control_rad,
        } => format!("B-spline of degree {degree} through {}", list(control_rad)),
        CurveInfo::Through { points } => {
            let points = points.iter();
            let points = points.map(|(s, value)| format!("{} at {s:.3}", coefficient(*value)));
            format!("cubic through {}", points.collect::<Vec<_>>().join(", "))
        }
    }
}

/// A coefficient, rad.
pub fn coefficient(value: f64) -> String {
    with_minus(value, 5)
}

/// A number with the minus sign, which is as wide as a plus, and none before zero.
pub fn with_minus(value: f64, decimals: usize) -> String {
    number(value, decimals).replace('-', "−")
}
