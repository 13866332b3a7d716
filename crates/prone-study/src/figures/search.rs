//! Figure 24: the best and the mean of each generation; and what simulation says of what was found.

use super::axis::Axis;
use super::panel::{Curve, Panel, Rule};
use super::sheet::{KeyEntry, Sheet};
use super::style::{
    CURVE_WIDTH, Dash, Fill, MARKER_RADIUS, Marker, REFERENCE, Stroke, gait_shape, gait_stroke,
};
use super::svg::Point;
use super::{Figure, FigureError, Wording};
use crate::optimize::confirm::{Confirmation, Row};
use crate::optimize::objective::Objective;
use crate::optimize::search::{Search, SeededRun};

/// Points of a curve at most: a figure is 900 units wide.
const MOST_POINTS: usize = 400;

/// Everything drawn of a search.
///
/// # Errors
/// [`FigureError`] where a record holds a number that no axis can show.
pub fn figures(
    search: &Search,
    confirmation: &Confirmation,
    objective: &Objective,
    scores: Scores,
) -> Result<Vec<Figure>, FigureError> {
    let drawn = [
        generations(search, objective, scores),
        ratios(confirmation, objective),
    ];
    for row in &confirmation.rows {
        for value in [row.objective, row.duration_s] {
            if !value.is_finite() {
                return Err(FigureError::Value {
                    place: format!("confirmation of {} at {} s", row.gait, row.duration_s),
                    value,
                });
            }
        }
    }
    Ok(drawn.into_iter().flatten().collect())
}

/// What the scores of a search mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scores {
    /// Violated samples, and a torque part.
    Published,
    /// Excesses, and a torque part that only feasible gaits are compared by.
    Graded,
}

/// The run that found the best gait.
fn generations(search: &Search, objective: &Objective, scores: Scores) -> Option<Figure> {
    let (run, _) = search.best()?;
    let unit = objective.unit();
    let (left, right) = match scores {
        Scores::Published => (
            panel(run, "broken rules", "violated samples", |row| {
                (Some(row.best.violation()), Some(row.mean_violation))
            }),
            panel(run, "torque part", &format!("Σ w τ² dt, {unit}"), |row| {
                (Some(row.best.value()), Some(row.mean_value))
            }),
        ),
        Scores::Graded => (
            panel(run, "broken rules", "excess, shares of limits", |row| {
                (Some(row.best.violation()), None)
            }),
            panel(
                run,
                "gaits that keep the rules",
                &format!("{}, {unit}", objective.name()),
                |row| {
                    let feasible = row.best.violation() == 0.0;
                    (
                        feasible.then(|| row.best.value()),
                        (row.feasible > 0).then_some(row.mean_feasible_value),
                    )
                },
            ),
        ),
    };
    let key = [("best of the run so far", 0), ("mean of the generation", 1)];
    let sheet = Sheet {
        key: key
            .map(|(label, index)| KeyEntry::line(label.to_owned(), stroke(index), None))
            .to_vec(),
        bar: None,
        columns: 2,
        frame_height: 260.0,
        panels: vec![left, right],
    };
    let mean = match scores {
        Scores::Published => "all gaits of the generation",
        Scores::Graded => "the gaits of the generation that keep the rules",
    };
    let wording = Wording {
        stem: "fig-24-search".to_owned(),
        number: "24",
        title: "Best and mean of each generation".to_owned(),
        caption: format!(
            "The run with seed {} over its generations: left the rules that are broken, right the \
             torque part. Solid: the best gait so far. Dashed: the mean of {mean}. Fewer violations \
             win, and torque decides between equals. Source: our search.",
            run.seed
        ),
        alt: "Line plots of violations and of torque, best and mean, against generation."
            .to_owned(),
    };
    Some(wording.with(&sheet))
}

fn stroke(index: usize) -> Stroke {
    let dash = if index == 0 { Dash::Solid } else { Dash::Short };
    Stroke {
        width: CURVE_WIDTH,
        ..gait_stroke(index).with_dash(dash)
    }
}

fn panel(
    run: &SeededRun,
    title: &str,
    label: &str,
    of: impl Fn(&prone_optim::Generation) -> (Option<f64>, Option<f64>),
) -> Panel {
    let rows = &run.history.0;
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

/// Cost over the first gait's against duration, a panel per regime.
fn ratios(confirmation: &Confirmation, objective: &Objective) -> Option<Figure> {
    let mut gaits: Vec<&str> = Vec::new();
    let mut regimes: Vec<&str> = Vec::new();
    for row in &confirmation.rows {
        if !gaits.contains(&row.gait.as_str()) {
            gaits.push(&row.gait);
        }
        if !regimes.contains(&row.regime) {
            regimes.push(row.regime);
        }
    }
    let [base, others @ ..] = &gaits[..] else {
        return None;
    };
    let curve = |regime: &str, gait: &str| -> Vec<Point> {
        let own = |row: &&Row| row.regime == regime && row.gait == gait && row.ratio.is_finite();
        let rows = confirmation.rows.iter().filter(own);
        rows.map(|row| (row.duration_s, row.ratio)).collect()
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
        let y = Axis::covering(&format!("{} over {base}'s", objective.name()), values);
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
        title: format!(
            "The found gait in simulation: {} over {base}'s",
            objective.name()
        ),
        caption: format!(
            "Each gait simulated from its own first pose, settled, at each duration of the pull and \
             in each contact regime; below 1 it costs less than {base}. Source: our simulation."
        ),
        alt: format!(
            "Line plots of cost relative to the {base} gait against duration, a panel per regime."
        ),
    };
    Some(wording.with(&sheet))
}
