//! Figure 44: torque of two gaits on the same axes, joint by joint, at three durations.

use super::panel::{Curve, Panel};
use super::sheet::{KeyEntry, Sheet};
use super::style::gait_stroke;
use super::torque::{TORQUE_MEANING, over_time, time_axis, torque_axis};
use super::{Figure, Wording, selection, sentence};
use prone_record::pulls::{JOINTS, PullRecord};

/// Durations to show, or the nearest there are, s.
const DURATIONS_S: [f64; 3] = [1.0, 5.0, 10.0];

/// Runs of equal duration, one of each gait.
type Pair<'a> = [&'a PullRecord; 2];

/// A row per joint, a column per duration; nothing without a duration that both gaits have.
pub(super) fn figure(pulls: &[PullRecord], reference: &str, other: &str) -> Option<Figure> {
    let pairs = pairs(pulls, reference, other);
    if pairs.is_empty() {
        return None;
    }
    let panels = (0..JOINTS.len()).flat_map(|joint| joint_row(&pairs, joint));
    let key = [reference, other]
        .into_iter()
        .enumerate()
        .map(|(index, gait)| KeyEntry::line(format!("{gait} gait"), gait_stroke(index), None));
    let sheet = Sheet {
        key: key.collect(),
        bar: None,
        columns: pairs.len(),
        frame_height: 150.0,
        panels: panels.collect(),
    };
    let durations: Vec<String> = pairs
        .iter()
        .map(|pair| pair[0].duration_s.to_string())
        .collect();
    let durations = durations.join(", ");
    let wording = Wording {
        stem: format!("fig-44-{reference}-against-{other}"),
        number: "44",
        title: format!("{} against {other} gait: joint torque", sentence(reference)),
        caption: format!(
            "Torque, N·m, over time, s, of the {reference} gait (solid) and the {other} gait \
             (dashed); a row per joint with one torque scale, a column per duration ({durations} \
             s). {TORQUE_MEANING} Source: our simulation."
        ),
        alt: format!(
            "Line plots of joint torque against time, {reference} and {other} gait overlaid, for \
             four joints and durations of {durations} seconds."
        ),
    };
    Some(wording.with(&sheet))
}

fn pairs<'a>(pulls: &'a [PullRecord], reference: &str, other: &str) -> Vec<Pair<'a>> {
    let others = selection::runs_of(pulls, other);
    let partner = |run: &PullRecord| {
        others
            .iter()
            .copied()
            .find(|o| selection::same_duration(o.duration_s, run.duration_s))
    };
    let pairs: Vec<Pair> = selection::runs_of(pulls, reference)
        .into_iter()
        .filter_map(|run| partner(run).map(|other| [run, other]))
        .collect();
    selection::nearest(&pairs, |pair| pair[0].duration_s, &DURATIONS_S)
}

fn joint_row(pairs: &[Pair], joint: usize) -> Vec<Panel> {
    let curves: Vec<Vec<Curve>> = pairs.iter().map(|pair| pair_curves(pair, joint)).collect();
    let y = torque_axis(curves.iter().flatten());
    let panels = pairs.iter().zip(curves).map(|(pair, curves)| {
        let duration_s = pair[0].duration_s;
        let title = format!("{}, {duration_s} s", JOINTS[joint]);
        Panel::new(title, time_axis(duration_s), y.clone(), curves)
    });
    panels.collect()
}

fn pair_curves(pair: &Pair, joint: usize) -> Vec<Curve> {
    let runs = pair.iter().enumerate();
    let curves = runs.map(|(index, run)| Curve {
        points: over_time(run, joint),
        stroke: gait_stroke(index),
        marker: None,
    });
    curves.collect()
}
