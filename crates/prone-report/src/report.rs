//! The report: result folders as one HTML page that loads nothing, with figures beside it.
//!
//! It reads records and computes no physics: drawings are made from tables again, what the engine's
//! camera saw is shown as it was recorded. `folder` and `cut_table` read, `crawl_run`,
//! `search_run` and `drawn_run` know what each command leaves behind, as a
//! [`Publication`] knows of its own; `shown` are the figures that there are; `card` is the report card; `page` and the
//! `…sections` write.

mod card;
mod card_sections;
pub mod chains;
mod crawl_run;
pub mod curve_tables;
mod cut_table;
mod drawn_run;
mod error;
mod folder;
mod page;
mod picture;
mod publication;
mod replay;
mod rivals;
mod run_sections;
mod search_run;
mod shown;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;

pub use card::{Card, JointCard};
pub use cut_table::{Column, Cut, CutTable, Line, NoNumber};
pub use error::ReportError;
pub use folder::Folder;
pub use publication::{MadeBy, Part, Place, Publication, PublishedRun, Unpublished};

use crate::figures::PNG_SCALE;
use crawl_run::{CrawlRun, PullRun};
use drawn_run::DrawnRun;
use folder::Given;
use prone_record::head::Head;
use prone_record::output::{Artefacts, RUN_FILE, json};
use prone_record::program::Program;
use prone_record::record_info::RecordInfo;
use prone_record::search_plan::SearchPlan;
use search_run::SearchRun;
use shown::Shown;

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

/// What was read of a folder.
enum Run {
    Published(Box<Folder>, Box<dyn PublishedRun>),
    Crawl(Box<CrawlRun>),
    Pull(Box<PullRun>),
    Search(Box<SearchRun>),
    Drawn(Box<DrawnRun>),
}

/// A finished report.
pub struct Report {
    /// The page.
    pub html: String,
    /// What the page says, for programs.
    pub numbers: Numbers,
    shown: Vec<Shown>,
}

/// What a report says, for programs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Numbers {
    /// The folders that were read, those within folders too.
    pub runs: Vec<RunEntry>,
    /// Of each crawl.
    pub cards: Vec<Card>,
    /// The figures that are there.
    pub figures: Vec<ShownEntry>,
    /// Figures of the chapter that are not, and what makes them.
    pub missing: Vec<MissingEntry>,
    /// Folders in the replay.
    pub replayed: Vec<String>,
    /// What is missing of the records because tables break off, one sentence each.
    pub shortfalls: Vec<String>,
    /// What the records never had, one sentence each.
    pub unrecorded: Vec<String>,
    /// How many figures the publication has.
    #[serde(skip)]
    places: usize,
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

/// A figure that is there.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct ShownEntry {
    /// Of its original in the chapter; empty where there is none.
    pub number: String,
    /// Name of its files in `figures/`, without extension.
    pub stem: String,
    /// A few words.
    pub title: String,
    /// The folders that it comes from.
    pub runs: Vec<String>,
}

/// A figure that is not there.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct MissingEntry {
    /// Of its original in the chapter.
    pub number: String,
    /// What it shows.
    pub shows: String,
    /// The command that makes it; nothing where that takes a robot.
    pub command: Option<String>,
}

impl Numbers {
    /// How many figures of a publication have a counterpart.
    pub const fn chapter_figures(&self) -> usize {
        self.places - self.missing.len()
    }
}

impl Report {
    /// Reads result folders and makes the report of them, held against a publication. Drawings are made
    /// on the current rayon pool.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn of(sources: &[Source], publication: &dyn Publication) -> Result<Self, ReportError> {
        let runs: Vec<Vec<Run>> = sources
            .par_iter()
            .map(|source| read(&source.name, &source.folder, Given::Named, publication))
            .collect::<Result<_, _>>()?;
        let runs: Vec<Run> = runs.into_iter().flatten().collect();
        let shown = shown::of(&runs, publication)?;
        let mut crawls: Vec<&CrawlRun> = runs
            .iter()
            .filter_map(|run| match run {
                Run::Crawl(crawl) => Some(crawl.as_ref()),
                _ => None,
            })
            .collect();
        // Those that the user named first; stable.
        crawls.sort_by_key(|crawl| crawl.folder.given == Given::Within);
        let cards: Vec<Card> = crawls.into_iter().filter_map(Card::from_crawl).collect();
        let page = page::Page {
            runs: &runs,
            shown: &shown,
            cards: &cards,
            publication,
            left_out: BTreeSet::new(),
        };
        let (html, replayed) = page.html()?;
        Ok(Self {
            html,
            numbers: Numbers {
                runs: runs.iter().map(Run::entry).collect(),
                cards,
                figures: shown.iter().map(entry).collect(),
                missing: missing(&shown, publication),
                replayed,
                shortfalls: runs.iter().flat_map(Run::shortfalls).collect(),
                unrecorded: runs.iter().flat_map(Run::unrecorded).cloned().collect(),
                places: places(publication).count(),
            },
            shown,
        })
    }

    /// The report of a result that is not published yet: of the files that it will have.
    ///
    /// # Errors
    /// [`ReportError`].
    pub fn of_artefacts(
        name: &str,
        artefacts: &Artefacts,
        publication: &dyn Publication,
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
        Self::of(&[source], publication)
    }

    /// Figures as SVG and PNG, in `figures/`.
    ///
    /// # Errors
    /// [`ReportError`] where a drawing has no PNG.
    pub fn figures(&self) -> Result<Artefacts, ReportError> {
        let files = self
            .shown
            .par_iter()
            .map(|shown| shown.files(PNG_SCALE))
            .collect::<Result<Vec<_>, _>>()?;
        Ok(files.into_iter().flatten().collect())
    }

    /// Page, figures as SVG and PNG, `report.json` and `run.json`.
    ///
    /// # Errors
    /// [`ReportError`] where a drawing has no PNG.
    pub fn files(&self, program: &Program) -> Result<Artefacts, ReportError> {
        let mut artefacts = self.figures()?;
        artefacts.insert(PAGE_FILE.to_owned(), self.html.clone().into_bytes());
        let numbers = json(&self.numbers).map_err(ReportError::Encode)?;
        artefacts.insert(NUMBERS_FILE.to_owned(), numbers);
        let info = ReportInfo {
            head: Head::new(program, "report", None),
            runs: &self.numbers.runs,
        };
        let info = json(&info).map_err(ReportError::Encode)?;
        artefacts.insert(RUN_FILE.to_owned(), info);
        Ok(artefacts)
    }
}

