//! What a report is held against: a published study with numbered figures, and results of its own.

use serde::{Deserialize, Serialize};

use super::error::ReportError;
use super::folder::Folder;
use super::run::Run;
use crate::figures::{GaitNumbers, PublishedRange};

/// A published study. What it does not say of itself is left out of the report.
pub trait Publication: Sync {
    /// What a report held against it is called.
    fn title(&self) -> &str;

    /// Where figures have their numbers from; a sentence or two.
    fn lead(&self) -> Option<&str> {
        None
    }

    /// Whom "published" means, as the end of a sentence.
    fn name(&self) -> Option<&str> {
        None
    }

    /// What is published of a crawl, to be read beside the report cards; the rest of a sentence.
    fn crawled(&self) -> Option<&str> {
        None
    }

    /// Its numbered figures in their order, by section.
    fn parts(&self) -> &[Part] {
        &[]
    }

    /// Its gaits, with the numbers of the figures that show one alone.
    fn gaits(&self) -> &[GaitNumbers] {
        &[]
    }

    /// The range that a joint swept on the crawling robot, rad, where it is published.
    fn joint_range(&self, _joint: &str) -> Option<PublishedRange> {
        None
    }

    /// Reads the result folder of a command of its own; `None` where the folder is no such result.
    fn read(&self, _folder: &Folder) -> Option<Result<Run, ReportError>> {
        None
    }
}

/// A section of numbered figures.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct Part {
    /// Its heading.
    pub title: String,
    /// What stands below the heading.
    pub lead: String,
    /// Its figures.
    pub places: Vec<Place>,
}

/// A numbered figure of a publication.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Place {
    /// Its number there.
    pub number: String,
    /// What it shows, in our words.
    pub shows: String,
    /// The command that makes our counterpart, whose folder is then given to the report; nothing where
    /// that takes a robot on the wire, which this program does not drive yet.
    pub command: Option<String>,
    /// What is published of it, and how that was obtained.
    #[serde(skip_serializing)]
    pub published: Option<String>,
}

/// No publication: figures have no numbers to be held against.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unpublished;

impl Publication for Unpublished {
    fn title(&self) -> &'static str {
        "Crawling: report"
    }
}
