//! The page: what is on every page, and how much room its pictures and its replay have. `chapter` and
//! `by_run` say what stands on it, and in which order.

mod by_run;
mod chapter;

use std::collections::BTreeSet;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use prone::foreign_text;

use super::folder::Given;
use super::publication::Publication;
use super::replay::Replay;
use super::run::{Content, PublishedRun};
use super::shown::{Image, Shown};
use super::{Arrangement, Card, LARGEST_PAGE, ReportError, Run, figure_html};
use crate::figures::each_once;
use crate::page_head;
use crate::view::record::not_simulated;

const STYLE: &str = include_str!("style.css");

/// The replay, for links to it.
const REPLAY: &str = "section-replay";

/// What stands around the sections, at most, bytes; and in the place of a picture.
const AROUND: usize = 4_000;
const PLACE: usize = 300;

/// What a page is made of.
pub(super) struct Page<'a> {
    pub(super) runs: &'a [Run],
    pub(super) shown: &'a [Shown],
    pub(super) cards: &'a [Card],
    pub(super) publication: &'a dyn Publication,
    pub(super) arrangement: Arrangement,
    /// Names of the pictures for which it has no room.
    pub(super) left_out: BTreeSet<String>,
}

impl Page<'_> {
    /// The page, and the folders that its replay shows.
    pub(super) fn html(mut self) -> Result<(String, Vec<String>), ReportError> {
        let above = self.above();
        let mut below = self.below();
        let room = LARGEST_PAGE.saturating_sub(above.0.len() + AROUND + STYLE.len());
        if let Some(excess) = below.0.len().checked_sub(room) {
            self.left_out = self.last_pictures(excess);
            below = self.below();
        }
        let room = room.saturating_sub(below.0.len());
        let replay = Replay::from_runs(self.runs, room)?;
        let replayed = replay
            .as_ref()
            .map_or_else(Vec::new, |replay| replay.shown.clone());
        let title = self.title();
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    (page_head::from_title(&title))
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    (self.header())
                    main {
                        (above)
                        @if let Some(replay) = &replay { (replay_section(replay)) }
                        (below)
                    }
                    (self.footer())
                }
            }
        };
        let page = page.into_string();
        Ok((foreign_text::escaped_page(&page).into_owned(), replayed))
    }

    /// What a browser calls the page.
    fn title(&self) -> String {
        match self.arrangement {
            Arrangement::Runs => format!("{}: report of prone", self.holds()),
            Arrangement::Chapter => format!("prone: report of {}", self.titles().join(", ")),
        }
    }

    fn header(&self) -> Markup {
        match self.arrangement {
            Arrangement::Runs => self.by_run_header(),
            Arrangement::Chapter => self.chapter_header(),
        }
    }

    /// What is before the replay.
    fn above(&self) -> Markup {
        match self.arrangement {
            Arrangement::Runs => self.by_run_above(),
            Arrangement::Chapter => self.chapter_above(),
        }
    }

    /// What is after it.
    fn below(&self) -> Markup {
        match self.arrangement {
            Arrangement::Runs => self.by_run_below(),
            Arrangement::Chapter => self.chapter_below(),
        }
    }

    /// The last pictures, as many as it takes to save so many bytes.
    fn last_pictures(&self, excess: usize) -> BTreeSet<String> {
        let mut saved = 0;
        let pictures = self.shown.iter().rev().filter_map(|shown| {
            let Image::Recorded { small, svg, .. } = &shown.image else {
                return None;
            };
            Some((shown, small.as_ref().unwrap_or(svg).len()))
        });
        let last = pictures.take_while(|(_, bytes)| {
            let enough = saved >= excess;
            // As base64, less what stands in its place.
            saved += (bytes / 3 * 4).saturating_sub(PLACE);
            !enough
        });
        last.map(|(shown, _)| shown.stem.clone()).collect()
    }

    /// What is missing of the records because tables break off; nothing where they are whole.
    fn shortfalls(&self) -> Markup {
        let shortfalls: Vec<&String> = self.runs.iter().flat_map(|run| &run.shortfalls).collect();
        html! {
            @if !shortfalls.is_empty() {
                section.warning { (sentences("Records that are not whole", &shortfalls)) }
            }
        }
    }

    /// What the records never had; nothing where they have all.
    fn unrecorded(&self) -> Markup {
        let unrecorded: Vec<&String> = self.runs.iter().flat_map(|run| &run.unrecorded).collect();
        html! {
            @if !unrecorded.is_empty() {
                section { (sentences("What was not recorded", &unrecorded)) }
            }
        }
    }

    /// The records that were not simulated, and where each comes from.
    fn not_simulated(&self) -> Vec<String> {
        let records = self.runs.iter().filter_map(|run| {
            let from = not_simulated(&run.record()?.info.origin)?;
            Some(format!("{} ({from})", run.folder.name))
        });
        records.collect()
    }

    /// The runs that were named.
    fn named(&self) -> impl Iterator<Item = &Run> {
        let runs = self.runs.iter();
        runs.filter(|run| run.folder.given == Given::Named)
    }

    /// The folders that were named.
    fn titles(&self) -> Vec<String> {
        let folders = self.named().map(|run| &run.folder);
        folders
            .map(|folder| format!("{} ({})", folder.name, folder.head.command))
            .collect()
    }

    fn published(&self) -> impl Iterator<Item = &dyn PublishedRun> {
        self.runs.iter().filter_map(|run| match &run.content {
            Content::Published(run) => Some(run.as_ref()),
            _ => None,
        })
    }

    /// A figure above its caption, or what stands in its place where the page has no room for it.
    fn figure(&self, figure: &Shown, caption: &Markup) -> Markup {
        html! {
            figure id=(figure.stem) {
                @if self.left_out.contains(&figure.stem) { (figure_html::left_out(figure)) }
                @else { (figure_html::image(figure)) }
                figcaption { (caption) }
            }
        }
    }

    fn footer(&self) -> Markup {
        let robots = self.runs.iter().filter_map(|run| run.robot.as_deref());
        let robots = each_once(robots, &[]);
        html! {
            footer {
                p {
                    "Written by prone " (env!("CARGO_PKG_VERSION")) " from records"
                    @if self.not_simulated().is_empty() { " that it made" }
                    "; nothing was simulated for this page."
                    @if !robots.is_empty() {
                        " Text without a source is about " (robots.join(" and ")) "."
                    }
                }
            }
        }
    }
}