/// What made a report: `run.json`.
#[derive(Serialize)]
struct ReportInfo<'a> {
    #[serde(flatten)]
    head: Head<&'static str>,
    runs: &'a [RunEntry],
}

/// A folder, and the records in it.
fn read(
    name: &str,
    path: &Path,
    given: Given,
    publication: &dyn Publication,
) -> Result<Vec<Run>, ReportError> {
    let folder = Folder::open(name, path, given)?;
    if let Some(published) = publication.read(&folder) {
        let published = published?;
        let within = folder.records();
        let mut runs = vec![Run::Published(Box::new(folder), published)];
        for inner in within {
            let (name, path) = (format!("{name}/{inner}"), path.join(&inner));
            runs.extend(read(&name, &path, Given::Within, publication)?);
        }
        return Ok(runs);
    }
    let run = match folder.head.command.as_str() {
        "crawl run" | "reproduce crawl" | "robot record" => {
            Run::Crawl(Box::new(CrawlRun::read(folder)?))
        }
        "reproduce pull" | "pull run" => Run::Pull(Box::new(PullRun::read(folder)?)),
        "optimize" | "crawl frontier" => match folder.run()? {
            SearchPlan::Pull(plan) => Run::Search(Box::new(SearchRun::read(folder, &plan)?)),
            SearchPlan::Cycle(plan) => Run::Drawn(Box::new(DrawnRun::cycles(folder, &plan.under)?)),
        },
        "torque-map plot" => Run::Drawn(Box::new(DrawnRun::map(folder)?)),
        other => {
            return Err(ReportError::OtherCommand {
                folder: path.to_owned(),
                found: other.to_owned(),
            });
        }
    };
    Ok(vec![run])
}

impl Run {
    fn folder(&self) -> &Folder {
        match self {
            Self::Published(folder, _) => folder,
            Self::Crawl(run) => &run.folder,
            Self::Pull(run) => &run.folder,
            Self::Search(run) => &run.folder,
            Self::Drawn(run) => &run.folder,
        }
    }

    fn entry(&self) -> RunEntry {
        let folder = self.folder();
        RunEntry {
            folder: folder.name.clone(),
            command: folder.head.command.clone(),
            commit: folder.head.commit.clone(),
        }
    }

    /// What is missing of its tables, one sentence each.
    fn shortfalls(&self) -> Vec<String> {
        let said = |cuts: &[cut_table::Cut]| cuts.iter().map(ToString::to_string).collect();
        match self {
            Self::Published(_, run) => run.shortfalls(),
            Self::Search(run) => said(&run.cuts),
            Self::Crawl(run) => run.notes.clone(),
            Self::Pull(run) => run.notes.clone(),
            Self::Drawn(run) => said(&run.cuts),
        }
    }

    /// What its record never had, one sentence each.
    fn unrecorded(&self) -> &[String] {
        match self {
            Self::Crawl(run) => &run.gaps,
            Self::Pull(run) => &run.gaps,
            Self::Published(..) | Self::Search(_) | Self::Drawn(_) => &[],
        }
    }

    /// What a record says of itself.
    fn record(&self) -> Option<&RecordInfo> {
        match self {
            Self::Crawl(run) => Some(&run.info),
            Self::Pull(run) => Some(&run.info),
            Self::Published(..) | Self::Search(_) | Self::Drawn(_) => None,
        }
    }
}

fn entry(shown: &Shown) -> ShownEntry {
    ShownEntry {
        number: shown.number.clone(),
        stem: shown.stem.clone(),
        title: shown.title.clone(),
        runs: shown.runs.clone(),
    }
}

fn places(publication: &dyn Publication) -> impl Iterator<Item = &Place> {
    publication.parts().iter().flat_map(|part| &part.places)
}

fn missing(shown: &[Shown], publication: &dyn Publication) -> Vec<MissingEntry> {
    let places = places(publication);
    let places = places.filter(|place| shown.iter().all(|shown| shown.number != place.number));
    let missing = places.map(|place| MissingEntry {
        number: place.number.clone(),
        shows: place.shows.clone(),
        command: match &place.made_by {
            MadeBy::Command(command) => Some(command.clone()),
            MadeBy::Robot => None,
        },
    });
    missing.collect()
}
