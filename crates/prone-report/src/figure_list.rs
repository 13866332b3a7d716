//! Puts figures among the files of a result, and lists them in `figures.json`.

use crate::figures::Figure;
use prone_record::figure_entry::{FIGURES_FILE, FigureEntry};
use prone_record::output::{Artefacts, json};

/// Collects the entries while figures are put among the files of a result.
#[derive(Debug, Default)]
pub struct FigureList(Vec<FigureEntry>);

impl FigureList {
    /// Puts a drawing and its PNG into `folder` of the result; `folder` ends in `/` or is empty.
    pub fn drawing(
        &mut self,
        artefacts: &mut Artefacts,
        folder: &str,
        figure: Figure,
        png: Vec<u8>,
    ) {
        let file = format!("{folder}{}", figure.stem);
        artefacts.insert(format!("{file}.png"), png);
        artefacts.insert(format!("{file}.svg"), figure.svg.into_bytes());
        self.0.push(FigureEntry {
            file,
            number: figure.number.to_owned(),
            title: figure.title,
            caption: figure.caption,
            alt: figure.alt,
            picture: false,
        });
    }

    /// Puts a picture and the SVG around it into `figures/` of the result.
    pub fn picture(&mut self, artefacts: &mut Artefacts, figure: Figure, png: Vec<u8>) {
        self.drawing(artefacts, "figures/", figure, png);
        if let Some(entry) = self.0.last_mut() {
            entry.picture = true;
        }
    }

    /// Puts `figures.json` into the result.
    pub fn finish(self, artefacts: &mut Artefacts) -> Result<(), serde_json::Error> {
        artefacts.insert(FIGURES_FILE.to_owned(), json(&self.0)?);
        Ok(())
    }
}
