//! Figure 24: the best and the mean of each generation; and what simulation says of what was found.

use super::axis::Axis;
use super::panel::{Curve, Panel, Rule};
use super::records::{ConfirmedRecord, GenerationRecord, Scores, SearchRecord};
use super::sheet::{KeyEntry, Sheet};
use super::style::{
    CURVE_WIDTH, Dash, Fill, MARKER_RADIUS, Marker, REFERENCE, Stroke, gait_shape, gait_stroke,
};
use super::svg::Point;
use super::{Figure, FigureError, Wording, selection};

/// Points of a curve at most: a figure is 900 units wide.
const MOST_POINTS: usize = 400;

/// Values of the best and of the mean gait of a generation.
type BestAndMean = fn(&GenerationRecord) -> (Option<f64>, Option<f64>);

/// What scores mean, in words and in numbers.
struct Meaning<'a> {
    /// What a violation counts.
    violation: &'static str,
    violations: BestAndMean,
    /// Title and label of the torque part.
    value: (&'static str, String),
    values: BestAndMean,
    /// Of which gaits the mean is.
    mean: &'static str,
    /// What is minimised.
    searched: &'a str,
}

/// Figure 24; nothing without generations.
pub fn generations(search: &SearchRecord) -> Result<Option<Figure>, FigureError> {
    let rows = &search.generations;
    if rows.is_empty() {
        return Ok(None);
    }
    let (unit, objective) = (&search.unit, search.objective.as_str());
    let meaning = match search.scores {
        Scores::Published => Meaning {
            violation: "violated samples",
            violations: |row| (Some(row.best_violation), Some(row.mean_violation)),
            value: ("torque part", format!("Σ w τ² dt, {unit}")),
            values: |row| (Some(row.best_value), row.mean_value),
            mean: "all gaits of the generation",
            searched: "the torque part",
        },
        Scores::Graded => Meaning {
            violation: "excess, shares of limits",
            violations: |row| (Some(row.best_violation), None),
            value: ("gaits that keep the rules", format!("{objective}, {unit}")),
            values: |row| {
                let feasible = row.best_violation == 0.0;
                (feasible.then_some(row.best_value), row.mean_feasible_value)
            },
            mean: "the gaits of the generation that keep the rules",
            searched: objective,
        },
    };
    let (value, label) = &meaning.value;
    let panels = [
        panel(rows, "broken rules", meaning.violation, meaning.violations),
        panel(rows, value, label, meaning.values),
    ];
    let (mean, searched) = (meaning.mean, meaning.searched);
    let best = KeyEntry::line("best of the run so far".to_owned(), stroke(0), None);
    let mut key = vec![best];
    let (mut title, mut dashed) = ("Best of each generation", String::new());
    if rows.iter().any(|row| (meaning.values)(row).1.is_some()) {
        let label = "mean of the generation".to_owned();
        key.push(KeyEntry::line(label, stroke(1), None));
        title = "Best and mean of each generation";
        dashed = format!(" Dashed: the mean of {mean}.");
    }
    let sheet = Sheet::new(2, 260.0, panels).with_key(key);
    let wording = Wording {
        stem: "fig-24-search".to_owned(),
        number: "24",
        title: title.to_owned(),
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
    sheet.figure(wording).map(Some)
}

fn stroke(index: usize) -> Stroke {
    let dash = if index == 0 { Dash::Solid } else { Dash::Short };
    Stroke {
        width: CURVE_WIDTH,
        ..gait_stroke(index).with_dash(dash)
    }
}

fn panel(rows: &[GenerationRecord], title: &str, label: &str, best_and_mean: BestAndMean) -> Panel {
    let step = rows.len().div_ceil(MOST_POINTS).max(1);
    let (mut best, mut mean) = (Vec::new(), Vec::new());
    for row in rows.iter().step_by(step).chain(rows.last()) {
        let generation = row.generation as f64;
        let (of_best, of_mean) = best_and_mean(row);
        // A gait that breaks rules may have no torque at all, and is not drawn there.
        let point = |value: Option<f64>| Some((generation, value.filter(|it| it.is_finite())?));
        best.extend(point(of_best));
        mean.extend(point(of_mean));
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
    let curves = vec![Curve::new(mean, stroke(1)), Curve::new(best, stroke(0))];
    Panel::new(title, x, y, curves)
}

/// Cost over the first gait's against duration, a panel per regime; nothing without rows.
pub fn confirmation(
    rows: &[ConfirmedRecord],
    objective: &str,
) -> Result<Option<Figure>, FigureError> {
    let gaits = selection::each_once(rows.iter().map(|row| row.gait.as_str()), &[]);
    let regimes = selection::each_once(rows.iter().map(|row| row.regime.as_str()), &[]);
    let [base, others @ ..] = &gaits[..] else {
        return Ok(None);
    };
    // The first gait has the first style.
    let styles = others.iter().zip(1..).map(|(&gait, index)| {
        let marker = Marker::new(gait_shape(index), Fill::Full, MARKER_RADIUS);
        (gait, gait_stroke(index), Some(marker))
    });
    let styles: Vec<(&str, Stroke, Option<Marker>)> = styles.collect();
    let panels = regimes.iter().map(|regime| {
        let curves = styles.iter().map(|&(gait, stroke, marker)| {
            let own = |row: &&ConfirmedRecord| row.regime == *regime && row.gait == gait;
            let points = rows.iter().filter(own);
            Curve {
                points: points
                    .filter_map(|row| Some((row.duration_s, row.ratio?)))
                    .collect(),
                stroke,
                marker,
            }
        });
        let curves: Vec<Curve> = curves.collect();
        let points = || curves.iter().flat_map(|curve| &curve.points);
        let longest = points().map(|point| point.0).fold(0.0, f64::max);
        let x = Axis::exactly("duration of the pull, s", 0.0, 1.05 * longest);
        let values = points().map(|point| point.1).chain([1.0]);
        let y = Axis::covering(&format!("{objective} over {base}'s, –"), values);
        let mut panel = Panel::new(format!("regime {regime}"), x, y, curves);
        let one = Rule::Level(1.0, Stroke::solid(REFERENCE, 1.0));
        panel.rules.push(one);
        panel
    });
    let key = styles.iter();
    let key = key.map(|&(gait, stroke, marker)| KeyEntry::line(gait.to_owned(), stroke, marker));
    let sheet = Sheet::new(regimes.len().max(1), 260.0, panels).with_key(key);
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
    sheet.figure(wording).map(Some)
}
