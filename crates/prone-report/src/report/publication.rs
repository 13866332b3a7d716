//! What a report is held against: a published study with numbered figures, and results of its own.

use maud::Markup;

use prone_record::figure_entry::FigureEntry;

use super::error::ReportError;
use super::folder::Folder;
use crate::figures::{Figure, FigureError, GaitNumbers};

/// A published study.
pub trait Publication: Sync {
    /// What a report held against it is called.
    fn title(&self) -> &str;

    /// Where figures have their numbers from, and whom "published" means; a sentence or two.
    fn lead(&self) -> &str;

    /// Its numbered figures in their order, by section.
    fn parts(&self) -> &[Part];

    /// Its gaits, with the numbers of the figures that show one alone.
    fn gaits(&self) -> &[GaitNumbers];

    /// The range that a joint swept on the crawling robot, rad, where it is published.
    fn joint_range(&self, joint: &str) -> Option<(f64, f64)>;

    /// Reads the result folder of a command of its own; `None` where the folder is no such result.
    fn read(&self, folder: &Folder) -> Option<Result<Box<dyn PublishedRun>, ReportError>>;
}

/// A result of a publication's own command.
pub trait PublishedRun: Send + Sync {
    /// Its figures, drawn from its tables.
    ///
    /// # Errors
    /// [`FigureError`] where a record holds what no axis can show.
    fn drawings(&self) -> Result<Vec<Figure>, FigureError>;

    /// Figures that it holds as files.
    fn recorded(&self) -> &[FigureEntry];

    /// What is missing of its tables, one sentence each.
    fn shortfalls(&self) -> Vec<String>;

    /// What stands first on the page.
    fn results(&self) -> Markup;

    /// Tables that follow the figure of a number.
    fn tables_after(&self, number: &str) -> Markup;

    /// What follows the figures.
    fn sections(&self) -> Markup;

    /// Under which conditions it was made, as entries of a description list.
    fn facts(&self) -> Markup;
}

/// A section of numbered figures.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// Its heading.
    pub title: String,
    /// What stands below the heading.
    pub lead: String,
    /// Its figures.
    pub places: Vec<Place>,
}

/// A numbered figure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Its number there.
    pub number: String,
    /// What it shows, in our words.
    pub shows: String,
    /// What makes our counterpart.
    pub made_by: MadeBy,
    /// What is published of it, and how that was obtained.
    pub published: Option<String>,
}

/// What makes a figure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum MadeBy {
    /// A command, whose folder is then given to the report.
    Command(String),
    /// A robot on the wire, which this program does not drive yet.
    Robot,
}

/// No publication: figures have no numbers to be held against.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unpublished;

impl Publication for Unpublished {
    fn title(&self) -> &'static str {
        "Crawling: report"
    }

    fn lead(&self) -> &'static str {
        ""
    }

    fn parts(&self) -> &[Part] {
        &[]
    }

    fn gaits(&self) -> &[GaitNumbers] {
        &[]
    }

    fn joint_range(&self, _: &str) -> Option<(f64, f64)> {
        None
    }

    fn read(&self, _: &Folder) -> Option<Result<Box<dyn PublishedRun>, ReportError>> {
        None
    }
}
