//! One plot: a frame with two axes, curves or the cells of a heat map inside, notes beside their
//! points.

use super::axis::{Axis, Ticks};
use super::font::{self, Weight};
use super::heat::Cells;
use super::style::{BAND, GRID, INK, MINOR_GRID, Marker, REFERENCE, SMALL_SIZE, Stroke, TEXT_SIZE};
use super::svg::{Anchor, Canvas, Look, Point, Rect, TextStyle};

/// Units of the drawing per labelled tick, at least.
const ACROSS_PER_TICK: f64 = 40.0;
const UP_PER_TICK: f64 = 20.0;
/// Gap between the frame and the labels of its ticks.
const TICK_GAP: f64 = 6.0;

/// Whether both axes have the same scale.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Aspect {
    /// Each axis fills its side of the frame.
    Free,
    /// One unit is as long across as it is up; the upper ends give way.
    Equal,
}

/// One plot.
#[derive(Debug, Clone)]
pub(super) struct Panel {
    pub(super) title: String,
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) aspect: Aspect,
    /// Over the whole frame, below everything else.
    pub(super) cells: Option<Cells>,
    /// Below the rules.
    pub(super) bands: Vec<Band>,
    /// Below the curves.
    pub(super) rules: Vec<Rule>,
    /// Later ones above earlier ones.
    pub(super) curves: Vec<Curve>,
    /// Above the curves.
    pub(super) notes: Vec<Note>,
}

/// Points joined by a line, in the units of the axes.
#[derive(Debug, Clone)]
pub(super) struct Curve {
    pub(super) points: Vec<Point>,
    pub(super) stroke: Stroke,
    pub(super) marker: Option<Marker>,
}

impl Curve {
    /// A line without markers.
    pub(super) const fn new(points: Vec<Point>, stroke: Stroke) -> Self {
        let marker = None;
        Self {
            points,
            stroke,
            marker,
        }
    }
}

/// A level stripe from edge to edge.
#[derive(Debug, Clone, Copy)]
pub(super) struct Band {
    pub(super) low: f64,
    pub(super) high: f64,
}

/// A straight line from edge to edge.
#[derive(Debug, Clone, Copy)]
pub(super) enum Rule {
    /// Upright, at this x.
    At(f64, Stroke),
    /// Level, at this y.
    Level(f64, Stroke),
}

/// A few words beside a point.
#[derive(Debug, Clone)]
pub(super) struct Note {
    /// The point, in the units of the axes.
    pub(super) at: Point,
    /// From the point to the text, in units of the drawing: right, down.
    pub(super) offset: Point,
    pub(super) anchor: Anchor,
    pub(super) text: String,
}

impl Panel {
    /// A plot of `curves`, with a line at zero if zero is in range.
    pub(super) fn new(title: impl Into<String>, x: Axis, y: Axis, curves: Vec<Curve>) -> Self {
        let zero = y
            .contains(0.0)
            .then_some(Rule::Level(0.0, Stroke::solid(REFERENCE, 1.0)));
        Self {
            title: title.into(),
            x,
            y,
            aspect: Aspect::Free,
            cells: None,
            bands: Vec::new(),
            rules: zero.into_iter().collect(),
            curves,
            notes: Vec::new(),
        }
    }

    /// Widest label of the ticks on the left of a frame of this height.
    pub(super) fn tick_label_width(&self, frame_height: f64) -> f64 {
        let widths = ticks_up(&self.y, frame_height).major;
        widths
            .iter()
            .map(|tick| font::width(&tick.1, SMALL_SIZE, Weight::Regular))
            .fold(0.0, f64::max)
    }

    /// Draws the plot; labels go outside `frame`, the one on the left `label_gap` away from it.
    pub(super) fn draw(&self, canvas: &mut Canvas, frame: Rect, label_gap: f64) {
        let (x, y) = self.scaled(frame);
        let view = View { x, y, frame };
        for band in &self.bands {
            view.draw_band(canvas, *band);
        }
        view.draw_grid(canvas);
        if let Some(cells) = &self.cells {
            cells.draw(canvas, frame);
        }
        canvas.clipped(frame, |canvas| {
            for rule in &self.rules {
                view.draw_rule(canvas, *rule);
            }
            for curve in &self.curves {
                view.draw_curve(canvas, curve);
            }
        });
        canvas.outline(frame, Stroke::solid(INK, 1.0));
        view.draw_labels(canvas, label_gap);
        for note in &self.notes {
            view.draw_note(canvas, note);
        }
        let title = TextStyle::plain(TEXT_SIZE, Anchor::Start).looking(Look::Bold);
        canvas.text((frame.left, frame.top - 7.0), &self.title, title);
    }

