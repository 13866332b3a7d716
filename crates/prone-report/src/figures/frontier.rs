//! What was reached against what is held: a frontier, its best points joined.
//!
//! The upper panel has what was searched. The lower one has what it takes: heat, or the advance where
//! heat was searched.

use super::axis::{Axis, extremes};
use super::panel::{Curve, Panel};
use super::sheet::{KeyEntry, Sheet};
use super::style::{
    CURVE_WIDTH, Dash, Fill, MARKER_RADIUS, Marker, REFERENCE, Shape, Stroke, gait_stroke,
};
use super::svg::Point;
use super::{Figure, FigureError, Wording};
use prone_record::frontier::{
    ConfirmedSetting, CycleObjective, Found, Frontier, Quantity, SettingKind, Standing,
};

/// What is held against what was reached there; `None` where nothing was found.
pub fn figure(frontier: &Frontier) -> Result<Option<Figure>, FigureError> {
    let searched = Quantity::of_objective(frontier.objective).unwrap_or(Quantity::Advance);
    let beside = match searched {
        Quantity::Heat => Quantity::Advance,
        _ => Quantity::Heat,
    };
    let shown = [searched, beside];
    let panels = shown.map(|quantity| panel(frontier, quantity));
    let panels: Vec<Panel> = panels.into_iter().flatten().collect();
    if panels.is_empty() {
        return Ok(None);
    }
    let one = |label: &str, standing: Standing| {
        let no_line = Stroke::solid(REFERENCE, 0.0);
        KeyEntry::line(label.to_owned(), no_line, Some(marker(standing)))
    };
    let key = [
        KeyEntry::line("best of each value".to_owned(), line(), None),
        one("robust", Standing::Robust),
        one("ideal only", Standing::Ideal),
        one("breaks rules", Standing::Broken),
    ];
    let sheet = Sheet::new(1, 250.0, panels).with_key(key);
    let held = frontier.held;
    let margin = match held {
        Quantity::Ceiling => format!("; {} mm are kept free of the ceiling", frontier.margin_mm),
        _ => String::new(),
    };
    let wording = Wording {
        stem: "frontier".to_owned(),
        number: "",
        title: match held {
            Quantity::Ceiling => "What is reached under a ceiling".to_owned(),
            _ => format!("What is reached where the {} is held", held.name()),
        },
        caption: format!(
            "Crawls searched for the {}, with the {} held at several values{margin}. Ours, simulated: \
             friction 0.7, the manufacturer's effort and joint limits on, 2.5 ms steps. Robust: without \
             touching the ceiling, it keeps three quarters of its advance in every corner, at 0.8 and \
             1.7 times its duration and with 1 ms steps. Ideal: it keeps the rules of its search, and \
             not that. Heat is that with normal servos.",
            match frontier.objective {
                CycleObjective::Heat => "least heat per metre",
                CycleObjective::HeatRate => "least heat per second",
                CycleObjective::Advance => "largest advance",
                CycleObjective::Speed => "largest speed",
                CycleObjective::Peak => "least torque demanded of a shoulder",
                CycleObjective::Duty => "least duty of the worst motor",
                CycleObjective::Height => "lowest highest point",
            },
            held.name(),
        ),
        alt: format!(
            "Plots over the {}: {}, and {}.",
            held.held_axis(),
            searched.reached_axis(),
            beside.reached_axis()
        ),
    };
    sheet.figure(wording).map(Some)
}

fn line() -> Stroke {
    gait_stroke(0).with_dash(Dash::Solid)
}

fn marker(standing: Standing) -> Marker {
    let (shape, fill) = match standing {
        Standing::Robust => (Shape::Circle, Fill::Full),
        Standing::Ideal => (Shape::Circle, Fill::Hollow),
        Standing::Broken => (Shape::Triangle, Fill::Hollow),
    };
    Marker::new(shape, fill, MARKER_RADIUS)
}

/// One search: where what is held is held, what was reached there, how far it can be counted on, and
/// its own measure.
struct Search {
    at: Point,
    standing: Standing,
    value: f64,
}

impl Search {
    /// What is best is robust rather than ideal, then best by the search's own measure.
    fn beats(&self, other: &Self) -> bool {
        let rank = |search: &Self| (search.standing == Standing::Robust, -search.value);
        rank(self) > rank(other)
    }
}

fn panel(frontier: &Frontier, quantity: Quantity) -> Option<Panel> {
    let search = |found: &Found| {
        let mut settings = found.confirmed.settings.iter();
        let row: &ConfirmedSetting = settings.find(|row| row.setting == SettingKind::AsItIs)?;
        let reached = quantity.reached(row).filter(|value| value.is_finite())?;
        Some(Search {
            at: (found.at?, reached),
            standing: found.standing(frontier.held),
            value: found.value.unwrap_or(f64::INFINITY),
        })
    };
    let searches: Vec<Search> = frontier.found.iter().filter_map(search).collect();
    let mut best: Vec<&Search> = Vec::new();
    // What breaks rules is no point of the frontier.
    let kept = |search: &&Search| search.standing != Standing::Broken;
    for search in searches.iter().filter(kept) {
        let same = |old: &&mut &Search| old.at.0.total_cmp(&search.at.0).is_eq();
        match best.iter_mut().find(same) {
            Some(old) if search.beats(old) => *old = search,
            Some(_) => {}
            None => best.push(search),
        }
    }
    best.sort_by(|a, b| a.at.0.total_cmp(&b.at.0));
    let best: Vec<Point> = best.into_iter().map(|search| search.at).collect();
    let mut curves = Vec::new();
    if !best.is_empty() {
        curves.push(Curve::new(best, line()));
    }
    curves.extend(searches.iter().map(|search| Curve {
        points: vec![search.at],
        stroke: Stroke::solid(gait_stroke(0).colour, CURVE_WIDTH),
        marker: Some(marker(search.standing)),
    }));
    let (low, high) = extremes(searches.iter().map(|search| search.at.0))?;
    // A hundredth of the value where there is one alone.
    let room = (0.08 * (high - low)).max(0.012 * high.abs());
    let x = Axis::exactly(frontier.held.held_axis(), low - room, high + room);
    let values = searches.iter().map(|search| search.at.1);
    let y = Axis::covering(quantity.reached_axis(), values.chain([0.0]));
    Some(Panel::new("", x, y, curves))
}
