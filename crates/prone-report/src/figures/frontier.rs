//! The ceiling against what a crawl reaches below it: advance, and heat.

use super::axis::Axis;
use super::panel::{Curve, Panel};
use super::sheet::{KeyEntry, Sheet};
use super::style::{
    CURVE_WIDTH, Dash, Fill, MARKER_RADIUS, Marker, REFERENCE, Stroke, gait_shape, gait_stroke,
};
use super::svg::Point;
use super::{Figure, Wording};
use prone_record::frontier::ConfirmedSetting;
use prone_record::frontier::CycleObjective;
use prone_record::frontier::SettingKind;
use prone_record::frontier::{Found, Frontier};

/// The ceiling against what was reached below it; `None` where nothing was found.
pub fn figure(frontier: &Frontier) -> Option<Figure> {
    let advance = panel(
        frontier,
        SettingKind::AsItIs,
        "advance per cycle, mm",
        |row| row.mm_per_cycle,
    );
    let heat = panel(
        frontier,
        SettingKind::AsItIs,
        "heat per metre, s/m",
        |row| row.heat_per_metre_s,
    );
    let panels: Vec<Panel> = [advance, heat].into_iter().flatten().collect();
    if panels.is_empty() {
        return None;
    }
    let key = vec![
        KeyEntry::line("best of each ceiling".to_owned(), line(), None),
        KeyEntry::line(
            "one search, holds".to_owned(),
            Stroke::solid(REFERENCE, 0.0),
            Some(marker(Fill::Full)),
        ),
        KeyEntry::line(
            "one search, does not".to_owned(),
            Stroke::solid(REFERENCE, 0.0),
            Some(marker(Fill::Hollow)),
        ),
    ];
    let sheet = Sheet {
        key,
        bar: None,
        columns: 1,
        frame_height: 250.0,
        panels,
    };
    let wording = Wording {
        stem: "frontier".to_owned(),
        number: "",
        title: "What is reached under a ceiling".to_owned(),
        caption: format!(
            "Crawls searched for the {} under ceilings of several heights, {} mm kept free. \
             Ours, simulated: friction 0.7, the maker's effort and joint limits on, 2.5 ms steps. \
             A search holds where, without touching the ceiling, it keeps 80 % of its advance at \
             friction 0.4 and 1, 0.8 and 1.7 times its duration and with 1 ms steps.",
            match frontier.objective {
                CycleObjective::Heat => "least heat per metre",
                CycleObjective::Advance => "largest advance",
                CycleObjective::Speed => "largest speed",
                CycleObjective::Peak => "least torque demanded of a shoulder",
            },
            frontier.margin_mm
        ),
        alt:
            "Two plots over the height of the ceiling: advance per cycle and motor heat per metre."
                .to_owned(),
    };
    Some(wording.with(&sheet))
}

fn line() -> Stroke {
    gait_stroke(0).with_dash(Dash::Solid)
}

fn marker(fill: Fill) -> Marker {
    Marker {
        shape: gait_shape(0),
        fill,
        radius: MARKER_RADIUS,
    }
}

fn panel(
    frontier: &Frontier,
    setting: SettingKind,
    label: &str,
    of: impl Fn(&ConfirmedSetting) -> Option<f64>,
) -> Option<Panel> {
    let point = |found: &Found| -> Option<(Point, Fill, f64)> {
        let row = found
            .confirmed
            .settings
            .iter()
            .find(|row| row.setting == setting)?;
        let fill = if found.confirmed.holds {
            Fill::Full
        } else {
            Fill::Hollow
        };
        let value = of(row).filter(|value| value.is_finite())?;
        Some((
            (found.ceiling_mm?, value),
            fill,
            found.value.unwrap_or(f64::INFINITY),
        ))
    };
    let points: Vec<(Point, Fill, f64)> = frontier.found.iter().filter_map(point).collect();
    if points.is_empty() {
        return None;
    }
    // The best by the search's own measure, holding ones first.
    let mut best: Vec<(Point, bool, f64)> = Vec::new();
    for &(at, fill, value) in &points {
        let holds = fill == Fill::Full;
        match best
            .iter_mut()
            .find(|(other, ..)| other.0.total_cmp(&at.0).is_eq())
        {
            Some(old) if (holds, -value) > (old.1, -old.2) => *old = (at, holds, value),
            Some(_) => {}
            None => best.push((at, holds, value)),
        }
    }
    best.sort_by(|a, b| a.0.0.total_cmp(&b.0.0));
    let mut curves = vec![Curve {
        points: best.into_iter().map(|(at, ..)| at).collect(),
        stroke: line(),
        marker: None,
    }];
    curves.extend(points.iter().map(|&(at, fill, _)| Curve {
        points: vec![at],
        stroke: Stroke::solid(gait_stroke(0).colour, CURVE_WIDTH),
        marker: Some(marker(fill)),
    }));
    let heights = points.iter().map(|(at, ..)| at.0);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| {
        (low.min(height), high.max(height))
    });
    let room = (0.08 * (high - low)).max(2.0);
    let x = Axis::exactly("ceiling above the floor, mm", low - room, high + room);
    let y = Axis::covering(label, points.iter().map(|(at, ..)| at.1).chain([0.0]));
    Some(Panel::new("", x, y, curves))
}
