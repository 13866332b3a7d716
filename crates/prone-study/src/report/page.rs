//! The page: its order, its figures, and what stands where a figure is not there.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD as BASE64;
use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::chapter::{self, MadeBy, Part, Place};
use super::folder::Given;
use super::shown::{Image, Shown};
use super::study::StudyRun;
use super::{
    Card, LARGEST_PAGE, ReportError, Run, card_sections, parameter_tables, replay, run_sections,
    sections,
};

const STYLE: &str = include_str!("style.css");

/// Nothing leaves the page, and nothing comes to it. The frame of the replay inherits this.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
                      img-src data:; base-uri 'none'; form-action 'none'";

/// What a page is made of.
pub(super) struct Page<'a> {
    pub(super) runs: &'a [Run],
    pub(super) shown: &'a [Shown],
    pub(super) cards: &'a [Card],
}

impl Page<'_> {
    /// The page, and the folders that its replay shows.
    pub(super) fn html(&self) -> Result<(String, Vec<String>), ReportError> {
        let above = self.above();
        let below = self.below();
        let room = LARGEST_PAGE.saturating_sub(above.0.len() + below.0.len() + 2_000 + STYLE.len());
        let replay = replay::of(self.runs, room)?;
        let replayed = replay
            .as_ref()
            .map_or_else(Vec::new, |replay| replay.shown.clone());
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta http-equiv="Content-Security-Policy" content=(POLICY);
                    // Without it a browser asks the server for one.
                    link rel="icon" href="data:,";
                    title { "prone: report of " (self.titles().join(", ")) }
                    style { (PreEscaped(STYLE)) }
                }
                body {
                    (self.header())
                    main {
                        (above)
                        @if let Some(replay) = &replay { (replay_section(replay)) }
                        (below)
                    }
                    (footer())
                }
            }
        };
        Ok((page.into_string(), replayed))
    }

    /// What is before the replay.
    fn above(&self) -> Markup {
        html! {
            (self.shortfalls())
            @for study in self.studies() { (sections::results(&study.summary)) }
            (card_sections::all(self.cards))
        }
    }

    /// What is after it.
    fn below(&self) -> Markup {
        html! {
            @for part in &chapter::PARTS { (self.part(part)) }
            @for study in self.studies() {
                (sections::costs(&study.summary))
                (sections::agreement(&study.summary))
                (sections::contacts(&study.summary))
                (sections::stride(&study.summary))
                (sections::clamps(&study.summary))
                (sections::mappings(&study.summary))
                (sections::differences())
            }
            (run_sections::searches(self.runs))
            (self.beyond())
            (run_sections::what_was_run(self.runs))
        }
    }

    fn header(&self) -> Markup {
        html! {
            header {
                h1 { "The Projected Profile crawl: report" }
                p.lead {
                    "Made from the records of " (self.titles().join("; ")) ". Figures are numbered as in chapter 5 of the \
                     master's thesis that published this crawl (NYU Polytechnic, 2015). "
                    strong { "Ours" } " is what this program simulated; " strong { "published" }
                    " is the thesis; " strong { "theirs" } " is somebody else's. No robot took part."
                }
            }
        }
    }

    /// The folders that were named.
    fn titles(&self) -> Vec<String> {
        let folders = self.runs.iter().map(Run::folder);
        let named = folders.filter(|folder| folder.given == Given::Named);
        named
            .map(|folder| format!("{} ({})", folder.name, folder.command))
            .collect()
    }

    fn shortfalls(&self) -> Markup {
        let sentences: Vec<String> = self.runs.iter().flat_map(Run::shortfalls).collect();
        html! {
            @if !sentences.is_empty() {
                section.warning {
                    h2 { "Records that are not whole" }
                    ul { @for sentence in &sentences { li { (sentence) } } }
                }
            }
        }
    }

    fn studies(&self) -> impl Iterator<Item = &StudyRun> {
        self.runs.iter().filter_map(|run| match run {
            Run::Study(study) => Some(study.as_ref()),
            _ => None,
        })
    }

    fn part(&self, part: &Part) -> Markup {
        html! {
            section {
                h2 { (part.title) }
                p { (part.lead) }
                @for place in part.places {
                    (self.place(place))
                    (self.tables_after(place.number))
                }
            }
        }
    }

    /// The figures of one number, or what would fill their place.
    fn place(&self, place: &Place) -> Markup {
        let figures: Vec<&Shown> = self
            .shown
            .iter()
            .filter(|shown| shown.number == place.number)
            .collect();
        html! {
            @if figures.is_empty() { (empty(place)) }
            @for figure in &figures { (captioned(figure, self.runs.len() > 1, place.published)) }
        }
    }

    /// Tables of the chapter that follow a figure.
    fn tables_after(&self, number: &str) -> Markup {
        html! {
            @if number == "25" {
                @for study in self.studies() {
                    @for gait in &study.info.options.gaits {
                        @if gait.name == "nominal" { (parameter_tables::nominal(&gait.curves)) }
                        @if gait.name == "optimal" { (parameter_tables::optimal(&gait.curves)) }
                    }
                }
                @for run in self.runs {
                    @if let Run::Search(search) = run {
                        (parameter_tables::found(
                            &search.result.gait, &search.folder.name, &search.result.curves,
                        ))
                    }
                }
            }
            @if number == "28" {
                @for study in self.studies() {
                    @if !study.summary.table.is_empty() { (sections::table_crawl(&study.summary)) }
                }
            }
        }
    }

    /// Figures that the chapter does not have.
    fn beyond(&self) -> Markup {
        let others: Vec<&Shown> = self
            .shown
            .iter()
            .filter(|shown| shown.number.is_empty())
            .collect();
        html! {
            @if !others.is_empty() {
                section {
                    h2 { "Beyond the chapter" }
                    @for figure in others { (captioned(figure, self.runs.len() > 1, None)) }
                }
            }
        }
    }
}

