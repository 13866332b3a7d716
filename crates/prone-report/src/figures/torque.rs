//! Figures 36 to 43: joint torque of one gait, by duration and by joint.

use super::axis::Axis;
use super::bar::{Bar, ColourBar};
use super::panel::{Curve, Note, Panel, Rule};
use super::sheet::{KeyEntry, Sheet};
use super::style::{
    CURVE_WIDTH, Dash, Fill, INK, JOINT_STROKES, Marker, SMALL_MARKER_RADIUS, Shape, Stroke,
};
use super::svg::{Anchor, Point};
use super::{Figure, Wording, selection, sentence};
use prone_record::pulls::{JOINTS, PullRecord, PullRow};

/// Quantity and unit of every torque axis.
pub(super) const TORQUE_LABEL: &str = "joint torque, N·m";
/// What that quantity is; part of every torque caption.
pub(super) const TORQUE_MEANING: &str = "Joint torque is minus the actuator torque of the right side, averaged over a control step: the sign of the published recordings.";

/// Durations shown one panel each, s.
const PANEL_DURATIONS_S: [f64; 6] = [1.0, 2.0, 3.0, 5.0, 7.0, 10.0];
/// How much of the beginning the transient figures show, s.
const TRANSIENT_S: f64 = 0.5;

/// Numbers of the originals for one gait.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Numbers {
    /// Mean torques by duration.
    pub by_duration: &'static str,
    /// Torques over time, by joint.
    pub time: &'static str,
    /// Their beginning.
    pub transient: &'static str,
    /// Torques over the phase.
    pub cycle: &'static str,
}

/// What a figure with one panel per joint has on its x axis.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Span {
    /// Time since the phase began.
    Time,
    /// The same, magnified; with the time where the thesis sees the curves part.
    Transient { divergence_s: f64 },
    /// Percent of the phase.
    Cycle,
}

