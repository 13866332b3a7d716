//! A canvas that writes SVG: lines, curves, markers, texts, nothing about plots.
//!
//! Coordinates are rounded to a hundredth of a unit, so that the bytes are the same everywhere.

use super::style::{Colour, FONT_FAMILY, Fill, INK, Marker, PAPER, Shape, Stroke};
use crate::markup::escaped;

/// A place on the canvas: right, down.
pub(super) type Point = (f64, f64);

/// An upright rectangle on the canvas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Rect {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Rect {
    pub(super) const fn new(left: f64, top: f64, width: f64, height: f64) -> Self {
        Self {
            left,
            top,
            width,
            height,
        }
    }

    pub(super) fn right(&self) -> f64 {
        self.left + self.width
    }

    pub(super) fn bottom(&self) -> f64 {
        self.top + self.height
    }
}

/// Which end of a text its place is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// How a text stands out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Look {
    Plain,
    Bold,
    /// Running up.
    Upward,
    /// With a rim of paper, so that a line behind does not run into the letters.
    Halo,
}

/// How a text is set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct TextStyle {
    pub(super) size: f64,
    pub(super) anchor: Anchor,
    pub(super) look: Look,
}

impl TextStyle {
    /// A text without a special look.
    pub(super) const fn plain(size: f64, anchor: Anchor) -> Self {
        Self {
            size,
            anchor,
            look: Look::Plain,
        }
    }

    /// The same with another look.
    pub(super) const fn looking(self, look: Look) -> Self {
        Self { look, ..self }
    }
}

/// An SVG document being drawn.
pub(super) struct Canvas {
    stem: String,
    size: (f64, f64),
    body: String,
    clips: usize,
}

impl Canvas {
    /// White paper; `stem` makes the document's identifiers unique where several share a page.
    pub(super) fn new(stem: &str, width: f64, height: f64) -> Self {
        let mut canvas = Self {
            stem: stem.to_owned(),
            size: (width, height),
            body: String::new(),
            clips: 0,
        };
        canvas.fill(Rect::new(0.0, 0.0, width, height), PAPER);
        canvas
    }

    /// A filled rectangle without outline.
    pub(super) fn fill(&mut self, area: Rect, colour: Colour) {
        self.element(&format!(
            "<rect{} fill=\"{}\"/>",
            rectangle(area),
            hex(colour)
        ));
    }

    /// The outline of a rectangle.
    pub(super) fn outline(&mut self, area: Rect, stroke: Stroke) {
        self.element(&format!(
            "<rect{} fill=\"none\"{}/>",
            rectangle(area),
            line_style(stroke)
        ));
    }

    /// A straight line.
    pub(super) fn line(&mut self, from: Point, to: Point, stroke: Stroke) {
        self.curve(&[from, to], stroke);
    }

    /// Straight lines of one kind, as one element: a grid of many is small.
    pub(super) fn lines(&mut self, lines: &[(Point, Point)], stroke: Stroke) {
        if lines.is_empty() {
            return;
        }
        let segments = lines.iter().map(|(from, to)| {
            let [from_x, from_y, to_x, to_y] = [from.0, from.1, to.0, to.1].map(number);
            if from_x == to_x {
                format!("M{from_x} {from_y}V{to_y}")
            } else if from_y == to_y {
                format!("M{from_x} {from_y}H{to_x}")
            } else {
                format!("M{from_x} {from_y}L{to_x} {to_y}")
            }
        });
        let path: String = segments.collect();
        self.element(&format!(
            "<path d=\"{path}\" fill=\"none\"{}/>",
            line_style(stroke)
        ));
    }

    /// A line through all points.
    pub(super) fn curve(&mut self, points: &[Point], stroke: Stroke) {
        self.element(&format!(
            "<polyline points=\"{}\" fill=\"none\" stroke-linejoin=\"round\"{}/>",
            list(points),
            line_style(stroke)
        ));
    }

    /// A marker centred on `at`.
    pub(super) fn marker(&mut self, at: Point, marker: Marker, colour: Colour) {
        let fill = match marker.fill {
            Fill::Full => colour,
            Fill::Hollow => PAPER,
        };
        let outline = line_style(Stroke::solid(colour, marker.radius * 0.35));
        let shape = match corners(at, marker) {
            Some(points) => format!("<polygon points=\"{}\"", list(&points)),
            None => format!(
                "<circle cx=\"{}\" cy=\"{}\" r=\"{}\"",
                number(at.0),
                number(at.1),
                number(marker.radius)
            ),
        };
        self.element(&format!("{shape} fill=\"{}\"{outline}/>", hex(fill)));
    }

