//! The figures of a report: drawn from tables, or recorded by the commands that made the runs.

use std::collections::BTreeSet;

use rayon::prelude::*;
use serde::Serialize;

use super::folder::Folder;
use super::{ReportError, Run, picture, svg_file};
use crate::figures::{self, Figure, file_stem};

/// One figure of a report.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Shown {
    /// Number of its original in the publication; empty where it has none.
    pub number: String,
    /// Name of its files in `figures/`, without extension; no other figure has the same.
    pub stem: String,
    /// A few words.
    pub title: String,
    #[serde(skip)]
    pub(super) caption: String,
    #[serde(skip)]
    pub(super) alt: String,
    /// The folders that it comes from, as they were named; more than one where they have the same.
    pub runs: Vec<String>,
    #[serde(skip)]
    pub(super) image: Image,
}

/// How a figure is there.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Image {
    /// Drawn here from tables.
    Drawing {
        svg: String,
        /// Where the run has the same drawing, its PNG.
        png: Option<Vec<u8>>,
    },
    /// Recorded as files.
    Recorded {
        svg: Vec<u8>,
        png: Vec<u8>,
        /// The same as a smaller PNG, of a picture.
        small: Option<Vec<u8>>,
    },
}

/// Takes the figures out of some runs, in their order.
pub(super) fn from_runs(runs: &mut [Run]) -> Result<Vec<Shown>, ReportError> {
    let mut found = Vec::new();
    for run in runs {
        add(&mut found, run)?;
    }
    let mut found = shrunk(once(found))?;
    set_apart(&mut found);
    Ok(found)
}

/// The PNG of the same drawing, where the run has it: it needs not be made again.
fn drawn_before(folder: &Folder, figure: &Figure) -> Option<Vec<u8>> {
    let file = |kind: &str| format!("figures/{}.{kind}", figure.stem);
    let same = folder.bytes(&file("svg")).ok()? == figure.svg.as_bytes();
    same.then(|| folder.bytes(&file("png")).ok()).flatten()
}

/// Figures that several runs have, to the last stroke, once.
fn once(found: Vec<Shown>) -> Vec<Shown> {
    let mut kept: Vec<Shown> = Vec::new();
    for shown in found {
        let same = |other: &&mut Shown| {
            other.stem == shown.stem
                && other.caption == shown.caption
                && other.image.svg() == shown.image.svg()
        };
        match kept.iter_mut().find(same) {
            Some(other) => other.runs.extend(shown.runs),
            None => kept.push(shown),
        }
    }
    kept
}

/// What was drawn, then what was recorded and is not among that.
fn add(found: &mut Vec<Shown>, run: &mut Run) -> Result<(), ReportError> {
    let folder = &run.folder;
    let drawings = std::mem::take(&mut run.drawings);
    let drawn: BTreeSet<String> = drawings.iter().map(|figure| figure.stem.clone()).collect();
    found.extend(drawings.into_iter().map(|figure| Shown {
        image: Image::Drawing {
            png: drawn_before(folder, &figure),
            svg: figure.svg,
        },
        stem: figure.stem,
        number: figure.number.to_owned(),
        title: figure.title,
        caption: figure.caption,
        alt: figure.alt,
        runs: vec![folder.name.clone()],
    }));
    for entry in std::mem::take(&mut run.recorded) {
        let stem = file_stem(entry.file.rsplit('/').next().unwrap_or(&entry.file));
        // What is drawn anew from tables that were cut would look whole in its recorded form.
        if drawn.contains(&stem) {
            continue;
        }
        let (png, svg) = (format!("{}.png", entry.file), format!("{}.svg", entry.file));
        let (png, drawing) = (folder.bytes(&png)?, folder.bytes(&svg)?);
        svg_file::check(&drawing).map_err(|reason| ReportError::Picture {
            file: folder.path.join(svg),
            reason,
        })?;
        found.push(Shown {
            stem,
            image: Image::Recorded {
                svg: drawing,
                small: entry.picture.then(Vec::new),
                png,
            },
            number: entry.number,
            title: entry.title,
            caption: entry.caption,
            alt: entry.alt,
            runs: vec![folder.name.clone()],
        });
    }
    Ok(())
}

/// Pictures with their smaller form.
fn shrunk(found: Vec<Shown>) -> Result<Vec<Shown>, ReportError> {
    let shrink = |mut shown: Shown| {
        if let Image::Recorded {
            png,
            small: Some(small),
            ..
        } = &mut shown.image
        {
            *small = picture::with_palette(png).map_err(|reason| ReportError::Picture {
                file: format!("{}/{}.png", shown.runs.join(", "), shown.stem).into(),
                reason,
            })?;
        }
        Ok(shown)
    };
    found.into_par_iter().map(shrink).collect()
}

/// Gives figures of the same name numbers, in the drawing too, whose parts are named after it.
fn set_apart(found: &mut [Shown]) {
    let mut taken = BTreeSet::new();
    for shown in found {
        let before = shown.stem.clone();
        let mut count = 1;
        while !taken.insert(shown.stem.clone()) {
            count += 1;
            shown.stem = format!("{before}-{count}");
        }
        if let Image::Drawing { svg, .. } = &mut shown.image
            && shown.stem != before
        {
            *svg = svg.replace(&before, &shown.stem);
        }
    }
}

impl Image {
    fn svg(&self) -> &[u8] {
        match self {
            Self::Drawing { svg, .. } => svg.as_bytes(),
            Self::Recorded { svg, .. } => svg,
        }
    }
}

impl Shown {
    /// Its files: SVG and PNG.
    pub(super) fn files(&self, png_scale: f32) -> Result<[(String, Vec<u8>); 2], ReportError> {
        let png = match &self.image {
            Image::Drawing { png: Some(png), .. } | Image::Recorded { png, .. } => png.clone(),
            Image::Drawing { svg, png: None } => {
                figures::raster::png(svg, png_scale).map_err(|source| ReportError::Figure {
                    run: self.runs.join(", "),
                    source,
                })?
            }
        };
        Ok([
            (
                format!("figures/{}.svg", self.stem),
                self.image.svg().to_vec(),
            ),
            (format!("figures/{}.png", self.stem), png),
        ])
    }
}
