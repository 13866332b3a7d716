//! A whole drawing: title, key, a grid of panels, a colour bar.
//!
//! The key stands above the panels and the bar beside them, so that neither covers a curve.

use super::bar::Bar;
use super::font::{self, Weight};
use super::heat;
use super::panel::Panel;
use super::style::{Colour, INK, Marker, SHEET_WIDTH, Stroke, TEXT_SIZE, TITLE_SIZE};
use super::svg::{Anchor, Canvas, Look, Point, Rect, TextStyle};
use super::{Figure, FigureError, Wording, file_stem};

/// Paper around everything.
const MARGIN: f64 = 12.0;
/// Above a frame: the panel's title.
const ABOVE: f64 = 28.0;
/// Below a frame: labels of ticks and axis.
const BELOW: f64 = 50.0;
/// Between a frame and the next panel's labels; a tick's label may stick out this far.
const BESIDE: f64 = 18.0;
/// Height of a line of the key.
const KEY_LINE: f64 = 22.0;
/// Length of a line's sample in the key.
const SAMPLE: f64 = 34.0;
/// Width kept for the colour bar.
const BAR_SPACE: f64 = 84.0;

/// What to draw on one sheet.
#[derive(Debug, Clone)]
pub(super) struct Sheet {
    pub(super) key: Vec<KeyEntry>,
    pub(super) bar: Option<Bar>,
    pub(super) columns: usize,
    /// Height of each panel's frame.
    pub(super) frame_height: f64,
    /// Row by row.
    pub(super) panels: Vec<Panel>,
}

/// One way of drawing and its meaning.
#[derive(Debug, Clone)]
pub(super) struct KeyEntry {
    pub(super) label: String,
    pub(super) sample: Sample,
}

/// What stands beside a label of the key.
#[derive(Debug, Clone, Copy)]
pub(super) enum Sample {
    /// A line style.
    Line {
        stroke: Stroke,
        marker: Option<Marker>,
    },
    /// A range behind curves.
    Band(Colour),
    /// The cells of a heat map that have no value.
    Hatched,
}

/// Beyond this a difference between neighbouring values is lost; no quantity here comes near it.
const LARGEST: f64 = 1e9;

impl Sheet {
    /// Panels in columns, without key and bar.
    pub(super) fn new(
        columns: usize,
        frame_height: f64,
        panels: impl IntoIterator<Item = Panel>,
    ) -> Self {
        Self {
            key: Vec::new(),
            bar: None,
            columns,
            frame_height,
            panels: panels.into_iter().collect(),
        }
    }

    /// The same with a key.
    pub(super) fn with_key(self, key: impl IntoIterator<Item = KeyEntry>) -> Self {
        let key = key.into_iter().collect();
        Self { key, ..self }
    }

    /// The same with a bar.
    pub(super) fn with_bar(self, bar: Bar) -> Self {
        let bar = Some(bar);
        Self { bar, ..self }
    }

    /// The figure, unless it holds a number that no axis can show.
    pub(super) fn figure(&self, wording: Wording) -> Result<Figure, FigureError> {
        for panel in &self.panels {
            let points = panel.curves.iter().flat_map(|curve| &curve.points);
            let cells = panel.cells.iter().flat_map(|cells| &cells.values);
            let values = points.flat_map(|point| [point.0, point.1]);
            let mut values = values.chain(cells.filter_map(|value| *value));
            // Not a number is none of these.
            if let Some(value) = values.find(|value| !(-LARGEST..=LARGEST).contains(value)) {
                let place = format!("{}, panel {}", wording.stem, panel.title);
                return Err(FigureError::Value { place, value });
            }
        }
        let stem = file_stem(&wording.stem);
        Ok(Figure {
            svg: self.draw(&stem, &wording.title, &wording.alt),
            stem,
            number: wording.number,
            title: wording.title,
            caption: wording.caption,
            alt: wording.alt,
        })
    }