    /// A text whose baseline passes through `at`.
    pub(super) fn text(&mut self, at: Point, text: &str, style: TextStyle) {
        let (x, y) = (number(at.0), number(at.1));
        let anchor = match style.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let look = match style.look {
            Look::Plain => String::new(),
            Look::Bold => " font-weight=\"bold\"".to_owned(),
            Look::Upward => format!(" transform=\"rotate(-90 {x} {y})\""),
            Look::Halo => format!(
                " paint-order=\"stroke\" stroke-linejoin=\"round\"{}",
                line_style(Stroke::solid(PAPER, 4.0))
            ),
        };
        self.element(&format!(
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\"{look}>{}</text>",
            number(style.size),
            escaped(text)
        ));
    }

    /// Draws with everything outside `area` cut off.
    pub(super) fn clipped(&mut self, area: Rect, draw: impl FnOnce(&mut Self)) {
        self.clips += 1;
        let id = format!("{}-clip-{}", escaped(&self.stem), self.clips);
        self.element(&format!(
            "<clipPath id=\"{id}\"><rect{}/></clipPath>\n<g clip-path=\"url(#{id})\">",
            rectangle(area)
        ));
        draw(self);
        self.element("</g>");
    }

    /// Draws without smoothing edges, so that areas side by side show no seam.
    pub(super) fn crisp(&mut self, draw: impl FnOnce(&mut Self)) {
        self.element("<g shape-rendering=\"crispEdges\">");
        draw(self);
        self.element("</g>");
    }

    /// The document, with a name and a description for readers who do not see it.
    pub(super) fn finish(self, title: &str, description: &str) -> String {
        let (width, height) = (number(self.size.0), number(self.size.1));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
             viewBox=\"0 0 {width} {height}\" role=\"img\" font-family=\"{FONT_FAMILY}\" \
             fill=\"{}\">\n<title>{}</title>\n<desc>{}</desc>\n{}</svg>\n",
            hex(INK),
            escaped(title),
            escaped(description),
            self.body
        )
    }

    fn element(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }
}

/// Corners of a marker; a circle has none.
fn corners(at: Point, marker: Marker) -> Option<Vec<Point>> {
    let r = marker.radius;
    // Sides chosen so that all shapes look equally large.
    let (square, diamond) = (0.9, 1.25);
    let offsets: &[Point] = match marker.shape {
        Shape::Circle => return None,
        Shape::Square => &[
            (-square, -square),
            (square, -square),
            (square, square),
            (-square, square),
        ],
        Shape::Triangle => &[(0.0, -1.2), (1.1, 0.8), (-1.1, 0.8)],
        Shape::Diamond => &[
            (0.0, -diamond),
            (diamond, 0.0),
            (0.0, diamond),
            (-diamond, 0.0),
        ],
    };
    let corners = offsets.iter();
    Some(
        corners
            .map(|offset| (at.0 + r * offset.0, at.1 + r * offset.1))
            .collect(),
    )
}

fn rectangle(area: Rect) -> String {
    format!(
        " x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"",
        number(area.left),
        number(area.top),
        number(area.width),
        number(area.height)
    )
}

fn line_style(stroke: Stroke) -> String {
    let dash = stroke.dash.pattern().map_or_else(String::new, |pattern| {
        format!(" stroke-dasharray=\"{pattern}\"")
    });
    format!(
        " stroke=\"{}\" stroke-width=\"{}\"{dash}",
        hex(stroke.colour),
        number(stroke.width)
    )
}

fn list(points: &[Point]) -> String {
    let pairs: Vec<String> = points
        .iter()
        .map(|point| format!("{},{}", number(point.0), number(point.1)))
        .collect();
    pairs.join(" ")
}

fn hex(colour: Colour) -> String {
    format!("#{:02x}{:02x}{:02x}", colour.0, colour.1, colour.2)
}

/// A coordinate with at most two decimals.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        let written = [1.0, 100.0, 0.125, -0.001, 12.5].map(number);
        assert_eq!(written, ["1", "100", "0.12", "0", "12.5"]);
    }
}
