//! Tables 2 and 3: what gaits are made of, ours beside published.

use maud::{Markup, html};

use prone_record::curves_info::{CurveInfo, CurvesInfo};
use crate::published::{NOMINAL_DEG, OPTIMAL_COEFFICIENTS};

const NAMES: [&str; 3] = ["θ3", "θ4", "α"];

/// Table 2: ends of the nominal gait's parameters.
pub(super) fn nominal(curves: &CurvesInfo) -> Markup {
    html! {
        div.scroll { table {
            caption {
                strong { "Table 2. Gait parameters, nominal." }
                " Ours: start and end of the curves that this run commanded, from its record. \
                 Published: as printed in the thesis. θ3 and θ4 stay, α falls in proportion to time."
            }
            thead { tr { @for head in ["parameter", "ours", "published"] { th scope="col" { (head) } } } }
            tbody { @for ((name, curve), published) in NAMES.into_iter().zip(curves.to_array()).zip(NOMINAL_DEG) {
                tr {
                    th scope="row" { (name) }
                    td { (ours_deg(curve)) }
                    td { (span_deg(published)) }
                }
            } }
        } }
    }
}

/// Table 3: coefficients of the optimal gait's parameters.
pub(super) fn optimal(curves: &CurvesInfo) -> Markup {
    html! {
        div.scroll { table {
            caption {
                strong { "Table 3. Gait parameters, optimal." }
                " Coefficients of c₃s³ + c₂s² + c₁s + c₀, rad. Ours: what this run commanded, from its \
                 record. Published: as printed in the thesis, whose c₀ of α has the wrong sign: only \
                 the negative one reaches −90°."
            }
            thead {
                tr {
                    th scope="col" { "parameter" }
                    th scope="col" { "whose" }
                    @for head in ["c₃", "c₂", "c₁", "c₀"] { th scope="col" { (head) } }
                }
            }
            tbody { @for ((name, curve), published) in NAMES.into_iter().zip(curves.to_array()).zip(OPTIMAL_COEFFICIENTS) {
                tr {
                    th scope="row" { (name) }
                    td { "ours" }
                    @match cubic(curve) {
                        Some(ours) => { @for value in ours { td { (coefficient(value)) } } }
                        None => { td colspan="4" { (numbers(curve)) } }
                    }
                }
                tr {
                    th scope="row" { (name) }
                    td { "published" }
                    @for value in published { td { (coefficient(value)) } }
                }
            } }
        } }
    }
}

/// What another gait is made of, beside nothing.
pub(super) fn found(gait: &str, run: &str, curves: &CurvesInfo) -> Markup {
    html! {
        div.scroll { table {
            caption { strong { "Gait parameters, " (gait) "." } " Ours, found by the search in " (run) "; rad, s from 0 to 1." }
            thead { tr { th scope="col" { "parameter" } th scope="col" { "curve" } } }
            tbody { @for (name, curve) in NAMES.into_iter().zip(curves.to_array()) {
                tr { th scope="row" { (name) } td { (numbers(curve)) } }
            } }
        } }
    }
}

/// c₃ to c₀ of a polynomial of degree 3 or less.
fn cubic(curve: &CurveInfo) -> Option<[f64; 4]> {
    let CurveInfo::Polynomial { coefficients_rad } = curve else {
        return None;
    };
    let mut cubic = [0.0; 4];
    let missing = cubic.len().checked_sub(coefficients_rad.len())?;
    cubic[missing..].copy_from_slice(coefficients_rad);
    Some(cubic)
}

/// A curve's numbers in words.
fn numbers(curve: &CurveInfo) -> String {
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

fn ours_deg(curve: &CurveInfo) -> String {
    match cubic(curve) {
        Some(c) => span_deg([c[3], c.iter().sum()].map(f64::to_degrees)),
        None => numbers(curve),
    }
}

fn span_deg([from, to]: [f64; 2]) -> String {
    let degrees = |value: f64| format!("{}°", sign(&format!("{value:.1}")));
    if (from - to).abs() < 0.05 {
        degrees(from)
    } else {
        format!("{} to {}", degrees(from), degrees(to))
    }
}

fn coefficient(value: f64) -> String {
    sign(&format!("{value:.5}"))
}

/// The minus sign, as wide as a plus, and none before zero.
fn sign(text: &str) -> String {
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|byte| matches!(byte, b'0' | b'.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_fill_a_cubic_from_behind() {
        let curve = |values: &[f64]| CurveInfo::Polynomial {
            coefficients_rad: values.to_vec(),
        };
        assert_eq!(cubic(&curve(&[2.0, 1.0])), Some([0.0, 0.0, 2.0, 1.0]));
        assert_eq!(cubic(&curve(&[0.0; 5])), None);
        assert_eq!(ours_deg(&curve(&[16.5_f64.to_radians()])), "16.5°");
        let falling = curve(&[-60.0_f64.to_radians(), -30.0_f64.to_radians()]);
        assert_eq!(ours_deg(&falling), "−30.0° to −90.0°");
        assert_eq!(sign("-0.00000"), "0.00000");
    }
}