/// The four torque figures of one gait; none without runs.
pub(super) fn figures(
    gait: &str,
    runs: &[&PullRecord],
    numbers: &Numbers,
    divergence_s: f64,
) -> Vec<Figure> {
    if runs.is_empty() {
        return Vec::new();
    }
    vec![
        by_duration(gait, runs, numbers.by_duration),
        by_joint(gait, runs, numbers.time, Span::Time),
        by_joint(
            gait,
            runs,
            numbers.transient,
            Span::Transient { divergence_s },
        ),
        by_joint(gait, runs, numbers.cycle, Span::Cycle),
    ]
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

fn by_duration(gait: &str, runs: &[&PullRecord], number: &'static str) -> Figure {
    let runs = selection::nearest(runs, |run| run.duration_s, &PANEL_DURATIONS_S);
    let curves: Vec<Vec<Curve>> = runs.iter().map(|run| joint_curves(run)).collect();
    let y = torque_axis(curves.iter().flatten());
    let panels = runs.iter().zip(curves).map(|(run, curves)| {
        let title = format!("{} s", run.duration_s);
        Panel::new(title, time_axis(run.duration_s), y.clone(), curves)
    });
    let key = JOINTS
        .iter()
        .zip(JOINT_STROKES)
        .map(|(joint, stroke)| KeyEntry::line((*joint).to_owned(), stroke, None));
    let sheet = Sheet {
        key: key.collect(),
        bar: None,
        columns: 2.min(runs.len()),
        frame_height: 190.0,
        panels: panels.collect(),
    };
    let durations = listed(&runs);
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
    wording.with(&sheet)
}

fn joint_curves(run: &PullRecord) -> Vec<Curve> {
    let joints = JOINT_STROKES.into_iter().enumerate();
    let curves = joints.map(|(joint, stroke)| Curve {
        points: over_time(run, joint),
        stroke,
        marker: None,
    });
    curves.collect()
}

fn by_joint(gait: &str, runs: &[&PullRecord], number: &'static str, span: Span) -> Figure {
    let bar = ColourBar {
        label: "duration of the phase, s".to_owned(),
        steps: runs.iter().map(|run| run.duration_s.to_string()).collect(),
    };
    let panels = (0..JOINTS.len()).map(|joint| joint_panel(runs, joint, span, &bar));
    let sheet = Sheet {
        panels: panels.collect(),
        key: span.key(),
        bar: Some(Bar::Steps(bar)),
        columns: 2,
        frame_height: 230.0,
    };
    let durations = listed(runs);
    let wording = Wording {
        stem: format!("fig-{number}-{gait}-{}", span.stem()),
        number,
        title: format!("{} gait: joint torque {}", sentence(gait), span.title()),
        caption: format!(
            "Torque, N·m, {} of the closed-chain phase of the {gait} gait; one panel per joint, \
             one line per duration ({durations} s; the colour bar names them). {}{TORQUE_MEANING} \
             Source: our simulation.",
            span.quantity(),
            span.remark()
        ),
        alt: format!(
            "Four panels, ankle, knee, hip and shoulder, each with the torque {} for durations of \
             {durations} seconds.",
            span.quantity()
        ),
    };
    wording.with(&sheet)
}

fn joint_panel(runs: &[&PullRecord], joint: usize, span: Span, bar: &ColourBar) -> Panel {
    let curves = runs.iter().enumerate().map(|(index, run)| Curve {
        points: span.points(run, joint),
        stroke: Stroke::solid(bar.colour(index), CURVE_WIDTH),
        marker: span.marker(),
    });
    let curves: Vec<Curve> = curves.collect();
    let y = torque_axis(&curves);
    let mut panel = Panel::new(JOINTS[joint], span.axis(runs), y, curves);
    panel.rules.extend(span.rule());
    panel.notes.extend(span.note(panel.y.high));
    panel
}

impl Span {
    fn stem(self) -> &'static str {
        match self {
            Self::Time => "torque-over-time",
            Self::Transient { .. } => "transient",
            Self::Cycle => "torque-over-cycle",
        }
    }

    fn title(self) -> &'static str {
        match self {
            Self::Time => "over time, by joint",
            Self::Transient { .. } => "at the beginning, by joint",
            Self::Cycle => "over the cycle, by joint",
        }
    }

    fn quantity(self) -> &'static str {
        match self {
            Self::Time => "over time, s,",
            Self::Transient { .. } => "over the first half second",
            Self::Cycle => "over percent",
        }
    }

    fn remark(self) -> String {
        match self {
            Self::Time | Self::Cycle => String::new(),
            Self::Transient { divergence_s } => format!(
                "Each marker is one row of the records. The dashed line at {divergence_s} s is \
                 the thesis' value for where the curves part; it is not fitted to ours. "
            ),
        }
    }

    fn axis(self, runs: &[&PullRecord]) -> Axis {
        let longest_s = runs.iter().map(|run| run.duration_s).fold(0.0, f64::max);
        match self {
            Self::Time => time_axis(longest_s),
            // A little more, for the markers at its end.
            Self::Transient { .. } => time_axis(1.03 * TRANSIENT_S.min(longest_s)),
            Self::Cycle => Axis::exactly("cycle, %", 0.0, 100.0),
        }
    }

    fn points(self, run: &PullRecord, joint: usize) -> Vec<Point> {
        /// Part of a control step by which the end of the window may be missed.
        const SLACK_S: f64 = 1e-6;
        match self {
            Self::Time => over_time(run, joint),
            Self::Transient { .. } => {
                let seen = |row: &&PullRow| row.time_s <= TRANSIENT_S + SLACK_S;
                let rows = run.rows.iter().filter(seen);
                rows.map(|row| (row.time_s, row.torque_nm[joint])).collect()
            }
            Self::Cycle => run
                .rows
                .iter()
                .map(|row| (row.cycle_percent, row.torque_nm[joint]))
                .collect(),
        }
    }

    fn marker(self) -> Option<Marker> {
        let row = Marker {
            shape: Shape::Circle,
            fill: Fill::Full,
            radius: SMALL_MARKER_RADIUS,
        };
        matches!(self, Self::Transient { .. }).then_some(row)
    }

    fn divergence(self) -> Option<(f64, Stroke)> {
        let stroke = Stroke::solid(INK, 1.2).with_dash(Dash::Short);
        match self {
            Self::Transient { divergence_s } => Some((divergence_s, stroke)),
            Self::Time | Self::Cycle => None,
        }
    }

    fn rule(self) -> Option<Rule> {
        self.divergence()
            .map(|(at_s, stroke)| Rule::At(at_s, stroke))
    }

    /// The time, above the frame, where it covers no curve.
    fn note(self, top: f64) -> Option<Note> {
        self.divergence().map(|(at_s, _)| Note {
            at: (at_s, top),
            offset: (0.0, -7.0),
            anchor: Anchor::Middle,
            text: format!("{at_s} s"),
        })
    }

    fn key(self) -> Vec<KeyEntry> {
        let entry = self.divergence().map(|(at_s, stroke)| {
            let label = format!("{at_s} s: where the thesis sees the curves part (published)");
            KeyEntry::line(label, stroke, None)
        });
        entry.into_iter().collect()
    }
}

fn listed(runs: &[&PullRecord]) -> String {
    let durations: Vec<String> = runs.iter().map(|run| run.duration_s.to_string()).collect();
    durations.join(", ")
}
