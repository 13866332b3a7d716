//! What the colours of a drawing mean: the bar beside its panels.

use super::axis::Axis;
use super::font::{self, Weight};
use super::style::{Colour, INK, SMALL_SIZE, Stroke, TEXT_SIZE, diverging, step_colour};
use super::svg::{Anchor, Canvas, Look, Rect, TextStyle};

/// Height of one step of the colour bar, at most.
const HIGHEST_BAND: f64 = 70.0;

/// What the colours mean.
#[derive(Debug, Clone)]
pub(super) enum Bar {
    /// Of curves.
    Steps(ColourBar),
    /// Of the cells of a heat map.
    Scale(HeatScale),
}

/// Colours of the steps of a quantity.
#[derive(Debug, Clone)]
pub(super) struct ColourBar {
    /// Quantity and unit.
    pub(super) label: String,
    /// One band each, from the dark end to the light one.
    pub(super) steps: Vec<String>,
}

/// A diverging scale around zero.
#[derive(Debug, Clone)]
pub(super) struct HeatScale {
    /// From −limit to +limit, with quantity and unit.
    axis: Axis,
}

impl Bar {
    /// Draws the bar into `area`, its labels to the right of it.
    pub(super) fn draw(&self, canvas: &mut Canvas, area: Rect) {
        match self {
            Self::Steps(bar) => bar.draw(canvas, area),
            Self::Scale(scale) => scale.draw(canvas, area),
        }
    }
}

impl ColourBar {
    /// Colour of the band `index`.
    pub(super) fn colour(&self, index: usize) -> Colour {
        step_colour(index, self.steps.len())
    }

    /// Draws the bar in the middle of `area`, as high as its steps need.
    fn draw(&self, canvas: &mut Canvas, area: Rect) {
        let count = self.steps.len().max(1) as f64;
        let band = (area.height / count).min(HIGHEST_BAND);
        let (middle, height) = (f64::midpoint(area.top, area.bottom()), count * band);
        let area = Rect::new(area.left, middle - height / 2.0, area.width, height);
        for (index, step) in self.steps.iter().enumerate() {
            let top = area.bottom() - (index as f64 + 1.0) * band;
            let step_area = Rect::new(area.left, top, area.width, band);
            canvas.fill(step_area, self.colour(index));
            let at = (area.right() + 6.0, top + band / 2.0 + SMALL_SIZE * 0.35);
            canvas.text(at, step, TextStyle::plain(SMALL_SIZE, Anchor::Start));
        }
        canvas.outline(area, Stroke::solid(INK, 1.0));
        let values = self.steps.iter().map(String::as_str);
        label(canvas, area, &self.label, values);
    }
}

impl HeatScale {
    /// The scale on which all values fit, and as much of the other sign.
    pub(super) fn covering(label: &str, values: impl Iterator<Item = f64>) -> Self {
        let limit = values.map(f64::abs).fold(0.0, f64::max);
        let round = Axis::covering(label, [-limit, limit]);
        let axis = Axis::exactly(label, -round.high, round.high);
        Self { axis }
    }

    pub(super) fn colour(&self, value: f64) -> Colour {
        diverging(value / self.axis.high)
    }

    /// Draws the scale as an upright bar.
    fn draw(&self, canvas: &mut Canvas, area: Rect) {
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
                let band_area = Rect::new(area.left, top, area.width, height);
                canvas.fill(band_area, self.colour(value));
            }
        });
        canvas.outline(area, Stroke::solid(INK, 1.0));
        let ticks = self.axis.ticks(10).major;
        for (value, label) in &ticks {
            let y = area.bottom() - self.axis.fraction(*value) * area.height;
            let ink = Stroke::solid(INK, 1.0);
            canvas.line((area.right(), y), (area.right() + TICK, y), ink);
            let at = (area.right() + TICK + 3.0, y + SMALL_SIZE * 0.35);
            canvas.text(at, label, TextStyle::plain(SMALL_SIZE, Anchor::Start));
        }
        let values = ticks.iter().map(|tick| tick.1.as_str());
        label(canvas, area, &self.axis.label, values);
    }
}

/// Writes what a bar means beside the labels of its values.
fn label<'a>(
    canvas: &mut Canvas,
    area: Rect,
    meaning: &str,
    values: impl Iterator<Item = &'a str>,
) {
    let widths = values.map(|value| font::width(value, SMALL_SIZE, Weight::Regular));
    let across = area.right() + 6.0 + widths.fold(0.0, f64::max) + 4.0 + TEXT_SIZE;
    let at = (across, area.top + area.height / 2.0);
    let style = TextStyle::plain(TEXT_SIZE, Anchor::Middle).looking(Look::Upward);
    canvas.text(at, meaning, style);
}
