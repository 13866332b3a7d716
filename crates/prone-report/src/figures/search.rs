//! Figure 24: the best and the mean of each generation; and what simulation says of what was found.

use super::axis::Axis;
use super::panel::{Curve, Panel, Rule};
use super::records::{ConfirmedRecord, GenerationRecord, Scores, SearchRecord};
use super::sheet::{KeyEntry, Sheet};
use super::style::{
    CURVE_WIDTH, Dash, Fill, MARKER_RADIUS, Marker, REFERENCE, Stroke, gait_shape, gait_stroke,
};
use super::svg::Point;
use super::{Figure, FigureError, Wording, check};

/// Points of a curve at most: a figure is 900 units wide.
const MOST_POINTS: usize = 400;

/// Figure 24; nothing without generations.
///
/// # Errors
/// [`FigureError`] where a number cannot be drawn.
pub fn generations(search: &SearchRecord) -> Result<Option<Figure>, FigureError> {
    check::search(search)?;
    if search.generations.is_empty() {
        return Ok(None);
    }
    let unit = &search.unit;
    let rows = &search.generations;
    let (left, right) = match search.scores {
        Scores::Published => (
            panel(rows, "broken rules", "violated samples", |row| {
                (Some(row.best_violation), Some(row.mean_violation))
            }),
            panel(
                rows,
                "torque part",
                &format!("Σ w τ² dt, {unit}"),
                |row| (Some(row.best_value), row.mean_value),
            ),
        ),
        Scores::Graded => (
            panel(rows, "broken rules", "excess, shares of limits", |row| {
                (Some(row.best_violation), None)
            }),
            panel(
                rows,
                "gaits that keep the rules",
                &format!("{}, {unit}", search.objective),
                |row| {
                    let feasible = row.best_violation == 0.0;
                    (feasible.then_some(row.best_value), row.mean_feasible_value)
                },
            ),
        ),
    };
    let known = |row: &GenerationRecord| match search.scores {
        Scores::Published => row.mean_value.is_some(),
        Scores::Graded => row.mean_feasible_value.is_some(),
    };
    let means = rows.iter().any(known);
    let key = [("best of the run so far", 0), ("mean of the generation", 1)];
    let key = key.into_iter().take(if means { 2 } else { 1 });
    let sheet = Sheet {
        key: key
            .map(|(label, index)| KeyEntry::line(label.to_owned(), stroke(index), None))
            .collect(),
        bar: None,
        columns: 2,
        frame_height: 260.0,
        panels: vec![left, right],
    };
    let (mean, searched) = match search.scores {
        Scores::Published => ("all gaits of the generation", "the torque part"),
        Scores::Graded => (
            "the gaits of the generation that keep the rules",
            search.objective.as_str(),
        ),
    };
    let dashed = if means {
        format!(" Dashed: the mean of {mean}.")
    } else {
        String::new()
    };
    let wording = Wording {
        stem: "fig-24-search".to_owned(),
        number: "24",
        title: if means {
            "Best and mean of each generation"
        } else {
            "Best of each generation"
        }
        .to_owned(),
        caption: format!(
            "The run with seed {} over its generations: left the rules that are broken, right {searched}. \
             Solid: the best gait so far.{dashed} Fewer violations win, and {searched} decides between \
             equals. Source: our search.",
            search.seed
        ),
        alt: format!(
            "Line plots of broken rules and of {searched}, the best of each generation, against \
             generation."
        ),
    };
    Ok(Some(wording.with(&sheet)))
}

fn stroke(index: usize) -> Stroke {
    let dash = if index == 0 { Dash::Solid } else { Dash::Short };
    Stroke {
        width: CURVE_WIDTH,
        ..gait_stroke(index).with_dash(dash)
    }
}

