//! The figures of the published results, drawn again from records.
//!
//! Each drawing is SVG; its PNG is rasterised from that same SVG. Same records, same bytes.
//! Numbers are those of the thesis' chapter 5, and go with the gaits named "nominal" and
//! "optimal"; figures that compare gaits show every gait there is. What the records lack is left
//! out: a panel, a curve or a whole figure.
//!
//! `records` holds what is drawn and is not in `prone_record::pulls`. `style` is the look, `svg` and `font`
//! draw, `axis`, `bar`, `panel` and `sheet` lay out, `raster` makes pixels; `parameters`, `chain`, `torque`, `comparison` and `cost` are the figures. `torque_map` draws
//! what the thesis does not: slices of a map, with the cells and colours of `heat`.

mod axis;
mod bar;
mod chain;
mod comparison;
mod cost;
mod crawl_angles;
mod font;
mod frontier;
mod heat;
mod panel;
mod parameters;
pub mod raster;
mod records;
mod search;
mod selection;
mod sheet;
mod style;
mod svg;
#[cfg(test)]
mod tests;
mod torque;
mod torque_map;

pub(crate) use axis::extremes;
pub use crawl_angles::figure as crawl_angles;
pub use frontier::figure as frontier_figure;
pub(crate) use parameters::figure as parameters;
pub use records::{
    AngleRecord, AngleRow, ConfirmedRecord, GenerationRecord, PublishedRange, Scores, SearchRecord,
};
pub use search::{confirmation, generations};
pub(crate) use selection::each_once;

use prone_record::pulls::{ChainRecord, CostRecord, PullRecord};
pub use torque_map::figures as torque_map_figures;

/// Pixels per unit of an SVG figure in the PNG that lies beside it.
pub const PNG_SCALE: f32 = 2.0;

/// One finished drawing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Figure {
    /// Name of its files, without extension.
    pub stem: String,
    /// Number of its original in the thesis; empty where it has none.
    pub number: &'static str,
    /// A few words.
    pub title: String,
    /// What is shown, in which unit, from which source.
    pub caption: String,
    /// Description for readers who do not see it.
    pub alt: String,
    /// The drawing.
    pub svg: String,
}

/// Why figures could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// A record holds a number no axis can show.
    #[error("{place}: {value} cannot be drawn")]
    Value {
        /// Where the number is.
        place: String,
        /// The number.
        value: f64,
    },
    /// The drawing is not valid SVG.
    #[error("the drawing cannot be read back: {0}")]
    Parse(#[from] resvg::usvg::Error),
    /// The picture would have no pixels, or far too many.
    #[error("scale {scale} gives no picture of usable size")]
    Scale {
        /// Pixels per unit asked for.
        scale: f32,
    },
    /// The picture could not be written as PNG.
    #[error("the picture cannot be encoded: {0}")]
    Encode(String),
}

impl Figure {
    /// The same drawing as PNG, `scale` pixels per unit of the SVG (which is 900 units wide).
    ///
    /// # Errors
    /// If `scale` is not a positive number of reasonable size, or the SVG was altered.
    pub fn png(&self, scale: f32) -> Result<Vec<u8>, FigureError> {
        raster::png(&self.svg, scale)
    }
}

/// A gait of a publication, with the numbers of the figures that show it alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaitNumbers {
    /// Its name.
    pub gait: &'static str,
    /// Of the planned chain.
    pub chain: &'static str,
    /// Of the pictures over a pull.
    pub frames: &'static str,
    /// Of the torques by duration.
    pub torque_by_duration: &'static str,
    /// Of the torques over time, by joint.
    pub torque_over_time: &'static str,
    /// Of the beginning of the torques.
    pub transient: &'static str,
    /// Of the torques over the phase.
    pub torque_over_cycle: &'static str,
    /// Where the publication sees the curves of different durations part, s.
    pub published_divergence_s: f64,
}

/// All figures of a study of some gaits that the records allow, in the order of their numbers.
pub fn study_figures(
    gaits: &[GaitNumbers],
    chains: &[ChainRecord],
    pulls: &[PullRecord],
    costs: &[CostRecord],
) -> Result<Vec<Figure>, FigureError> {
    let mut figures: Vec<Figure> = parameters(gaits, chains)?.into_iter().collect();
    for numbers in gaits {
        if let Some(record) = chains.iter().find(|record| record.gait == numbers.gait) {
            figures.extend(chain::figure(record, numbers.chain)?);
        }
        figures.extend(torque::figures(pulls, numbers)?);
    }
    if let [first, second, ..] = gaits {
        figures.extend(comparison::figure(pulls, first.gait, second.gait)?);
        figures.extend(cost::absolute(gaits, costs)?);
        figures.extend(cost::ratio(gaits, costs, first.gait)?);
    }
    figures.sort_by_key(|figure| figure.number);
    Ok(figures)
}

/// What is said about a drawing.
struct Wording {
    stem: String,
    number: &'static str,
    title: String,
    caption: String,
    alt: String,
}

/// Longest name of a figure's files, which have an end behind it.
const LONGEST_STEM: usize = 150;

/// A name of files that is no path and hides nothing, whatever the gait in it is called: of ASCII
/// letters, digits, `-`, `_`, `+` and `.`.
pub(crate) fn file_stem(named: &str) -> String {
    let plain = |it: char| it.is_ascii_alphanumeric() || "-_+.".contains(it);
    let letters = named.chars().map(|it| if plain(it) { it } else { '-' });
    letters.take(LONGEST_STEM).collect()
}

/// `text` beginning with a capital.
fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}