    /// The axes, longer where equal scales ask for it.
    fn scaled(&self, frame: Rect) -> (Axis, Axis) {
        let (mut x, mut y) = (self.x.clone(), self.y.clone());
        if self.aspect == Aspect::Equal {
            let scale = ((x.high - x.low) / frame.width).max((y.high - y.low) / frame.height);
            x.high = x.low + scale * frame.width;
            y.high = y.low + scale * frame.height;
        }
        (x, y)
    }
}

/// Axes laid on a frame.
struct View {
    x: Axis,
    y: Axis,
    frame: Rect,
}

impl View {
    fn x_ticks(&self) -> Ticks {
        self.x.ticks(whole(self.frame.width / ACROSS_PER_TICK))
    }

    fn y_ticks(&self) -> Ticks {
        ticks_up(&self.y, self.frame.height)
    }

    fn across(&self, x: f64) -> f64 {
        self.frame.left + self.x.fraction(x) * self.frame.width
    }

    fn down(&self, y: f64) -> f64 {
        self.frame.bottom() - self.y.fraction(y) * self.frame.height
    }

    fn place(&self, point: &Point) -> Point {
        (self.across(point.0), self.down(point.1))
    }

    fn draw_grid(&self, canvas: &mut Canvas) {
        let (x, y) = (self.x_ticks(), self.y_ticks());
        let fine = x.minor.iter().map(|x| self.upright(*x));
        let fine = fine.chain(y.minor.iter().map(|y| self.level(*y)));
        canvas.lines(&fine.collect::<Vec<_>>(), Stroke::solid(MINOR_GRID, 0.7));
        let coarse = x.major.iter().map(|tick| self.upright(tick.0));
        let coarse = coarse.chain(y.major.iter().map(|tick| self.level(tick.0)));
        canvas.lines(&coarse.collect::<Vec<_>>(), Stroke::solid(GRID, 0.9));
    }

    fn draw_band(&self, canvas: &mut Canvas, band: Band) {
        /// A range of one value is seen too.
        const THINNEST: f64 = 3.0;
        let (top, bottom) = (self.down(band.high), self.down(band.low));
        let middle = f64::midpoint(top, bottom);
        let height = (bottom - top).max(THINNEST);
        let top = middle - height / 2.0;
        canvas.fill(
            Rect::new(self.frame.left, top, self.frame.width, height),
            BAND,
        );
    }

    fn draw_rule(&self, canvas: &mut Canvas, rule: Rule) {
        let ((from, to), stroke) = match rule {
            Rule::At(x, stroke) => (self.upright(x), stroke),
            Rule::Level(y, stroke) => (self.level(y), stroke),
        };
        canvas.line(from, to, stroke);
    }

    /// Ends of the upright line at `x`.
    fn upright(&self, x: f64) -> (Point, Point) {
        let x = self.across(x);
        ((x, self.frame.top), (x, self.frame.bottom()))
    }

    /// Ends of the level line at `y`.
    fn level(&self, y: f64) -> (Point, Point) {
        let y = self.down(y);
        ((self.frame.left, y), (self.frame.right(), y))
    }

    fn draw_curve(&self, canvas: &mut Canvas, curve: &Curve) {
        let points: Vec<Point> = curve.points.iter().map(|point| self.place(point)).collect();
        canvas.curve(&points, curve.stroke);
        if let Some(marker) = curve.marker {
            for at in points {
                canvas.marker(at, marker, curve.stroke.colour);
            }
        }
    }

    fn draw_labels(&self, canvas: &mut Canvas, label_gap: f64) {
        let frame = self.frame;
        let below = frame.bottom() + TICK_GAP + SMALL_SIZE * 0.8;
        for (value, label) in self.x_ticks().major {
            let style = TextStyle::plain(SMALL_SIZE, Anchor::Middle);
            canvas.text((self.across(value), below), &label, style);
        }
        for (value, label) in self.y_ticks().major {
            let at = (frame.left - TICK_GAP, self.down(value) + SMALL_SIZE * 0.35);
            canvas.text(at, &label, TextStyle::plain(SMALL_SIZE, Anchor::End));
        }
        let style = TextStyle::plain(TEXT_SIZE, Anchor::Middle);
        let below = (frame.left + frame.width / 2.0, below + TEXT_SIZE * 1.4);
        canvas.text(below, &self.x.label, style);
        let beside = (frame.left - label_gap, frame.top + frame.height / 2.0);
        canvas.text(beside, &self.y.label, style.looking(Look::Upward));
    }

    fn draw_note(&self, canvas: &mut Canvas, note: &Note) {
        let (across, down) = self.place(&note.at);
        let at = (across + note.offset.0, down + note.offset.1);
        let style = TextStyle::plain(SMALL_SIZE, note.anchor);
        canvas.text(at, &note.text, style.looking(Look::Halo));
    }
}

fn ticks_up(axis: &Axis, height: f64) -> Ticks {
    axis.ticks(whole(height / UP_PER_TICK))
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a few ticks"
)]
fn whole(count: f64) -> usize {
    count as usize
}
