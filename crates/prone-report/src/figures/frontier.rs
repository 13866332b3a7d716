//! The ceiling against what a crawl reaches below it: advance, and heat.

use super::axis::{Axis, extremes};
use super::panel::{Curve, Panel};
use super::sheet::{KeyEntry, Sheet};
use super::style::{
    CURVE_WIDTH, Dash, Fill, MARKER_RADIUS, Marker, REFERENCE, Stroke, gait_shape, gait_stroke,
};
use super::svg::Point;
use super::{Figure, FigureError, Wording};
use prone_record::frontier::{ConfirmedSetting, CycleObjective, Found, Frontier, SettingKind};

/// The ceiling against what was reached below it; `None` where nothing was found.
pub fn figure(frontier: &Frontier) -> Result<Option<Figure>, FigureError> {
    let advance = panel(frontier, "advance per cycle, mm", |row| row.mm_per_cycle);
    let heat = panel(frontier, "heat per metre, s/m", |row| row.heat_per_metre_s);
    let panels: Vec<Panel> = [advance, heat].into_iter().flatten().collect();
    if panels.is_empty() {
        return Ok(None);
    }
    let one = |label: &str, fill: Fill| {
        let no_line = Stroke::solid(REFERENCE, 0.0);
        KeyEntry::line(label.to_owned(), no_line, Some(marker(fill)))
    };
    let key = [
        KeyEntry::line("best of each ceiling".to_owned(), line(), None),
        one("one search, holds", Fill::Full),
        one("one search, does not", Fill::Hollow),
    ];
    let sheet = Sheet::new(1, 250.0, panels).with_key(key);
    let wording = Wording {
        stem: "frontier".to_owned(),
        number: "",
        title: "What is reached under a ceiling".to_owned(),
        caption: format!(
            "Crawls searched for the {} under ceilings of several heights, {} mm kept free. \
             Ours, simulated: friction 0.7, the manufacturer's effort and joint limits on, 2.5 ms steps. \
             A search holds where, without touching the ceiling, it keeps 80 % of its advance at \
             friction 0.4 and 1, 0.8 and 1.7 times its duration and with 1 ms steps.",
            match frontier.objective {
                CycleObjective::Heat => "least heat per metre",
                CycleObjective::HeatRate => "least heat per second",
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
    sheet.figure(wording).map(Some)
}

fn line() -> Stroke {
    gait_stroke(0).with_dash(Dash::Solid)
}

fn marker(fill: Fill) -> Marker {
    Marker::new(gait_shape(0), fill, MARKER_RADIUS)
}

/// One search: ceiling and what was reached below it, whether that holds, and its own measure.
struct Search {
    at: Point,
    holds: bool,
    value: f64,
}

fn panel(
    frontier: &Frontier,
    label: &str,
    reached: impl Fn(&ConfirmedSetting) -> Option<f64>,
) -> Option<Panel> {
    let search = |found: &Found| {
        let mut settings = found.confirmed.settings.iter();
        let row = settings.find(|row| row.setting == SettingKind::AsItIs)?;
        let reached = reached(row).filter(|value| value.is_finite())?;
        Some(Search {
            at: (found.ceiling_mm?, reached),
            holds: found.confirmed.holds,
            value: found.value.unwrap_or(f64::INFINITY),
        })
    };
    let searches: Vec<Search> = frontier.found.iter().filter_map(search).collect();
    // The best by the search's own measure, holding ones first.
    let mut best: Vec<&Search> = Vec::new();
    for search in &searches {
        let same = |old: &&mut &Search| old.at.0.total_cmp(&search.at.0).is_eq();
        match best.iter_mut().find(same) {
            Some(old) if (search.holds, -search.value) > (old.holds, -old.value) => *old = search,
            Some(_) => {}
            None => best.push(search),
        }
    }
    best.sort_by(|a, b| a.at.0.total_cmp(&b.at.0));
    let best = best.into_iter().map(|search| search.at).collect();
    let mut curves = vec![Curve::new(best, line())];
    curves.extend(searches.iter().map(|search| Curve {
        points: vec![search.at],
        stroke: Stroke::solid(gait_stroke(0).colour, CURVE_WIDTH),
        marker: Some(marker(if search.holds {
            Fill::Full
        } else {
            Fill::Hollow
        })),
    }));
    let (low, high) = extremes(searches.iter().map(|search| search.at.0))?;
    let room = (0.08 * (high - low)).max(2.0);
    let x = Axis::exactly("ceiling above the floor, mm", low - room, high + room);
    let values = searches.iter().map(|search| search.at.1);
    let y = Axis::covering(label, values.chain([0.0]));
    Some(Panel::new("", x, y, curves))
}
