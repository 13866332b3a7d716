//! Figures 36 to 43: joint torque of one gait, by duration and by joint.

use super::axis::Axis;
use super::bar::{Bar, ColourBar};
use super::panel::{Curve, Note, Panel, Rule};
use super::sheet::{KeyEntry, Sheet};
use super::style::{
    CURVE_WIDTH, Dash, Fill, INK, JOINT_STROKES, Marker, SMALL_MARKER_RADIUS, Shape, Stroke,
};
use super::svg::{Anchor, Point};
use super::{Figure, FigureError, GaitNumbers, Wording, selection, sentence};
use prone_record::pulls::{JOINTS, PullRecord, PullRow};

/// Quantity and unit of every torque axis.
pub(super) const TORQUE_LABEL: &str = "joint torque, N·m";
/// What that quantity is; part of every torque caption.
pub(super) const TORQUE_MEANING: &str = "Joint torque is minus the applied torque of the right side, averaged over a control step: the sign of the published recordings.";

/// Durations shown one panel each, s.
const PANEL_DURATIONS_S: [f64; 6] = [1.0, 2.0, 3.0, 5.0, 7.0, 10.0];
/// How much of the beginning the transient figures show, s.
const TRANSIENT_S: f64 = 0.5;

/// The line where the thesis sees the curves part.
const DIVERGENCE: Stroke = Stroke::solid(INK, 1.2).with_dash(Dash::Short);

/// What a figure with one panel per joint has on its x axis.
struct Span {
    number: &'static str,
    stem: &'static str,
    title: &'static str,
    quantity: &'static str,
    axis: Axis,
    /// Where a row is on that axis, if it is shown.
    place: fn(&PullRow) -> Option<f64>,
    /// Where the thesis sees the curves part, s, if that is shown.
    divergence_s: Option<f64>,
}

/// The four torque figures of one gait; none without runs.
pub(super) fn figures(
    pulls: &[PullRecord],
    numbers: &GaitNumbers,
) -> Result<Vec<Figure>, FigureError> {
    /// Part of a control step by which the end of the window may be missed.
    const SLACK_S: f64 = 1e-6;
    let gait = numbers.gait;
    let runs = selection::runs_of(pulls, gait);
    if runs.is_empty() {
        return Ok(Vec::new());
    }
    let longest_s = runs.iter().map(|run| run.duration_s).fold(0.0, f64::max);
    let time = Span {
        number: numbers.torque_over_time,
        stem: "torque-over-time",
        title: "over time, by joint",
        quantity: "over time, s,",
        axis: time_axis(longest_s),
        place: |row| Some(row.time_s),
        divergence_s: None,
    };
    let transient = Span {
        number: numbers.transient,
        stem: "transient",
        title: "at the beginning, by joint",
        quantity: "over the first half second",
        // A little more, for the markers at its end.
        axis: time_axis(1.03 * TRANSIENT_S.min(longest_s)),
        place: |row| (row.time_s <= TRANSIENT_S + SLACK_S).then_some(row.time_s),
        divergence_s: Some(numbers.published_divergence_s),
    };
    let cycle = Span {
        number: numbers.torque_over_cycle,
        stem: "torque-over-cycle",
        title: "over the cycle, by joint",
        quantity: "over percent",
        axis: Axis::exactly("cycle, %", 0.0, 100.0),
        place: |row| Some(row.cycle_percent),
        divergence_s: None,
    };
    let mut figures = vec![by_duration(gait, &runs, numbers.torque_by_duration)?];
    for span in [time, transient, cycle] {
        figures.push(by_joint(gait, &runs, &span)?);
    }
    Ok(figures)
}

/// The axis from the beginning to the end of a run.
pub(super) fn time_axis(end_s: f64) -> Axis {
    Axis::exactly("time, s", 0.0, end_s)
}

/// The axis on which all torques of `curves` fit.
pub(super) fn torque_axis<'a>(curves: impl IntoIterator<Item = &'a Curve>) -> Axis {
    let points = curves.into_iter().flat_map(|curve| &curve.points);
    Axis::covering(TORQUE_LABEL, points.map(|point| point.1).chain([0.0]))
}

/// One joint's torque over time.
pub(super) fn over_time(run: &PullRecord, joint: usize) -> Vec<Point> {
    run.rows
        .iter()
        .map(|row| (row.time_s, row.torque_nm[joint]))
        .collect()
}

