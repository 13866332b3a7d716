//! The report: result folders as one HTML page that loads nothing, with figures beside it.
//!
//! It reads records and computes no physics: drawings are made from tables again, what the engine's
//! camera saw is shown as it was recorded. `folder` and `cut_table` read files. A `run` is what was read
//! of one folder; a [`Publication`] reads the folders of its own command. `shown` holds the figures that
//! there are, `card` the report card; `page`, `figure_html` and the `…sections` write.

mod card;
mod card_sections;
pub mod chains;
pub mod curve_tables;
mod cut_table;
mod error;
mod figure_html;
mod folder;
pub mod html_table;
mod page;
mod picture;
mod publication;
mod replay;
mod rivals;
mod run;
mod run_sections;
mod shown;
mod svg_file;

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use rayon::prelude::*;
use serde::Serialize;

pub use card::{Card, JointCard};
pub use cut_table::{Column, CutTable, Line, NoNumber};
pub use error::ReportError;
pub use folder::Folder;
pub use publication::{Part, Place, Publication, Unpublished};
pub use run::{PublishedRun, Run};
pub use shown::Shown;

use crate::figures::{PNG_SCALE, PublishedRange};
use folder::Given;
use prone_record::head::Head;
use prone_record::output::{Artefacts, RUN_FILE, json};
use prone_record::program::Program;
use run::{real, record};

/// What a page may weigh, bytes; the replay gives way.
pub const LARGEST_PAGE: usize = 6_000_000;

/// Name of the page in a result folder.
pub const PAGE_FILE: &str = "report.html";

/// Name of the page's figures as JSON.
pub const NUMBERS_FILE: &str = "report.json";

/// A result folder that a report is made of.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// How it is called in the report.
    pub name: String,
    /// Where it is.
    pub folder: PathBuf,
}

/// How a report is arranged.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Arrangement {
    /// By run: the user's own come first, then results of the publication's own commands. Figures that
    /// no run has are not mentioned, and nothing published stands beside the user's own.
    Runs,
    /// As the publication: its numbered figures in their order, with what is published of each. The
    /// place of a figure that no run has says what makes it.
    Chapter,
}

/// A finished report.
pub struct Report {
    /// The page.
    pub html: String,
    /// What the page says, for programs.
    pub numbers: Numbers,
}

/// What a report says, for programs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Numbers {
    /// The folders that were read, those within folders too.
    pub runs: Vec<RunEntry>,
    /// Of each crawl.
    pub cards: Vec<Card>,
    /// The figures that are there.
    pub figures: Vec<Shown>,
    /// Figures of the chapter that are not, and what makes them; none where the report is no chapter.
    pub missing: Vec<Place>,
    /// Folders in the replay.
    pub replayed: Vec<String>,
    /// What is missing of the records because tables break off, one sentence each.
    pub shortfalls: Vec<String>,
    /// What the records never had, one sentence each.
    pub unrecorded: Vec<String>,
    /// How many figures the chapter has; none where the report is no chapter.
    #[serde(skip)]
    places: usize,
    #[serde(skip)]
    arrangement: Arrangement,
}

/// A folder that was read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct RunEntry {
    /// As it was named.
    pub folder: String,
    /// What made it.
    pub command: String,
    /// From which the program was built that made it.
    pub commit: String,
}

impl Numbers {
    /// How many figures of a publication have a counterpart.
    pub const fn chapter_figures(&self) -> usize {
        self.places - self.missing.len()
    }
}

impl Report {
    /// Reads result folders and makes the report of them, held against a publication. A folder that is
    /// named twice, or that is named and lies within another one, is taken once. Drawings are made on the
    /// current rayon pool.
    pub fn from_folders(
        sources: &[Source],
        publication: &dyn Publication,
        arrangement: Arrangement,
    ) -> Result<Self, ReportError> {
        let mut named = BTreeSet::new();
        let sources = sources.iter();
        let sources: Vec<&Source> = sources
            .filter(|source| named.insert(real(&source.folder)))
            .collect();
        let reading = Reading {
            named: &named,
            publication,
            arrangement,
        };
        let runs: Vec<Vec<Run>> = sources
            .par_iter()
            .map(|source| {
                let folder = Folder::open(&source.name, &source.folder, Given::Named)?;
                reading.read(folder)
            })
            .collect::<Result<_, _>>()?;
        let mut runs: Vec<Run> = runs.into_iter().flatten().collect();
        if arrangement == Arrangement::Runs {
            // Stable.
            runs.sort_by_key(|run| !run.is_own());
        }
        let shown = shown::from_runs(&mut runs)?;
        // The crawls that the user named come first; stable.
        let mut by_given: Vec<&Run> = runs.iter().collect();
        by_given.sort_by_key(|run| run.folder.given == Given::Within);
        let cards: Vec<Card> = by_given.into_iter().filter_map(Card::from_run).collect();
        let page = page::Page {
            runs: &runs,
            shown: &shown,
            cards: &cards,
            publication,
            arrangement,
            left_out: BTreeSet::new(),
        };
        let (html, replayed) = page.html()?;
        let places: Vec<&Place> = match arrangement {
            Arrangement::Runs => Vec::new(),
            Arrangement::Chapter => places(publication).collect(),
        };
        let missing = places
            .iter()
            .filter(|place| shown.iter().all(|shown| shown.number != place.number));
        let numbers = Numbers {
            missing: missing.copied().cloned().collect(),
            runs: runs.iter().map(RunEntry::from_run).collect(),
            cards,
            figures: shown,
            replayed,
            shortfalls: runs.iter().flat_map(|run| run.shortfalls.clone()).collect(),
            unrecorded: runs.iter().flat_map(|run| run.unrecorded.clone()).collect(),
            places: places.len(),
            arrangement,
        };
        Ok(Self { html, numbers })
    }