fn footer() -> Markup {
    html! {
        footer {
            p {
                "Written by prone " (env!("CARGO_PKG_VERSION")) " from records that it made; nothing was \
                 simulated for this page. Text without a source is about the NAO."
            }
        }
    }
}

fn replay_section(replay: &replay::Replay) -> Markup {
    html! {
        section {
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

/// A figure that is not there: what fills its place.
fn empty(place: &Place) -> Markup {
    html! {
        div.place id={ "place-" (place.number) } {
            p {
                strong { "Figure " (place.number) ": " (place.shows) ". " }
                @match place.made_by {
                    MadeBy::Command(command) => {
                        "Not among these runs. " code { (command) } " makes it; give its folder to "
                        code { "prone report" } "."
                    }
                    MadeBy::Robot => {
                        "Comes with a robot on the wire, which prone does not drive yet."
                    }
                }
            }
            @if let Some(published) = place.published { p { (published) } }
        }
    }
}

fn captioned(figure: &Shown, several: bool, published: Option<&str>) -> Markup {
    html! {
        figure id=(figure.stem) {
            (image(figure))
            figcaption {
                strong {
                    @if !figure.number.is_empty() { "Figure " (figure.number) ". " }
                    (figure.title) ". "
                }
                (figure.caption)
                @if let Some(published) = published { " " (published) }
                @if several { " " span.run { "From " (figure.runs.join(", ")) "." } }
            }
        }
    }
}

fn image(figure: &Shown) -> Markup {
    let picture = |kind: &str, bytes: &[u8]| {
        html! { img alt=(figure.alt) src={ "data:image/" (kind) ";base64," (BASE64.encode(bytes)) }; }
    };
    match &figure.image {
        Image::Drawing { svg, .. } => html! {
            div.drawing role="img" aria-label=(figure.alt) { (PreEscaped(inline(svg))) }
        },
        Image::Recorded {
            small: Some(small), ..
        } => picture("png", small),
        // In an image nothing of a drawing can run or load.
        Image::Recorded { svg, .. } => html! { div.drawing { (picture("svg+xml", svg)) } },
    }
}

/// An SVG document as a part of a page: without its XML declaration.
fn inline(svg: &str) -> &str {
    svg.find("<svg").map_or(svg, |start| &svg[start..])
}
