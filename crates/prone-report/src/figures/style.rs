//! The one look of every figure: fonts, sizes, colours, lines.
//!
//! A drawing is [`SHEET_WIDTH`] units wide and printed about 170 mm wide, so that text of 13 units
//! comes out at 7 pt. Whatever tells two curves apart differs in lightness as well as in hue, and
//! mostly in dash or marker too, so that it survives grey printing and colour blindness.

/// Width of every drawing, in the units of all sizes here.
pub(super) const SHEET_WIDTH: f64 = 900.0;

/// First choice is the embedded font; Verdana has nearly the same metrics.
pub(super) const FONT_FAMILY: &str = "DejaVu Sans, Verdana, Geneva, sans-serif";
/// Size of a figure's title.
pub(super) const TITLE_SIZE: f64 = 16.0;
/// Size of axis labels, panel titles and the key.
pub(super) const TEXT_SIZE: f64 = 13.0;
/// Size of tick labels and of notes inside a panel.
pub(super) const SMALL_SIZE: f64 = 12.0;

/// Width of a curve.
pub(super) const CURVE_WIDTH: f64 = 1.8;
/// Radius of a marker.
pub(super) const MARKER_RADIUS: f64 = 4.2;
/// Radius of a marker where every row of a record has one.
pub(super) const SMALL_MARKER_RADIUS: f64 = 2.4;

/// A colour, red, green, blue.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Colour(pub(super) u8, pub(super) u8, pub(super) u8);

/// Behind everything.
pub(super) const PAPER: Colour = Colour(255, 255, 255);
/// Text and frames.
pub(super) const INK: Colour = Colour(26, 26, 26);
/// Lines at labelled ticks.
pub(super) const GRID: Colour = Colour(217, 217, 217);
/// Lines between labelled ticks.
pub(super) const MINOR_GRID: Colour = Colour(240, 240, 240);
/// Where a map has nothing to show, and the lines of its hatching.
pub(super) const NOTHING: Colour = Colour(224, 224, 224);
pub(super) const HATCHING: Colour = Colour(112, 112, 112);
/// What was commanded, beside what was measured.
pub(super) const LIGHT: Colour = Colour(170, 190, 214);
/// A range, behind curves.
pub(super) const BAND: Colour = Colour(250, 232, 190);
/// The line at zero, the floor and other references.
pub(super) const REFERENCE: Colour = Colour(128, 128, 128);

/// Pattern of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Dash {
    Solid,
    Long,
    Short,
    Mixed,
}

impl Dash {
    /// Lengths of dashes and gaps as SVG lists them; nothing for a solid line.
    pub(super) fn pattern(self) -> Option<&'static str> {
        match self {
            Self::Solid => None,
            Self::Long => Some("8 4"),
            Self::Short => Some("4 3"),
            Self::Mixed => Some("7 3 1.5 3"),
        }
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stroke {
    pub(super) colour: Colour,
    pub(super) width: f64,
    pub(super) dash: Dash,
}

impl Stroke {
    /// An unbroken line.
    pub(super) const fn solid(colour: Colour, width: f64) -> Self {
        Self {
            colour,
            width,
            dash: Dash::Solid,
        }
    }

    /// The same line in another pattern.
    pub(super) const fn with_dash(self, dash: Dash) -> Self {
        Self { dash, ..self }
    }
}

/// Outline of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    Circle,
    Square,
    Triangle,
    Diamond,
}

/// Inside of a marker.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Fill {
    Full,
    Hollow,
}

/// A marker at each point of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Marker {
    pub(super) shape: Shape,
    pub(super) fill: Fill,
    pub(super) radius: f64,
}

impl Marker {
    pub(super) const fn new(shape: Shape, fill: Fill, radius: f64) -> Self {
        Self {
            shape,
            fill,
            radius,
        }
    }
}

// Paul Tol's "high-contrast" scheme: three hues that stay apart in grey. Yellow and red are a
// little darker than his, for thin lines on white paper.
const BLUE: Colour = Colour(0, 68, 136);
const RED: Colour = Colour(165, 60, 80);
const YELLOW: Colour = Colour(214, 156, 24);
const BLACK: Colour = Colour(0, 0, 0);

/// Lines of the four joints, in the order of [`prone_record::pulls::JOINTS`].
pub(super) const JOINT_STROKES: [Stroke; 4] = [
    Stroke::solid(BLACK, CURVE_WIDTH).with_dash(Dash::Mixed),
    Stroke::solid(RED, CURVE_WIDTH),
    Stroke::solid(BLUE, CURVE_WIDTH).with_dash(Dash::Long),
    Stroke::solid(YELLOW, CURVE_WIDTH + 0.6),
];