fn panel(
    rows: &[GenerationRecord],
    title: &str,
    label: &str,
    of: impl Fn(&GenerationRecord) -> (Option<f64>, Option<f64>),
) -> Panel {
    let step = rows.len().div_ceil(MOST_POINTS).max(1);
    let (mut best, mut mean) = (Vec::new(), Vec::new());
    for row in rows.iter().step_by(step).chain(rows.last()) {
        let generation = row.generation as f64;
        let (of_best, of_mean) = of(row);
        best.extend(of_best.map(|value| (generation, value)));
        mean.extend(of_mean.map(|value| (generation, value)));
    }
    let last = rows.last().map_or(1.0, |row| row.generation as f64);
    let x = Axis::exactly("generation", 0.0, last);
    let values = best.iter().chain(&mean).map(|point: &Point| point.1);
    // Where nothing is broken all along, an axis from 0 to 1 says so.
    let highest = values.clone().fold(0.0, f64::max);
    let y = if highest > 0.0 {
        Axis::covering(label, values)
    } else {
        Axis::exactly(label, 0.0, 1.0)
    };
    let curve = |points, index| Curve {
        points,
        stroke: stroke(index),
        marker: None,
    };
    Panel::new(title, x, y, vec![curve(mean, 1), curve(best, 0)])
}

/// Cost over the first gait's against duration, a panel per regime; nothing without rows.
///
/// # Errors
/// [`FigureError`] where a number cannot be drawn.
pub fn confirmation(
    rows: &[ConfirmedRecord],
    objective: &str,
) -> Result<Option<Figure>, FigureError> {
    check::confirmed(rows)?;
    let mut gaits: Vec<&str> = Vec::new();
    let mut regimes: Vec<&str> = Vec::new();
    for row in rows {
        if !gaits.contains(&row.gait.as_str()) {
            gaits.push(&row.gait);
        }
        if !regimes.contains(&row.regime.as_str()) {
            regimes.push(&row.regime);
        }
    }
    let [base, others @ ..] = &gaits[..] else {
        return Ok(None);
    };
    let curve = |regime: &str, gait: &str| -> Vec<Point> {
        let own = |row: &&ConfirmedRecord| row.regime == regime && row.gait == gait;
        let rows = rows.iter().filter(own);
        rows.filter_map(|row| Some((row.duration_s, row.ratio?)))
            .collect()
    };
    let marker = |index: usize| Marker {
        shape: gait_shape(index),
        fill: Fill::Full,
        radius: MARKER_RADIUS,
    };
    let panels = regimes.iter().map(|regime| {
        let curves: Vec<Curve> = others
            .iter()
            .enumerate()
            .map(|(index, gait)| Curve {
                points: curve(regime, gait),
                stroke: gait_stroke(index + 1),
                marker: Some(marker(index + 1)),
            })
            .collect();
        let points = || curves.iter().flat_map(|curve| &curve.points);
        let longest = points().map(|point| point.0).fold(0.0, f64::max);
        let x = Axis::exactly("duration of the pull, s", 0.0, 1.05 * longest);
        let values = points().map(|point| point.1).chain([1.0]);
        let y = Axis::covering(&format!("{objective} over {base}'s, –"), values);
        let mut panel = Panel::new(format!("regime {regime}"), x, y, curves);
        panel
            .rules
            .push(Rule::Level(1.0, Stroke::solid(REFERENCE, 1.0)));
        panel
    });
    let key = others.iter().enumerate().map(|(index, gait)| {
        let (stroke, marker) = (gait_stroke(index + 1), marker(index + 1));
        KeyEntry::line((*gait).to_owned(), stroke, Some(marker))
    });
    let sheet = Sheet {
        key: key.collect(),
        bar: None,
        columns: regimes.len().max(1),
        frame_height: 260.0,
        panels: panels.collect(),
    };
    let wording = Wording {
        stem: "confirmation".to_owned(),
        number: "",
        title: format!("The found gait in simulation: {objective} over {base}'s"),
        caption: format!(
            "Each gait simulated from its own first pose, settled, at each duration of the pull and \
             in each contact regime; below 1 it costs less than {base}. Source: our simulation."
        ),
        alt: format!(
            "Line plots of cost relative to the {base} gait against duration, a panel per regime."
        ),
    };
    Ok(Some(wording.with(&sheet)))
}
