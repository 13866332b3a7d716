//! Heat maps: cells coloured by a quantity of either sign.
//!
//! Cells without a value are grey and hatched, so that none of them passes for a small value.

use super::bar::HeatScale;
use super::style::{HATCHING, NOTHING, Stroke};
use super::svg::{Canvas, Rect};

/// How far an area reaches under the next one: coordinates are rounded, and paper must not show
/// between the two.
const OVERLAP: f64 = 0.5;

/// The cells of a heat map, all of the same size.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    pub(super) columns: usize,
    /// From the lowest row to the highest, each from left to right.
    pub(super) values: Vec<Option<f64>>,
    pub(super) scale: HeatScale,
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
        let (width, height) = (cell.width + right, cell.height + up);
        Rect::new(cell.left, cell.top - up, width, height)
    }

    fn rows(&self) -> usize {
        self.values.len().div_ceil(self.columns.max(1)).max(1)
    }

    fn cell(&self, index: usize, frame: Rect) -> Rect {
        let (columns, rows) = (self.columns.max(1), self.rows());
        let (row, column) = ((index / columns) as f64, (index % columns) as f64);
        let (width, height) = (frame.width / columns as f64, frame.height / rows as f64);
        let left = frame.left + column * width;
        Rect::new(left, frame.bottom() - (row + 1.0) * height, width, height)
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
