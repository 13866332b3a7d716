//! Figure 45: cost against duration (left), and relative to a reference gait (right).

use super::axis::Axis;
use super::panel::{Curve, Panel, Rule};
use super::sheet::{KeyEntry, Sheet};
use super::style::{Dash, Fill, MARKER_RADIUS, Marker, REFERENCE, Stroke, gait_shape, gait_stroke};
use super::svg::Point;
use super::{Figure, GaitNumbers, Wording, selection};
use prone_record::pulls::CostRecord;

const NUMBER: &str = "45";

/// Whose measurement a curve is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    Ours,
    Published,
}

const SOURCES: [Source; 2] = [Source::Ours, Source::Published];

/// Curves of all gaits and sources, with their meaning.
type Series = Vec<(KeyEntry, Curve)>;

/// Both halves; those without any point are left out.
pub(super) fn figures(gaits: &[GaitNumbers], costs: &[CostRecord], reference: &str) -> Vec<Figure> {
    [absolute(gaits, costs), ratio(gaits, costs, reference)]
        .into_iter()
        .flatten()
        .collect()
}

fn absolute(gaits: &[GaitNumbers], costs: &[CostRecord]) -> Option<Figure> {
    let series = series(gaits, costs, |gait, source| {
        (gait.to_owned(), source.curve_of(costs, gait))
    });
    let sheet = sheet(series, "cost of one phase, N²·m²·s", &[0.0])?;
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
    Some(wording.with(&sheet))
}

fn ratio(gaits: &[GaitNumbers], costs: &[CostRecord], reference: &str) -> Option<Figure> {
    let series = series(gaits, costs, |gait, source| {
        let own = source.curve_of(costs, gait);
        let base = source.curve_of(costs, reference);
        let curve = if gait == reference {
            Vec::new()
        } else {
            percent_of(&own, &base)
        };
        (format!("{gait} / {reference}"), curve)
    });
    let sheet = sheet(
        series,
        &format!("cost relative to {reference}, %"),
        &[100.0],
    )?;
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
    Some(wording.with(&sheet))
}

impl Source {
    /// Duration and cost of a gait, by rising duration.
    fn curve_of(self, costs: &[CostRecord], gait: &str) -> Vec<Point> {
        let own = costs.iter().filter(|cost| cost.gait == gait);
        let mut points: Vec<Point> = own
            .filter_map(|cost| match self {
                Self::Ours => Some((cost.duration_s, cost.cost_n2m2s)),
                Self::Published => Some((cost.duration_s, cost.published_n2m2s?)),
            })
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points
    }

    fn label(self) -> &'static str {
        match self {
            Self::Ours => "ours",
            Self::Published => "published (thesis)",
        }
    }

    fn fill(self) -> Fill {
        match self {
            Self::Ours => Fill::Full,
            Self::Published => Fill::Hollow,
        }
    }

    fn dash(self) -> Dash {
        match self {
            Self::Ours => Dash::Solid,
            Self::Published => Dash::Short,
        }
    }
}

/// The curves `curve` makes of each gait and source, without empty ones.
fn series(
    gaits: &[GaitNumbers],
    costs: &[CostRecord],
    curve: impl Fn(&str, Source) -> (String, Vec<Point>),
) -> Series {
    let names = costs.iter().map(|cost| cost.gait.as_str());
    let gaits = selection::gaits(names, &selection::names(gaits));
    let mut series = Vec::new();
    for (index, gait) in gaits.into_iter().enumerate() {
        for source in SOURCES {
            let (name, points) = curve(gait, source);
            if points.is_empty() {
                continue;
            }
            let stroke = gait_stroke(index).with_dash(source.dash());
            let (shape, fill) = (gait_shape(index), source.fill());
            let marker = Some(Marker {
                shape,
                fill,
                radius: MARKER_RADIUS,
            });
            let label = format!("{name}, {}", source.label());
            series.push((
                KeyEntry::line(label, stroke, marker),
                Curve {
                    points,
                    stroke,
                    marker,
                },
            ));
        }
    }
    series
}

/// One panel with all curves and a level line at each of `levels`.
fn sheet(series: Series, label: &str, levels: &[f64]) -> Option<Sheet> {
    if series.is_empty() {
        return None;
    }
    let (key, curves): (Vec<KeyEntry>, Vec<Curve>) = series.into_iter().unzip();
    let points = || curves.iter().flat_map(|curve| &curve.points);
    let longest_s = points().map(|point| point.0).fold(0.0, f64::max);
    // A little more, for the markers at its end.
    let x = Axis::exactly("duration of the phase, s", 0.0, 1.05 * longest_s);
    let y = Axis::covering(
        label,
        points().map(|point| point.1).chain(levels.iter().copied()),
    );
    let mut panel = Panel::new("four joints of one side", x, y, curves);
    let line = |level: &f64| Rule::Level(*level, Stroke::solid(REFERENCE, 1.0));
    panel.rules = levels.iter().map(line).collect();
    Some(Sheet {
        key,
        bar: None,
        columns: 1,
        frame_height: 330.0,
        panels: vec![panel],
    })
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