    /// The report of a result that is not published yet: of the files that it will have.
    pub fn from_artefacts(
        name: &str,
        artefacts: &Artefacts,
        publication: &dyn Publication,
        arrangement: Arrangement,
    ) -> Result<Self, ReportError> {
        let home = tempfile::tempdir().map_err(ReportError::Temporary)?;
        for (file, bytes) in artefacts {
            let path = home.path().join(file);
            path.parent()
                .map_or(Ok(()), fs::create_dir_all)
                .and_then(|()| fs::write(&path, bytes))
                .map_err(ReportError::Temporary)?;
        }
        let source = Source {
            name: name.to_owned(),
            folder: home.path().to_owned(),
        };
        Self::from_folders(&[source], publication, arrangement)
    }

    /// Figures as SVG and PNG, in `figures/`.
    ///
    /// # Errors
    /// [`ReportError`] where a drawing has no PNG.
    pub fn figures(&self) -> Result<Artefacts, ReportError> {
        let figures = &self.numbers.figures;
        let files = figures.par_iter().map(|shown| shown.files(PNG_SCALE));
        let files: Vec<_> = files.collect::<Result<_, _>>()?;
        Ok(files.into_iter().flatten().collect())
    }

    /// Page, figures as SVG and PNG, `report.json` and `run.json`.
    ///
    /// # Errors
    /// [`ReportError`] where a drawing has no PNG.
    pub fn files(&self, program: &Program) -> Result<Artefacts, ReportError> {
        let mut artefacts = self.figures()?;
        artefacts.insert(PAGE_FILE.to_owned(), self.html.clone().into_bytes());
        artefacts.insert(NUMBERS_FILE.to_owned(), json(&self.numbers)?);
        let info = ReportInfo {
            head: Head::new(program, "report", None),
            arrangement: self.numbers.arrangement,
            runs: &self.numbers.runs,
        };
        artefacts.insert(RUN_FILE.to_owned(), json(&info)?);
        Ok(artefacts)
    }
}

/// What made a report: `run.json`.
#[derive(Serialize)]
struct ReportInfo<'a> {
    #[serde(flatten)]
    head: Head<&'static str>,
    arrangement: Arrangement,
    runs: &'a [RunEntry],
}

/// How folders are read.
struct Reading<'a> {
    /// The folders that the user named.
    named: &'a BTreeSet<PathBuf>,
    publication: &'a dyn Publication,
    arrangement: Arrangement,
}

impl Reading<'_> {
    /// Reads a folder and, of a publication's own result, the records within it that the user did not
    /// name.
    fn read(&self, folder: Folder) -> Result<Vec<Run>, ReportError> {
        let absent = folder.absent();
        let mut runs = self.read_whole(folder)?;
        if let Some(run) = runs.first_mut() {
            run.shortfalls.extend(absent);
        }
        Ok(runs)
    }

    fn read_whole(&self, folder: Folder) -> Result<Vec<Run>, ReportError> {
        if let Some(published) = self.publication.read(&folder) {
            let mut runs = vec![published?];
            for inner in folder.records() {
                let path = folder.path.join(&inner);
                if !self.named.contains(&real(&path)) {
                    let name = format!("{}/{inner}", folder.name);
                    runs.extend(self.read(Folder::open(&name, &path, Given::Within)?)?);
                }
            }
            return Ok(runs);
        }
        let run = match folder.head.command.as_str() {
            "crawl run" | "pull run" | "reproduce crawl" | "reproduce pull" | "robot record" => {
                let given = folder.given;
                record::read(folder, &|joint| self.joint_range(given, joint))
            }
            "optimize" | "crawl frontier" => Run::search(folder, self.publication.gaits()),
            "torque-map plot" => Run::map(folder),
            other => Err(ReportError::OtherCommand {
                found: other.to_owned(),
                folder: folder.path,
            }),
        };
        Ok(vec![run?])
    }

    /// The published range of a joint, where it belongs beside a record.
    fn joint_range(&self, given: Given, joint: &str) -> Option<PublishedRange> {
        match (self.arrangement, given) {
            (Arrangement::Runs, Given::Named) => None,
            (Arrangement::Chapter, _) | (_, Given::Within) => self.publication.joint_range(joint),
        }
    }
}

impl RunEntry {
    fn from_run(run: &Run) -> Self {
        Self {
            folder: run.folder.name.clone(),
            command: run.folder.head.command.clone(),
            commit: run.folder.head.commit.clone(),
        }
    }
}

/// The numbered figures of a publication.
fn places(publication: &dyn Publication) -> impl Iterator<Item = &Place> {
    publication.parts().iter().flat_map(|part| &part.places)
}
