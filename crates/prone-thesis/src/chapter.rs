//! The chapter of the thesis as something that a report is held against.

use std::sync::OnceLock;

use serde::Deserialize;

use prone_report::figures::GaitNumbers;
use prone_report::report::{Folder, MadeBy, Part, Place, Publication, PublishedRun, ReportError};

use crate::published;
use crate::report::study::StudyRun;

/// The command whose result folders are the study's own.
const COMMAND: &str = "reproduce";

/// Chapter 5 of the master's thesis.
#[derive(Debug, Clone, Copy, Default)]
pub struct Thesis;

/// What `chapter.json` says of a section.
#[derive(Deserialize)]
struct PartText {
    title: String,
    lead: String,
    places: Vec<PlaceText>,
}

/// What it says of a figure.
#[derive(Deserialize)]
struct PlaceText {
    number: String,
    shows: String,
    /// The command; null where it takes a robot.
    made_by: Option<String>,
    published: Option<String>,
}

impl Publication for Thesis {
    fn title(&self) -> &'static str {
        "The Projected Profile crawl: report"
    }

    fn lead(&self) -> &'static str {
        "Figures are numbered as in chapter 5 of the master's thesis that published this crawl (NYU \
         Polytechnic, 2015)."
    }

    fn parts(&self) -> &[Part] {
        static PARTS: OnceLock<Vec<Part>> = OnceLock::new();
        PARTS.get_or_init(parts)
    }

    fn gaits(&self) -> &[GaitNumbers] {
        &published::FIGURES
    }

    fn joint_range(&self, joint: &str) -> Option<(f64, f64)> {
        published::crawl_range(joint)
    }

    fn read(&self, folder: &Folder) -> Option<Result<Box<dyn PublishedRun>, ReportError>> {
        (folder.head.command == COMMAND).then(|| {
            let run = StudyRun::read(folder)?;
            Ok(Box::new(run) as Box<dyn PublishedRun>)
        })
    }
}

/// The sections; none where the text that ships does not parse, which a test excludes.
fn parts() -> Vec<Part> {
    let text = include_str!("chapter.json");
    let parts: Vec<PartText> = serde_json::from_str(text).unwrap_or_default();
    let place = |place: PlaceText| Place {
        number: place.number,
        shows: place.shows,
        made_by: place.made_by.map_or(MadeBy::Robot, MadeBy::Command),
        published: place.published,
    };
    let part = |part: PartText| Part {
        title: part.title,
        lead: part.lead,
        places: part.places.into_iter().map(place).collect(),
    };
    parts.into_iter().map(part).collect()
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