fn sentences(heading: &str, sentences: &[&String]) -> Markup {
    html! {
        h2 { (heading) }
        ul { @for sentence in sentences { li { (sentence) } } }
    }
}

fn replay_section(replay: &Replay) -> Markup {
    html! {
        section id=(REPLAY) {
            h2 { "Replay" }
            @if replay.shown.is_empty() {
                p { "The page has no room for a replay." }
            } @else {
                p {
                    "Recorded angles, moved by the page itself: " (replay.shown.join(" beside "))
                    ". It needs JavaScript; all else does not. Press ? in it for its keys."
                }
                (replay.frame)
            }
            @if !replay.left_out.is_empty() {
                p {
                    "Not in it: " (replay.left_out.join(", ")) ". " code { "prone view RUN" }
                    " makes a page of any of them."
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::publication::{Part, Place, Unpublished};
    use super::*;

    /// Two sections of four figures, the last of which takes a robot.
    struct Chapter(Vec<Part>);

    impl Chapter {
        fn new() -> Self {
            let place = |number: u32| Place {
                number: number.to_string(),
                shows: format!("figure {number}"),
                command: (number != 29).then(|| "prone reproduce".to_owned()),
                published: None,
            };
            let part = |numbers: std::ops::Range<u32>| Part {
                title: "A section".to_owned(),
                lead: "What is in it.".to_owned(),
                places: numbers.map(place).collect(),
            };
            Self(vec![part(22..26), part(26..30)])
        }
    }

    impl Publication for Chapter {
        fn title(&self) -> &'static str {
            "A chapter"
        }

        fn parts(&self) -> &[Part] {
            &self.0
        }
    }

    fn picture(number: &str, bytes: usize) -> Shown {
        Shown {
            stem: format!("picture-{number}"),
            number: number.to_owned(),
            title: "A picture".to_owned(),
            caption: "What it shows.".to_owned(),
            alt: "A robot.".to_owned(),
            runs: vec!["run".to_owned()],
            image: Image::Recorded {
                svg: Vec::new(),
                png: Vec::new(),
                small: Some(vec![7; bytes]),
            },
        }
    }

    fn page(shown: &[Shown]) -> String {
        let page = Page {
            runs: &[],
            shown,
            cards: &[],
            publication: &Chapter::new(),
            arrangement: Arrangement::Chapter,
            left_out: BTreeSet::new(),
        };
        page.html().unwrap().0
    }

    #[test]
    fn a_page_that_would_be_too_large_leaves_its_last_pictures_out() {
        let all = ["22", "23", "27", "28"].map(|number| picture(number, 1_500_000));
        let (fits, too_much) = (page(&all[..2]), page(&all));
        assert!(!fits.contains("Left out, as"));
        assert!(too_much.len() <= LARGEST_PAGE && too_much.len() > LARGEST_PAGE / 2);
        assert_eq!(too_much.matches("Left out, as").count(), 2);
        assert!(too_much.contains("<code>figures/picture-28.png"));
        assert!(!too_much.contains("<code>figures/picture-22.png"));
        // What is left out is named and described all the same.
        assert_eq!(too_much.matches("What it shows.").count(), all.len());
    }

    #[test]
    fn places_without_figures_say_what_fills_them() {
        let empty = page(&[]);
        assert_eq!(empty.matches("class=\"place\"").count(), 8,);
        assert!(empty.contains("<code>prone reproduce</code> makes it"));
        assert_eq!(empty.matches("Comes with a robot on the wire").count(), 1);
        // Held against nothing, a page has no places.
        let page = Page {
            runs: &[],
            shown: &[],
            cards: &[],
            publication: &Unpublished,
            arrangement: Arrangement::Chapter,
            left_out: BTreeSet::new(),
        };
        let (bare, _) = page.html().unwrap();
        assert!(!bare.contains("<h2>Figures</h2>"));
        let shown = [picture("22", 100)];
        let page = Page {
            runs: &[],
            shown: &shown,
            cards: &[],
            publication: &Unpublished,
            arrangement: Arrangement::Chapter,
            left_out: BTreeSet::new(),
        };
        let (unplaced, _) = page.html().unwrap();
        assert!(unplaced.contains("<h2>Figures</h2>"));
        assert_eq!(unplaced.matches("What it shows.").count(), 1);
        assert_eq!(bare.matches("class=\"place\"").count(), 0);
    }
}
