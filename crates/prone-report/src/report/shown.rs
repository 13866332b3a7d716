//! The figures of a report: drawn from tables, or recorded by the commands that made the runs.

use std::collections::BTreeSet;

use rayon::prelude::*;

use super::folder::Folder;
use super::publication::Publication;
use super::{ReportError, Run, picture};
use crate::figures::{self, Figure};
use prone_record::figure_entry::FigureEntry;

/// One figure of a report.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shown {
    /// Name of its files, of which no other figure has the same.
    pub(super) stem: String,
    /// Number of its original in the thesis; empty where it has none.
    pub(super) number: String,
    pub(super) title: String,
    pub(super) caption: String,
    pub(super) alt: String,
    /// The folders that it comes from, as they were named; more than one where they have the same.
    pub(super) runs: Vec<String>,
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

/// Every figure of some runs, in their order.
pub(super) fn of(runs: &[Run], publication: &dyn Publication) -> Result<Vec<Shown>, ReportError> {
    let mut found = Vec::new();
    for run in runs {
        match run {
            Run::Published(folder, run) => {
                let drawings = run.drawings().map_err(|source| ReportError::Figure {
                    run: folder.name.clone(),
                    source,
                })?;
                add(&mut found, folder, drawings, run.recorded())?;
            }
            Run::Crawl(run) => {
                let drawings = run.drawing(publication)?.into_iter().collect();
                add(&mut found, &run.folder, drawings, &run.recorded)?;
            }
            Run::Search(run) => {
                let mut drawings = run.drawings()?;
                drawings.extend(figures::parameters(publication.gaits(), &run.chains));
                add(&mut found, &run.folder, drawings, &[])?;
            }
            Run::Drawn(run) => {
                let drawings = run.drawing()?.into_iter().collect();
                add(&mut found, &run.folder, drawings, &run.recorded)?;
            }
            Run::Pull(_) => {}
        }
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
fn add(
    found: &mut Vec<Shown>,
    folder: &Folder,
    drawings: Vec<Figure>,
    recorded: &[FigureEntry],
) -> Result<(), ReportError> {
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
    for entry in recorded {
        let stem = entry.file.rsplit('/').next().unwrap_or(&entry.file);
        // What is drawn anew from tables that were cut would look whole in its recorded form.
        if drawn.contains(stem) {
            continue;
        }
        let png = folder.bytes(&format!("{}.png", entry.file))?;
        found.push(Shown {
            stem: stem.to_owned(),
            number: entry.number.clone(),
            title: entry.title.clone(),
            caption: entry.caption.clone(),
            alt: entry.alt.clone(),
            runs: vec![folder.name.clone()],
            image: Image::Recorded {
                svg: folder.bytes(&format!("{}.svg", entry.file))?,
                small: entry.picture.then(Vec::new),
                png,
            },
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
        let (svg, png) = match &self.image {
            Image::Drawing { svg, png } => {
                let made = || figures::raster::png(svg, png_scale);
                let png = png.clone().map_or_else(made, Ok);
                let png = png.map_err(|source| ReportError::Figure {
                    run: self.runs.join(", "),
                    source,
                })?;
                (svg.clone().into_bytes(), png)
            }
            Image::Recorded { svg, png, .. } => (svg.clone(), png.clone()),
        };
        Ok([
            (format!("figures/{}.svg", self.stem), svg),
            (format!("figures/{}.png", self.stem), png),
        ])
    }
}
