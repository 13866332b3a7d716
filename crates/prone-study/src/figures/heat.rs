//! Heat maps: cells coloured by a quantity of either sign, and what the colours mean.
//!
//! Cells without a value are grey and hatched, so that none of them passes for a small value.

use super::axis::Axis;
use super::sheet::bar_label;
use super::style::{Colour, HATCHING, INK, NOTHING, SMALL_SIZE, Stroke, diverging};
use super::svg::{Anchor, Canvas, Rect, TextStyle};

/// How far an area reaches under the next one: coordinates are rounded, and paper must not show
/// between the two.
const OVERLAP: f64 = 0.5;

/// A diverging scale around zero.
#[derive(Debug, Clone)]
pub(super) struct HeatScale {
    /// From −limit to +limit, with quantity and unit.
    axis: Axis,
}

/// The cells of a heat map, all of the same size.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    pub(super) columns: usize,
    /// From the lowest row to the highest, each from left to right.
    pub(super) values: Vec<Option<f64>>,
    pub(super) scale: HeatScale,
}

impl HeatScale {
    /// The scale on which all values fit, and as much of the other sign.
    pub(super) fn covering(label: &str, values: impl Iterator<Item = f64>) -> Self {
        let limit = values.map(f64::abs).fold(0.0, f64::max);
        let round = Axis::covering(label, [-limit, limit]);
        let axis = Axis::exactly(label, -round.high, round.high);
        Self { axis }
    }

    fn colour(&self, value: f64) -> Colour {
        diverging(value / self.axis.high)
    }

    /// Draws the scale as an upright bar.
    pub(super) fn draw(&self, canvas: &mut Canvas, area: Rect) {
        /// Bands of the bar: more than an eye tells apart.
        const BANDS: usize = 100;
        /// Length of a tick.
        const TICK: f64 = 4.0;
        let height = area.height / BANDS as f64;
        canvas.crisp(|canvas| {
            for band in 0..BANDS {
                let share = (band as f64 + 0.5) / BANDS as f64;
                let top = area.bottom() - (band + 1) as f64 * height;
                let value = self.axis.low + share * (self.axis.high - self.axis.low);
                canvas.fill(
                    Rect {
                        top,
                        height,
                        ..area
                    },
                    self.colour(value),
                );
            }
        });
        canvas.outline(area, Stroke::solid(INK, 1.0));
        let ticks = self.axis.ticks(10).major;
        for (value, label) in &ticks {
            let y = area.bottom() - self.axis.fraction(*value) * area.height;
            let ink = Stroke::solid(INK, 1.0);
            canvas.line((area.right(), y), (area.right() + TICK, y), ink);
            let at = (area.right() + TICK + 3.0, y + SMALL_SIZE * 0.35);
            canvas.text(at, label, TextStyle::new(SMALL_SIZE, Anchor::Start));
        }
        let values = ticks.iter().map(|tick| tick.1.as_str());
        bar_label(canvas, area, &self.axis.label, values);
    }
}

impl Cells {
    /// Fills `frame` with the cells.
    pub(super) fn draw(&self, canvas: &mut Canvas, frame: Rect) {
        canvas.crisp(|canvas| {
            for (index, value) in self.values.iter().enumerate() {
                let colour = value.map_or(NOTHING, |value| self.scale.colour(value));
                canvas.fill(self.overlapping(index, frame), colour);
            }
        });
        for (index, value) in self.values.iter().enumerate() {
            if value.is_none() {
                hatch_lines(canvas, self.cell(index, frame));
            }
        }
    }

    /// A cell, and a little of those that are drawn after it.
    fn overlapping(&self, index: usize, frame: Rect) -> Rect {
        let cell = self.cell(index, frame);
        let (row, column) = (index / self.columns.max(1), index % self.columns.max(1));
        let beyond = |place: usize, count: usize| if place + 1 < count { OVERLAP } else { 0.0 };
        let (right, up) = (beyond(column, self.columns), beyond(row, self.rows()));
        Rect {
            top: cell.top - up,
            width: cell.width + right,
            height: cell.height + up,
            ..cell
        }
    }

    fn rows(&self) -> usize {
        self.values.len().div_ceil(self.columns.max(1)).max(1)
    }

    fn cell(&self, index: usize, frame: Rect) -> Rect {
        let (columns, rows) = (self.columns.max(1), self.rows());
        let (row, column) = ((index / columns) as f64, (index % columns) as f64);
        let (width, height) = (frame.width / columns as f64, frame.height / rows as f64);
        Rect {
            left: frame.left + column * width,
            top: frame.bottom() - (row + 1.0) * height,
            width,
            height,
        }
    }
}

/// An area that has no value.
pub(super) fn hatch(canvas: &mut Canvas, area: Rect) {
    canvas.fill(area, NOTHING);
    hatch_lines(canvas, area);
}

/// Rising lines, which meet those of a neighbour of the same size.
fn hatch_lines(canvas: &mut Canvas, area: Rect) {
    let squares = (area.width / area.height).round().max(1.0);
    let width = area.width / squares;
    let line = Stroke::solid(HATCHING, 0.7);
    let (top, bottom) = (area.top, area.bottom());
    let middle = f64::midpoint(top, bottom);
    let mut left = area.left;
    while left + width / 2.0 < area.right() {
        let (centre, right) = (left + width / 2.0, left + width);
        canvas.line((left, middle), (centre, top), line);
        canvas.line((left, bottom), (right, top), line);
        canvas.line((centre, bottom), (right, middle), line);
        left = right;
    }
}
