//! The chapter of the thesis as something that a report is held against.

use std::sync::OnceLock;

use prone_report::figures::{GaitNumbers, PublishedRange};
use prone_report::report::{Folder, Part, Publication, ReportError, Run};

use crate::published;
use crate::report::study;

/// The command whose result folders are the study's own.
const COMMAND: &str = "reproduce";

/// Chapter 5 of the master's thesis.
#[derive(Debug, Clone, Copy, Default)]
pub struct Thesis;

impl Publication for Thesis {
    fn title(&self) -> &'static str {
        "The Projected Profile crawl: report"
    }

    fn lead(&self) -> Option<&str> {
        Some(
            "Figures are numbered as in chapter 5 of the master's thesis that published this crawl \
             (NYU Polytechnic, 2015).",
        )
    }

    fn name(&self) -> Option<&str> {
        Some("the thesis")
    }

    fn crawled(&self) -> Option<&str> {
        Some("The published robot made 67 mm a cycle with the original's gait.")
    }

    /// The sections; none where the text that ships does not parse, which a test excludes.
    fn parts(&self) -> &[Part] {
        static PARTS: OnceLock<Vec<Part>> = OnceLock::new();
        PARTS.get_or_init(|| serde_json::from_str(include_str!("chapter.json")).unwrap_or_default())
    }

    fn gaits(&self) -> &[GaitNumbers] {
        &published::FIGURES
    }

    fn joint_range(&self, joint: &str) -> Option<PublishedRange> {
        published::crawl_range(joint)
    }

    fn read(&self, folder: &Folder) -> Option<Result<Run, ReportError>> {
        (folder.head.command == COMMAND).then(|| study::read(folder))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_of_the_chapter_has_one_place() {
        let places = Thesis.parts().iter().flat_map(|part| &part.places);
        let numbers: Vec<String> = places.map(|place| place.number.clone()).collect();
        let expected: Vec<String> = (22..=45).map(|number| number.to_string()).collect();
        assert_eq!(numbers, expected);
    }
}