fn by_duration(
    gait: &str,
    runs: &[&PullRecord],
    number: &'static str,
) -> Result<Figure, FigureError> {
    let runs = selection::nearest(runs, |run| run.duration_s, &PANEL_DURATIONS_S);
    let curves: Vec<Vec<Curve>> = runs.iter().map(|run| joint_curves(run)).collect();
    let y = torque_axis(curves.iter().flatten());
    let panels = runs.iter().zip(curves).map(|(run, curves)| {
        let title = format!("{} s", run.duration_s);
        Panel::new(title, time_axis(run.duration_s), y.clone(), curves)
    });
    let key = JOINTS.into_iter().zip(JOINT_STROKES);
    let key = key.map(|(joint, stroke)| KeyEntry::line(joint.to_owned(), stroke, None));
    let sheet = Sheet::new(2.min(runs.len()), 190.0, panels).with_key(key);
    let durations = listed(runs);
    let wording = Wording {
        stem: format!("fig-{number}-{gait}-torque-by-duration"),
        number,
        title: format!(
            "{} gait: joint torque of four joints, by duration",
            sentence(gait)
        ),
        caption: format!(
            "Torque at ankle, knee, hip and shoulder, N·m, over time, s, during the closed-chain \
             phase of the {gait} gait; one panel per duration ({durations} s), the same torque \
             scale in all. {TORQUE_MEANING} Source: our simulation."
        ),
        alt: format!(
            "Line plots of four joint torques against time, one panel for each duration of \
             {durations} seconds."
        ),
    };
    sheet.figure(wording)
}

fn joint_curves(run: &PullRecord) -> Vec<Curve> {
    let joints = JOINT_STROKES.into_iter().enumerate();
    joints
        .map(|(joint, stroke)| Curve::new(over_time(run, joint), stroke))
        .collect()
}

fn by_joint(gait: &str, runs: &[&PullRecord], span: &Span) -> Result<Figure, FigureError> {
    let bar = ColourBar {
        label: "duration of the phase, s".to_owned(),
        steps: runs.iter().map(|run| run.duration_s.to_string()).collect(),
    };
    let panels: Vec<Panel> = (0..JOINTS.len())
        .map(|joint| joint_panel(runs, joint, span, &bar))
        .collect();
    let key = span.divergence_s.map(|at_s| {
        let label = format!("{at_s} s: where the thesis sees the curves part (published)");
        KeyEntry::line(label, DIVERGENCE, None)
    });
    let remark = span.divergence_s.map_or_else(String::new, |at_s| {
        format!(
            "Each marker is one row of the records. The dashed line at {at_s} s is the thesis' value \
             for where the curves part; it is not fitted to ours. "
        )
    });
    let sheet = Sheet::new(2, 230.0, panels)
        .with_key(key)
        .with_bar(Bar::Steps(bar));
    let durations = listed(runs.iter().copied());
    let (number, quantity) = (span.number, span.quantity);
    let wording = Wording {
        stem: format!("fig-{number}-{gait}-{}", span.stem),
        number,
        title: format!("{} gait: joint torque {}", sentence(gait), span.title),
        caption: format!(
            "Torque, N·m, {quantity} of the closed-chain phase of the {gait} gait; one panel per joint, \
             one line per duration ({durations} s; the colour bar names them). {remark}{TORQUE_MEANING} \
             Source: our simulation."
        ),
        alt: format!(
            "Four panels, ankle, knee, hip and shoulder, each with the torque {quantity} for durations of \
             {durations} seconds."
        ),
    };
    sheet.figure(wording)
}

fn joint_panel(runs: &[&PullRecord], joint: usize, span: &Span, bar: &ColourBar) -> Panel {
    let row_marker = Marker::new(Shape::Circle, Fill::Full, SMALL_MARKER_RADIUS);
    let curves = runs.iter().enumerate().map(|(index, run)| {
        let rows = run.rows.iter();
        let points = rows.filter_map(|row| Some(((span.place)(row)?, row.torque_nm[joint])));
        Curve {
            points: points.collect(),
            stroke: Stroke::solid(bar.colour(index), CURVE_WIDTH),
            marker: span.divergence_s.map(|_| row_marker),
        }
    });
    let curves: Vec<Curve> = curves.collect();
    let y = torque_axis(&curves);
    let mut panel = Panel::new(JOINTS[joint], span.axis.clone(), y, curves);
    if let Some(at_s) = span.divergence_s {
        panel.rules.push(Rule::At(at_s, DIVERGENCE));
        // The time stands above the frame, where it covers no curve.
        panel.notes.push(Note {
            at: (at_s, panel.y.high),
            offset: (0.0, -7.0),
            anchor: Anchor::Middle,
            text: format!("{at_s} s"),
        });
    }
    panel
}

/// The durations of some runs, in words.
pub(super) fn listed<'a>(runs: impl IntoIterator<Item = &'a PullRecord>) -> String {
    let runs = runs.into_iter();
    let durations: Vec<String> = runs.map(|run| run.duration_s.to_string()).collect();
    durations.join(", ")
}
