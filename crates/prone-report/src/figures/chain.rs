//! Figures 26 and 34: the planned closed chain at several instants, seen from the side.

use super::axis::Axis;
use super::bar::{Bar, ColourBar};
use super::panel::{Aspect, Curve, Note, Panel, Rule};
use super::sheet::Sheet;
use super::style::{Fill, INK, Marker, Shape, Stroke};
use super::svg::{Anchor, Point};
use super::{Figure, FigureError, Wording, sentence};
use prone_record::pulls::{ChainRecord, ChainSample};

/// Postures drawn, first and last among them.
const POSTURES: usize = 7;
/// Room around the chain, mm.
const ROOM_MM: f64 = 32.0;
/// Where the ankle is in a sample's points.
const ANKLE: usize = 1;

/// Names of a sample's points, and from the point to its name in units of the drawing: on the
/// side where the first posture leaves room.
const NAMES: [(&str, Point, Anchor); 6] = [
    ("toe", (-9.0, -6.0), Anchor::End),
    ("ankle", (-8.0, 4.0), Anchor::End),
    ("knee", (-4.0, 17.0), Anchor::End),
    ("hip", (0.0, 16.5), Anchor::Middle),
    ("shoulder", (-16.0, 18.0), Anchor::Middle),
    ("elbow", (9.0, -6.0), Anchor::Start),
];

/// Stick figures of one gait; nothing without samples.
pub(super) fn figure(
    record: &ChainRecord,
    number: &'static str,
) -> Result<Option<Figure>, FigureError> {
    let postures = instants(&record.samples);
    let height = |sample: &&ChainSample| sample.points_mm[ANKLE].1;
    let by_height = |a: &&ChainSample, b: &&ChainSample| height(a).total_cmp(&height(b));
    let Some(highest) = record.samples.iter().max_by(by_height) else {
        return Ok(None);
    };
    let phases = postures.iter().map(|sample| sample.s);
    let bar = ColourBar {
        label: "phase s, –".to_owned(),
        steps: phases.map(|s| format!("{s:.2}")).collect(),
    };
    let gait = &record.gait;
    let panel = panel(&postures, highest, &bar);
    let sheet = Sheet::new(1, 250.0, [panel]).with_bar(Bar::Steps(bar));
    let height_mm = highest.points_mm[ANKLE].1;
    let wording = Wording {
        stem: format!("fig-{number}-{gait}-chain"),
        number,
        title: format!("{} gait: closed chain over the phase", sentence(gait)),
        caption: format!(
            "The planned chain from toe to elbow in the sagittal plane at {} instants of the \
             closed-chain phase of the {gait} gait; joint centres, mm, equal scales. The ankle \
             reaches {height_mm:.1} mm at s = {:.2}. Source: the gait as planned here.",
            postures.len(),
            highest.s
        ),
        alt: format!(
            "Stick figures of toe, ankle, knee, hip, shoulder and elbow above the floor, moving \
             forward. The ankle's highest point is {height_mm:.0} millimetres."
        ),
    };
    sheet.figure(wording).map(Some)
}

/// Equally spaced samples, the first and the last included.
fn instants(samples: &[ChainSample]) -> Vec<ChainSample> {
    let count = POSTURES.min(samples.len());
    let last = samples.len().saturating_sub(1);
    let gaps = count.saturating_sub(1).max(1);
    // The nearest sample, in whole numbers.
    (0..count)
        .map(|index| samples[(index * last + gaps / 2) / gaps])
        .collect()
}

fn panel(postures: &[ChainSample], highest: &ChainSample, bar: &ColourBar) -> Panel {
    let joint = Marker::new(Shape::Circle, Fill::Full, 3.2);
    let postures_drawn = postures.iter().enumerate().map(|(index, sample)| Curve {
        points: sample.points_mm.to_vec(),
        stroke: Stroke::solid(bar.colour(index), 2.4),
        marker: Some(joint),
    });
    let mut curves: Vec<Curve> = postures_drawn.collect();
    let peak = highest.points_mm[ANKLE];
    curves.push(Curve {
        points: vec![peak],
        stroke: Stroke::solid(INK, 1.0),
        marker: Some(Marker::new(Shape::Diamond, Fill::Hollow, 5.0)),
    });
    let (x, y) = axes(postures, peak);
    let mut panel = Panel::new("side view", x, y, curves);
    panel.aspect = Aspect::Equal;
    panel.rules = vec![Rule::Level(0.0, Stroke::solid(INK, 2.5))];
    panel.notes = postures.first().map(names).unwrap_or_default();
    panel.notes.push(Note {
        at: peak,
        offset: (8.0, -14.0),
        anchor: Anchor::Start,
        text: format!("ankle highest: {:.1} mm at s = {:.2}", peak.1, highest.s),
    });
    panel
}

fn axes(postures: &[ChainSample], peak: Point) -> (Axis, Axis) {
    let points = postures.iter().flat_map(|sample| sample.points_mm);
    let (xs, zs): (Vec<f64>, Vec<f64>) = points.chain([peak]).unzip();
    let low = |values: &[f64]| values.iter().copied().fold(0.0, f64::min) - ROOM_MM;
    let high = |values: &[f64]| values.iter().copied().fold(0.0, f64::max) + ROOM_MM;
    let x = Axis::exactly("x, forward from the toe, mm", low(&xs), high(&xs));
    let floor = low(&zs) + ROOM_MM / 4.0;
    let z = Axis::exactly("z, above the floor, mm", floor, high(&zs));
    (x, z)
}

fn names(sample: &ChainSample) -> Vec<Note> {
    let named = sample.points_mm.iter().zip(NAMES);
    let notes = named.map(|(at, (name, offset, anchor))| Note {
        at: *at,
        offset,
        anchor,
        text: name.to_owned(),
    });
    notes.collect()
}