/// Line of the `index`-th gait.
pub(super) fn gait_stroke(index: usize) -> Stroke {
    const STROKES: [Stroke; 4] = [
        Stroke::solid(BLUE, CURVE_WIDTH),
        Stroke::solid(YELLOW, CURVE_WIDTH + 0.4).with_dash(Dash::Long),
        Stroke::solid(RED, CURVE_WIDTH).with_dash(Dash::Mixed),
        Stroke::solid(BLACK, CURVE_WIDTH).with_dash(Dash::Short),
    ];
    STROKES[index % STROKES.len()]
}

/// Outline of the markers of the `index`-th gait.
pub(super) fn gait_shape(index: usize) -> Shape {
    const SHAPES: [Shape; 4] = [
        Shape::Circle,
        Shape::Square,
        Shape::Triangle,
        Shape::Diamond,
    ];
    SHAPES[index % SHAPES.len()]
}

/// Colour at `position`, 0 (dark) to 1 (light), of the map viridis (van der Walt and Smith, CC0).
///
/// The map stops short of its yellow end, which is lost on white paper.
pub(super) fn sequential(position: f64) -> Colour {
    const ANCHORS: [(f64, f64, f64); 8] = [
        (68.0, 1.0, 84.0),
        (70.0, 50.0, 126.0),
        (54.0, 92.0, 141.0),
        (39.0, 127.0, 142.0),
        (31.0, 161.0, 135.0),
        (74.0, 193.0, 109.0),
        (108.0, 205.0, 90.0),
        (144.0, 215.0, 67.0),
    ];
    between(&ANCHORS, position)
}

/// Colour at `position`, −1 to 1, of Paul Tol's diverging map "sunset": blue below zero, pale at
/// zero, red above, apart for every kind of colour blindness.
pub(super) fn diverging(position: f64) -> Colour {
    const ANCHORS: [(f64, f64, f64); 11] = [
        (54.0, 75.0, 154.0),
        (74.0, 123.0, 183.0),
        (110.0, 166.0, 205.0),
        (152.0, 202.0, 225.0),
        (194.0, 228.0, 239.0),
        (234.0, 236.0, 204.0),
        (254.0, 218.0, 139.0),
        (253.0, 179.0, 102.0),
        (246.0, 126.0, 75.0),
        (221.0, 61.0, 45.0),
        (165.0, 0.0, 38.0),
    ];
    between(&ANCHORS, f64::midpoint(position, 1.0))
}

/// The colour at `position`, 0 to 1, along equally spaced anchors.
fn between(anchors: &[(f64, f64, f64)], position: f64) -> Colour {
    let place = position.clamp(0.0, 1.0) * (anchors.len() - 1) as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 10"
    )]
    let below = (place as usize).min(anchors.len() - 2);
    let part = place - below as f64;
    let (a, b) = (anchors[below], anchors[below + 1]);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 to 255"
    )]
    let mix = |low: f64, high: f64| (low + part * (high - low)).round() as u8;
    Colour(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

/// Colour of the `index`-th of `count` steps of a quantity.
pub(super) fn step_colour(index: usize, count: usize) -> Colour {
    sequential(index as f64 / count.saturating_sub(1).max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Luma of ITU-R BT.601, as a grey printer mixes it.
    fn luma(colour: Colour) -> f64 {
        0.299 * f64::from(colour.0) + 0.587 * f64::from(colour.1) + 0.114 * f64::from(colour.2)
    }

    #[test]
    fn sequential_colours_grow_lighter() {
        let steps: Vec<f64> = (0..=10).map(|i| luma(step_colour(i, 11))).collect();
        assert!(steps.windows(2).all(|pair| pair[0] < pair[1]), "{steps:?}");
    }

    #[test]
    fn diverging_colours_are_lightest_at_zero_and_darken_outwards() {
        let half = |sign: f64| (0..=10).map(move |i| luma(diverging(sign * f64::from(i) / 10.0)));
        for sign in [-1.0, 1.0] {
            let steps: Vec<f64> = half(sign).collect();
            assert!(steps.windows(2).all(|pair| pair[0] > pair[1]), "{steps:?}");
        }
        // Without hue the two ends are alike; the two signs differ in red against blue.
        let (below, above) = (diverging(-0.5), diverging(0.5));
        assert!(below.2 > below.0 && above.0 > above.2);
    }

    #[test]
    fn solid_joint_lines_differ_in_grey() {
        let solid: Vec<f64> = JOINT_STROKES
            .iter()
            .filter(|stroke| stroke.dash == Dash::Solid)
            .map(|stroke| luma(stroke.colour))
            .collect();
        // A sixth of the scale apart: two solid lines a reader can still name in grey.
        assert!((solid[0] - solid[1]).abs() > 255.0 / 6.0, "{solid:?}");
    }

    #[test]
    fn a_single_step_has_a_colour() {
        assert_eq!(step_colour(0, 1), sequential(0.0));
    }
}