    /// The drawing as SVG.
    fn draw(&self, stem: &str, title: &str, description: &str) -> String {
        let key = self.key_places();
        let key_lines = key.last().map_or(0.0, |place| place.1 + 1.0);
        let top = MARGIN + TITLE_SIZE + 8.0 + key_lines * KEY_LINE;
        let rows = self.panels.len().div_ceil(self.columns.max(1)) as f64;
        let height = top + rows * (ABOVE + self.frame_height + BELOW) + MARGIN / 2.0;

        let mut canvas = Canvas::new(stem, SHEET_WIDTH, height);
        let heading = TextStyle::plain(TITLE_SIZE, Anchor::Start).looking(Look::Bold);
        canvas.text((MARGIN, MARGIN + TITLE_SIZE * 0.85), title, heading);
        for (entry, place) in self.key.iter().zip(key) {
            let middle = MARGIN + TITLE_SIZE + 8.0 + (place.1 + 0.5) * KEY_LINE;
            entry.draw(&mut canvas, (place.0, middle));
        }
        self.draw_panels(&mut canvas, top);
        if let Some(bar) = &self.bar {
            let (top, bottom) = (top + ABOVE, height - MARGIN / 2.0 - BELOW);
            let left = SHEET_WIDTH - BAR_SPACE + 10.0;
            bar.draw(&mut canvas, Rect::new(left, top, 16.0, bottom - top));
        }
        canvas.finish(title, description)
    }

    fn draw_panels(&self, canvas: &mut Canvas, top: f64) {
        let columns = self.columns.max(1);
        let ticks = self
            .panels
            .iter()
            .map(|panel| panel.tick_label_width(self.frame_height));
        let label_gap = ticks.fold(0.0, f64::max) + 14.0;
        let left = label_gap + TEXT_SIZE + 4.0;
        let right = if self.bar.is_some() {
            BAR_SPACE
        } else {
            MARGIN / 2.0
        };
        let cell = (SHEET_WIDTH - MARGIN / 2.0 - right) / columns as f64;
        for (index, panel) in self.panels.iter().enumerate() {
            let (row, column) = ((index / columns) as f64, (index % columns) as f64);
            let across = MARGIN / 2.0 + column * cell + left;
            let down = top + row * (ABOVE + self.frame_height + BELOW) + ABOVE;
            let frame = Rect::new(across, down, cell - left - BESIDE, self.frame_height);
            panel.draw(canvas, frame, label_gap);
        }
    }

    /// Left end and line of each entry of the key.
    fn key_places(&self) -> Vec<Point> {
        let (mut left, mut line) = (MARGIN, 0.0);
        let mut places = Vec::new();
        for entry in &self.key {
            let width = entry.width();
            if left > MARGIN && left + width > SHEET_WIDTH - MARGIN {
                (left, line) = (MARGIN, line + 1.0);
            }
            places.push((left, line));
            left += width;
        }
        places
    }
}

impl KeyEntry {
    /// A line style and its meaning.
    pub(super) fn line(label: String, stroke: Stroke, marker: Option<Marker>) -> Self {
        let sample = Sample::Line { stroke, marker };
        Self { label, sample }
    }

    /// A range and its meaning.
    pub(super) fn band(label: String, colour: Colour) -> Self {
        Self {
            label,
            sample: Sample::Band(colour),
        }
    }

    /// Room for sample, label and a gap; some to spare where another font is wider.
    fn width(&self) -> f64 {
        SAMPLE + 8.0 + font::width(&self.label, TEXT_SIZE, Weight::Regular) * 1.05 + 20.0
    }

    fn draw(&self, canvas: &mut Canvas, (left, middle): Point) {
        let area = Rect::new(left, middle - 7.0, SAMPLE, 14.0);
        match self.sample {
            Sample::Line { stroke, marker } => {
                canvas.line((left, middle), (left + SAMPLE, middle), stroke);
                if let Some(marker) = marker {
                    canvas.marker((left + SAMPLE / 2.0, middle), marker, stroke.colour);
                }
            }
            Sample::Band(colour) => canvas.fill(area, colour),
            Sample::Hatched => {
                heat::hatch(canvas, area);
                canvas.outline(area, Stroke::solid(INK, 0.7));
            }
        }
        let at = (left + SAMPLE + 8.0, middle + TEXT_SIZE * 0.35);
        canvas.text(at, &self.label, TextStyle::plain(TEXT_SIZE, Anchor::Start));
    }
}
