//! Figure 44: torque of two gaits on the same axes, joint by joint, at three durations.

use super::panel::{Curve, Panel};
use super::sheet::{KeyEntry, Sheet};
use super::style::gait_stroke;
use super::torque::{TORQUE_MEANING, listed, over_time, time_axis, torque_axis};
use super::{Figure, FigureError, Wording, selection, sentence};
use prone_record::pulls::{JOINTS, PullRecord};

/// Durations to show, or the nearest there are, s.
const DURATIONS_S: [f64; 3] = [1.0, 5.0, 10.0];

/// Runs of equal duration, one of each gait.
type Pair<'a> = [&'a PullRecord; 2];

/// A row per joint, a column per duration; nothing without a duration that both gaits have.
pub(super) fn figure(
    pulls: &[PullRecord],
    reference: &str,
    other: &str,
) -> Result<Option<Figure>, FigureError> {
    let pairs = pairs(pulls, reference, other);
    if pairs.is_empty() {
        return Ok(None);
    }
    let panels = (0..JOINTS.len()).flat_map(|joint| joint_row(&pairs, joint));
    let key = [reference, other]
        .into_iter()
        .enumerate()
        .map(|(index, gait)| KeyEntry::line(format!("{gait} gait"), gait_stroke(index), None));
    let sheet = Sheet::new(pairs.len(), 150.0, panels).with_key(key);
    let durations = listed(pairs.iter().map(|pair| pair[0]));
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
    sheet.figure(wording).map(Some)
}

fn pairs<'a>(pulls: &'a [PullRecord], reference: &str, other: &str) -> Vec<Pair<'a>> {
    let others = selection::runs_of(pulls, other);
    let pair = |run: &'a PullRecord| {
        let same =
            |other: &&&PullRecord| selection::same_duration(other.duration_s, run.duration_s);
        Some([run, others.iter().find(same)?])
    };
    let runs = selection::runs_of(pulls, reference).into_iter();
    let pairs: Vec<Pair<'a>> = runs.filter_map(pair).collect();
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
    runs.map(|(index, run)| Curve::new(over_time(run, joint), gait_stroke(index)))
        .collect()
}
