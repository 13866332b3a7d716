//! Figure 45: cost against duration (left), and relative to a reference gait (right).

use super::axis::Axis;
use super::panel::{Curve, Panel, Rule};
use super::sheet::{KeyEntry, Sheet};
use super::style::{Dash, Fill, MARKER_RADIUS, Marker, REFERENCE, Stroke, gait_shape, gait_stroke};
use super::svg::Point;
use super::{Figure, FigureError, GaitNumbers, Wording, selection};
use prone_record::pulls::CostRecord;

const NUMBER: &str = "45";

/// Whose costs a curve shows, and how it looks.
struct Source {
    label: &'static str,
    fill: Fill,
    dash: Dash,
    cost: fn(&CostRecord) -> Option<f64>,
}

const SOURCES: [Source; 2] = [
    Source {
        label: "ours",
        fill: Fill::Full,
        dash: Dash::Solid,
        cost: |record| Some(record.cost_n2m2s),
    },
    Source {
        label: "published (thesis)",
        fill: Fill::Hollow,
        dash: Dash::Short,
        cost: |record| record.published_n2m2s,
    },
];

/// Left half: the costs themselves; nothing without any.
pub(super) fn absolute(
    gaits: &[GaitNumbers],
    costs: &[CostRecord],
) -> Result<Option<Figure>, FigureError> {
    let curve = |gait: &str, source: &Source| (gait.to_owned(), source.curve(costs, gait));
    let label = "cost of one phase, N²·m²·s";
    let Some(sheet) = sheet(gaits, costs, curve, label, 0.0) else {
        return Ok(None);
    };
    let wording = Wording {
        stem: format!("fig-{NUMBER}-left-cost"),
        number: NUMBER,
        title: "Cost of one closed-chain phase".to_owned(),
        caption: "Torque cost ∫ Σ τ² dt of ankle, knee, hip and shoulder of one side, N²·m²·s, \
                  against the duration of the closed-chain phase, s; all joints weigh 1. Filled \
                  markers, solid lines: our simulation. Hollow markers, dashed lines: published \
                  (thesis)."
            .to_owned(),
        alt: "Line plot of torque cost against duration for each gait, ours and published."
            .to_owned(),
    };
    sheet.figure(wording).map(Some)
}

/// Right half: costs over those of the gait `reference`; nothing without any.
pub(super) fn ratio(
    gaits: &[GaitNumbers],
    costs: &[CostRecord],
    reference: &str,
) -> Result<Option<Figure>, FigureError> {
    let curve = |gait: &str, source: &Source| {
        let mut own = source.curve(costs, gait);
        own.retain(|_| gait != reference);
        let curve = percent_of(&own, &source.curve(costs, reference));
        (format!("{gait} / {reference}"), curve)
    };
    let label = format!("cost relative to {reference}, %");
    let Some(sheet) = sheet(gaits, costs, curve, &label, 100.0) else {
        return Ok(None);
    };
    let wording = Wording {
        stem: format!("fig-{NUMBER}-right-cost-ratio"),
        number: NUMBER,
        title: format!("Cost relative to the {reference} gait"),
        caption: format!(
            "Torque cost in percent of the {reference} gait's at the same duration, against the \
             duration of the closed-chain phase, s; below 100 % is cheaper. Filled markers, solid \
             lines: our simulation. Hollow markers, dashed lines: published (thesis)."
        ),
        alt: format!(
            "Line plot of cost as a percentage of the {reference} gait's against duration, ours \
             and published."
        ),
    };
    sheet.figure(wording).map(Some)
}

impl Source {
    /// Duration and cost of a gait, by rising duration.
    fn curve(&self, costs: &[CostRecord], gait: &str) -> Vec<Point> {
        let own = costs.iter().filter(|cost| cost.gait == gait);
        let points = own.filter_map(|cost| Some((cost.duration_s, (self.cost)(cost)?)));
        let mut points: Vec<Point> = points.collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }
}

/// One panel with the curves that `curve` makes of each gait and source, and a line at `level`; nothing
/// where all are empty.
fn sheet(
    gaits: &[GaitNumbers],
    costs: &[CostRecord],
    curve: impl Fn(&str, &Source) -> (String, Vec<Point>),
    label: &str,
    level: f64,
) -> Option<Sheet> {
    let names = costs.iter().map(|cost| cost.gait.as_str());
    let gaits = selection::each_once(names, &selection::names(gaits));
    let (mut key, mut curves) = (Vec::new(), Vec::new());
    for (index, gait) in gaits.into_iter().enumerate() {
        for source in &SOURCES {
            let (name, points) = curve(gait, source);
            if points.is_empty() {
                continue;
            }
            let stroke = gait_stroke(index).with_dash(source.dash);
            let marker = Marker::new(gait_shape(index), source.fill, MARKER_RADIUS);
            let marker = Some(marker);
            let name = format!("{name}, {}", source.label);
            key.push(KeyEntry::line(name, stroke, marker));
            curves.push(Curve {
                points,
                stroke,
                marker,
            });
        }
    }
    if curves.is_empty() {
        return None;
    }
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let longest_s = points().map(|point| point.0).fold(0.0, f64::max);
    // A little more, for the markers at its end.
    let x = Axis::exactly("duration of the phase, s", 0.0, 1.05 * longest_s);
    let y = Axis::covering(label, points().map(|point| point.1).chain([level]));
    let mut panel = Panel::new("four joints of one side", x, y, curves);
    panel.rules = vec![Rule::Level(level, Stroke::solid(REFERENCE, 1.0))];
    Some(Sheet::new(1, 330.0, [panel]).with_key(key))
}

/// Each cost in percent of the base's at the same duration.
fn percent_of(own: &[Point], base: &[Point]) -> Vec<Point> {
    let ratio = |(duration_s, cost): &Point| {
        let same = |point: &&Point| selection::same_duration(point.0, *duration_s);
        let base = base.iter().find(same)?.1;
        // A phase that costs nothing has no ratio.
        (base > 0.0).then_some((*duration_s, 100.0 * cost / base))
    };
    own.iter().filter_map(ratio).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_ratio_at_seven_seconds() {
        // Thesis, figure 45: 6.558 against 8.354 N²·m²·s, "up to 21.5 % less".
        let ratio = percent_of(&[(7.0, 6.558)], &[(1.0, 1.552), (7.0, 8.354)]);
        assert!((ratio[0].1 - 78.5).abs() < 0.05, "{ratio:?}");
    }

    #[test]
    fn durations_without_a_partner_or_a_cost_have_no_ratio() {
        assert!(percent_of(&[(2.0, 1.0), (3.0, 1.0)], &[(1.0, 1.0), (3.0, 0.0)]).is_empty());
    }
}
