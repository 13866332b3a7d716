//! Tables 2 and 3: what gaits are made of, ours beside published.

use maud::{Markup, html};

use crate::published::{NOMINAL_DEG, OPTIMAL_COEFFICIENTS};
use prone_record::curves_info::{CurveInfo, CurvesInfo};
use prone_report::report::curve_tables::{NAMES, coefficient, cubic, numbers, with_minus};
use prone_report::report::html_table::table;

/// Table 2: ends of the nominal gait's parameters.
pub(crate) fn nominal(curves: &CurvesInfo) -> Markup {
    let caption = html! {
        strong { "Table 2. Gait parameters, nominal." }
        " Ours: start and end of the curves that this run commanded, from its record. \
         Published: as printed in the thesis. θ3 and θ4 stay, α falls in proportion to time."
    };
    let rows = NAMES.into_iter().zip(curves.to_array()).zip(NOMINAL_DEG);
    let rows = rows.map(|((name, curve), published)| {
        html! {
            th scope="row" { (name) }
            td { (ours_deg(curve)) }
            td { (span_deg(published)) }
        }
    });
    table(caption, &["parameter", "ours", "published"], rows)
}

/// Table 3: coefficients of the optimal gait's parameters.
pub(crate) fn optimal(curves: &CurvesInfo) -> Markup {
    let caption = html! {
        strong { "Table 3. Gait parameters, optimal." }
        " Coefficients of c₃s³ + c₂s² + c₁s + c₀, rad. Ours: what this run commanded, from its \
         record. Published: as printed in the thesis, whose c₀ of α has the wrong sign: only \
         the negative one reaches −90°."
    };
    let row = |name: &str, whose: &str, values: Option<[f64; 4]>, curve: &CurveInfo| {
        html! {
            th scope="row" { (name) }
            td { (whose) }
            @match values {
                Some(values) => { @for value in values { td { (coefficient(value)) } } }
                None => { td colspan="4" { (numbers(curve)) } }
            }
        }
    };
    let rows = NAMES
        .into_iter()
        .zip(curves.to_array())
        .zip(OPTIMAL_COEFFICIENTS);
    let rows = rows.flat_map(|((name, curve), published)| {
        [
            row(name, "ours", cubic(curve), curve),
            row(name, "published", Some(published), curve),
        ]
    });
    table(
        caption,
        &["parameter", "whose", "c₃", "c₂", "c₁", "c₀"],
        rows,
    )
}

fn ours_deg(curve: &CurveInfo) -> String {
    match cubic(curve) {
        Some(c) => span_deg([c[3], c.iter().sum()].map(f64::to_degrees)),
        None => numbers(curve),
    }
}

fn span_deg([from, to]: [f64; 2]) -> String {
    let degrees = |value: f64| format!("{}°", with_minus(value, 1));
    if (from - to).abs() < 0.05 {
        degrees(from)
    } else {
        format!("{} to {}", degrees(from), degrees(to))
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
        assert_eq!(coefficient(-1e-9), "0.00000");
    }
}
